"""Evolution: the genome, its mutation, and the reward that it defines."""

from dataclasses import dataclass
from typing import Literal

from hedon.config.field import CODE, EITHER, OURS, PAPER, section, setting

LEARNING_GENES = {
    "learning_rate": "power of ten by which the learning rate differs",
    "gamma": "power of ten by which the odds of the discount differ",
    "entropy_coef": "power of ten by which the weight of the entropy differs",
    "action_sd": "power of ten of the standard deviation of a newborn's actions",
}
"""Learning parameters that a gene may set, with the gene's description."""
FAMILY_GENES = {
    "threshold": "power of ten by which the threshold of the reward differs",
    "threshold_width": "power of ten by which the width of that threshold differs",
}
"""Parameters of the reward family that a gene may set, with the gene's description."""
GATED = ("above", "below", "between", "around")
"""Reward families that have a gate with a threshold."""
MAX_EXPONENT = 2.0
"""Largest limit of genes that are powers of ten."""
OF_ALL_GENES = {
    "law": "mutation_law",
    "scale": "mutation_scale",
    "df": "mutation_df",
    "probability": "mutation_probability",
    "limit": "weight_limit",
}
"""Settings of one gene's mutation, with the settings of `genome` that apply to all genes."""


@dataclass(frozen=True, slots=True)
class GeneConfig:
    """Distribution of one gene among founders: a normal law, clipped to ± `genome.weight_limit`."""

    initial_mean: float = setting(0.0, "mean of the founders' gene", "", EITHER, ge=-1e3, le=1e3)
    initial_sd: float = setting(0.1, "standard deviation of the founders' gene", "", EITHER, ge=0, le=1e3)


@dataclass(frozen=True, slots=True)
class MutationConfig:
    """Mutation of one gene, by the gene's name; values not set here come from `[genome]`."""

    law: Literal["cauchy", "student_t", "normal", "uniform"] = setting(
        "cauchy", "law of the noise added at birth", "", OURS
    )
    scale: float = setting(0.02, "scale of the noise, or the largest noise if it is uniform", "", OURS, ge=0, le=1e3)
    df: float = setting(2.0, "degrees of freedom of student_t", "", OURS, gt=0, le=1e3)
    probability: float = setting(1.0, "probability that the gene mutates at a birth", "", OURS, ge=0, le=1)
    limit: float = setting(10.0, "the gene is clipped to ± this", "", OURS, gt=0, le=1e3)


@dataclass(frozen=True, slots=True)
class GenomeConfig:
    """Genes: weights of the reward, genes that set numbers, genes for rules, and neutral genes without effect.

    Founders' weights are drawn as given by `[food.<kind>.gene]` for a kind of food, `[genome.action]` for action,
    `[genome.prey]` for each species that is eaten, and `[genome.second]` for the second gene of each weight, if the
    reward family has one; neutral genes as given by `[genome.neutral]`.

    `[genome.learning.NAME]` adds a gene for learning_rate, gamma, entropy_coef or action_sd: the gene g multiplies the
    learning rate, the odds of the discount gamma/(1 - gamma), the entropy coefficient, or the spread of a newborn's
    actions, by 10^g. `[genome.family.NAME]` does the same for threshold or threshold_width of the reward family.
    `[genome.set.PATH]`, such as `[genome.set.sensor.ray_length]`, does so for a number of the body, the senses, the
    motors, the stores, the hazard, births or the drive, within the limits of its setting; the gene is named g_PATH,
    with `_` for each dot.

    `[genome.extra.NAME]` adds a gene extra_NAME that only rules in Python read (guide/rule.md).
    `[genome.mutation.GENE]` gives one gene its own mutation.
    """

    neutral_count: int = setting(
        16, "number of neutral genes: inherited and mutated like weights, a control for drift", "", OURS, ge=0, le=16
    )
    mutation_scale: float = setting(0.02, "scale of the noise added to every weight at birth", "", EITHER, ge=0, le=1e3)
    weight_limit: float = setting(10.0, "weights are clipped to ± this", "", EITHER, gt=0, le=1e3)
    mutation_law: Literal["cauchy", "student_t", "normal", "uniform"] = setting(
        "cauchy",
        "law of the noise added at birth; mutation_scale is its scale, or the largest noise if it is uniform",
        "",
        PAPER,
    )
    mutation_df: float = setting(
        2.0, "degrees of freedom of student_t", "", OURS + "; the code of the sequel has 2", gt=0, le=1e3
    )
    mutation_probability: float = setting(1.0, "probability that a gene mutates at a birth", "", EITHER, ge=0, le=1)
    action: GeneConfig = section(GeneConfig)
    prey: GeneConfig = section(GeneConfig)
    neutral: GeneConfig = section(GeneConfig)
    second: GeneConfig = section(GeneConfig)
    learning: dict[str, GeneConfig] = section(names=LEARNING_GENES)
    family: dict[str, GeneConfig] = section(names=FAMILY_GENES)
    set: dict[str, GeneConfig] = section()
    extra: dict[str, GeneConfig] = section()
    mutation: dict[str, MutationConfig] = section()


@dataclass(frozen=True, slots=True)
class PayConfig:
    """A reward term for any channel, by the name of the term: coef·weight·channel. Its gene is `w_NAME`."""

    channel: str = setting(
        "",
        "what is paid for: the name of a channel (guide/reward.md). Empty for the one that is called as the term",
        "",
        OURS,
    )
    coef: float = setting(1.0, "factor of the term", "", OURS, ge=-1e3, le=1e3)
    gene: GeneConfig = section(GeneConfig)


@dataclass(frozen=True, slots=True)
class RewardConfig:
    """Reward: meal_coef·Σ weight·eaten + action_coef·weight·|force|/norm + Σ coef·weight·channel + drive reduction.

    The family defines how a weight follows from its genes. With x = (gate - threshold) / threshold_width and σ(x) =
    1/(1 + e^-x): `linear` w; `sinh` sinh(2.5 w); `scaled` 10^s·w with a second gene s; `above` w·σ(x) and `below`
    w·σ(-x); `between` w + (w' - w)·σ(x) with a second gene w'; `around` 4·w·σ(x)·σ(-x). The gate is a channel.
    """

    family: Literal["linear", "sinh", "scaled", "above", "below", "between", "around"] = setting(
        "linear", "how a weight follows from its genes", "", PAPER + "; the others are ours", shapes=True
    )
    gate: str = setting(
        "energy",
        "the channel that the families above, below, between and around compare with the threshold (guide/reward.md)",
        "",
        OURS,
    )
    threshold: float = setting(
        50.0, "value of the gate around which weights change", "that of the gate", OURS, ge=-1e6, le=1e6
    )
    threshold_width: float = setting(
        10.0, "how wide the change around the threshold is", "that of the gate", OURS, gt=0, le=1e6
    )
    meal_coef: float = setting(
        1.0,
        "factor of the terms for what is eaten; 0: their weights do nothing",
        "",
        PAPER,
        ge=-1e3,
        le=1e3,
        derived=True,
    )
    drive_reduction_coef: float = setting(
        0.0,
        "factor of drive reduction: by how much a step's meals and costs bring the stores closer to set points, which "
        "are genes, in shares of their capacities, or of motor_threshold where they weaken the motors; 0: there is "
        "neither term nor gene",
        "",
        OURS,
        ge=-1e3,
        le=1e3,
        derived=True,
    )
    drive_exponent: float = setting(
        2.0, "exponent n of the drive (Σ |set point - held|^n)^(1/m), whose decrease is paid for", "", OURS, ge=1, le=8
    )
    drive_root: float = setting(2.0, "root m of that drive", "", OURS, ge=1, le=8)
    action_coef: float = setting(0.01, "factor of the action term", "", EITHER, ge=-1e3, le=1e3, derived=True)
    action_norm: Literal["max_force", "none"] = setting(
        "max_force",
        "what |force| is divided by: its largest value, or nothing",
        "",
        CODE + '; the paper prints "none"',
        derived=True,
    )
    rule: str = setting(
        "",
        "a Python function that pays instead, as FILE.py:NAME; a run adds @ and the digest of the file. Empty for "
        "the sum above (guide/rule.md)",
        "",
        OURS,
    )
    memory: int = setting(
        0, "numbers that the rule keeps for each agent from step to step", "", OURS, ge=0, le=16, shapes=True
    )
    pay: dict[str, PayConfig] = section(derived=True)
