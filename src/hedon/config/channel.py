"""Channels: the numbers that can be known about an agent in a step.

Lists of channels define what an agent observes besides rays and touch, what it is rewarded for, what opens the gate of
its reward, and what a user's rule receives. The engine gets these lists as data and reads every channel in one
function, `channel_value` in `engine/world/channel.h`.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

from hedon.config.schema.settings import Settings
from hedon.config.schema.species import SpeciesConfig
from hedon.config.schema.store import ENERGY
from hedon.config.type import asked_for, chosen, diet, seen, smelled


@dataclass(frozen=True, slots=True)
class Source:
    """A source that the engine reads channels from.

    Attributes:
        name: Pattern of its channels' names; `{}` stands for what it has several of.
        meaning: Pattern of their descriptions, as a phrase.
        unit: Unit of their numbers.
        of: What the source has several of: names, or a key of `SEVERAL`.
        of_step: Whether the number is known only after the step, so that an observation has the previous step's.
        limits: Minimum and maximum, if known; the limits of a store's level come from the store.
    """

    name: str
    meaning: str
    unit: str = "1"
    of: str | tuple[str, ...] = ("",)
    of_step: bool = False
    limits: tuple[float, float] = (-math.inf, math.inf)

    @property
    def several(self) -> str:
        """The engine's word for what the source has several of: a key of `SEVERAL`, "one" or "two"."""
        return self.of if isinstance(self.of, str) else ("one", "two")[len(self.of) - 1]


SEVERAL: dict[str, tuple[tuple[str, ...], str]] = {
    "stores": (("<store>",), "of each store, energy too"),
    "meals": (("<meal>",), "of each kind of food and each species that it eats"),
    "sees": (("<type>",), "of each type that it sees"),
    "smells": (("<type>",), "of each type that it smells"),
    "noses": (("<type>_<nose>",), "of each type that it smells, and each nose from 0 on"),
    "touches": (("<type>",), "of each type that it collides with"),
    "season": (("sine", "cosine"), "where a schedule has a period, or with sensor.season_period"),
    "queries": (("<query>",), "of each query"),
    "companies": (("<query>",), "of each query that finds agents"),
    "harm": (("",), "where there are obstacles"),
    "mates": (("",), 'with birth.mating = "pairs"'),
    "drive": (("",), "with reward.drive_reduction_coef"),
}
"""For sources with several channels, or only in some worlds: the placeholders in names, and when they exist."""
_SHARE, _CIRCLE, _COUNT = (0.0, 1.0), (-1.0, 1.0), (0.0, math.inf)
SOURCES = {
    "velocity": Source("velocity_{}", "velocity along {}", "u/s", ("x", "y")),
    "angle": Source("heading", "heading, 0 along y", "rad", limits=(-2 * math.pi, 2 * math.pi)),
    "heading": Source(
        "heading_{}", "{} of the heading at the start of the step", of=("sine", "cosine"), limits=_CIRCLE
    ),
    "angular_velocity": Source("angular_velocity", "angular velocity", "rad/s"),
    "store": Source("{}", "{} that it holds", "amount", "stores", limits=_COUNT),
    "store_before": Source(
        "{}_before", "{} before the meals and costs of the step", "amount", "stores", True, limits=_COUNT
    ),
    "store_change": Source("{}_change", "change of {} by the meals and costs of the step", "amount", "stores", True),
    "meals": Source("eaten_{}", "pieces or agents of {} eaten in the step", of="meals", of_step=True, limits=_COUNT),
    "damage": Source("damage", "energy that obstacles took in the step", "energy", "harm", True, limits=_COUNT),
    "see_mean": Source("see_{}", "mean over the rays of what they read of {}", of="sees", limits=_SHARE),
    "see_max": Source("see_{}_max", "the largest that a ray reads of {}", of="sees", limits=_SHARE),
    "nearness": Source("nearness", "mean reading of the rays, 0 for those that met nothing", limits=_SHARE),
    "smell": Source("smell_{}", "smell of {}, with the number of the nose", of="noses", limits=_SHARE),
    "smell_mean": Source("smell_{}", "mean over the noses of the smell of {}", of="smells", limits=_SHARE),
    "contacts": Source("contacts_{}", "touch sectors that feel {}", of="touches", limits=_COUNT),
    "touched": Source("touched", "touch sectors that feel anything", limits=_COUNT),
    "neighbor_count": Source("{}_count", "how many {} finds as the step begins", of="queries", limits=_COUNT),
    "neighbor_kin": Source(
        "{}_kin", "how many of these are its parents, children or siblings", of="companies", limits=_COUNT
    ),
    "neighbor_distance": Source("{}_distance", "distance of the nearest of these", "u", "queries", limits=_COUNT),
    "neighbor_bearing": Source(
        *("{}_bearing", "direction of the nearest of these, 0 ahead, positive to the left", "rad", "queries"),
        limits=(-math.pi, math.pi),
    ),
    "neighbor_meals": Source(
        "{}_meals", "meals, in the step, of agents that {} finds", of="companies", of_step=True, limits=_COUNT
    ),
    "effort": Source(
        "effort", "norm of the forces of both motors, as a share of its largest", of_step=True, limits=_COUNT
    ),
    "force": Source("force_{}", "force of the {} motor", "mass·u/s²", ("left", "right"), True),
    "force_norm": Source("force", "norm of the forces of both motors", "mass·u/s²", of_step=True, limits=_COUNT),
    "moved": Source("moved", "distance moved in the step", "u", of_step=True, limits=_COUNT),
    "position": Source("{}", "place of its center along {}", "u", ("x", "y")),
    "age": Source("age", "steps lived, the present one included", "step", limits=_COUNT),
    "births": Source("births", "children that it had at the end of the step before", limits=_COUNT),
    "waits": Source("waits", "1 while it waits for a second parent", of="mates", limits=_SHARE),
    "drive_reduction": Source(
        "drive_reduction", "how much closer to their set points the step brought its stores", of="drive", of_step=True
    ),
    "season": Source("season_{}", "{} of the time of the year", of="season", limits=_CIRCLE),
    "step": Source("step", "steps that the world had done before the present one", "step", limits=_COUNT),
    "alive": Source("alive", "living agents of its species", limits=_COUNT),
    "one": Source("one", "1 in every step", limits=(1.0, 1.0)),
}
"""Sources of channels by their names in the engine."""
LAST = "last"
"""Source of what was known after the previous step; the engine keeps it for the next observation."""
QUERIED = tuple(name for name, source in SOURCES.items() if source.of in ("queries", "companies"))
"""Sources of the results of neighbor queries."""
RECORDED = (
    *(("age", 0), ("store_before", 0), ("store", 0), ("moved", 0), ("nearness", 0), ("force", 0), ("force", 1)),
    *(("position", 0), ("position", 1), ("step", 0), ("alive", 0)),
)
"""Channels that every rule receives, as (source, index), besides reward inputs, genes, memory and further stores."""


@dataclass(frozen=True, slots=True)
class Channel:
    """One number that describes an agent.

    Attributes:
        name: Its column in the records.
        source: One of `SOURCES`, or `LAST`.
        index: Position among the source's channels.
        scale: Divisor of the number.
        place: Path of the scale in the species; "" if no setting gives it.
        meaning: Description, as a phrase.
        unit: Unit before division by the scale.
        limits: Minimum and maximum before division by the scale.
    """

    name: str
    source: str
    index: int = 0
    scale: float = 1.0
    place: str = ""
    meaning: str = ""
    unit: str = "1"
    limits: tuple[float, float] = (-math.inf, math.inf)

    @property
    def of_step(self) -> bool:
        """Whether the number is known only after the step."""
        return self.source != LAST and SOURCES[self.source].of_step


Channels = dict[tuple[str, int], Channel]
"""All channels of a species by (source, index), in the order of `SOURCES`."""


def known_channels(config: Settings, species: SpeciesConfig) -> Channels:
    """All channels of a species. Names of food kinds or stores can make two channels share a name."""
    eaten, smells = diet(config, species), smelled(config, species.sensor.smells)
    alive = {name for name, query in species.neighbor.items() if {*asked_for(config, query.of)} & config.species.keys()}
    names: dict[str, Sequence[str | None]] = {
        "stores": tuple(species.stores),
        "meals": [name if name in eaten else None for name in (*config.food, *config.species)],
        "sees": seen(config, species.sensor.sees),
        "smells": smells,
        "noses": [f"{name}_{nose}" for name in smells for nose in range(species.sensor.noses)],
        "touches": chosen(config, species.body.collides),
        "season": ("sine", "cosine") if season_place(config, species) else (),
        "queries": tuple(species.neighbor),
        "companies": [name if name in alive else None for name in species.neighbor],
        "harm": ("",) * (config.obstacle.count > 0),
        "mates": ("",) * (species.birth.mating == "pairs"),
        "drive": ("",) * (species.reward.drive_reduction_coef != 0),
    }
    return {
        (key, i): Channel(
            *(source.name.format(label), key, i),
            meaning=source.meaning.format(label),
            unit=source.unit,
            limits=source.limits,
        )
        for key, source in SOURCES.items()
        for i, label in enumerate(names[source.of] if isinstance(source.of, str) else source.of)
        if label is not None
    }


def season_place(config: Settings, species: SpeciesConfig) -> str:
    """Finds the setting for the length of a year: the species' own, or else the period of the first repeating schedule.

    Returns:
        A path in the config if it begins with "food." or "obstacle.", else a path in the species; "" without a year.
    """
    if species.sensor.season_period:
        return "sensor.season_period"
    owners = [(f"food.{kind}", food.schedule) for kind, food in config.food.items()]
    owners += [("hazard", species.hazard.schedule), ("obstacle", config.obstacle.schedule)]
    return next(
        (
            f"{path}.schedule.{name}.period"
            for path, schedules in owners
            for name, schedule in schedules.items()
            if schedule.period
        ),
        "",
    )


def called(known: Channels, name: str) -> list[Channel]:
    """Channels with this name: one, none if the name is unknown, or two if a food kind or store repeats a name."""
    return [channel for channel in known.values() if channel.name == name]


def plain_channels(species: SpeciesConfig, known: Channels) -> tuple[Channel, ...]:
    """Channels observed besides rays and touch if `sensor.observes` is empty, in order: model page, section 5."""
    sensor, raw = species.sensor, species.sensor.scaling == "raw"

    def scaled(source: str, index: int, scale: float, place: str) -> Channel:
        channel = known[source, index]
        return channel if raw else replace(channel, scale=scale, place=place)

    return (
        *(scaled("velocity", axis, sensor.velocity_scale, "sensor.velocity_scale") for axis in (0, 1)),
        *([known["angle", 0]] if raw else [known["heading", 0], known["heading", 1]]),
        scaled("angular_velocity", 0, sensor.angular_velocity_scale, "sensor.angular_velocity_scale"),
        *(
            scaled("store", i, store.scale, f"{'' if name == ENERGY else 'store.'}{name}.scale")
            for i, (name, store) in enumerate(species.stores.items())
            if store.observed
        ),
        *(channel for channel in known.values() if channel.source == "smell"),
    )


def observed_channels(species: SpeciesConfig, known: Channels) -> tuple[tuple[Channel, ...], tuple[Channel, ...]]:
    """Channels observed besides rays and touch, in order, and those stored during a step for the next observation."""
    added: list[Channel] = []
    last: list[Channel] = []
    for name, scale in species.sensor.observes.items():
        (channel,) = called(known, name)
        if channel.of_step:
            last.append(channel)
            channel = replace(channel, source=LAST, index=len(last) - 1)
        added.append(replace(channel, scale=scale, place=f"sensor.observes.{name}"))
    return (*plain_channels(species, known), *added), tuple(last)


def recorded_channels(species: SpeciesConfig, known: Channels) -> tuple[Channel, ...]:
    """Channels that a rule receives besides inputs of the reward, genes and memory, in order.

    Each store other than energy appears twice, at the start of the step and now; the results of neighbor queries
    follow.
    """
    stores = [known[source, i + 1] for i in range(len(species.store)) for source in ("store_before", "store")]
    queried = (each for each in known.values() if each.source in QUERIED)
    return (*(known[each] for each in RECORDED), *stores, *queried)
