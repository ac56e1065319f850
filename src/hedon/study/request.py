"""A request: the items of studies to make, their scale, and the worlds that they need."""

import math
from dataclasses import dataclass

from hedon.config import digest
from hedon.ensemble.demand import Demand
from hedon.study.item import Item, Scale


@dataclass(frozen=True)
class Request:
    """The requested items, and the number and length of their worlds.

    Attributes:
        items: The items, in the order in which they are shown.
        fidelity: Fidelity of the conditions that do not set their own.
        seeds: Seeds that replace the items' own seeds; None to keep them.
        steps: Length of each world that replaces the items' own length [step]; None to keep it.
    """

    items: tuple[Item, ...]
    fidelity: str
    seeds: tuple[int, ...] | None = None
    steps: int | None = None

    def scale(self, item: Item) -> Scale:
        """The number and length of worlds for each condition of an item. A picture needs no more than its own scale."""
        if item.pictures:
            return item.scale
        return Scale(self.seeds or item.scale.seeds, self.steps or item.scale.steps)


def needs(request: Request) -> list[Demand]:
    """The worlds that a request needs, by condition; each seed gets the steps of the most demanding item."""
    demands: dict[str, Demand] = {}
    for item, condition in ((entry, condition) for entry in request.items for condition in entry.conditions):
        config = condition.config(request.fidelity)
        key = digest(config)
        demand = demands.setdefault(key, Demand(config, key, founders=condition.table(request.fidelity)))
        scale = request.scale(item)
        demand.frames = math.gcd(demand.frames, item.frames)  # 0 if neither needs them
        for seed in scale.seeds:
            demand.steps[seed] = max(demand.steps.get(seed, 0), scale.steps)
    return list(demands.values())
