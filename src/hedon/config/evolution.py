"""Evolution: the genome, how it mutates, and the reward that it defines."""

from dataclasses import dataclass, field
from typing import Annotated, Literal

from hedon.config.field import CODE, DERIVED, EITHER, OURS, PAPER, Doc, Range, Table

LEARNING_GENES = {
    "learning_rate": "power of ten by which the learning rate differs",
    "gamma": "power of ten by which the odds of the discount differ",
    "entropy_coef": "power of ten by which the weight of the entropy differs",
    "action_sd": "power of ten of the standard deviation of a newborn's actions",
}
"""What of learning a gene may set, with what the gene is."""
FAMILY_GENES = {
    "threshold": "power of ten by which the threshold of the reward differs",
    "threshold_width": "power of ten by which the width of that threshold differs",
}
"""What of the family of a reward a gene may set, with what the gene is."""
OF_ALL_GENES = {
    "law": "mutation_law",
    "scale": "mutation_scale",
    "df": "mutation_df",
    "probability": "mutation_probability",
    "limit": "weight_limit",
}
"""What the mutation of one gene says, and the setting of `genome` that says it for all."""


@dataclass(frozen=True, slots=True)
class GeneConfig:
    """How founders draw one gene: from a normal law, then clipped to ± `genome.weight_limit`."""

    initial_mean: Annotated[
        float,
        Doc("mean of the founders' gene", "", EITHER, Range(ge=-1e3, le=1e3)),
    ] = 0.0
    initial_sd: Annotated[
        float,
        Doc("standard deviation of the founders' gene", "", EITHER, Range(ge=0, le=1e3)),
    ] = 0.1


@dataclass(frozen=True, slots=True)
class MutationConfig:
    """How one gene mutates, by the gene's name; what is not said here is as `[genome]` says for all genes."""

    law: Annotated[
        Literal["cauchy", "student_t", "normal", "uniform"],
        Doc("law of the noise added at birth", "", OURS),
    ] = "cauchy"
    scale: Annotated[
        float,
        Doc("scale of the noise, or the largest noise if it is uniform", "", OURS, Range(ge=0, le=1e3)),
    ] = 0.02
    df: Annotated[
        float,
        Doc("degrees of freedom of student_t", "", OURS, Range(gt=0, le=1e3)),
    ] = 2.0
    probability: Annotated[
        float,
        Doc("probability that the gene mutates at a birth", "", OURS, Range(ge=0, le=1)),
    ] = 1.0
    limit: Annotated[
        float,
        Doc("the gene is clipped to ± this", "", OURS, Range(gt=0, le=1e3)),
    ] = 10.0


@dataclass(frozen=True, slots=True)
class GenomeConfig:
    """The weights of the reward, genes that set learning, then neutral markers that have no effect.

    `[food.<kind>.gene]` says how founders draw the weight of a kind, `[genome.action]` that of action, `[genome.prey]`
    that of each species that is eaten, `[genome.second]` the second gene of each weight where the family of the
    reward has one, `[genome.set_point]` the set point of energy
    (`set_point_nutrient`, `set_point_toxin` those of other inner states), and `[genome.neutral]` each neutral marker.
    `[genome.learning.NAME]` makes a gene of learning_rate, gamma, entropy_coef or action_sd: the gene g multiplies the
    learning rate, the odds of the discount gamma/(1 - gamma), the entropy coefficient, or the spread of a newborn's
    actions, by 10^g. `[genome.family.NAME]` does so for threshold or threshold_width of the family of the reward.
    `[genome.mutation.GENE]` gives one gene a mutation of its own.
    """

    neutral_count: Annotated[
        int,
        Doc(
            "number of neutral markers: inherited and mutated like weights, a control for drift",
            "",
            OURS,
            Range(ge=0, le=16),
        ),
    ] = 16
    mutation_scale: Annotated[
        float,
        Doc("scale of the noise added to every weight at birth", "", EITHER, Range(ge=0, le=1e3)),
    ] = 0.02
    weight_limit: Annotated[
        float,
        Doc("weights are clipped to ± this", "", EITHER, Range(gt=0, le=1e3)),
    ] = 10.0
    mutation_law: Annotated[
        Literal["cauchy", "student_t", "normal", "uniform"],
        Doc(
            "law of the noise added at birth; mutation_scale is its scale, or the largest noise if it is uniform",
            "",
            PAPER,
        ),
    ] = "cauchy"
    mutation_df: Annotated[
        float,
        Doc("degrees of freedom of student_t", "", OURS + "; the code of the sequel has 2", Range(gt=0, le=1e3)),
    ] = 2.0
    mutation_probability: Annotated[
        float,
        Doc("probability that a gene mutates at a birth", "", EITHER, Range(ge=0, le=1)),
    ] = 1.0
    action: GeneConfig = field(default_factory=GeneConfig)
    prey: GeneConfig = field(default_factory=GeneConfig)
    neutral: GeneConfig = field(default_factory=GeneConfig)
    second: GeneConfig = field(default_factory=GeneConfig)
    set_point: GeneConfig = field(default_factory=lambda: GeneConfig(initial_mean=0.5))
    set_point_nutrient: GeneConfig = field(default_factory=lambda: GeneConfig(initial_mean=0.5))
    set_point_toxin: GeneConfig = field(default_factory=GeneConfig)
    learning: Annotated[dict[str, GeneConfig], Table(names=LEARNING_GENES)] = field(default_factory=dict)
    family: Annotated[dict[str, GeneConfig], Table(names=FAMILY_GENES)] = field(default_factory=dict)
    mutation: dict[str, MutationConfig] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class SeeConfig:
    """A reward for seeing a species, a kind of food, walls or obstacles, by name: coef·weight·what rays read of it."""

    coef: Annotated[
        float,
        Doc("factor of the term", "", OURS + "; the code of the sequel has 0.1", Range(ge=-1e3, le=1e3)),
    ] = 0.1
    over_rays: Annotated[
        Literal["mean", "max"],
        Doc("how the readings of the rays, 0 for those that meet something else, become one number", "", OURS),
    ] = "mean"
    reads: Annotated[
        str,
        Doc(
            "the rays of this name are read instead: a wrong channel. Empty for its own",
            "",
            OURS + "; for obstacles the code of the sequel reads those of food",
        ),
    ] = ""
    gene: GeneConfig = field(default_factory=GeneConfig)


@dataclass(frozen=True, slots=True)
class SmellConfig:
    """A reward for smelling a species or a kind of food, by its name: coef·weight·mean over the noses."""

    coef: Annotated[
        float,
        Doc("factor of the term", "", OURS, Range(ge=-1e3, le=1e3)),
    ] = 0.1
    gene: GeneConfig = field(default_factory=GeneConfig)


@dataclass(frozen=True, slots=True)
class RewardConfig:
    """Reward: meal_coef·Σ weight·eaten + action_coef·weight·|force|/norm + Σ coef·weight·sensed + drive reduction.

    How a weight follows from its genes is the family. With x = (energy or age - threshold) / threshold_width and
    σ(x) = 1/(1 + e^-x): `linear` w; `sinh` sinh(2.5 w); `scaled` 10^s·w with a second gene s; `fed` w·σ(x) and `hungry`
    w·σ(-x) of energy; `by_age` w + (w' - w)·σ(x) of age with a second gene w'.
    """

    family: Annotated[
        Literal["linear", "sinh", "scaled", "fed", "hungry", "by_age"],
        Doc("how a weight follows from its genes", "", PAPER + "; the others are ours", shapes=True),
    ] = "linear"
    threshold: Annotated[
        float,
        Doc("energy, or age in steps, around which weights change", "energy or step", OURS, Range(ge=0, le=1e6)),
    ] = 50.0
    threshold_width: Annotated[
        float,
        Doc("how wide the change around the threshold is", "energy or step", OURS, Range(gt=0, le=1e6)),
    ] = 10.0
    meal_coef: Annotated[
        float,
        Doc(
            "factor of the terms for what is eaten; 0: their weights do nothing",
            "",
            PAPER,
            Range(ge=-1e3, le=1e3),
            derived=True,
        ),
    ] = 1.0
    drive_reduction_coef: Annotated[
        float,
        Doc(
            "factor of drive reduction: by how much a step's meals and costs bring energy, nutrient and toxin closer "
            "to set points, which are genes, in shares of their capacities; 0: there is neither term nor gene",
            "",
            OURS,
            Range(ge=-1e3, le=1e3),
            derived=True,
        ),
    ] = 0.0
    action_coef: Annotated[
        float,
        Doc("factor of the action term", "", EITHER, Range(ge=-1e3, le=1e3), derived=True),
    ] = 0.01
    action_norm: Annotated[
        Literal["max_force", "none"],
        Doc("what |force| is divided by: its largest value, or nothing", "", CODE + '; the paper prints "none"'),
    ] = "max_force"
    rule: Annotated[
        str,
        Doc(
            "a Python function that pays instead, as FILE.py:NAME; a run adds @ and the digest of the file. Empty for "
            "the sum above (guide/rule.md)",
            "",
            OURS,
        ),
    ] = ""
    memory: Annotated[
        int,
        Doc("numbers that the rule keeps for each agent from step to step", "", OURS, Range(ge=0, le=16), shapes=True),
    ] = 0
    see: Annotated[dict[str, SeeConfig], DERIVED] = field(default_factory=dict)
    smell: Annotated[dict[str, SmellConfig], DERIVED] = field(default_factory=dict)
