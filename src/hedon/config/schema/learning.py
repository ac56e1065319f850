"""Learning: PPO, one learner per agent."""

from dataclasses import dataclass
from typing import Literal

from hedon.config.field import CODE, EITHER, OURS, PAPER, setting


@dataclass(frozen=True, slots=True)
class LearningConfig:
    """Action selection and learning: proximal policy optimization (Schulman et al. 2017) with GAE."""

    policy: Literal["ppo", "random", "idle", "external", "fixed"] = setting(
        "ppo",
        "how agents choose actions: a network that learns; standard normals before the sigmoid, as a new network "
        "gives; none, so that no motor runs; what the caller sets (`hedon.env`); or a network that never learns",
        "",
        OURS,
    )
    minibatch_size: int = setting(256, "steps per gradient; must divide rollout_steps", "step", EITHER, ge=1, le=65_536)
    update_epochs: int = setting(10, "passes over a rollout in one update", "", EITHER, ge=0, le=1000)
    gamma: float = setting(0.999, "discount factor of later rewards", "1/step", EITHER, ge=0, le=1)
    gae_lambda: float = setting(0.95, "decay of the advantage estimate (λ)", "1/step", EITHER, ge=0, le=1)
    clip_coef: float = setting(0.2, "clip range of the probability ratio", "", EITHER, gt=0, le=10)
    learning_rate: float = setting(3e-4, "learning rate of Adam", "", EITHER, ge=0, le=1)
    adam_beta1: float = setting(0.9, "decay of Adam's first moment", "", EITHER, ge=0, lt=1)
    adam_beta2: float = setting(0.999, "decay of Adam's second moment", "", EITHER, ge=0, lt=1)
    adam_epsilon: float = setting(1e-7, "added to the square root of Adam's second moment", "", EITHER, gt=0, le=1)
    value_coef: float = setting(1.0, "weight of the value loss", "", EITHER, ge=0, le=1e3)
    entropy_coef: float = setting(0.001, "weight of the entropy bonus", "", CODE + "; the paper prints 0", ge=0, le=1e3)
    critic_target: Literal["per_state", "batch_mean"] = setting(
        "per_state",
        "target of the value estimate: each state's return, or the mean over the minibatch",
        "",
        PAPER + '; the code amounts to "batch_mean"',
    )
    reward_scaling: Literal["none", "window"] = setting(
        "none",
        "what rewards are divided by before an agent learns from them: nothing, or their standard deviation over the "
        "window, unless that is 0",
        "",
        EITHER + "; window is ours",
    )
    advantage_normalization: Literal["none", "window"] = setting(
        "none",
        "whether advantages are made to have mean 0 and standard deviation 1 over the window",
        "",
        EITHER + "; window is ours",
    )
    acting_weights: Literal["float32", "bfloat16"] = setting(
        "bfloat16",
        "precision of the weights of both hidden layers when agents act; they learn in float32",
        "",
        OURS + ", for speed; the code acts in float32",
    )
