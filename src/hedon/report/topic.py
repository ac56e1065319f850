"""The topics of an analysis, by the names that `hedon analyze --only` accepts."""

from collections.abc import Callable, Sequence

from hedon.analysis.result import ResultTable
from hedon.analysis.topic import drift, life, selection, treatment, world
from hedon.analysis.world.record import Conditions
from hedon.config.problem import did_you_mean
from hedon.error import HedonError
from hedon.study.verdict import verdict

TOPICS: dict[str, Callable[[Conditions], list[ResultTable]]] = {
    "verdict": verdict,
    "regime": world.regime,
    "lifetime": life.lifetime,
    "food": life.food,
    "energy": life.energy,
    "reproduction": life.reproductive_success,
    "generation": life.generation,
    "genealogy": world.genealogy_topic,
    "genome": selection.genome,
    "selection": selection.selection_topic,
    "price": selection.price_topic,
    "curvature": selection.curvature_topic,
    "drift": drift.drift,
    "reversion": drift.reversion_topic,
    "mode": drift.mode,
    "mutation": treatment.mutation_topic,
}


class TopicError(HedonError):
    """No topic has this name."""


def require_topics(names: Sequence[str]) -> Sequence[str]:
    """Checks names of topics and returns them unchanged.

    Raises:
        TopicError: One of them is not a topic.
    """
    for name in names:
        if name not in TOPICS:
            hint = did_you_mean(name, TOPICS, ".")
            raise TopicError(f"there is no topic {name!r}{hint} There are: {', '.join(TOPICS)}")
    return names


def choose_topics(names: str | None) -> tuple[str, ...]:
    """The topics in a list such as "lifetime,selection", in that order; all topics for None.

    Raises:
        TopicError: One of the names is not a topic.
    """
    if names is None:
        return tuple(TOPICS)
    requested = require_topics([name.strip() for name in names.split(",") if name.strip()])
    return tuple(name for name in TOPICS if name in requested)


ONE_PARENT = ("genealogy", "price", "drift", "reversion", "mutation")
"""Topics that follow genes along pedigrees, which requires that each child has one parent."""


Tell = Callable[[int, int, str], None]
"""Progress callback, called before each step with the number of finished steps, their total and the next step."""


def tell_nobody(done: int, of: int, step: str) -> None:
    """A progress callback that ignores its arguments."""


def run_topics(
    conditions: Conditions, names: Sequence[str] = tuple(TOPICS), tell: Tell = tell_nobody
) -> list[ResultTable]:
    """The tables of some topics.

    Tables without rows are omitted, and worlds with two parents are left out of topics that need one parent.
    """
    trees = {
        condition: asexual_worlds
        for condition, worlds in conditions.items()
        if (asexual_worlds := [world for world in worlds if world.species_config.birth.mating == "none"])
    }
    tables: list[ResultTable] = []
    for done, name in enumerate(names):
        tell(done, len(names), name)
        tables += TOPICS[name](trees if name in ONE_PARENT else conditions)
    return [table for table in tables if not table.rows.is_empty()]
