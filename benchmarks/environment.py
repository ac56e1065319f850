"""Agent-steps per second of `hedon.make` and `JaxEnv` beside JaxMARL's simple spread, in turns, each on one core.

    python -m venv /tmp/jaxmarl && /tmp/jaxmarl/bin/pip install "jax[cpu]" jaxmarl
    uv run python benchmarks/environment.py /tmp/jaxmarl/bin/python

All act at random, and show every agent's observation and reward in every step. JaxMARL runs as its users run it: many
environments by `vmap`, many steps by `scan`, compiled before the clock starts; so does `JaxEnv`. The best of five turns
counts, since other programs only slow things down.
"""

import argparse
import os
import subprocess
import time
from collections.abc import Callable
from functools import partial

SPREAD = """
import sys, time
import jax
from jaxmarl import make

agents, worlds, steps = (int(word) for word in sys.argv[1:])
env = make("MPE_simple_spread_v3", num_agents=agents, num_landmarks=agents)

def advance(carry, key):
    state, seen = carry
    act, step = jax.random.split(key)
    keys = jax.random.split(act, agents * worlds).reshape(agents, worlds, -1)
    actions = {name: jax.vmap(env.action_space(name).sample)(keys[i]) for i, name in enumerate(env.agents)}
    seen, state, reward, _, _ = jax.vmap(env.step)(jax.random.split(step, worlds), state, actions)
    return (state, seen), sum(each.sum() for each in reward.values())

@jax.jit
def run(carry, key):
    return jax.lax.scan(advance, carry, jax.random.split(key, steps))

seen, state = jax.vmap(env.reset)(jax.random.split(jax.random.PRNGKey(0), worlds))
carry, _ = jax.block_until_ready(run((state, seen), jax.random.PRNGKey(1)))
begun = time.perf_counter()
jax.block_until_ready(run(carry, jax.random.PRNGKey(2)))
print(agents * worlds * steps / (time.perf_counter() - begun))
"""
TURNS = 5
SECONDS = 3.0
"""How long `hedon.make` is measured in each turn."""
SPREADS = {3: (1024, 100), 50: (64, 20)}
"""Agents of simple spread, the first its default, each with worlds at once and steps: pairs grow with the square."""
WORLDS, SCANNED = (1, 16, 256), (16, 500)
"""Worlds of `hedon.make`; worlds and steps of `JaxEnv`."""
SETTINGS = ("hazard.kappa=0", "hazard.alpha_age=0", "birth.kappa=0", "population.capacity=50")
"""Fifty agents that neither die nor breed."""


def spread(python: str, agents: int) -> float:
    """Agent-steps per second of JaxMARL, in a process of its own."""
    worlds, steps = SPREADS[agents]
    command = [python, "-c", SPREAD, str(agents), str(worlds), str(steps)]
    where = os.environ | {"JAX_PLATFORMS": "cpu"}
    done = subprocess.run(command, check=True, capture_output=True, text=True, env=where)
    return float(done.stdout.split()[-1])


def made(worlds: int) -> float:
    """Agent-steps per second of `hedon.make`."""
    import numpy as np

    import hedon

    driven = hedon.make(hedon.load_config("baseline", overrides=SETTINGS), worlds, actions="logit", threads=1)
    rng, count = np.random.default_rng(1), 0
    begun = time.perf_counter()
    while time.perf_counter() - begun < SECONDS:
        driven.actions[...] = rng.standard_normal(driven.actions.shape, np.float32)
        driven.step(driven.actions)
        count += int(driven.alive.sum())
    return count / (time.perf_counter() - begun)


def scanned() -> float:
    """Agent-steps per second of `JaxEnv` within `jit`, `vmap` and `scan`."""
    import jax

    import hedon
    from hedon.env import JaxEnv

    worlds, steps = SCANNED
    env = JaxEnv(hedon.load_config("baseline", overrides=SETTINGS), worlds, actions="logit", threads=1)

    def advance(state, key):  # of JAX
        act, go = jax.random.split(key)
        actions = jax.random.normal(act, (worlds, env.slots, 2))
        _, state, reward, _, told = jax.vmap(env.step)(jax.random.split(go, worlds), state, actions)
        return state, (reward.sum(), told["alive"].sum())

    run = jax.jit(lambda state, key: jax.lax.scan(advance, state, jax.random.split(key, steps)))
    _, state = jax.jit(jax.vmap(env.reset))(jax.random.split(jax.random.key(0), worlds))
    state, _ = jax.block_until_ready(run(state, jax.random.key(1)))
    begun = time.perf_counter()
    _, (_, alive) = jax.block_until_ready(run(state, jax.random.key(2)))
    return int(alive.sum()) / (time.perf_counter() - begun)


def main() -> None:
    """Measures in turns and prints the best of each."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("python", help="an interpreter that has jaxmarl and jax[cpu]")
    python = parser.parse_args().python
    os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})  # the processes that it starts inherit it
    cases: dict[str, Callable[[], float]] = {f"hedon.make, worlds: {count}": partial(made, count) for count in WORLDS}
    cases[f"JaxEnv in scan, worlds: {SCANNED[0]}"] = scanned
    cases |= {f"simple spread, agents: {count}": partial(spread, python, count) for count in SPREADS}
    rates: dict[str, list[float]] = {name: [] for name in cases}
    for turn in range(TURNS):
        for name, measure in cases.items():
            rates[name].append(measure())
        print(f"turn {turn + 1} of {TURNS}: {', '.join(f'{each[-1]:,.0f}' for each in rates.values())}", flush=True)
    for name, values in rates.items():
        print(f"{name}: {max(values):,.0f} agent-steps/s")


if __name__ == "__main__":
    main()
