"""Converts a config to the engine's input: the same paths of settings, with layouts in place of names."""

from collections.abc import Iterator
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

from hedon.config.channel import Channel, season_place
from hedon.config.config import Config, validated
from hedon.config.expression import engine_name, gene_column, kind_of
from hedon.config.field import engine_sections, engine_settings, leaves, settings
from hedon.config.layout import Gene, layout_of, set_point_of
from hedon.config.schema.arena import outer_count, walls
from hedon.config.schema.evolution import FAMILY_GENES, OF_ALL_GENES, GeneConfig
from hedon.config.schema.life import distance_sd
from hedon.config.schema.species import RULE_USES, SpeciesConfig
from hedon.config.type import asked_for, diet, look, types

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


@dataclass(frozen=True, slots=True)
class EngineInput:
    """A checked config with the engine's input made from it.

    Attributes:
        config: The checked config.
        settings: Values for the engine's structs.
        walls: Segments, (count, 4) float32, outer polygon first [u].
        outer_walls: Number of walls in the outer polygon.
    """

    config: Config
    settings: dict[str, Any]
    walls: "NDArray[np.float32]"
    outer_walls: int


def engine_input(config: Config) -> EngineInput:
    """Checks a config from any source, and converts it to the engine's input.

    The walls are computed in the caller's rounding mode: see `FloatMode` of the engine.

    Raises:
        ConfigError: A setting is wrong.
        ArgumentError: The argument is not a `Config`.
    """
    config = validated(config)
    return EngineInput(config, engine_config(config), walls(config.arena), outer_count(config.arena))


def engine_config(config: Config) -> dict[str, Any]:
    """Nested dict that fills the engine's structs."""

    values = {path: value for path, _, value in leaves(config)}

    def filled(value: Any) -> Any:
        if isinstance(value, _Path):
            return int(values[value]) if isinstance(values[value], bool) else values[value]
        if isinstance(value, dict):
            return {name: filled(item) for name, item in value.items()}
        return [filled(item) for item in value] if isinstance(value, list) else value

    return filled(_tree(config))


def engine_paths(config: Config) -> dict[str, list[str]]:
    """The engine's paths, such as `species[0].energy.initial`, for each path of a setting."""
    paths: dict[str, list[str]] = {}
    for path, value in flat(_tree(config)):
        if isinstance(value, _Path):
            paths.setdefault(value, []).append(path)
    return paths


def flat(value: Any, path: str = "") -> Iterator[tuple[str, Any]]:
    """Flattens nested dicts and lists to values by path, such as `food[0].energy`."""
    if isinstance(value, dict):
        for name, item in value.items():
            yield from flat(item, f"{path}.{name}" if path else name)
    elif isinstance(value, list | tuple):
        for i, item in enumerate(value):
            yield from flat(item, f"{path}[{i}]")
    else:
        yield path, value


class _Path(str):
    """Placeholder in the engine's input for the value of the setting with this path."""

    __slots__ = ()


def _tree(config: Config) -> dict[str, Any]:
    """The engine's input with paths of settings in place of values."""
    return _section(config, "") | {"layout": [_layout(config, name) for name in config.species]}


def _section(section: Any, path: str) -> dict[str, Any]:
    tree: dict[str, Any] = {name: _Path(path + name) for name in engine_settings(type(section))}
    for name, inner in engine_sections(type(section)).items():
        content, place = getattr(section, name), f"{path}{name}."
        if inner.names:
            values_by_name = {key: content.get(key) for key in inner.names}
            tree[name] = {
                key: asdict(inner.type()) if value is None else _section(value, f"{place}{key}.")
                for key, value in values_by_name.items()
            }
        elif inner.repeated:
            tree[name] = [_section(value, f"{place}{key}.") for key, value in content.items()]
        else:
            tree[name] = _section(content, place)
    return tree


def _layout(config: Config, name: str) -> dict[str, Any]:
    """Engine input derived from a species' names, and from lengths and forces in other units."""
    species, path = config.species[name], f"species.{name}."
    layout = layout_of(config, species)
    eaten, motor = diet(config, species), species.motor
    number = {name: i for i, name in enumerate(types(config))}
    gene = {name: i for i, name in enumerate(layout.gene_names)}
    force: dict[str, Any] = {
        limit: _Path(f"{path}motor.{limit}") if motor.force_scale == 1.0 else motor.force_scale * getattr(motor, limit)
        for limit in ("min_force", "max_force")
    }
    return force | {
        "distance_sd": distance_sd(config.arena, species.birth),
        "sees": [number[each] for each in layout.sees],
        "looks": [number[look(config, each)] for each in types(config)],
        "touches": [number[each] for each in layout.touches],
        "smells": [number[each] for each in layout.smells],
        "eats_food": [eaten.get(each, 0.0) for each in config.food],
        "eats_species": [eaten.get(each, 0.0) for each in config.species],
        "gives": _of_stores(config, "gives", layout.stores),
        "needs": _of_stores(config, "needs", layout.stores),
        "rules": [int(bool(getattr(species, use).rule)) for use in RULE_USES],
        "genes": [_gene(species, path, each) for each in layout.genes],
        "learning": [{"sets": each, "gene": gene[f"g_{each}"]} for each in species.genome.learning],
        "sets": [
            {
                "sets": engine_name(kind_of(place)),
                "store": layout.stores.index(place.split(".")[-2]) if kind_of(place) != place else 0,
                "gene": gene[gene_column(place)],
            }
            for place in species.genome.set
        ],
        "family": [gene.get(f"g_{each}", -1) for each in FAMILY_GENES],
        "set_points": [gene.get(set_point_of(state), -1) for state in layout.stores],
        "terms": [
            {
                "channel": _channel(path, term.channel),
                "gene": gene.get(term.gene, -1),
                "second_gene": gene.get(term.second_gene, -1),
                "coef": _Path(path + term.place),
            }
            for term in layout.terms
        ],
        "observed": [_channel(path, each) for each in layout.observed],
        "last": [_channel(path, each) for each in layout.last],
        "recorded": [_channel(path, each) for each in layout.recorded],
        "gate": _channel(path, layout.gate),
        "season_period": _season(config, path, species),
        "neighbors": [
            {
                "types": sum(1 << number[each] for each in asked_for(config, query.of)),
                "range": _Path(f"{path}neighbor.{query_name}.range"),
            }
            for query_name, query in species.neighbor.items()
        ],
    }


def _season(config: Config, path: str, species: SpeciesConfig) -> Any:
    place = season_place(config, species)
    return _Path(place if place.startswith(("food.", "obstacle.")) else path + place) if place else 0


def _channel(path: str, channel: Channel) -> dict[str, Any]:
    scale = _Path(path + channel.place) if channel.place else channel.scale
    return {"source": channel.source, "index": channel.index, "scale": scale}


def _of_stores(config: Config, field: str, stores: tuple[str, ...]) -> list[Any]:
    """Amounts that each kind of food gives or needs, by kind, then by store."""
    tables = {kind: getattr(food, field) for kind, food in config.food.items()}
    return [
        _Path(f"food.{kind}.{field}.{name}") if name in table else 0.0
        for kind, table in tables.items()
        for name in stores
    ]


def _gene(species: SpeciesConfig, path: str, gene: Gene) -> dict[str, Any]:
    law = gene.place if gene.place.startswith("food.") else path + gene.place
    mutation_path = f"{path}genome.mutation.{gene.name}." if gene.name in species.genome.mutation else ""
    return {
        "law": {name: _Path(f"{law}.{name}") for name in settings(GeneConfig)},
        "mutation": {
            name: _Path(mutation_path + name if mutation_path else f"{path}genome.{OF_ALL_GENES[name]}")
            for name in OF_ALL_GENES
        },
        "most": gene.most,
    }
