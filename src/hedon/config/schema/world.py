"""Rules common to all agents of a world, of any species."""

from dataclasses import dataclass
from typing import Literal

from hedon.config.field import EITHER, OURS, PAPER, setting


@dataclass(frozen=True, slots=True)
class WorldConfig:
    """Rules that all agents of a world share; they cannot be set per species."""

    food_radius: float = setting(4.0, "radius of a piece of food", "u", EITHER, gt=0, le=1e3)
    eaten_food: Literal["gone", "seen"] = setting(
        "gone", "whether rays still meet a food in the step after it was eaten", "", OURS + '; the code has "seen"'
    )
    mouths: Literal["nearest", "all"] = setting(
        "nearest", "who is fed if several mouths touch a food in the same step", "", OURS + '; the code has "all"'
    )
    prey_sharing: Literal["one", "each"] = setting(
        "one",
        "who gains by an agent that several eat in the same step: one of them, by a draw, or each in full",
        "",
        OURS + '; the code of the sequel has "each"',
    )
    prey_at_mouth: Literal["nearest", "all"] = setting(
        "nearest",
        "which agents are eaten if a mouth touches several in the same step",
        "",
        OURS + '; the code of the sequel has "all"',
    )
    prey_energy: Literal["after_costs", "before_step"] = setting(
        "after_costs",
        "what an eater has its share of: what its prey has after this step's meals and costs, or had before them",
        "",
        OURS + '; the code of the sequel has "before_step"',
    )
    birth_order: Literal["before_deaths", "after_deaths"] = setting(
        "before_deaths",
        "which comes first in a step; after deaths, the dying do not breed, their slots are free, and the hazard "
        "takes the parent's energy before it is shared",
        "",
        OURS + '; the code has "after_deaths"',
    )
    inheritance: Literal["at_birth", "at_window_end"] = setting(
        "at_birth",
        "when a newborn gets its network and its genome; until the window's end it acts with the network of the "
        "agent that died in its slot, and gets that agent's rewards",
        "",
        PAPER + '; the code has "at_window_end"',
    )
    parents: Literal["all", "resident_slots"] = setting(
        "all",
        "who may have children: all, or only agents in slots that were taken when the window began",
        "",
        PAPER + '; the code has "resident_slots"',
    )
    child_heading: Literal["own", "shared"] = setting(
        "own",
        "whether each child has a random heading of its own, or the children of one step share one",
        "",
        OURS + '; the code has "shared"',
    )
    mutation_noise: Literal["independent", "tabulated"] = setting(
        "independent",
        "new noise for every birth, or noise fixed by seed, gene, the number of births in a window and the birth's "
        "index among them",
        "",
        PAPER + '; the code has "tabulated"',
    )
    rollout_steps: int = setting(
        1024,
        "steps of a window; at its end, every agent that lived through all of it learns",
        "step",
        EITHER,
        ge=1,
        le=65_536,
    )
    founders: str = setting(
        "",
        "digest of the table that the founders' genes come from, `founders.csv` in the run's folder; set by "
        "`--founders`. Genes that the table does not have are drawn as below",
        "",
        OURS,
        form="64 hexadecimal digits",
    )
    networks: str = setting(
        "",
        'digest of the file that the founders\' networks come from where `policy` is "fixed", `networks.npz` in '
        "the run's folder; set by `--networks`. Without one they are new networks",
        "",
        OURS,
        form="64 hexadecimal digits",
    )
