"""What a reproduction should make: which items, at which scale, and hence which worlds."""

import math
from dataclasses import dataclass

from hedon.config import digest
from hedon.ensemble.demand import Demand
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


def needs(request: Request) -> list[Demand]:
    """The worlds that a request needs, by setting; of each seed as many steps as the most demanding item asks for."""
    found: dict[str, Demand] = {}
    for item, condition in ((each, condition) for each in request.items for condition in each.conditions):
        config = condition.config(request.fidelity)
        key = digest(config)
        need = found.setdefault(key, Demand(config, key, founders=condition.table(request.fidelity)))
        scale = request.scale(item)
        need.frames = math.gcd(need.frames, item.frames)  # 0 where neither needs them
        for seed in scale.seeds:
            need.steps[seed] = max(need.steps.get(seed, 0), scale.steps)
    return list(found.values())
