"""Channels: what can be known of an agent in a step, one number each.

What an agent observes beside rays and touch, and what a rule of the caller gets, are lists of channels. The engine gets
them as data and reads all of them in one function, `channel_value` in `engine/world/channel.h`.
"""

from collections.abc import Sequence
from dataclasses import dataclass

from hedon.config.neighbor import NUMBERS
from hedon.config.species import SpeciesConfig
from hedon.config.store import ENERGY

SOURCES = {
    "velocity": "velocity along x, along y [u/s]",
    "angle": "heading, 0 along y, not wrapped [rad]",
    "heading": "sine and cosine of the heading at the start of the step",
    "angular_velocity": "angular velocity [rad/s]",
    "store": "what it holds of a store",
    "store_before": "the same, before the meals and costs of the step",
    "smell": "what a nose smells of a source, in [0, 1]",
    "age": "steps lived, the present one included",
    "moved": "distance moved in the step [u]",
    "nearness": "mean reading of its rays, 0 for those that met nothing",
    "force": "force of the left, of the right motor [mass·u/s²]",
    "position": "place along x, along y [u]",
    "step": "the step of the world",
    "alive": "living agents of its species",
    "neighbor": "what a query of its rules found, by query",
}
"""Where the engine reads a channel, with its meaning. What a source has several of, `Channel.index` counts."""
VELOCITY_SCALE, ANGULAR_VELOCITY_SCALE = 1.5, 0.2
"""Divisors of observed velocities [u/s] and angular velocities [rad/s] where each part is scaled to about 1."""


@dataclass(frozen=True, slots=True)
class Channel:
    """One number of an agent.

    Attributes:
        name: Its column.
        source: One of `SOURCES`.
        index: Which number of the source.
        scale: The number is divided by this.
        place: The path of the scale in the species, "" where no setting says it.
    """

    name: str
    source: str
    index: int = 0
    scale: float = 1.0
    place: str = ""


def observed_channels(species: SpeciesConfig, smells: Sequence[str]) -> tuple[Channel, ...]:
    """What a species observes beside rays and touch, in order: model page, section 5.

    Args:
        species: with its stores.
        smells: names of what it smells.
    """
    sensor = species.sensor
    raw = sensor.scaling == "raw"
    scale, spin = (1.0, 1.0) if raw else (VELOCITY_SCALE, ANGULAR_VELOCITY_SCALE)
    heading = [Channel("heading", "angle")]
    if not raw:
        heading = [Channel("heading_sine", "heading", 0), Channel("heading_cosine", "heading", 1)]
    return (
        Channel("velocity_x", "velocity", 0, scale),
        Channel("velocity_y", "velocity", 1, scale),
        *heading,
        Channel("angular_velocity", "angular_velocity", 0, spin),
        *(
            Channel(name, "store", i)
            if raw
            else Channel(name, "store", i, store.scale, f"{'' if name == ENERGY else 'store.'}{name}.scale")
            for i, (name, store) in enumerate(species.stores.items())
            if store.observed
        ),
        *(
            Channel(f"smell_{name}_{nose}", "smell", i * sensor.noses + nose)
            for i, name in enumerate(smells)
            for nose in range(sensor.noses)
        ),
    )


def recorded_channels(species: SpeciesConfig) -> tuple[Channel, ...]:
    """What a rule gets of every agent beside its reward's inputs, its genes and its memory, in order.

    Where there are other stores than energy, each is there as it was at the start of the step and as it is; then what
    each query about neighbors found.

    Args:
        species: with its stores and its queries.
    """
    return (
        Channel("age", "age"),
        Channel("energy_before", "store_before"),
        Channel("energy", "store"),
        Channel("moved", "moved"),
        Channel("nearness", "nearness"),
        Channel("force_left", "force", 0),
        Channel("force_right", "force", 1),
        Channel("x", "position", 0),
        Channel("y", "position", 1),
        Channel("step", "step"),
        Channel("alive", "alive"),
        *(
            channel
            for i, name in enumerate(species.store, 1)
            for channel in (Channel(f"{name}_before", "store_before", i), Channel(name, "store", i))
        ),
        *(
            Channel(f"{name}_{number}", "neighbor", i * len(NUMBERS) + n)
            for i, name in enumerate(species.neighbor)
            for n, number in enumerate(NUMBERS)
        ),
    )
