"""What a reproduction should make: which items, at which scale, and hence which worlds."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from hedon.config import Config, digest
from hedon.config.load import changed_settings
from hedon.config.problem import format_value
from hedon.record.founder import Founders
from hedon.record.reader import Run
from hedon.study.item import Item, Scale


@dataclass(frozen=True)
class Request:
    """The items that are wanted, and how much is to be run for them.

    Attributes:
        items: in the order in which they are shown.
        fidelity: of the conditions that have none of their own.
        seeds: one world each, in the place of the items' own; None for those.
        steps: of each world, in the place of the items' own [step]; None for those.
    """

    items: tuple[Item, ...]
    fidelity: str
    seeds: tuple[int, ...] | None = None
    steps: int | None = None

    def scale(self, item: Item) -> Scale:
        """How much is run of each condition of an item. A picture needs no more than its own scale."""
        if item.pictures:
            return item.scale
        return Scale(self.seeds or item.scale.seeds, self.steps or item.scale.steps)


@dataclass
class RunRequirement:
    """A setting that worlds are needed of, by one item or several.

    Attributes:
        config: the setting.
        digest: of the config: settings of equal digest share their worlds.
        steps: of each seed [step].
        frames: steps between two records of all positions; 0 where no item needs them.
        founders: genomes that its worlds begin with; None where they are drawn from the setting's laws.
    """

    config: Config
    digest: str
    steps: dict[int, int] = field(default_factory=dict)
    frames: int = 0
    founders: Founders | None = None

    def has_frames(self, run: Run) -> bool:
        """Whether a run recorded the positions that are needed."""
        every = run.manifest.frames
        return self.frames == 0 or (every > 0 and self.frames % every == 0)


def needs(request: Request) -> list[RunRequirement]:
    """The worlds that a request needs, by setting; of each seed as many steps as the most demanding item asks for."""
    found: dict[str, RunRequirement] = {}
    for item, condition in ((each, condition) for each in request.items for condition in each.conditions):
        config = condition.config(request.fidelity)
        key = digest(config)
        need = found.setdefault(key, RunRequirement(config, key, founders=condition.table(request.fidelity)))
        scale = request.scale(item)
        need.frames = math.gcd(need.frames, item.frames)  # 0 where neither needs them
        for seed in scale.seeds:
            need.steps[seed] = max(need.steps.get(seed, 0), scale.steps)
    return list(found.values())


def part_of(requirements: Sequence[RunRequirement], part: tuple[int, int]) -> list[RunRequirement]:
    """The share of some worlds that one of several machines makes.

    Args:
        requirements: of all worlds.
        part: number, from 1 on, and count of parts into which worlds are dealt out in turn.
    """
    number, count = part
    worlds = [(need, seed) for need in requirements for seed in need.steps][number - 1 :: count]
    shares = [
        replace(need, steps={seed: need.steps[seed] for of, seed in worlds if of is need}) for need in requirements
    ]
    return [share for share in shares if share.steps]


def setting_name(config: Config) -> str:
    """What a setting is called: its preset and fidelity, and what it changes; no two settings have one name."""
    words = [f"{path} {format_value(new)}" for path, _, new in changed_settings(config)]
    return ", ".join([f"{config.preset} ({config.fidelity})", *words])
