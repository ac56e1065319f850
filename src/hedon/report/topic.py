"""The list of topics, by the names that `hedon analyze --only` takes."""

from collections.abc import Callable, Sequence

from hedon.analysis.result import ResultTable
from hedon.analysis.topic import drift, life, selection, treatment, world
from hedon.analysis.world.record import Conditions
from hedon.config.problem import nearest
from hedon.error import HedonError
from hedon.study.verdict_table import verdict

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
    """There is no topic of that name."""


def require_topics(names: Sequence[str]) -> Sequence[str]:
    """The same names.

    Raises:
        TopicError: one of them is none.
    """
    for name in names:
        if name not in TOPICS:
            near = nearest(name, TOPICS)
            hint = f"; did you mean {near}?" if near else "."
            raise TopicError(f"there is no topic {name!r}{hint} There are: {', '.join(TOPICS)}")
    return names


def choose_topics(names: str | None) -> tuple[str, ...]:
    """The topics of a list such as "lifetime,selection", in their order; all of them for None.

    Raises:
        TopicError: one of them is none.
    """
    if names is None:
        return tuple(TOPICS)
    wanted = require_topics([name.strip() for name in names.split(",") if name.strip()])
    return tuple(name for name in TOPICS if name in wanted)


ONE_PARENT = ("genealogy", "price", "drift", "reversion", "mutation")
"""Topics that follow genes along pedigrees, from one parent to its child."""


Tell = Callable[[int, int, str], None]
"""Is told of each step before it begins: how many are done, of how many, and what comes."""


def tell_nobody(done: int, of: int, step: str) -> None:
    """A `Tell` for those who need not know."""


def run_topics(
    conditions: Conditions, names: Sequence[str] = tuple(TOPICS), tell: Tell = tell_nobody
) -> list[ResultTable]:
    """The tables of some topics; those without rows are left out, and worlds with two parents where one is needed."""
    trees = {
        condition: alone
        for condition, worlds in conditions.items()
        if (alone := [world for world in worlds if world.own.birth.mating == "none"])
    }
    tables: list[ResultTable] = []
    for done, name in enumerate(names):
        tell(done, len(names), name)
        tables += TOPICS[name](trees if name in ONE_PARENT else conditions)
    return [table for table in tables if not table.rows.is_empty()]
