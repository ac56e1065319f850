"""Eventful worlds, and every way to copy them."""

import copy
import pickle
from collections.abc import Callable
from typing import Any

from worlds import QUICK

LIVELY = (*QUICK, "birth.kappa=0.05", "hazard.alpha_age=0.01", "population.capacity=40", "population.initial_count=30")
PAIR = (*LIVELY, "species.wise.body.radius=10", "species.led.body.radius=10", "species.led.sensor.ray_count=8")
WAYS: dict[str, Callable[[Any], Any]] = {
    "clone": lambda held: held.clone(),
    "copy": copy.copy,
    "deepcopy": copy.deepcopy,
    "pickle": lambda held: pickle.loads(pickle.dumps(held)),
}


def digests(held: Any) -> list[str]:
    return [world.digest() for world in getattr(held, "simulation", held).worlds]
