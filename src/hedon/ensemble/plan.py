"""The plan of a sweep: its conditions and batches, as it is written where the sweep lives.

It says what is wanted now. What is done is known by its own name, which has the digest of its config, its steps and its
seeds: so a plan can grow, and nothing that is done is done again.
"""

import json
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np

from hedon.config.config import Config
from hedon.config.dump import digest, dump_toml
from hedon.config.load import parse_config
from hedon.config.rule_path import RULE_PATTERN, rule_places
from hedon.config.validate import rebuild
from hedon.ensemble.condition import DIGITS, Base, SweepCondition, changes, seed_text
from hedon.ensemble.error import EnsembleError
from hedon.ensemble.store import Store
from hedon.experiment.argument import parse_seeds
from hedon.record.folder import holds_run
from hedon.record.manifest import RuleSource

PLAN, TABLE = "plan.json", "table.parquet"
FORMAT = 2
LONGEST_SEEDS = 120
"""Most characters of the seeds in a name."""

Done = Mapping[str, set[int]]
"""Seeds that are done, by the beginning of the names of a condition's batches."""


@dataclass(frozen=True, slots=True)
class Batch:
    """Worlds of one condition that share a process.

    Attributes:
        name: of its files: the config's digest, the steps, and the seeds.
        condition: index of the condition.
        seeds: one world for each.
    """

    name: str
    condition: int
    seeds: tuple[int, ...]


@dataclass(frozen=True)
class SweepPlan:
    """A sweep as it is written.

    Attributes:
        name: of the sweep.
        steps: of each world [step].
        seeds: of each condition.
        rounds: the seeds of its batches, in the order in which conditions take turns.
        keep: what is kept beside the table.
        order_seed: of the order within a round.
        factors: names, in order.
        ranged: names of those whose values are drawn from ranges.
        places: by base, the settings that each factor changes in it.
        conditions: each with its base and values.
    """

    name: str
    steps: int
    seeds: tuple[int, ...]
    rounds: tuple[tuple[int, ...], ...]
    keep: tuple[str, ...]
    order_seed: int
    factors: tuple[str, ...]
    ranged: tuple[str, ...]
    places: Mapping[str, Mapping[str, Sequence[str]]]
    conditions: tuple[SweepCondition, ...]

    @property
    def worlds(self) -> int:
        """How many there are."""
        return len(self.seeds) * len(self.conditions)

    @property
    def world_steps(self) -> int:
        """Steps of all worlds together, if none dies out."""
        return self.steps * self.worlds

    def key(self, condition: SweepCondition) -> str:
        """The beginning of the names of a condition's batches."""
        return f"{condition.digest}-{self.steps}"

    def batches(self) -> Iterator[Batch]:
        """All batches in their order: every condition has one before any has the next.

        So a sweep that is stopped has as many worlds of each condition as of any other, but for those of one round.
        Within a round the order is drawn, so that what is missing is no end of a range.
        """
        rng = np.random.default_rng(self.order_seed)
        for seeds in self.rounds:
            for condition in rng.permutation(len(self.conditions)).tolist():
                yield self._batch(condition, seeds)

    def left(self, done: Done, part: tuple[int, int] = (1, 1)) -> list[Batch]:
        """The batches of worlds that are not done, in their order."""
        found: list[Batch] = []
        for index, batch in enumerate(self.batches()):
            if index % part[1] == part[0] - 1:
                known = done.get(self.key(self.conditions[batch.condition]), ())
                seeds = tuple(seed for seed in batch.seeds if seed not in known)
                if seeds:
                    found.append(batch if seeds == batch.seeds else self._batch(batch.condition, seeds))
        return found

    def changes(self, condition: SweepCondition) -> dict[str, Any]:
        """What a condition changes in its base, by complete paths."""
        return changes(self.places[condition.base], condition.settings)

    def text(self) -> str:
        """As JSON; the values of a factor are one list."""
        bases = list(self.places)
        content = {
            "format": FORMAT,
            **{name: getattr(self, name) for name in _PLAIN},
            "places": self.places,
            "bases": [bases.index(each.base) for each in self.conditions],
            "digests": [each.digest for each in self.conditions],
            "values": {name: [each.settings[name] for each in self.conditions] for name in self.factors},
        }
        return json.dumps(content, ensure_ascii=False) + "\n"

    def _batch(self, condition: int, seeds: tuple[int, ...]) -> Batch:
        return Batch(f"{self.key(self.conditions[condition])}-{seed_text(seeds)}", condition, seeds)


_PLAIN = ("name", "steps", "seeds", "rounds", "keep", "order_seed", "factors", "ranged")


@dataclass(frozen=True)
class SweepFile:
    """What the file of a sweep asks for.

    Attributes:
        plan: its plan.
        bases: the configs that conditions begin with.
        worlds: most worlds of a batch.
        left_out: conditions that cannot be, and why.
    """

    plan: SweepPlan
    bases: Mapping[str, Base]
    worlds: int
    left_out: tuple[str, ...] = ()


def read_name(name: str) -> tuple[str, tuple[int, ...]]:
    """What the name of a result says: the beginning that its condition has, and its seeds; none for another file."""
    match = re.fullmatch(r"([0-9a-f]+-[0-9]+)-([0-9.-]+)\.json", name)
    return (match[1], parse_seeds(match[2].replace(".", ","))) if match else ("", ())


def done_seeds(names: Sequence[str]) -> dict[str, set[int]]:
    """What is done, from the names of results."""
    done: dict[str, set[int]] = {}
    for key, seeds in map(read_name, names):
        done.setdefault(key, set()).update(seeds)
    return done


def rounds_of(seeds: Sequence[int], worlds: int) -> tuple[tuple[int, ...], ...]:
    """Seeds in groups that make a batch each."""
    ends = [0]
    for i in range(len(seeds)):
        if i - ends[-1] == worlds or len(seed_text(seeds[ends[-1] : i + 1])) > LONGEST_SEEDS:
            ends.append(i)
    return tuple(tuple(seeds[low:high]) for low, high in pairwise([*ends, len(seeds)]) if high > low)


def write_plan(file: SweepFile, store: Store) -> SweepPlan:
    """Writes the plan, so that the sweep needs its file no longer; one that is there already grows into it.

    Configs come first and the plan last: where there is a plan, all of it is there. Worlds that are in both plans
    keep their batches.

    Raises:
        EnsembleError: a sweep lives there that has no world of this one, or it cannot be written.
    """
    if store.folder is not None and holds_run(store.folder):
        raise EnsembleError(f"{store.location} holds a run: give the sweep another place with --out")
    plan, before = file.plan, load_plan(store) if store.read(PLAN) is not None else None
    if before is not None:
        shared = set(map(plan.key, plan.conditions)) & set(map(before.key, before.conditions))
        if plan.steps != before.steps:
            raise EnsembleError(
                f"{store.location} holds a sweep of {before.steps:,} steps, and {plan.name}.toml asks for "
                f"{plan.steps:,}: worlds of a sweep do not get longer, so give another place with --out"
            )
        if not shared or not set(plan.seeds) & set(before.seeds):
            raise EnsembleError(
                f"{store.location} holds another sweep, which has no world of that of {plan.name}.toml: give another "
                f"place with --out, or go on with that one by `hedon sweep resume {store.location}`"
            )
        kept = [tuple(seed for seed in each if seed in plan.seeds) for each in before.rounds]
        new = [seed for seed in plan.seeds if seed not in before.seeds]
        plan = replace(plan, rounds=(*filter(None, kept), *rounds_of(new, file.worlds)))
        if plan.text() == before.text():
            return before
    for name, base in file.bases.items():
        if before is None or name not in before.places:
            store.write(_config_name(name), dump_toml(base.config).encode())
            for rule in base.rules:
                store.write(_rule_name(rule.digest), rule.text.encode())
    store.write(PLAN, plan.text().encode())
    store.remove(TABLE)  # of what was wanted before
    return plan


def load_plan(store: Store) -> SweepPlan:
    """Reads a plan.

    Raises:
        EnsembleError: there is none, or it cannot be read.
    """
    content = store.read(PLAN)
    if content is None:
        raise EnsembleError(f"{store.location} holds no sweep: it has no {PLAN}")
    try:
        read: dict[str, Any] = json.loads(content)
        if read["format"] != FORMAT:
            raise EnsembleError(
                f"{store.location}: {PLAN} has format {read['format']}, and this hedon reads {FORMAT}: make the sweep "
                "again in another place"
            )
        bases, columns = list(read["places"]), read["values"]
        rows = zip(*columns.values(), strict=True) if columns else [()] * len(read["digests"])
        conditions = tuple(
            SweepCondition(key, bases[base], dict(zip(columns, row, strict=True)))
            for key, base, row in zip(read["digests"], read["bases"], rows, strict=True)
        )
        plain = {name: _tuples(read[name]) for name in _PLAIN}
        places = {base: {name: tuple(own) for name, own in each.items()} for base, each in read["places"].items()}
        return SweepPlan(**plain, places=places, conditions=conditions)
    except (ValueError, KeyError, TypeError, AttributeError, IndexError) as error:
        raise EnsembleError(f"{store.location}: {PLAN} cannot be read: {error}") from error


def _tuples(value: Any) -> Any:
    return tuple(map(_tuples, value)) if isinstance(value, list) else value


def load_bases(plan: SweepPlan, store: Store) -> list[Config]:
    """The configs that the conditions of a sweep begin with, as far as they are there.

    Raises:
        ConfigError: One cannot be read.
    """
    texts = ((_config_name(base), store.read(_config_name(base))) for base in plan.places)
    return [parse_config(text.decode(), f"{store.location}/{name}") for name, text in texts if text is not None]


def load_config_of(store: Store, key: str, base: str, changed: Mapping[str, Any]) -> Config:
    """The config of a condition.

    Raises:
        EnsembleError: It is missing, or another one.
        ConfigError: It cannot be read.
    """
    name = _config_name(base)
    content = store.read(name)
    if content is None:
        raise EnsembleError(f"{store.location} has no {name}: make the sweep again in another place")
    config = rebuild(parse_config(content.decode(), f"{store.location}/{name}"), changed, f"{store.location}/{name}")
    if digest(config)[:DIGITS] != key:
        raise EnsembleError(f"{store.location}/{name} is not the planned config: make the sweep again elsewhere")
    return config


def load_rules(store: Store, config: Config) -> tuple[RuleSource, ...]:
    """The texts of the rules that a condition is pinned to.

    Raises:
        EnsembleError: One is missing or damaged.
    """
    return tuple(_load_rule(store, place) for place in rule_places(config))


def _load_rule(store: Store, place: str) -> RuleSource:
    match = re.fullmatch(RULE_PATTERN, place)
    content = store.read(_rule_name(match[3] or "")) if match else None
    if match is None or content is None:
        raise EnsembleError(f"{store.location} has no text of the rule {place}: make the sweep again in another place")
    return RuleSource(match[1], match[2], match[3], content.decode())


def _rule_name(digest: str) -> str:
    return f"rules/{digest}.py"


def _config_name(digest: str) -> str:
    return f"configs/{digest}.toml"
