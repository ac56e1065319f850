"""The paper's table of extinction: which costs of living and of action let a world die out?"""

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from hedon.analysis.table import ResultTable, table
from hedon.analysis.world.extinction import world_extinction
from hedon.analysis.world.population import mean_alive, mean_energy, run_tail
from hedon.analysis.world.record import WorldRecord
from hedon.statistic.contrast import fisher_mid_p
from hedon.statistic.interval import mean_interval
from hedon.statistic.survival import survival_curve
from hedon.study.census import missing, present, sentences
from hedon.study.item import Arm, Item, Material, Scale
from hedon_studies.kanagawa_doya_2024.paper import EXTINCTION, EXTINCTION_SEEDS, EXTINCTION_STEP

_READ = (
    "Costs are those of living [energy/step] and of action [energy/(step·force)]. The share is that of worlds extinct "
    "by the step named, over all worlds (Kaplan and Meier; living ones that end earlier are censored), with the mid-p "
    "interval of the beta product. The paper's is by step 1,024,000, of ten; p_paper is the chance of shares at least "
    "so far apart if both are the same (mid-p Fisher), where all worlds are known to that step. The median step of "
    "extinction counts living worlds as censored, and is known where half of the worlds died out. Agents alive and "
    "their energy are means over the last tenth of the worlds that live."
)


def _arm(basic_cost: float, action_cost: float) -> Arm:
    overrides = (f"energy.basic_cost={basic_cost!r}", f"energy.action_cost={action_cost!r}")
    return Arm(f"{basic_cost:g}, {action_cost:.0e}".replace("e-0", "e-"), overrides=overrides)


ARMS = {_arm(*costs): share for costs, share in EXTINCTION.items()}
"""The paper's settings, with the share of worlds that it reports extinct."""


def _make(material: Material) -> Iterator[ResultTable]:
    worlds = present(ARMS, material)
    cut = {label: [world.until(EXTINCTION_STEP) for world in group] for label, group in worlds.items()}
    title = "Extinction by the costs of living and of action"
    rows = [_row(arm, cut[arm.label], share) for arm, share in ARMS.items() if arm.label in cut]
    yield table("extinction", title, rows, sentences(_READ, missing(ARMS, material)))
    by_world = [_world_row(label, world) for label, group in cut.items() for world in group]
    yield table("extinction-world", f"{title}, world by world", by_world, shown=False)


def _row(arm: Arm, worlds: Sequence[WorldRecord], paper: float) -> dict[str, Any]:
    found = world_extinction(worlds, _furthest_step(worlds))
    whole = all(world.extinct_step is not None or world.last_step >= EXTINCTION_STEP for world in worlds)
    paper_count = round(paper * EXTINCTION_SEEDS)
    died = np.array([world.extinct_step is not None for world in worlds])
    lasted = np.array([world.last_step if world.extinct_step is None else world.extinct_step for world in worlds])
    median, _, _ = survival_curve(lasted.astype(np.float64), died).quantile()
    living = [run_tail(world.population) for world in worlds if world.extinct_step is None]
    return {
        "costs": arm.label,
        "extinct": found.extinct,
        "worlds": len(worlds),
        "share": found.share,
        "low": found.low,
        "high": found.high,
        "paper": paper,
        "p_paper": fisher_mid_p(found.extinct, len(worlds), paper_count, EXTINCTION_SEEDS) if whole else None,
        "by_step": int(found.known_until),
        "median_step": median,
        "alive": mean_interval(map(mean_alive, living)).mean,
        "energy": mean_interval(map(mean_energy, living)).mean,
    }


def _furthest_step(worlds: Sequence[WorldRecord]) -> int:
    """The step up to which some world is known to live, or the paper's where all died out: who died out stays so."""
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


EXTINCTIONS: tuple[Item, ...] = (
    Item(
        "extinction",
        "Extinction by the costs of living and of action",
        "table",
        "Of ten worlds per setting none dies out at the costs of the baseline. A half more for living lets 30 % die "
        "out, twice as much 90 %; a half more for action 50 %, twice as much all.",
        _make,
        tuple(ARMS),
        Scale(tuple(range(1, 11)), EXTINCTION_STEP),
    ),
)
