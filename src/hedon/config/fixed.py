"""Settings fixed for a world's lifetime: those that determine array shapes or its initial state."""

from hedon.config.schema.species import default_path

FIXED = (
    "arena.",
    "sensor.ray_count",
    "sensor.touch_sectors",
    "sensor.scaling",
    "genome.neutral_count",
    "world.founders",
    "world.networks",
    "reward.memory",
    "world.rollout_steps",
)
"""Fixed settings and sections. The food kinds and their capacities are fixed too."""


def fixed_path(path: str) -> bool:
    """Whether a setting cannot change once a world has started."""
    food = path == "food" or (path.startswith("food.") and path.endswith(".capacity"))
    return food or default_path(path).startswith(FIXED)
