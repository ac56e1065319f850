"""A config as text for the engine in a web page, in the format described in `engine/web/input.h`."""

from hedon.config.config import Config
from hedon.config.engine import engine_config, flat
from hedon.config.schema.arena import outer_count, walls


def engine_text(config: Config, seed: int) -> str:
    """The text, with one `path=value` per line: the seed, the walls, and every setting of the engine.

    Args:
        config: Settings of the world.
        seed: Seed of the world.
    """
    lines = [f"seed={seed}", f"outer_walls={outer_count(config.arena)}"]
    lines += ["wall=" + ",".join(repr(float(value)) for value in wall) for wall in walls(config.arena)]
    lines += [f"{path}={value}" for path, value in flat(engine_config(config))]
    return "\n".join(lines) + "\n"
