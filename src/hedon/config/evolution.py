"""Evolution: the genome, how it mutates, and the reward that it defines."""

from dataclasses import dataclass, field
from typing import Annotated, Literal

from hedon.config.field import CODE, EITHER, OURS, PAPER, Doc, Range


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
class GenomeConfig:
    """One weight per food kind, one for action, then neutral markers that have no effect on rewards.

    `[food.<kind>.gene]` says how founders draw the weight of a kind, `[genome.action]` that of action, `[genome.prey]`
    that of each species that is eaten, and `[genome.neutral]` each neutral marker.
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
    mutation_scale: Annotated[
        float,
        Doc("scale of the noise added to every weight at birth", "", EITHER, Range(ge=0, le=1e3)),
    ] = 0.02
    weight_limit: Annotated[
        float,
        Doc("weights are clipped to ± this", "", EITHER, Range(gt=0, le=1e3)),
    ] = 10.0
    mutation_noise: Annotated[
        Literal["independent", "frozen"],
        Doc(
            "new noise for every birth, or noise fixed by seed, gene, the number of births in a window and the birth's "
            "index among them",
            "",
            PAPER + '; the code has "frozen"',
        ),
    ] = "independent"
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


@dataclass(frozen=True, slots=True)
class SeeConfig:
    """A reward for seeing a species or a kind of food, by its name: coef·weight·what the rays read of it."""

    coef: Annotated[
        float,
        Doc("factor of the term", "", OURS + "; the code of the sequel has 0.1", Range(ge=-1e3, le=1e3)),
    ] = 0.1
    over_rays: Annotated[
        Literal["mean", "max"],
        Doc("how the readings of the rays, 0 for those that meet something else, become one number", "", OURS),
    ] = "mean"
    gene: GeneConfig = field(default_factory=GeneConfig)


@dataclass(frozen=True, slots=True)
class RewardConfig:
    """Reward in a step: Σ weight·eaten over meals + action_coef·weight·|force|/norm + Σ coef·weight·seen."""

    action_coef: Annotated[
        float,
        Doc("factor of the action term", "", EITHER, Range(ge=-1e3, le=1e3)),
    ] = 0.01
    action_norm: Annotated[
        Literal["max_force", "none"],
        Doc("what |force| is divided by: its largest value, or nothing", "", CODE + '; the paper prints "none"'),
    ] = "max_force"
    see: dict[str, SeeConfig] = field(default_factory=dict)
