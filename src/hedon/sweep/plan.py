"""The plan of a sweep: its conditions and batches, as it is written where the sweep lives."""

import json
import re
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from hedon.config.config import Config
from hedon.config.dump import dump_toml
from hedon.config.load import parse_config
from hedon.config.rule_path import RULE_PATTERN, rule_places
from hedon.jobs.store import Store
from hedon.record.manifest import RuleSource
from hedon.sweep.design import Settings
from hedon.sweep.error import SweepError

PLAN = "plan.json"
FORMAT = 1


@dataclass(frozen=True)
class Batch:
    """Worlds of one condition that share a process.

    Attributes:
        name: of its files.
        condition: index of the condition.
        first: number of the repetition of its first world, from 1 on.
        seeds: one world for each.
    """

    name: str
    condition: int
    first: int
    seeds: tuple[int, ...]


@dataclass(frozen=True)
class SweepPlan:
    """A sweep as it is written.

    Attributes:
        name: of the sweep.
        steps: of each world [step].
        seeds: of each condition.
        worlds: most worlds of a batch.
        keep: what is kept beside the table.
        order_seed: of the order in which conditions take turns.
        factors: names, in order.
        ranged: names of those whose values are drawn from ranges.
        settings: values of the factors, by condition.
        digests: of the configs, by condition.
    """

    name: str
    steps: int
    seeds: tuple[int, ...]
    worlds: int
    keep: tuple[str, ...]
    order_seed: int
    factors: tuple[str, ...]
    ranged: tuple[str, ...]
    settings: tuple[Settings, ...]
    digests: tuple[str, ...]

    @property
    def world_steps(self) -> int:
        """Steps of all worlds together, if none dies out."""
        return self.steps * len(self.seeds) * len(self.settings)

    def batches(self) -> list[Batch]:
        """All batches in their order: every condition has one before any has the next.

        So a sweep that is stopped has as many worlds of each condition as of any other, but for those of one round.
        Within a round the order is drawn, so that what is missing is no end of a range.
        """
        return list(self._batches())

    def _batches(self) -> Iterator[Batch]:
        rng = np.random.default_rng(self.order_seed)
        for begin in range(0, len(self.seeds), self.worlds):
            seeds = self.seeds[begin : begin + self.worlds]
            for condition in rng.permutation(len(self.settings)).tolist():
                yield Batch(f"c{condition:05d}-r{begin + 1:05d}", condition, begin + 1, seeds)

    def text(self) -> str:
        """As JSON."""
        return json.dumps({"format": FORMAT, **asdict(self)}, indent=1, ensure_ascii=False) + "\n"


@dataclass(frozen=True)
class Condition:
    """One setting of a sweep: the values of its factors, the config that follows, and the texts of its rules."""

    settings: Settings
    config: Config
    rules: tuple[RuleSource, ...]


@dataclass(frozen=True)
class SweepFile:
    """What the file of a sweep asks for: its plan, and every condition in the order of the plan."""

    plan: SweepPlan
    conditions: tuple[Condition, ...]


def write_plan(file: SweepFile, store: Store) -> SweepPlan:
    """Writes the plan, so that the sweep needs its file no longer; does nothing if it is there already.

    Configs come first and the plan last: where there is a plan, all of it is there.

    Args:
        file: The sweep as its file describes it.
        store: Where the sweep lives.

    Raises:
        SweepError: another sweep lives there, or it cannot be written.
    """
    plan = file.plan
    before = store.read(PLAN)
    if before is not None:
        if before != plan.text().encode():
            raise SweepError(
                f"{store.location} holds another sweep than that of {plan.name}.toml: give another place with --out, "
                f"or go on with that one by `hedon sweep resume {store.location}`"
            )
        return plan
    for index, condition in enumerate(file.conditions):
        store.write(_config_name(index), dump_toml(condition.config).encode())
    for rule in {rule for condition in file.conditions for rule in condition.rules}:
        store.write(_rule_name(rule.digest), rule.text.encode())
    store.write(PLAN, plan.text().encode())
    return plan


def load_plan(store: Store) -> SweepPlan:
    """Reads a plan.

    Raises:
        SweepError: there is none, or it cannot be read.
    """
    content = store.read(PLAN)
    if content is None:
        raise SweepError(f"{store.location} holds no sweep: it has no {PLAN}")
    try:
        values: dict[str, Any] = json.loads(content)
        version = values.pop("format")
        if version != FORMAT:
            raise SweepError(f"{store.location}: {PLAN} has format {version}, and this hedon reads {FORMAT}")
        lists: dict[str, Any] = {
            key: tuple(value) if isinstance(value, list) else value for key, value in values.items()
        }
        return SweepPlan(**lists)
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        raise SweepError(f"{store.location}: {PLAN} cannot be read: {error}") from error


def load_condition(store: Store, index: int) -> Config:
    """The config of a condition.

    Args:
        store: Where the sweep lives.
        index: Of the condition in the plan.

    Raises:
        SweepError: It is missing.
        ConfigError: It cannot be read.
    """
    name = _config_name(index)
    content = store.read(name)
    if content is None:
        raise SweepError(f"{store.location} has no {name}: make the sweep again in another place")
    return parse_config(content.decode(), f"{store.location}/{name}")


def load_rules(store: Store, config: Config) -> tuple[RuleSource, ...]:
    """The texts of the rules that a condition is pinned to.

    Args:
        store: Where the sweep lives.
        config: Of the condition.

    Raises:
        SweepError: One is missing or damaged.
    """
    return tuple(_load_rule(store, place) for place in rule_places(config))


def _load_rule(store: Store, place: str) -> RuleSource:
    match = re.fullmatch(RULE_PATTERN, place)
    content = store.read(_rule_name(match[3] or "")) if match else None
    if match is None or content is None:
        raise SweepError(f"{store.location} has no text of the rule {place}: make the sweep again in another place")
    return RuleSource(match[1], match[2], match[3], content.decode())


def _rule_name(digest: str) -> str:
    return f"rules/{digest}.py"


def _config_name(index: int) -> str:
    return f"configs/c{index:05d}.toml"
