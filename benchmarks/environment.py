"""Agent-steps per second of `hedon.make` beside JaxMARL's simple spread, in turns, each on one core.

    python -m venv /tmp/jaxmarl && /tmp/jaxmarl/bin/pip install "jax[cpu]" jaxmarl
    uv run python benchmarks/environment.py /tmp/jaxmarl/bin/python

Both act at random, and show every agent's observation and reward in every step. JaxMARL runs as its users run it: many
environments by `vmap`, many steps by `scan`, compiled before the clock starts. The best of five turns counts, since
other programs only slow things down.
"""

import argparse
import os
import subprocess
import time

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
"""How long hedon is measured in each turn."""
AGENTS, WORLDS, STEPS = 3, 1024, 100
"""Of JaxMARL in each turn: agents of a world (its default), worlds at once, steps."""


def spread(python: str) -> float:
    """Agent-steps per second of JaxMARL, in a process of its own."""
    command = [python, "-c", SPREAD, str(AGENTS), str(WORLDS), str(STEPS)]
    where = os.environ | {"JAX_PLATFORMS": "cpu"}
    done = subprocess.run(command, check=True, capture_output=True, text=True, env=where)
    return float(done.stdout.split()[-1])


def hedon_batch(worlds: int = 4) -> float:
    """Agent-steps per second of `hedon.make`, in worlds of 50 agents that neither die nor breed."""
    import numpy as np

    import hedon

    settings = ("hazard.kappa=0", "hazard.alpha_age=0", "birth.kappa=0", "population.capacity=50")
    driven = hedon.make(hedon.load_config("baseline", overrides=settings), worlds, actions="logit", threads=1)
    rng, count = np.random.default_rng(1), 0
    begun = time.perf_counter()
    while time.perf_counter() - begun < SECONDS:
        driven.actions[...] = rng.standard_normal(driven.actions.shape, np.float32)
        driven.step(driven.actions)
        count += int(driven.alive.sum())
    return count / (time.perf_counter() - begun)


def main() -> None:
    """Measures in turns and prints the best of each."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("python", help="an interpreter that has jaxmarl and jax[cpu]")
    python = parser.parse_args().python
    os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})  # the processes that it starts inherit it
    rates: dict[str, list[float]] = {"hedon.make": [], "simple spread": []}
    for turn in range(TURNS):
        rates["hedon.make"].append(hedon_batch())
        rates["simple spread"].append(spread(python))
        print(f"turn {turn + 1} of {TURNS}: {', '.join(f'{each[-1]:,.0f}' for each in rates.values())}", flush=True)
    for name, values in rates.items():
        print(f"{name}: {max(values):,.0f} agent-steps/s")


if __name__ == "__main__":
    main()
