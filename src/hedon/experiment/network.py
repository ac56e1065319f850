"""Networks for agents that never learn, from a file or from the agents that had learned by the end of a run."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from hedon import _engine
from hedon.config.config import Config
from hedon.config.layout import layouts, observation_columns
from hedon.config.load import parse_config
from hedon.record.checkpoint import Checkpoint
from hedon.record.network import NetworkError, Networks, fixed_species, read_networks
from hedon.record.reader import open_run
from hedon.record.rollback import find_checkpoint
from hedon.text import brief


def networks_from(text: str, config: Config) -> Networks:
    """Loads networks from a source.

    Raises:
        NetworkError: There are none, or they do not fit the config.
        RecordError: The run cannot be read.
    """
    path = Path(text)
    networks = read_networks(path) if path.is_file() else _of_run(path)
    networks.require(config, text)
    species_names = fixed_species(config)
    return Networks(
        {name: networks.params[name] for name in species_names}, {name: networks.inputs[name] for name in species_names}
    )


def _of_run(folder: Path) -> Networks:
    if not folder.exists():
        raise NetworkError(
            f"--networks {brief(str(folder))}: there is no such file or folder: give networks.npz, or a run's folder"
        )
    open_run(folder)
    checkpoint, _ = find_checkpoint(folder)
    if checkpoint is None:
        raise NetworkError(f"--networks {brief(str(folder))}: the run has no checkpoint, so no networks")
    config = parse_config(checkpoint.head.config, f"config in the checkpoint of {folder}")
    params, inputs = {}, {}
    for name in config.species:
        rows = [_learned(checkpoint, config, name, world) for world in range(len(checkpoint.head.seeds))]
        if sum(map(len, rows)):
            params[name] = np.concatenate(rows)
            inputs[name] = observation_columns(config, name)
    if not params:
        raise NetworkError(f"--networks {brief(str(folder))}: nobody alive at its end has learned")
    return Networks(params, inputs)


def _learned(checkpoint: Checkpoint, config: Config, name: str, world: int) -> NDArray[np.float32]:
    """Networks of the agents of a species that have learned, (agents, parameters)."""
    arrays = checkpoint.world(world)
    policies = [species.learning.policy for species in config.species.values()]
    species_index = list(config.species).index(name)
    if policies[species_index] not in ("ppo", "fixed"):
        return np.zeros((0, 0), np.float32)
    species = arrays.get("species", np.zeros(len(arrays["life.agent_id"]), np.int32))
    with_network = species[np.isin(species, [i for i, policy in enumerate(policies) if policy in ("ppo", "fixed")])]
    rows = arrays["params"][with_network == species_index]
    if policies[species_index] == "ppo":
        learners = species[np.isin(species, [i for i, policy in enumerate(policies) if policy == "ppo"])]
        rows = rows[arrays["updates"][learners == species_index] > 0]
    return rows[:, : _engine.learning.param_count(_network_shape(config, name))]


def _network_shape(config: Config, name: str) -> tuple[int, int, int, int]:
    """Numbers of a species' network inputs: rays, types that rays distinguish, touch entries, and all other entries."""
    sensor, layout = config.species[name].sensor, layouts(config)[name]
    touches = len(layout.touches) * sensor.touch_sectors
    other_entries = len(observation_columns(config, name)) - sensor.ray_count * len(layout.sees) - touches
    return sensor.ray_count, len(layout.sees), touches, other_entries
