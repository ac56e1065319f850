"""Random settings with growing food, for tests of forecasts: placement, growth, arena, body and costs vary."""

import math
import random

from hedon.config import Config, load_config

FORMS = ("uniform", "gaussian", "switching", "mixture", "rectangle")


def _spread(rng: random.Random, low: float, high: float) -> float:
    """A number with a uniformly distributed logarithm."""
    return round(math.exp(rng.uniform(math.log(low), math.log(high))), 5)


def _kind(rng: random.Random, name: str, size: tuple[float, float]) -> list[str]:
    form = rng.choice(FORMS)
    capacity = round(_spread(rng, 5, 400))
    found = {
        "growth_rate": _spread(rng, 0.01, 5),
        "capacity": capacity,
        "initial_count": rng.randint(0, max(capacity // 3, 1)),
        "candidates": rng.choice([1, 3, 10, 30]),
        "placement.form": f'"{form}"',
    }
    if form != "uniform":
        count = 1 if form in ("gaussian", "rectangle") else rng.randint(2, 5)
        found["placement.centers"] = [[round(rng.uniform(0.05, 0.95) * side, 1) for side in size] for _ in range(count)]
        found["placement.sd"] = [_spread(rng, 2, 200), _spread(rng, 2, 200)]
        if form == "switching":
            found["placement.switch_after"] = rng.choice([20, 200, 1000])
        if rng.random() < 0.2:
            found["placement.drift"] = [round(rng.uniform(-0.1, 0.1), 3), round(rng.uniform(-0.1, 0.1), 3)]
    if rng.random() < 0.2:
        found["placement.spacing"] = _spread(rng, 8, 40)
    if name != "normal":
        found["gives"] = f"{{energy={round(rng.uniform(-1, 1), 2)}}}"
    return [f"food.{name}.{key}={value}" for key, value in found.items()]


def draw_setting(seed: int, policy: str = "random") -> Config:
    """A setting with one species, drawn with a seed; its world may lack room for its initial agents and foods."""
    rng = random.Random(seed)
    size = (_spread(rng, 200, 1200), _spread(rng, 200, 1200))
    radius, food_radius = rng.choice([5.0, 10.0, 10.0, 15.0]), rng.choice([2.0, 4.0, 4.0, 8.0])
    most = max(int(0.2 * size[0] * size[1] / (math.pi * radius**2)), 4)
    founders = min(round(_spread(rng, 10, 200)), most)
    overrides = [
        f"arena.width={size[0]}",
        f"arena.height={size[1]}",
        f"body.radius={radius}",
        f"motor.force_scale={_spread(rng, 0.7, 1.5) * (radius / 10) ** 2}",
        f"sensor.mouth_spread={rng.choice([30, 60, 60, 90, 180])}",
        f"world.food_radius={food_radius}",
        f"population.initial_count={founders}",
        f"population.capacity={founders * rng.choice([1, 2, 4])}",
        f"energy.initial={_spread(rng, 2, 80)}",
        f"energy.basic_cost={_spread(rng, 1e-4, 1e-2)}",
        f"energy.action_cost={_spread(rng, 2e-6, 2e-4)}",
        f"birth.kappa={_spread(rng, 5e-5, 1e-3)}",
        f"hazard.kappa={_spread(rng, 1e-3, 5e-2)}",
        f'learning.policy="{policy}"',
    ]
    if rng.random() < 0.25:
        ends = [round(rng.uniform(0.2, 0.8) * size[i % 2], 1) for i in range(4)]
        overrides.append(f"arena.inner_walls=[{ends}]")
    for name in ("normal", "other")[: rng.choice([1, 1, 2])]:
        overrides += _kind(rng, name, size)
    return load_config("baseline", overrides=overrides)
