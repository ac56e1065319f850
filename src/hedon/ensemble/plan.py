"""The plan of a sweep: its conditions and batches, stored with the sweep.

The plan lists what is wanted now. The name of each result contains the digest of its config, its steps and its seeds,
so a plan can grow without repeating finished work.
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
"""Largest number of characters of the seeds in a name."""

Done = Mapping[str, set[int]]
"""Finished seeds, by the prefix of the names of a condition's batches."""


@dataclass(frozen=True, slots=True)
class Batch:
    """Worlds of one condition that share a process.

    Attributes:
        name: Stem of its files: the digest of the config, the steps and the seeds.
        condition: Index of the condition in the plan.
        seeds: Seeds of its worlds.
    """

    name: str
    condition: int
    seeds: tuple[int, ...]


@dataclass(frozen=True)
class SweepPlan:
    """The stored plan of a sweep.

    Attributes:
        name: Name of the sweep.
        steps: Length of each world [step].
        seeds: Seeds of every condition.
        rounds: Seeds of the batches in each round; every condition has one batch per round.
        keep: Which records to keep in addition to the table.
        order_seed: Seed of the order of conditions within a round.
        factors: Names of the factors, in order.
        ranged: Names of the factors whose values are drawn from ranges.
        places: Settings that each factor changes, by base.
        conditions: The conditions, each with its base and values.
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
        """The number of worlds."""
        return len(self.seeds) * len(self.conditions)

    @property
    def world_steps(self) -> int:
        """Steps summed over all worlds, if none dies out [step]."""
        return self.steps * self.worlds

    def key(self, condition: SweepCondition) -> str:
        """The prefix of the names of a condition's batches."""
        return f"{condition.digest}-{self.steps}"

    def batches(self) -> Iterator[Batch]:
        """All batches in order of execution: every condition has its first batch before any has its second.

        If a sweep is stopped, the numbers of worlds per condition therefore differ by one round at most.
        Within a round the order is random, so that the missing conditions are not at one end of a range.
        """
        rng = np.random.default_rng(self.order_seed)
        for seeds in self.rounds:
            for condition in rng.permutation(len(self.conditions)).tolist():
                yield self._batch(condition, seeds)

    def left(self, done: Done, part: tuple[int, int] = (1, 1)) -> list[Batch]:
        """The batches of unfinished worlds, in order.

        Args:
            done: Finished seeds of each condition.
            part: Number of a part, from 1, and the number of parts; only batches of this part are returned.
        """
        batches: list[Batch] = []
        for index, batch in enumerate(self.batches()):
            if index % part[1] == part[0] - 1:
                finished = done.get(self.key(self.conditions[batch.condition]), ())
                seeds = tuple(seed for seed in batch.seeds if seed not in finished)
                if seeds:
                    batches.append(batch if seeds == batch.seeds else self._batch(batch.condition, seeds))
        return batches

    def changes(self, condition: SweepCondition) -> dict[str, Any]:
        """The settings that a condition changes in its base, by complete path."""
        return changes(self.places[condition.base], condition.settings)

    def text(self) -> str:
        """The plan as JSON, with one list of values per factor."""
        bases = list(self.places)
        content = {
            "format": FORMAT,
            **{name: getattr(self, name) for name in _PLAIN},
            "places": self.places,
            "bases": [bases.index(condition.base) for condition in self.conditions],
            "digests": [condition.digest for condition in self.conditions],
            "values": {name: [condition.settings[name] for condition in self.conditions] for name in self.factors},
        }
        return json.dumps(content, ensure_ascii=False) + "\n"

    def _batch(self, condition: int, seeds: tuple[int, ...]) -> Batch:
        return Batch(f"{self.key(self.conditions[condition])}-{seed_text(seeds)}", condition, seeds)


_PLAIN = ("name", "steps", "seeds", "rounds", "keep", "order_seed", "factors", "ranged")


@dataclass(frozen=True)
class SweepFile:
    """The content of a sweep's file.

    Attributes:
        plan: The plan that follows from it.
        bases: The base configs of its conditions, by digest.
        worlds: Largest number of worlds in a batch.
        left_out: Invalid conditions that were left out, with the reason.
    """

    plan: SweepPlan
    bases: Mapping[str, Base]
    worlds: int
    left_out: tuple[str, ...] = ()


def read_name(name: str) -> tuple[str, tuple[int, ...]]:
    """The prefix and the seeds in the name of a result; both empty for any other file."""
    match = re.fullmatch(r"([0-9a-f]+-[0-9]+)-([0-9.-]+)\.json", name)
    return (match[1], parse_seeds(match[2].replace(".", ","))) if match else ("", ())


def done_seeds(names: Sequence[str]) -> dict[str, set[int]]:
    """The finished seeds, from the names of results."""
    done: dict[str, set[int]] = {}
    for key, seeds in map(read_name, names):
        done.setdefault(key, set()).update(seeds)
    return done


def rounds_of(seeds: Sequence[int], worlds: int) -> tuple[tuple[int, ...], ...]:
    """Divides seeds into groups, one for each batch of a condition.

    Args:
        seeds: Seeds of a condition.
        worlds: Largest number of worlds in a batch.
    """
    ends = [0]
    for i in range(len(seeds)):
        if i - ends[-1] == worlds or len(seed_text(seeds[ends[-1] : i + 1])) > LONGEST_SEEDS:
            ends.append(i)
    return tuple(tuple(seeds[low:high]) for low, high in pairwise([*ends, len(seeds)]) if high > low)


def write_plan(file: SweepFile, store: Store) -> SweepPlan:
    """Writes the plan of a sweep to its store, which makes the sweep independent of its file.

    A plan that is already there is extended. Configs are written first and the plan last, so an existing plan is always
    complete. Worlds in both plans keep their batches.

    Raises:
        EnsembleError: The store contains a run, or a sweep that has another length or no world of this one; or it
            cannot be written.
    """
    if store.folder is not None and holds_run(store.folder):
        raise EnsembleError(f"{store.location} holds a run: give the sweep another place with --out")
    plan, previous = file.plan, load_plan(store) if store.read(PLAN) is not None else None
    if previous is not None:
        shared = set(map(plan.key, plan.conditions)) & set(map(previous.key, previous.conditions))
        if plan.steps != previous.steps:
            raise EnsembleError(
                f"{store.location} holds a sweep of {previous.steps:,} steps, and {plan.name}.toml asks for "
                f"{plan.steps:,}: worlds of a sweep do not get longer, so give another place with --out"
            )
        if not shared or not set(plan.seeds) & set(previous.seeds):
            raise EnsembleError(
                f"{store.location} holds another sweep, which has no world of that of {plan.name}.toml: give another "
                f"place with --out, or go on with that one by `hedon sweep resume {store.location}`"
            )
        kept_rounds = [tuple(seed for seed in round_seeds if seed in plan.seeds) for round_seeds in previous.rounds]
        new = [seed for seed in plan.seeds if seed not in previous.seeds]
        plan = replace(plan, rounds=(*filter(None, kept_rounds), *rounds_of(new, file.worlds)))
        if plan.text() == previous.text():
            return previous
    for name, base in file.bases.items():
        if previous is None or name not in previous.places:
            store.write(_config_name(name), dump_toml(base.config).encode())
            for rule in base.rules:
                store.write(_rule_name(rule.digest), rule.text.encode())
    store.write(PLAN, plan.text().encode())
    store.remove(TABLE)  # it belongs to the earlier plan
    return plan


def load_plan(store: Store) -> SweepPlan:
    """Reads a plan.

    Raises:
        EnsembleError: There is no plan, or it cannot be read.
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
        fields = {name: _tuples(read[name]) for name in _PLAIN}
        places = {
            base: {name: tuple(paths) for name, paths in mapping.items()} for base, mapping in read["places"].items()
        }
        return SweepPlan(**fields, places=places, conditions=conditions)
    except (ValueError, KeyError, TypeError, AttributeError, IndexError) as error:
        raise EnsembleError(f"{store.location}: {PLAN} cannot be read: {error}") from error


def _tuples(value: Any) -> Any:
    return tuple(map(_tuples, value)) if isinstance(value, list) else value


def load_bases(plan: SweepPlan, store: Store) -> list[Config]:
    """The base configs of a sweep's conditions, without missing ones.

    Raises:
        ConfigError: One of them cannot be read.
    """
    texts = ((_config_name(base), store.read(_config_name(base))) for base in plan.places)
    return [parse_config(text.decode(), f"{store.location}/{name}") for name, text in texts if text is not None]


def load_config_of(store: Store, key: str, base: str, changed: Mapping[str, Any]) -> Config:
    """The config of a condition.

    Args:
        store: Where the sweep is stored.
        key: Digest that the config must have.
        base: Digest of its base.
        changed: Settings to change in the base, by complete path.

    Raises:
        EnsembleError: The base is missing, or the config does not have this digest.
        ConfigError: The base cannot be read.
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
    """The source texts of the rules to which a condition is pinned.

    Raises:
        EnsembleError: One of them is missing or damaged.
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
