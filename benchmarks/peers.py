"""hedon and programs that do a part of its work, in turns, each on one core: `python -m benchmarks.peers`.

The parts are learning (a population of PPO learners in JAX), rigid bodies (pymunk, which is Chipmunk, and Box2D) and
driven worlds (the simple spread of mpe2, formerly in PettingZoo, and of JaxMARL). The development packages include JAX
and pymunk. pyb2d3 (Box2D) and mpe2 are used if they are there; JaxMARL needs an interpreter that has it:

    python -m venv /tmp/jaxmarl && /tmp/jaxmarl/bin/pip install "jax[cpu]" jaxmarl
    uv run --with mpe2 --with pyb2d3 python -m benchmarks.peers --jaxmarl /tmp/jaxmarl/bin/python --json peers.json

JAX and JaxMARL run as their users run them: many learners or worlds by `vmap`, many steps by `scan`, compiled before
the clock starts. The best of five turns counts, since other programs only slow things down.
"""

import argparse
import json
import os
import subprocess
import sys
import time
from collections.abc import Callable
from functools import partial
from importlib.util import find_spec
from pathlib import Path

import numpy as np

import hedon
from benchmarks import box2d, network, physics
from benchmarks.measure import seconds_of
from benchmarks.plan import make_plan
from hedon import _engine
from hedon.config.schema.arena import walls
from hedon.config.schema.species import ONLY
from hedon.env import JaxEnv

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
"""Time for which one program is measured in each turn."""
LEARNERS = 64
"""Of the population in JAX; on one core, more are no faster."""
PIECE = 20
"""Steps of rigid bodies between two moments at which both programs get the same positions and velocities."""
SPREADS = {3: (1024, 100), 50: (64, 20)}
"""Agents of simple spread, the first its default, each with worlds at once and steps: pairs grow with the square."""
WORLDS, SCANNED = (1, 16, 256), (16, 500)
"""Worlds of `hedon.make`; worlds and steps of `JaxEnv`."""
SETTINGS = ("hazard.kappa=0", "hazard.alpha_age=0", "birth.kappa=0", "population.capacity=50")
"""Fifty agents that neither die nor breed."""

Rate = Callable[[], float]


def update_rates() -> dict[str, Rate]:
    """Updates of one learner after a window of the baseline, per second: 10 epochs of 4 minibatches of 256."""
    plan = make_plan(kernel=_engine.kernel.kernel_names()[0])

    def ours() -> float:
        return 1.0 / min(network.update_seconds(plan)[plan.kernel])

    def in_jax() -> float:
        command = [sys.executable, str(Path(__file__).with_name("population.py"))]
        line = output([*command, "--learners", str(LEARNERS), "--precision", "highest"]).splitlines()[-1]
        return LEARNERS / min(json.loads(line)["seconds"])

    return {f"hedon ({plan.kernel})": ours, f"JAX, {LEARNERS} learners": in_jax}


def body_rates() -> dict[str, Rate]:
    """Steps of one body per second, among the bodies and foods of a baseline world; both begin each piece alike.

    pymunk makes as many substeps as hedon and as many passes over the contacts; it has neither motors nor limits of
    speed here, and its damping is the same.
    """
    import pymunk

    plan = make_plan()
    config, scene = plan.config(), physics.make_scene(plan)
    settings, body = config.physics, config.species[ONLY].body
    bodies, rng = len(scene.array("x")), np.random.default_rng(1)
    space = pymunk.Space()
    space.iterations, space.collision_slop = settings.velocity_passes, settings.slop
    space.damping = float(np.exp(-settings.linear_damping))
    mass = body.density * np.pi * body.radius**2
    discs = [pymunk.Body(mass, 0.5 * mass * body.radius**2) for _ in range(bodies)]
    circles = [pymunk.Circle(disc, body.radius) for disc in discs]
    foods = zip(scene.array("circle_x"), scene.array("circle_y"), strict=True)
    still = [pymunk.Circle(space.static_body, config.world.food_radius, (float(x), float(y))) for x, y in foods]
    still += [
        pymunk.Segment(space.static_body, (float(a), float(b)), (float(c), float(d)), 0.0)
        for a, b, c, d in walls(config.arena)
    ]
    for shape in (*circles, *still):
        shape.friction, shape.elasticity = settings.friction**0.5, settings.restitution**0.5
    space.add(*discs, *circles, *still)

    def begin_piece() -> None:
        motor = config.species[ONLY].motor
        physics.drive(config, scene, *rng.uniform(motor.min_force, motor.max_force, (2, bodies)))
        scene.step(PIECE, 1, record=False)
        for name in ("force_x", "force_y", "force_torque"):
            scene.array(name)[:] = 0.0
        place = np.column_stack([scene.array("x"), scene.array("y")]).tolist()
        velocity = np.column_stack([scene.array("velocity_x"), scene.array("velocity_y")]).tolist()
        spin, angle = scene.array("angular_velocity").tolist(), scene.array("angle").tolist()
        for i, disc in enumerate(discs):
            disc.position, disc.velocity = tuple(place[i]), tuple(velocity[i])
            disc.angular_velocity, disc.angle = spin[i], angle[i]

    def advance_pymunk() -> None:
        for _ in range(PIECE * settings.substeps):
            space.step(settings.dt)

    def rate(advance: Callable[[], object]) -> float:
        times: list[float] = []
        while sum(times) < SECONDS:
            begin_piece()
            times.append(seconds_of(advance))
        return bodies * PIECE * len(times) / sum(times)

    return {
        f"hedon, {bodies} bodies": lambda: rate(lambda: scene.step(PIECE, 1, record=False)),
        f"pymunk, {bodies} bodies": lambda: rate(advance_pymunk),
    }


def world_rates(jaxmarl: str | None) -> dict[str, Rate]:
    """Steps of one agent per second in driven worlds; all act at random, and get an observation and a reward each."""
    rates: dict[str, Rate] = {f"hedon.make, worlds: {count}": partial(made, count) for count in WORLDS}
    rates[f"JaxEnv in scan, worlds: {SCANNED[0]}"] = scanned
    if find_spec("mpe2"):
        rates |= {f"mpe2 simple spread, agents: {count}": partial(spread, count) for count in SPREADS}
    if jaxmarl:
        rates |= {
            f"JaxMARL simple spread, agents: {count}": partial(spread_in_jax, jaxmarl, count) for count in SPREADS
        }
    return rates


def made(worlds: int) -> float:
    """Agent-steps per second of `hedon.make`."""
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

    worlds, steps = SCANNED
    env = JaxEnv(hedon.load_config("baseline", overrides=SETTINGS), worlds, actions="logit", threads=1)

    def advance(state, key):  # of JAX
        act, go = jax.random.split(key)
        actions = jax.random.normal(act, (worlds, env.slots, 2))
        _, state, reward, _, info = jax.vmap(env.step)(jax.random.split(go, worlds), state, actions)
        return state, (reward.sum(), info["alive"].sum())

    run = jax.jit(lambda state, key: jax.lax.scan(advance, state, jax.random.split(key, steps)))
    _, state = jax.jit(jax.vmap(env.reset))(jax.random.split(jax.random.key(0), worlds))
    state, _ = jax.block_until_ready(run(state, jax.random.key(1)))
    begun = time.perf_counter()
    _, (_, alive) = jax.block_until_ready(run(state, jax.random.key(2)))
    return int(alive.sum()) / (time.perf_counter() - begun)


def spread(agents: int) -> float:
    """Agent-steps per second of simple spread in Python, by its parallel interface."""
    from mpe2 import simple_spread_v3  # pyright: ignore[reportMissingImports]

    env = simple_spread_v3.parallel_env(N=agents, max_cycles=1_000_000)
    env.reset(seed=1)
    rng, count = np.random.default_rng(1), 0
    begun = time.perf_counter()
    while time.perf_counter() - begun < SECONDS:
        env.step(dict(zip(env.agents, rng.integers(0, 5, agents).tolist(), strict=True)))
        count += agents
    return count / (time.perf_counter() - begun)


def spread_in_jax(python: str, agents: int) -> float:
    """Agent-steps per second of JaxMARL."""
    worlds, steps = SPREADS[agents]
    return float(output([python, "-c", SPREAD, str(agents), str(worlds), str(steps)]).split()[-1])


def output(command: list[str]) -> str:
    """What a process of its own prints, with JAX on the processor."""
    environment = os.environ | {"JAX_PLATFORMS": "cpu"}
    return subprocess.run(command, check=True, capture_output=True, text=True, env=environment).stdout


def main() -> None:
    """Measures in turns and prints a table of the best of each."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--jaxmarl", metavar="PYTHON", help="an interpreter that has jaxmarl and jax[cpu]")
    parser.add_argument("--json", metavar="FILE", type=Path, help="write the rates of all turns to this file")
    options = parser.parse_args()
    os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})  # child processes inherit it
    parts = {
        "updates/s": update_rates(),
        "body-steps/s": body_rates() | box2d.rates(make_plan("appetite")),
        "agent-steps/s": world_rates(options.jaxmarl),
    }
    rates: dict[str, dict[str, list[float]]] = {unit: {name: [] for name in part} for unit, part in parts.items()}
    for turn in range(TURNS):
        for unit, part in parts.items():
            for name, measure in part.items():
                rates[unit][name].append(measure())
        print(f"turn {turn + 1} of {TURNS}", file=sys.stderr, flush=True)
    print("| program | rate | median | unit |\n|---|---:|---:|---|")
    for unit, programs in rates.items():
        for name, values in programs.items():
            print(f"| {name} | {max(values):,.0f} | {np.median(values):,.0f} | {unit} |")
    if options.json:
        options.json.write_text(json.dumps(rates, indent=1) + "\n")


if __name__ == "__main__":
    main()
