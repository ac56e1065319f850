"""The schema of every table of a run, used by the writer, the reader and the documentation.

Columns that depend on settings are generated: `eaten_<kind>`, `w_<kind>` and so on for each food
kind, in the order of the config, and `neutral_<i>` for each neutral gene.
"""

from collections import Counter
from dataclasses import dataclass

from hedon.config.config import Config
from hedon.config.layout import EXTRA, SECOND_GENES, SET_POINT, layouts, store_columns
from hedon.config.schema.evolution import FAMILY_GENES, LEARNING_GENES
from hedon.config.type import diet
from hedon.record.column import Column, Table
from hedon.record.error import RecordError

FORMAT_VERSION = 1  # of the run folder; increased if older readers would misread newer folders

WORLD = Column("world", "i32", "1", "index of the world in the run")
SEED = Column("seed", "i64", "1", "seed of the world")


@dataclass(frozen=True)
class Columns:
    """The properties of a run that determine the columns of its tables.

    Attributes:
        food_kinds: Names of the food kinds, in the order of the config.
        neutral_count: Number of neutral genes.
        species: Names of the species, in the order of the config.
        rewards: Names of the genes that affect the reward, of all species, in order.
        prey: Names of the species that are eaten, by others or by their own kind.
        obstacles: Whether the worlds have obstacles.
        mating: Whether a species has two parents.
        stores: Names of the stores other than energy, of all species.
        levels: Whether agents and frames have a column for each of these stores; false before 1.0.
        causes: Whether agents die of more than age and energy. None if the manifest lacks it; columns of causes
            and of hunts then exist if there are several species.
    """

    food_kinds: tuple[str, ...]
    neutral_count: int
    species: tuple[str, ...] = ("agent",)
    rewards: tuple[str, ...] = ()
    prey: tuple[str, ...] = ()
    obstacles: bool = False
    mating: bool = False
    stores: tuple[str, ...] = ()
    levels: bool = False
    causes: bool | None = None

    @property
    def reward_names(self) -> tuple[str, ...]:
        """Names of the weights; if the run does not name them, one per food kind and that of action."""
        return self.rewards or (*(f"w_{kind}" for kind in self.food_kinds), "w_action")

    @property
    def neutral_names(self) -> tuple[str, ...]:
        """Names of the neutral genes."""
        return tuple(f"neutral_{i + 1}" for i in range(self.neutral_count))

    @property
    def gene_names(self) -> tuple[str, ...]:
        """Names of all genes, in order."""
        return (*self.reward_names, *self.neutral_names)

    @property
    def shown_names(self) -> tuple[str, ...]:
        """Names of the genes shown on a terminal: the weights, and one neutral gene as a control."""
        return (*self.reward_names, *self.neutral_names[:1])

    @property
    def several(self) -> bool:
        """Whether there are several species, so that rows name theirs."""
        return len(self.species) > 1

    @property
    def held_names(self) -> tuple[str, ...]:
        """The stores other than energy for which agents and frames have columns."""
        return self.stores if self.levels else ()

    @property
    def has_causes(self) -> bool:
        """Whether rows have columns for causes of death."""
        return self.several if self.causes is None else self.causes

    @property
    def has_hunts(self) -> bool:
        """Whether rows have columns for hunts."""
        return self.several if self.causes is None else bool(self.prey)


def columns_of(config: Config) -> Columns:
    """The columns of a config's runs."""
    species_layouts = layouts(config)
    rewards = dict.fromkeys(
        gene.name for layout in species_layouts.values() for gene in layout.genes if gene.role != "neutral"
    )
    neutral = max(species.genome.neutral_count for species in config.species.values())
    eaten = {name for species in config.species.values() for name in diet(config, species)}
    prey = tuple(name for name in config.species if name in eaten)
    stores = (store for species in config.species.values() for store in species.stores.values())
    starving = any(store.at_zero == "death" for store in stores)
    return Columns(
        food_kinds=tuple(config.food),
        neutral_count=neutral,
        species=tuple(config.species),
        rewards=tuple(rewards),
        prey=prey,
        obstacles=config.obstacle.count > 0,
        mating=any(species.birth.mating == "pairs" for species in config.species.values()),
        stores=store_columns(config),
        levels=bool(store_columns(config)),
        causes=bool(prey) or starving,
    )


CAUSES = ("age_energy", "starved", "eaten")
"""Causes of death, in the engine's order."""
_CAUSE = Column(
    "cause", "string", "", "why it died: " + ", ".join(CAUSES) + "; missing while it lives", True, choices=CAUSES
)
_STARVING = (Column("deaths_starved", "i32", "1", "deaths by starvation in the interval"),)
_HUNTING = (
    Column("deaths_eaten", "i32", "1", "agents of the species that were eaten in the interval"),
    Column("energy_hunted", "f64", "energy", "gained by eating agents in the interval"),
    Column("energy_prey", "f64", "energy", "held by those that were eaten in the interval; part of energy_lost"),
)
_MATE = Column("mate_id", "i64", "1", "agent_id of the second parent; missing for founders", nullable=True)
_HARM = (
    Column("obstacles_touched", "i64", "1", "harmful obstacles touched, summed over agents and steps of the interval"),
    Column("energy_damage", "f64", "energy", "charged for touching them in the interval"),
)


def agent_table(columns: Columns) -> Table:
    """Schema with one row per agent: the dead in the parts, those alive at the last flush in `living.parquet`."""
    return _table(
        "agents",
        "one agent; living agents have no death_step",
        WORLD,
        SEED,
        *_species_columns(columns),
        Column("agent_id", "i64", "1", "unique within the world, never used again"),
        Column("parent_id", "i64", "1", "agent_id of the parent; missing for founders", nullable=True),
        *([_MATE] if columns.mating else []),
        Column("generation", "i32", "1", "generations since the founders; 0 for founders"),
        Column("birth_step", "i64", "step", "steps completed when the agent was born; 0 for founders"),
        Column("death_step", "i64", "step", "steps completed when it died; missing while it lives", nullable=True),
        *([_CAUSE] if columns.has_causes else []),
        Column("birth_energy", "f32", "energy", "energy at birth"),
        Column("energy", "f32", "energy", "energy at death, or at the last flush"),
        *(_held_column(name, f"{name} at death, or at the last flush", columns) for name in columns.held_names),
        *(Column(f"eaten_{kind}", "i32", "1", f"pieces of food of kind {kind} eaten") for kind in columns.food_kinds),
        *(Column(f"eaten_{name}", "i32", "1", f"agents of the species {name} eaten") for name in columns.prey),
        Column("energy_gained", "f32", "energy", "energy of all food eaten; poison counts negative"),
        Column("energy_spent", "f32", "energy", "energy charged for living, for action and by obstacles"),
        Column("children", "i32", "1", "children born"),
        Column("distance", "f32", "u", "length of the path traveled"),
        Column("mean_force_left", "f32", "u·mass/s²", "mean force of the left motor over its life"),
        Column("mean_force_right", "f32", "u·mass/s²", "mean force of the right motor over its life"),
        Column("reward_sum", "f32", "1", "sum of all rewards received"),
        *(_gene_column(name, columns) for name in columns.gene_names),
    )


def _population_table(columns: Columns) -> Table:
    """Schema with one row per world and interval: state at its end, and counts and energy ledger over it."""
    return _table(
        "population",
        "one species of one world over one interval of steps"
        if columns.several
        else "one world over one interval of steps",
        WORLD,
        SEED,
        *_species_columns(columns),
        Column("step", "i64", "step", "end of the interval"),
        Column("steps", "i32", "step", "length of the interval"),
        Column("alive", "i32", "1", "agents alive at the end"),
        Column("agent_steps", "i64", "agent·step", "agents alive, summed over the steps of the interval"),
        Column("births", "i32", "1", "births in the interval"),
        Column("deaths", "i32", "1", "deaths in the interval"),
        Column("births_failed_full", "i32", "1", "births that failed because the world was at capacity"),
        Column("births_failed_space", "i32", "1", "births that failed because none of the tried places was free"),
        *_spread("energy", "energy", "of the living at the end"),
        *_spread("age", "step", "of the living at the end"),
        Column("generation_mean", "f32", "1", "mean generation of the living at the end", nullable=True),
        Column("generation_max", "i32", "1", "largest generation of the living at the end", nullable=True),
        *(
            Column(f"{name}_{statistic}", "f32", "1", f"{word} of {name} among the living at the end", True)
            for name in columns.gene_names
            for statistic, word in (("mean", "mean"), ("sd", "standard deviation"))
        ),
        *(
            Column(f"food_{kind}", "i32", "1", f"pieces of food of kind {kind} present at the end")
            for kind in columns.food_kinds
        ),
        *(
            Column(f"eaten_{kind}", "i32", "1", f"pieces of food of kind {kind} eaten in the interval")
            for kind in columns.food_kinds
        ),
        *(
            Column(f"eaten_{name}", "i32", "1", f"agents of the species {name} eaten in the interval")
            for name in columns.prey
        ),
        *(_STARVING if columns.has_causes else []),
        *(_HUNTING if columns.has_hunts else []),
        *(_HARM if columns.obstacles else []),
        Column("learners", "i32", "1", "agents that learned at the end of a window in the interval"),
        Column("energy_eaten", "f64", "energy", "gained from food in the interval; poison counts negative"),
        Column("energy_basic", "f64", "energy", "charged for living in the interval"),
        Column("energy_action", "f64", "energy", "charged for action in the interval"),
        Column("energy_forgiven", "f64", "energy", "charged but not paid, because energy cannot fall below 0"),
        Column("energy_capped", "f64", "energy", "eaten but lost, because energy cannot rise above the capacity"),
        Column("energy_lost", "f64", "energy", "held by those who died in the interval"),
        Column("energy_shared", "f64", "energy", "given by parents to children in the interval"),
        Column("energy_total", "f64", "energy", "held by the living at the end"),
        *(
            Column(f"{name}_mean", "f32", "amount", f"mean {name} of the living at the end", True)
            for name in columns.stores
        ),
    )


def _frame_table(columns: Columns) -> Table:
    """Schema with one row per agent or food in each frame; written only if frames are recorded."""
    kinds = (*columns.species, *columns.food_kinds)
    return _table(
        "frames",
        "one agent or one food in one frame",
        WORLD,
        Column("step", "i64", "step", "steps completed when the frame was taken"),
        Column("kind", "string", "", "the name of the species, or of the food kind", choices=kinds),
        Column("id", "i64", "1", "agent_id; missing for food", nullable=True, missing_for=columns.food_kinds),
        Column("x", "f32", "u", "position of the center"),
        Column("y", "f32", "u", "position of the center"),
        Column(
            "angle",
            "f32",
            "rad",
            "heading, 0 along +y, counter-clockwise; missing for food",
            nullable=True,
            missing_for=columns.food_kinds,
        ),
        Column("energy", "f32", "energy", "energy; missing for food", nullable=True, missing_for=columns.food_kinds),
        *(
            Column(name, "f32", "amount", f"{name}; missing for food, and for species without it", nullable=True)
            for name in columns.held_names
        ),
    )


def run_tables(columns: Columns) -> dict[str, Table]:
    """All tables of a run by name: agents, population and frames."""
    tables = (
        agent_table(columns),
        _population_table(columns),
        _frame_table(columns),
    )
    return {table.name: table for table in tables}


def _species_columns(columns: Columns) -> list[Column]:
    name = Column("species", "string", "", "name of the species", choices=columns.species)
    return [name] if columns.several else []


def _held_column(name: str, meaning: str, columns: Columns) -> Column:
    missing_note = "; missing for species without it" if columns.several else ""
    return Column(name, "f32", "amount", meaning + missing_note, nullable=columns.several)


def _gene_column(name: str, columns: Columns) -> Column:
    return Column(name, "f32", "1", _gene_meaning(name, columns), nullable=columns.several)


def _gene_meaning(name: str, columns: Columns) -> str:
    channel = name.removeprefix("w_")
    if name in columns.neutral_names:
        return "neutral gene: inherited and mutated, no effect on the reward"
    if name == "w_action":
        return "reward weight for motor action"
    if channel in columns.food_kinds:
        return f"reward weight for a food of kind {channel}"
    if channel in columns.prey:
        return f"reward weight for eating a {channel}"
    for suffix, meaning in SECOND_GENES.items():
        if channel.endswith(suffix):
            return f"{meaning}, beside {name.removesuffix(suffix)}"
    if name == SET_POINT:
        return "energy that is sought, as a share of the capacity"
    if name.startswith(EXTRA):
        return f"gene {name.removeprefix(EXTRA)}, which only rules in Python read"
    if name.startswith("g_"):
        number = name.removeprefix("g_")
        return (LEARNING_GENES | FAMILY_GENES).get(number, f"power of ten by which {number} differs")
    sense, _, target = channel.partition("_")
    verb = {"see": "seeing ", "smell": "smelling "}.get(sense, "")
    return f"reward weight for {verb}{target if verb else channel}"


def _spread(quantity: str, unit: str, owner: str) -> tuple[Column, ...]:
    statistics = {"mean": "mean", "sd": "standard deviation", "min": "minimum", "q25": "lower quartile"}
    statistics |= {"median": "median", "q75": "upper quartile", "max": "maximum"}
    return tuple(
        Column(f"{quantity}_{name}", "f32", unit, f"{statistic} of {quantity} {owner}", nullable=True)
        for name, statistic in statistics.items()
    )


def _table(name: str, row: str, *columns: Column) -> Table:
    counts = Counter(column.name for column in columns)
    duplicates = [column for column, count in counts.items() if count > 1]
    if duplicates:
        raise RecordError(
            f"table {name}: the food kinds make the column {duplicates[0]} appear twice; rename the food kind"
        )
    return Table(name, row, columns)
