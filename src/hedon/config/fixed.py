"""Which settings a world keeps for as long as it lives: what the shapes of its arrays depend on, and its beginning."""

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
"""Settings and sections. The kinds of food and their capacities are fixed too."""


def fixed_path(path: str) -> bool:
    """Whether a setting cannot be changed in a world that has begun."""
    food = path == "food" or (path.startswith("food.") and path.endswith(".capacity"))
    return food or default_path(path).startswith(FIXED)
