"""The results that the paper reports: Kanagawa & Doya (2024), means over 5 seeds of 10.24 million steps each.

The paper gives no spread of its means, neither over agents nor over seeds, and does not specify how they are weighted.
"""

from dataclasses import asdict, dataclass
from typing import Any

STEPS = 10_240_000  # per seed
SEEDS = 5


@dataclass(frozen=True)
class PaperFigures:
    """The paper's results for one condition; None if it gives no number.

    Attributes:
        mean_lifetime: Mean lifetime, by our reading unweighted over agents, which the paper does not specify [step].
        food_per_step: Mean of foods / lifetime, likewise [1/step].
        population: Range of the number of agents alive.
        generation: Range of the number of generations in a run.
        claim: Its statement about the weights that evolve.
    """

    mean_lifetime: float | None = None
    food_per_step: float | None = None
    population: tuple[int, int] | None = None
    generation: tuple[int, int] | None = None
    claim: str = ""


_POSITIVE = "w_food evolves positive, mostly above 4; w_action to two modes, largely positive or slightly negative"
_LARGE = "w_food evolves consistently positive; w_action to the same two modes, slightly lower than in the baseline"
_HARDLY = "hardly any evolution: agents learn to eat well within a life"
_VARIES = "varies widely between runs while the weight for normal food stays positive"

PAPER: dict[str, PaperFigures] = {
    "baseline": PaperFigures(6310, 0.001, (130, 150), (300, 400), _POSITIVE),
    "small": PaperFigures(120668, 0.0045, claim=_HARDLY),
    "large": PaperFigures(5718, 0.0008, claim=_LARGE),
    "centered": PaperFigures(74318, 0.0039, claim=_HARDLY),
    "relocation": PaperFigures(6794, 0.00096, claim="w_action evolves mostly negative"),
    "poor": PaperFigures(claim=f"the weight for poor food {_VARIES}"),
    "poison": PaperFigures(
        claim=f"the weight for poison {_VARIES}; it is positive in most runs, and below that for normal food"
    ),
}

LIFESPAN = 1_000_000
"""Approximate lifespan of an agent whose life is not ended by lack of energy [step]."""

# Share of 10 seeds extinct by 1.024 million steps, by (basic_cost, action_cost) per step.
EXTINCTION_STEP = 1_024_000
EXTINCTION_SEEDS = 10
EXTINCTION: dict[tuple[float, float], float] = {
    (0.002, 2e-5): 0.9,
    (0.0015, 2e-5): 0.3,
    (0.001, 4e-5): 1.0,
    (0.001, 3e-5): 0.5,
    (0.001, 2e-5): 0.0,
}


ENDS = ("food=5,action=5", "food=5,action=-0.5")
"""Our reading of the end points of the paper's baseline: food "mostly above 4", action "largely positive or slightly
negative". The paper prints no numbers (docs/model.md, section 14)."""


def paper_figures(preset: str | None) -> PaperFigures | None:
    """The paper's results for a preset; None for a condition that is not in the paper."""
    return PAPER.get(preset or "")


def reported() -> dict[str, dict[str, Any]]:
    """The paper's results for each preset, for `Study.reported`."""
    results = {preset: {"steps": STEPS} | {k: v for k, v in asdict(f).items() if v} for preset, f in PAPER.items()}
    for values in results.values():
        if "population" in values:
            values["alive_mean"] = values.pop("population")
    results["baseline"]["ends"] = ENDS
    return results
