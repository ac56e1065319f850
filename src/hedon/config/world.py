"""What holds for all agents of a world, of whatever species."""

from dataclasses import dataclass
from typing import Annotated, Literal

from hedon.config.field import EITHER, OURS, PAPER, Doc, Range


@dataclass(frozen=True, slots=True)
class WorldConfig:
    """Rules that all agents of a world share; no species has its own."""

    food_radius: Annotated[
        float,
        Doc("radius of a piece of food", "u", EITHER, Range(gt=0, le=1e3)),
    ] = 4.0
    eaten_food: Annotated[
        Literal["gone", "seen"],
        Doc(
            "whether rays still meet a food in the step after it was eaten",
            "",
            OURS + '; the code has "seen"',
        ),
    ] = "gone"
    mouths: Annotated[
        Literal["nearest", "all"],
        Doc(
            "who is fed if several mouths touch a food in the same step",
            "",
            OURS + '; the code has "all"',
        ),
    ] = "nearest"
    prey_sharing: Annotated[
        Literal["one", "each"],
        Doc(
            "who gains by an agent that several eat in the same step: one of them, by a draw, or each in full",
            "",
            OURS + '; the code of the sequel has "each"',
        ),
    ] = "one"
    birth_order: Annotated[
        Literal["before_deaths", "after_deaths"],
        Doc(
            "which comes first in a step; after deaths, the dying do not breed, their slots are free, and the hazard "
            "takes the parent's energy before it is shared",
            "",
            OURS + '; the code has "after_deaths"',
        ),
    ] = "before_deaths"
    inheritance: Annotated[
        Literal["at_birth", "at_window_end"],
        Doc(
            "when a newborn gets its network and its genome; until the window's end it acts with the network of the "
            "agent that died in its slot, and gets that agent's rewards",
            "",
            PAPER + '; the code has "at_window_end"',
        ),
    ] = "at_birth"
    parents: Annotated[
        Literal["all", "resident_slots"],
        Doc(
            "who may have children: all, or only agents in slots that were taken when the window began",
            "",
            PAPER + '; the code has "resident_slots"',
        ),
    ] = "all"
    child_heading: Annotated[
        Literal["own", "shared"],
        Doc(
            "whether each child has a random heading of its own, or the children of one step share one",
            "",
            OURS + '; the code has "shared"',
        ),
    ] = "own"
    mutation_noise: Annotated[
        Literal["independent", "tabulated"],
        Doc(
            "new noise for every birth, or noise fixed by seed, gene, the number of births in a window and the birth's "
            "index among them",
            "",
            PAPER + '; the code has "tabulated"',
        ),
    ] = "independent"
    rollout_steps: Annotated[
        int,
        Doc(
            "steps of a window; at its end, every agent that lived through all of it learns",
            "step",
            EITHER,
            Range(ge=1, le=65_536),
        ),
    ] = 1024
    founders: Annotated[
        str,
        Doc(
            "digest of the table that the founders' genes come from, `founders.csv` in the run's folder; set by "
            "`--founders`. Genes that the table does not have are drawn as below",
            "",
            OURS,
            Range(form="64 hexadecimal digits"),
        ),
    ] = ""
    networks: Annotated[
        str,
        Doc(
            'digest of the file that the founders\' networks come from where `policy` is "fixed", `networks.npz` in '
            "the run's folder; set by `--networks`. Without one they are new networks",
            "",
            OURS,
            Range(form="64 hexadecimal digits"),
        ),
    ] = ""
