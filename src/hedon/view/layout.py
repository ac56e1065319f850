"""What a world consists of, in the words that the page understands: the only place of the viewer that knows settings.

The page knows species, types that senses tell apart, foods, genes, rays and walls. It draws and names whatever this
description lists.
"""

from typing import Any

from hedon.config.arena import walls
from hedon.config.config import Config
from hedon.record.schema import neutral_names, weight_names


def describe(config: Config) -> dict[str, Any]:
    """The layout of a world.

    Returns:
        `species`: name, capacity, radius [u] and mouth_degrees (on each side of the heading) of each;
        `types`: names that senses tell apart, in the order of the engine's channels;
        `foods`: name, radius [u], energy and color of each;
        `genes`: name, role ("reward" or "neutral") and input (what it rewards, "" for none) of each, in genome order;
        `rays`: count, spread_degrees (on each side of the heading) and length [u];
        `arena`: width, height [u] and walls (ax, ay, bx, by) [u]; `window`: steps between two times of learning;
        `energy_capacity`: most energy of an agent.
    """
    foods = [
        {"name": name, "radius": config.body.food_radius, "energy": food.energy, "color": food.color}
        for name, food in config.food.items()
    ]
    return {
        "species": [
            {
                "name": "agent",
                "capacity": config.population.capacity,
                "radius": config.body.radius,
                "mouth_degrees": config.sensor.mouth_spread,
            }
        ],
        "types": ["agent", *config.food, "wall"],
        "foods": foods,
        "genes": _genes(config),
        "rays": {
            "count": config.sensor.ray_count,
            "spread_degrees": config.sensor.ray_spread,
            "length": config.sensor.ray_length,
        },
        "arena": {
            "width": config.arena.width,
            "height": config.arena.height,
            "walls": [[float(value) for value in wall] for wall in walls(config.arena)],
        },
        "window": config.learning.rollout_steps,
        "energy_capacity": config.energy.capacity,
    }


def _genes(config: Config) -> list[dict[str, str]]:
    names = weight_names(tuple(config.food), config.genome.neutral_count)
    neutral = neutral_names(config.genome.neutral_count)
    return [
        {
            "name": name,
            "role": "neutral" if name in neutral else "reward",
            "input": "" if name in neutral else name.removeprefix("w_"),
        }
        for name in names
    ]
