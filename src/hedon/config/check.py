"""Contradictions in a world: settings that are valid one by one but not together."""

import math
import re
from itertools import pairwise
from typing import Any

from hedon.config.check_species import MAX_COVERAGE, NAME, check_species
from hedon.config.field import inner_sections
from hedon.config.layout import store_columns
from hedon.config.problem import Check, Problem, nearest, single
from hedon.config.room import MAX_FOOD_KINDS
from hedon.config.schema.arena import ArenaConfig, is_inside
from hedon.config.schema.food import FoodConfig
from hedon.config.schema.schedule import ScheduleConfig
from hedon.config.schema.settings import PROVENANCE, Settings
from hedon.config.schema.store import ENERGY

MIN_WALL = 0.01
"""Length of the shortest wall whose direction float32 can represent [u]."""
RESERVED_KINDS = ("agent", "wall", "obstacle", "action")
"""Names that have another meaning in sensor channels or in columns of the records."""


def contradictions(config: Settings) -> list[Problem]:
    """Returns all contradictions in a config."""
    check = Check(config)
    _names(check)
    _arena(check, config.arena)
    _obstacles(check, config)
    _kinds(check, config)
    _tables(check, config, "")
    check_species(check)
    return check.problems


def _names(check: Check) -> None:
    for field in PROVENANCE:  # run folders are named after them
        rule = 'must have only letters, digits, "-", "_" and ".", at most 80 of them, and not begin with a "."'
        check.match(r"[A-Za-z0-9_-][A-Za-z0-9._-]{0,79}", field, rule)
    for name, kind in (("founders", "table of founders"), ("networks", "file of networks")):
        rule = f"must be empty, or the digest of a {kind}, which `--{name}` sets"
        check.match("([0-9a-f]{64})?", f"world.{name}", rule)


def _arena(check: Check, arena: ArenaConfig) -> None:
    half = min(arena.width, arena.height) / 2
    rule = f"must be 0 or below {half:g} [u], with no wall shorter than {MIN_WALL:g} [u]"
    check.need(_corners_fit(arena), "arena.corner_radius", rule)
    for i, wall in enumerate(arena.inner_walls):
        path, (ax, ay, bx, by) = f"arena.inner_walls[{i}]", wall
        outside = _is_outside(arena, ax, ay) or _is_outside(arena, bx, by)
        check.need(not outside, path, "lies outside the arena", wall)
        is_long = math.dist((ax, ay), (bx, by)) >= MIN_WALL
        check.need(is_long, path, f"must be at least {MIN_WALL:g} [u] long", wall)


def _corners_fit(arena: ArenaConfig) -> bool:
    chord = 2 * arena.corner_radius * math.sin(math.pi / 4 / arena.corner_chords)
    straight = min(arena.width, arena.height) - 2 * arena.corner_radius
    return straight >= MIN_WALL and (arena.corner_radius == 0 or chord >= MIN_WALL)


def _is_outside(arena: ArenaConfig, x: float, y: float) -> bool:
    """Whether a point is outside the outline. False for an invalid outline, which is reported separately."""
    return _corners_fit(arena) and not is_inside(arena, x, y)


def _obstacles(check: Check, config: Settings) -> None:
    obstacle = config.obstacle
    rule = f"must be at most obstacle.max_side = {obstacle.max_side:g}"
    check.need(obstacle.min_side <= obstacle.max_side, "obstacle.min_side", rule)
    rule = f"must be at most obstacle.max_angle = {obstacle.max_angle:g}"
    check.need(obstacle.min_angle <= obstacle.max_angle, "obstacle.min_angle", rule)
    if obstacle.cell > 0:
        _grid(check, config)
        return
    # Circumscribed circles must not overlap; random placement fails long before the circles fill the arena.
    circumradius = obstacle.max_side / (2 * math.sin(math.pi / obstacle.corners))
    area, room = math.pi * circumradius**2, MAX_COVERAGE * config.arena.width * config.arena.height
    rule = f"the arena has room for {math.floor(room / area)} with sides of {obstacle.max_side:g}"
    check.need(obstacle.count * area <= room, "obstacle.count", f"too many to place: {rule}")


def _grid(check: Check, config: Settings) -> None:
    cell, shorter_side = single(config.obstacle.cell), min(config.arena.width, config.arena.height)
    check.need(
        1 <= cell <= shorter_side,
        "obstacle.cell",
        f"must be 0, or from 1 to the shorter side of the arena, {shorter_side:g} [u]",
    )
    if 1 <= cell <= shorter_side:
        room = math.prod(math.floor(single(side) / cell) for side in (config.arena.width, config.arena.height)) // 2
        rule = f"must be at most {room}: half of the cells of {cell:g} u"
        check.need(config.obstacle.count <= room, "obstacle.count", rule)


def _kinds(check: Check, config: Settings) -> None:
    count = len(config.food)
    if not 1 <= count <= MAX_FOOD_KINDS:
        check.add("food", f"there must be from 1 to {MAX_FOOD_KINDS} kinds of food, not {count}")
    for kind, food in config.food.items():
        path = f"food.{kind}"
        if not re.fullmatch(NAME, kind) or kind in RESERVED_KINDS:
            rule = "a kind's name must have only a-z, 0-9 and _, start with a letter, have at most 32 characters"
            check.add(path, f"{rule} and not be one of " + ", ".join(RESERVED_KINDS))
        check.match("#[0-9a-f]{6}", f"{path}.color", 'must be "#rrggbb" in lower-case hexadecimal digits')
        rule = f"must be at most {path}.capacity = {food.capacity}"
        check.need(food.initial_count <= food.capacity, f"{path}.initial_count", rule)
        for field, table in (("gives", food.gives), ("needs", food.needs)):
            stores = (ENERGY, *store_columns(config))
            for name in table.keys() - set(stores):
                rule = "no species has such a store: there are " + ", ".join(stores)
                check.add(f"{path}.{field}.{name}", rule, nearest(name, stores))
        _look(check, config, kind)
        _placement(check, config.arena, food, f"{path}.placement")


def _look(check: Check, config: Settings, kind: str) -> None:
    other, path = config.food[kind].looks_like, f"food.{kind}.looks_like"
    if not other:
        return
    candidates = [name for name in config.food if name != kind]
    if other not in candidates:
        check.add(
            path,
            "must be another kind of food: there are " + (", ".join(candidates) or "none"),
            nearest(other, candidates),
        )
    elif config.food[other].looks_like:
        check.add(path, f"{other} looks like {config.food[other].looks_like}: name a kind that looks like itself")
    for name, species in config.species.items():
        if kind in species.sensor.sees:
            check.add(path, f"species.{name}.sensor.sees names {kind}, which no species sees as itself: name {other}")


def _placement(check: Check, arena: ArenaConfig, food: FoodConfig, path: str) -> None:
    place, count = food.placement, len(food.placement.centers)
    for i, (x, y) in enumerate(place.centers):
        check.need(not _is_outside(arena, x, y), f"{path}.centers[{i}]", "lies outside the arena", (x, y))
    if place.form == "uniform":
        return
    if place.form in ("gaussian", "rectangle") and count != 1:
        check.add(f"{path}.centers", f'"{place.form}" takes one center, not {count}')
    if place.form in ("switching", "mixture") and count < 2:
        check.add(f"{path}.centers", f'"{place.form}" takes at least two centers, not {count}')
    check.need(single(min(place.sd)) > 0, f"{path}.sd", f'"{place.form}" takes two numbers > 0 [u]')


def _tables(check: Check, section: Any, path: str) -> None:
    """Reports invalid names in tables with a fixed set of names, and schedules that cannot be followed."""
    for place, inner, value in inner_sections(section, path):
        name = place.rpartition(".")[2]
        if inner.names and name not in inner.names:
            reason = "this cannot follow a schedule here" if inner.type is ScheduleConfig else "no gene can set this"
            check.add(place, f"{reason}: there are " + ", ".join(inner.names), nearest(name, inner.names))
        elif inner.type is ScheduleConfig:
            _schedule(check, value, f"{place}.points", inner.names[name])
        _tables(check, value, f"{place}.")


def _schedule(check: Check, schedule: ScheduleConfig, path: str, largest: float) -> None:
    steps = [step for step, _ in schedule.points]
    if not steps:
        check.add(path, "must have at least one point")
    is_rising = all(first < second for first, second in pairwise(steps)) and all(step >= 0 for step in steps)
    check.need(is_rising, path, "steps must rise, from 0 on")
    if is_rising and steps and schedule.period:
        check.need(steps[-1] < schedule.period, path, f"steps must lie below period = {schedule.period}")
    for _, factor in schedule.points:
        check.need(0 <= factor <= largest, path, f"factors must be from 0 to {largest:g}", factor)
