"""Runs worlds with extreme settings for many steps, with a check at the end of each window.

`python tests/soak.py [--steps N] [--only NAME]` runs N steps in total, a million by default, divided among the
settings. It stops at the first violation, which the engine reports. A world that dies out is followed by one with the
next seed.
"""

import argparse
import time

from worlds import CHILDLESS, DEATHLESS, make_simulation

from hedon.config.load import load_config

FULL = ("population.initial_count=140", "birth.kappa=0.02", "birth.attempts=100")
LEARN_LITTLE = ("learning.update_epochs=1",)
SETTINGS = {
    "crowded small arena": ("small", (*FULL, "hazard.kappa=0.002")),
    "200 of 200 alive": ("small", (*FULL, *DEATHLESS)),
    "crowded, strong motors": ("small", (*FULL, "motor.max_force=300", "motor.min_force=-300", "hazard.kappa=0.002")),
    "no food": ("baseline", ("food.normal.initial_count=0", "food.normal.growth_rate=0", "birth.kappa=0.002")),
    "all food": ("baseline", ("food.normal.growth_rate=100", "food.normal.capacity=200", "birth.kappa=0.002")),
    "one agent": ("baseline", ("population.initial_count=1", *CHILDLESS, *DEATHLESS)),
    "births on the spot": ("baseline", ("birth.distance_sd=0.001", "birth.kappa=0.02", "hazard.kappa=0.0001")),
    "births and deaths all the time": ("small", ("birth.kappa=0.2", "hazard.kappa=0.3", "birth.attempts=100")),
    "starvation kills": ("poison", ('energy.at_zero="death"', "birth.kappa=0.01", "energy.basic_cost=0.01")),
}


def soak(name: str, steps: int) -> None:
    """Runs a setting for this many steps, in as many worlds as it takes."""
    preset, overrides = SETTINGS[name]
    window = load_config(preset).world.rollout_steps
    begun, done, seed, most = time.perf_counter(), 0, 0, 0
    while done < steps:
        seed += 1
        simulation = make_simulation(*overrides, *LEARN_LITTLE, preset=preset, seeds=(seed,))
        world = simulation.worlds[0]
        while not world.extinct and done + world.step < steps:
            simulation.run(min(window // 4, steps - done - world.step))
            simulation.engine.take_rows(0)
            most = max(most, world.alive)
        done += world.step
    seconds = time.perf_counter() - begun
    print(f"{name}: {done:,} steps, {seed} worlds, up to {most} alive, no violation ({seconds:.0f} s)", flush=True)


def main() -> None:
    """Runs all settings, or one."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--steps", type=int, default=1_000_000, help="in all")
    parser.add_argument("--only", choices=SETTINGS, help="one setting, with all the steps")
    options = parser.parse_args()
    names = [options.only] if options.only else list(SETTINGS)
    for name in names:
        soak(name, -(-options.steps // len(names)))


if __name__ == "__main__":
    main()
