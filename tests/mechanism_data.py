"""Initial data of test worlds in addition to their settings: tables of founders, and networks."""

from collections.abc import Sequence

import numpy as np
from mechanism import Mixture

from hedon import _engine
from hedon.config.config import Config
from hedon.config.layout import gene_columns, layouts, observation_columns
from hedon.experiment.simulation import Simulation
from hedon.record.founder import Founders, make_founders
from hedon.record.network import Networks, fixed_species


def founders_of(world: Mixture, config: Config) -> Founders | None:
    """Two groups of founders with values for two genes; None if founders are drawn."""
    if not world.any("founders"):
        return None
    values = np.array([[0.5, -0.25], [-1.0, 0.125], [1.5, 0.0]])
    return make_founders(gene_columns(config)[:2], values, ["a", "a", "b"], {"a": 0.5, "b": 0.5})


def networks_of(world: Mixture, config: Config) -> Networks | None:
    """Three networks for each species that never learns; None if no networks are given."""
    if not world.any("networks"):
        return None
    params, inputs = {}, {}
    for i, name in enumerate(fixed_species(config)):
        inputs[name] = observation_columns(config, name)
        draw = np.random.default_rng(i)
        params[name] = draw.normal(0.0, 0.1, (3, _size(config, name))).astype(np.float32)
        params[name][:, -11:] = 0.0  # padding
    return Networks(params, inputs)


def begin(world: Mixture, config: Config, seeds: Sequence[int], threads: int, kernel: str = "") -> Simulation:
    """A simulation of a world with its initial data."""
    simulation = Simulation(config, seeds, threads, kernel)
    founders, networks = founders_of(world, config), networks_of(world, config)
    if founders is not None:
        simulation.set_founders(founders)
    if networks is not None:
        simulation.set_networks(networks)
    return simulation


def _size(config: Config, name: str) -> int:
    """Number of parameters of a species' network."""
    sensor, layout = config.species[name].sensor, layouts(config)[name]
    touches = len(layout.touches) * sensor.touch_sectors
    rest = len(observation_columns(config, name)) - sensor.ray_count * len(layout.sees) - touches
    return _engine.learning.param_count((sensor.ray_count, len(layout.sees), touches, rest))
