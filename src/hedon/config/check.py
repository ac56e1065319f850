"""Contradictions: settings that are allowed one by one, but not together."""

import math
import re
from collections.abc import Iterator, Sequence
from typing import Any

from hedon.config.arena import ArenaConfig, is_inside
from hedon.config.check_schedule import schedule_problems
from hedon.config.check_species import MAX_COVERAGE, species_problems
from hedon.config.config import PROVENANCE, Config
from hedon.config.field import leaves
from hedon.config.food import FoodConfig
from hedon.config.problem import Problem, format_value, single
from hedon.config.room import MAX_FACTOR, MAX_FOOD_KINDS

MIN_WALL = 0.01
"""Length of the shortest wall whose direction float32 can still hold [u]."""
RESERVED_KINDS = ("agent", "wall", "obstacle", "action")
"""Names with another meaning in sensor channels or in the columns of records."""


def contradictions(config: Config) -> Iterator[Problem]:
    """Yields every contradiction in a config."""
    yield from _names(config)
    yield from _rounding(config)
    yield from _arena(config)
    yield from _obstacles(config)
    yield from _kinds(config)
    yield from _founders(config)
    yield from species_problems(config)


def _names(config: Config) -> Iterator[Problem]:
    for field in PROVENANCE:  # folders of runs are named by them
        text = getattr(config, field)
        if not re.fullmatch(r"[A-Za-z0-9_-][A-Za-z0-9._-]{0,79}", text):
            rule = 'must have only letters, digits, "-", "_" and ".", at most 80 of them, and not begin with a "."'
            yield Problem(field, rule, format_value(text))


def _rounding(config: Config) -> Iterator[Problem]:
    """Numbers that are outside their range after rounding to the engine's 32 bits, and those in lists."""
    for path, setting, value in leaves(config):
        if setting.type is float and single(value) not in setting.doc.range:
            message = f"is {single(value):g} in the engine's 32-bit numbers, but must be {setting.allowed}"
            yield Problem(path, message, format_value(value))
        if setting.doc.range.each is not None:
            low, high = setting.doc.range.each
            for place, number in _numbers(value):
                if not low <= number <= high:
                    yield Problem(path + place, f"must be from {low:.10g} to {high:.10g}", format_value(number))


def _numbers(items: Sequence[Any], path: str = "") -> Iterator[tuple[str, float]]:
    """The numbers in a list and in the lists in it, each with its place: [2][0]."""
    for i, item in enumerate(items):
        if isinstance(item, Sequence) and not isinstance(item, str):
            yield from _numbers(item, f"{path}[{i}]")
        elif not isinstance(item, str):
            yield f"{path}[{i}]", item


def _arena(config: Config) -> Iterator[Problem]:
    arena = config.arena
    if not _corners_fit(arena):
        side = min(arena.width, arena.height)
        rule = f"must be 0 or below {side / 2:g} [u], with no wall shorter than {MIN_WALL:g} [u]"
        yield _problem(config, "arena.corner_radius", rule)
    for i, wall in enumerate(arena.inner_walls):
        ax, ay, bx, by = wall
        if _is_outside(arena, ax, ay) or _is_outside(arena, bx, by):
            yield Problem(f"arena.inner_walls[{i}]", "lies outside the arena", format_value(wall))
        if math.dist((ax, ay), (bx, by)) < MIN_WALL:
            yield Problem(f"arena.inner_walls[{i}]", f"must be at least {MIN_WALL:g} [u] long", format_value(wall))


def _corners_fit(arena: ArenaConfig) -> bool:
    chord = 2 * arena.corner_radius * math.sin(math.pi / 4 / arena.corner_chords)
    straight = min(arena.width, arena.height) - 2 * arena.corner_radius
    return straight >= MIN_WALL and (arena.corner_radius == 0 or chord >= MIN_WALL)


def _is_outside(arena: ArenaConfig, x: float, y: float) -> bool:
    """Whether a point lies outside the outline. False if the outline itself is wrong, which has its own message."""
    return _corners_fit(arena) and not is_inside(arena, x, y)


def _obstacles(config: Config) -> Iterator[Problem]:
    obstacle = config.obstacle
    yield from schedule_problems(obstacle.schedule, "obstacle.schedule", {"harmful": 1.0})
    if obstacle.min_side > obstacle.max_side:
        rule = f"must be at most obstacle.max_side = {obstacle.max_side:g}"
        yield Problem("obstacle.min_side", rule, format_value(obstacle.min_side))
    # Circles around obstacles do not overlap when they are placed; random placement stops long before they fill it.
    around = obstacle.max_side / (2 * math.sin(math.pi / obstacle.corners))
    area, room = math.pi * around**2, MAX_COVERAGE * config.arena.width * config.arena.height
    if obstacle.count * area > room:
        most = math.floor(room / area)
        rule = f"too many to place: the arena has room for {most} with sides of {obstacle.max_side:g}"
        yield Problem("obstacle.count", rule, format_value(obstacle.count))


def _kinds(config: Config) -> Iterator[Problem]:
    if not 1 <= len(config.food) <= MAX_FOOD_KINDS:
        yield Problem("food", f"there must be from 1 to {MAX_FOOD_KINDS} kinds of food, not {len(config.food)}")
    for kind, food in config.food.items():
        path = f"food.{kind}"
        if not re.fullmatch(r"[a-z][a-z0-9_]{0,31}", kind) or kind in RESERVED_KINDS:
            rule = "a kind's name must have only a-z, 0-9 and _, start with a letter, have at most 32 characters"
            yield Problem(path, f"{rule} and not be one of " + ", ".join(RESERVED_KINDS))
        if not re.fullmatch(r"#[0-9a-f]{6}", food.color):
            yield Problem(
                f"{path}.color",
                'must be "#rrggbb" in lower-case hexadecimal digits',
                format_value(food.color),
            )
        if food.initial_count > food.capacity:
            message = f"must be at most {path}.capacity = {food.capacity}"
            yield Problem(f"{path}.initial_count", message, format_value(food.initial_count))
        yield from _placement(config, food, f"{path}.placement")
        yield from schedule_problems(food.schedule, f"{path}.schedule", {"growth_rate": MAX_FACTOR, "capacity": 1.0})


def _placement(config: Config, food: FoodConfig, path: str) -> Iterator[Problem]:
    place = food.placement
    for i, (x, y) in enumerate(place.centers):
        if _is_outside(config.arena, x, y):
            yield Problem(f"{path}.centers[{i}]", "lies outside the arena", format_value((x, y)))
    if place.form == "uniform":
        return
    if place.form in ("gaussian", "rectangle") and len(place.centers) != 1:
        yield Problem(f"{path}.centers", f'"{place.form}" takes one center, not {len(place.centers)}')
    if place.form in ("switching", "mixture") and len(place.centers) < 2:
        yield Problem(f"{path}.centers", f'"{place.form}" takes at least two centers, not {len(place.centers)}')
    if single(min(place.sd)) <= 0:
        yield Problem(f"{path}.sd", f'"{place.form}" takes two numbers > 0 [u]', format_value(place.sd))


def _founders(config: Config) -> Iterator[Problem]:
    digests = {
        "world.founders": "a table of founders, which `--founders` sets",
        "world.networks": "a file of networks, which `--networks` sets",
    }
    for path, what in digests.items():
        section, name = path.split(".")
        if not re.fullmatch(r"([0-9a-f]{64})?", getattr(getattr(config, section), name)):
            yield _problem(config, path, f"must be empty, or the digest of {what}")


def _problem(config: Config, path: str, message: str) -> Problem:
    section, name = path.split(".")
    return Problem(path, message, format_value(getattr(getattr(config, section), name)))
