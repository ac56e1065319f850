"""Episodes of agents in a JAX program: the total reward and the length of each life."""

from typing import Any, NamedTuple

import jax
from jax import numpy as jnp

from hedon.env.group import NOBODY
from hedon.env.jax import JaxEnv, JaxParams, State


class LogState(NamedTuple):
    """A state of `JaxEnv` with the rewards of its agents so far.

    Attributes:
        env_state: State of the environment.
        paid: (slots,) float32, total reward so far of the agent in each slot.
        lived: (slots,) int32, environment steps that it has lived so far.
    """

    env_state: State
    paid: jax.Array
    lived: jax.Array


class JaxLog:
    """`JaxEnv` with episodes in its infos, like PureJaxRL's wrapper; an episode is a life in a slot.

    `info` gets `returned_episode` (slots,) bool, whether a life has ended, by death or because its world has restarted;
    and for these lives `returned_episode_returns` (slots,) float32, their total rewards, and `returned_episode_lengths`
    (slots,) int32, their lengths in environment steps. Everything else is as in the environment.

    Args:
        env: The environment to wrap.

    Example:
        >>> import jax
        >>> from hedon.env import JaxEnv, JaxLog
        >>> env = JaxLog(JaxEnv("baseline"))
        >>> observations, state = jax.jit(env.reset)(jax.random.key(0))
    """

    def __init__(self, env: JaxEnv) -> None:
        self.env = env

    def __getattr__(self, name: str) -> Any:
        if name == "env":  # while a copy is being made
            raise AttributeError(name)
        return getattr(self.env, name)

    def reset(self, key: jax.Array, params: JaxParams | None = None) -> tuple[jax.Array, LogState]:
        """As `JaxEnv.reset`, with total rewards and lengths set to 0."""
        observation, state = self.env.reset(key, params)
        slots = state.agent_id.shape
        return observation, LogState(state, jnp.zeros(slots, jnp.float32), jnp.zeros(slots, jnp.int32))

    def step(
        self, key: jax.Array, state: LogState, action: jax.Array, params: JaxParams | None = None
    ) -> tuple[jax.Array, LogState, jax.Array, jax.Array, dict[str, jax.Array]]:
        """As `JaxEnv.step`, with ended lives in its infos."""
        observation, env_state, paid, done, info = self.env.step(key, state.env_state, action, params)
        was_alive = state.env_state.agent_id != NOBODY
        total, length = state.paid + paid, state.lived + was_alive
        ended = was_alive & (info["terminated"] | done)
        episode_info = {
            "returned_episode": ended,
            "returned_episode_returns": jnp.where(ended, total, 0.0),
            "returned_episode_lengths": jnp.where(ended, length, 0),
        }
        log_state = LogState(env_state, jnp.where(ended, 0.0, total), jnp.where(ended, 0, length))
        return observation, log_state, paid, done, info | episode_info
