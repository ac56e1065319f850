"""Learning: PPO, one learner per agent."""

from dataclasses import dataclass
from typing import Annotated, Literal

from hedon.config.field import CODE, EITHER, OURS, PAPER, Doc, Range


@dataclass(frozen=True, slots=True)
class LearningConfig:
    """How agents choose actions, and learn: proximal policy optimization (Schulman et al. 2017) with GAE."""

    policy: Annotated[
        Literal["ppo", "random", "idle", "external", "fixed"],
        Doc(
            "how agents choose actions: a network that learns; standard normals before the sigmoid, as a new network "
            "gives; none, so that no motor runs; what the caller sets (`hedon.env`); or a network that never learns",
            "",
            OURS,
        ),
    ] = "ppo"
    minibatch_size: Annotated[
        int,
        Doc("steps per gradient; must divide rollout_steps", "step", EITHER, Range(ge=1, le=65_536)),
    ] = 256
    update_epochs: Annotated[
        int,
        Doc("passes over a rollout in one update", "", EITHER, Range(ge=0, le=1000)),
    ] = 10
    gamma: Annotated[
        float,
        Doc("discount factor of later rewards", "1/step", EITHER, Range(ge=0, le=1)),
    ] = 0.999
    gae_lambda: Annotated[
        float,
        Doc("decay of the advantage estimate (λ)", "1/step", EITHER, Range(ge=0, le=1)),
    ] = 0.95
    clip_coef: Annotated[
        float,
        Doc("clip range of the probability ratio", "", EITHER, Range(gt=0, le=10)),
    ] = 0.2
    learning_rate: Annotated[
        float,
        Doc("learning rate of Adam", "", EITHER, Range(ge=0, le=1)),
    ] = 3e-4
    adam_beta1: Annotated[
        float,
        Doc("decay of Adam's first moment", "", EITHER, Range(ge=0, lt=1)),
    ] = 0.9
    adam_beta2: Annotated[
        float,
        Doc("decay of Adam's second moment", "", EITHER, Range(ge=0, lt=1)),
    ] = 0.999
    adam_epsilon: Annotated[
        float,
        Doc("added to the square root of Adam's second moment", "", EITHER, Range(gt=0, le=1)),
    ] = 1e-7
    value_coef: Annotated[
        float,
        Doc("weight of the value loss", "", EITHER, Range(ge=0, le=1e3)),
    ] = 1.0
    entropy_coef: Annotated[
        float,
        Doc("weight of the entropy bonus", "", CODE + "; the paper prints 0", Range(ge=0, le=1e3)),
    ] = 0.001
    critic_target: Annotated[
        Literal["per_state", "batch_mean"],
        Doc(
            "target of the value estimate: each state's return, or the mean over the minibatch",
            "",
            PAPER + '; the code amounts to "batch_mean"',
        ),
    ] = "per_state"
    acting_weights: Annotated[
        Literal["float32", "bfloat16"],
        Doc(
            "precision of the weights of both hidden layers when agents act; they learn in float32",
            "",
            OURS + ", for speed; the code acts in float32",
        ),
    ] = "bfloat16"
