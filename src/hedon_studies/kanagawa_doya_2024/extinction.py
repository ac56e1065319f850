"""The paper's table of extinction: at which costs of living and of action does a world die out?"""

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from hedon.analysis import ResultTable, WorldRecord, make_table, mean_alive, mean_energy, run_tail, world_extinction
from hedon.statistic import fisher_mid_p, mean_interval, survival_curve
from hedon.study import Condition, Item, ItemInputs, Scale, missing, present, sentences
from hedon_studies.kanagawa_doya_2024.paper import EXTINCTION, EXTINCTION_SEEDS, EXTINCTION_STEP

_READ = (
    "Costs are those of living [energy/step] and of action [energy/(step·force)]. The share is that of worlds extinct "
    "by the step named, over all worlds (Kaplan and Meier; living ones that end earlier are censored), with the mid-p "
    "interval of the beta product. The paper's is by step 1,024,000, of ten; p_paper is the chance of shares at least "
    "that far apart if both are the same (mid-p Fisher), where all worlds are known to that step. The median step of "
    "extinction counts living worlds as censored, and is known where half of the worlds died out. Agents alive and "
    "their energy are means over the last tenth of the worlds that live."
)


def _condition(basic_cost: float, action_cost: float) -> Condition:
    overrides = (f"energy.basic_cost={basic_cost!r}", f"energy.action_cost={action_cost!r}")
    return Condition(f"{basic_cost:g}, {action_cost:.0e}".replace("e-0", "e-"), overrides=overrides)


CONDITIONS = {_condition(*costs): share for costs, share in EXTINCTION.items()}
"""The paper's conditions, with the share of worlds that it reports as extinct."""


def _make(inputs: ItemInputs) -> Iterator[ResultTable]:
    worlds = present(CONDITIONS, inputs)
    truncated = {label: [world.until(EXTINCTION_STEP) for world in group] for label, group in worlds.items()}
    title = "Extinction by the costs of living and of action"
    rows = [
        _row(condition, truncated[condition.label], share)
        for condition, share in CONDITIONS.items()
        if condition.label in truncated
    ]
    yield make_table("extinction", title, rows, sentences(_READ, missing(CONDITIONS, inputs)))
    by_world = [_world_row(label, world) for label, group in truncated.items() for world in group]
    yield make_table("extinction-world", f"{title}, world by world", by_world, shown=False)


def _row(condition: Condition, worlds: Sequence[WorldRecord], paper: float) -> dict[str, Any]:
    extinction = world_extinction(worlds, _furthest_step(worlds))
    is_complete = all(world.extinct_step is not None or world.last_step >= EXTINCTION_STEP for world in worlds)
    paper_count = round(paper * EXTINCTION_SEEDS)
    is_extinct = np.array([world.extinct_step is not None for world in worlds])
    durations = np.array([world.last_step if world.extinct_step is None else world.extinct_step for world in worlds])
    median, _, _ = survival_curve(durations.astype(np.float64), is_extinct).quantile()
    living = [run_tail(world.population) for world in worlds if world.extinct_step is None]
    return {
        "costs": condition.label,
        "extinct": extinction.extinct,
        "worlds": len(worlds),
        "share": extinction.share,
        "low": extinction.low,
        "high": extinction.high,
        "paper": paper,
        "p_paper": fisher_mid_p(extinction.extinct, len(worlds), paper_count, EXTINCTION_SEEDS)
        if is_complete
        else None,
        "by_step": int(extinction.known_until),
        "median_step": median,
        "alive": mean_interval(map(mean_alive, living)).mean,
        "energy": mean_interval(map(mean_energy, living)).mean,
    }


def _furthest_step(worlds: Sequence[WorldRecord]) -> int:
    """The last step at which a world is known to be alive; the paper's step if all died out, which is permanent."""
    return max((world.last_step for world in worlds if world.extinct_step is None), default=EXTINCTION_STEP)


def _world_row(label: str, world: WorldRecord) -> dict[str, Any]:
    tail = run_tail(world.population)
    return {
        "costs": label,
        "seed": world.seed,
        "steps": world.last_step,
        "extinct_step": world.extinct_step,
        "alive": mean_alive(tail),
        "energy": mean_energy(tail),
    }


EXTINCTIONS = Item(
    "extinction",
    "Extinction by the costs of living and of action",
    "Of ten worlds per setting none dies out at the costs of the baseline. A half more for living lets 30 % die "
    "out, twice as much 90 %; a half more for action 50 %, twice as much all.",
    _make,
    tuple(CONDITIONS),
    Scale(tuple(range(1, 11)), EXTINCTION_STEP),
)
