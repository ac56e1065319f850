"""A forecast for the terminal and for reports."""

import math

from rich.console import Group
from rich.text import Text

from hedon.analysis.result import ResultTable, make_table
from hedon.cli.display.analysis import analysis_group
from hedon.config import Config
from hedon.demography.forecast import Forecast
from hedon.demography.intake import FACTOR, FORECAST_STEPS
from hedon.text import count

_FEEDING = {
    "unlearned": "they never learn",
    "all": "they eat all that grows, in equal shares",
    "full": "those who have children are always full",
}


def _forecast_tables(config: Config, species: str, found: Forecast, steps: int) -> dict[str, ResultTable]:
    """Tables of a forecast, by name."""
    levels = [
        {
            "energy": level.energy,
            "mean life [step]": level.lifetime,
            "R0": level.r0,
            "refusals it can bear": level.refusal,
            "agents that room allows": level.population,
        }
        for level in found.levels
    ]
    fed = "no limit" if math.isinf(found.fed) else count(round(found.fed), "agent")
    food = "it eats no food" if math.isnan(found.fed) else f"{found.supply:g} foods grow per step, enough for {fed}"
    cost = config.species[species].energy.basic_cost
    note = (
        f"A fresh policy pays {found.need:.2e} per step ({cost:g} for living, the rest for a mean "
        f"force of {found.force:.1f}); {food}. R0 is the number of children that an agent tries to have; refusals are "
        "births without a place. Room allows as many agents as leave R0 at 1."
    )
    room = [{"agents in the arena": place.alive, "births that find a place": place.success} for place in found.room]
    sampled = "Sampled, with agents and foods thrown at random. In a run agents gather, and fewer places are free."
    tables = {
        "life": make_table("life", f"{config.name} ({config.fidelity}): life at constant energy", levels, note),
        "room": make_table("room", "Room for newborns", room, sampled),
    }
    if found.intake:
        tables["intake"] = _intake_table(found)
    if found.equilibria:
        tables["generation"] = _generation_table(found, steps)
    return tables


def _intake_table(found: Forecast) -> ResultTable:
    rows = [
        {
            "food": each.kind,
            "places": each.places,
            "grows per step": each.growth,
            "eaten per step": each.eaten,
            "at least": each.low,
            "at most": each.high,
            "present": each.present,
        }
        for each in found.intake
    ]
    note = (
        f"Means over the first {FORECAST_STEPS:,} steps, in which agents hardly learn: foods that fit where their kind "
        "grows, and how often random motion comes upon them. In 19 of 20 settings the mean over worlds lies within a "
        f"factor of {FACTOR:g}; single worlds that eat few foods scatter more. Agents that have learned eat more, at "
        "most what grows. Left out: contacts between agents, and obstacles."
    )
    return make_table("intake", f"What is eaten in the first {FORECAST_STEPS:,} steps", rows, note)


def _generation_table(found: Forecast, steps: int) -> ResultTable:
    rows = [
        {
            "if": _FEEDING[each.feeding],
            "alive": each.alive,
            "energy": each.energy,
            "mean life [step]": each.lifetime,
            "generation [step]": each.generation,
            "generations": steps / each.generation,
        }
        for each in found.equilibria
    ]
    note = (
        "Where births and deaths balance. A generation is the mean age of a parent when a child is born. In a run some "
        "agents eat far more than others, live longer and have most of the children: its generations are longer than "
        "those of equal shares, and at most those of parents that are always full."
    )
    return make_table("generation", f"Generations in {steps:,} steps", rows, note)


def forecast_group(config: Config, species: str, found: Forecast, steps: int) -> Group:
    """Output of `hedon forecast`.

    Args:
        config: Settings of the world.
        species: Name of the species.
        found: The forecast.
        steps: Length of the planned run [step].
    """
    warnings = [Text.assemble(("! ", "bold"), text) for text in found.warnings]
    return Group(analysis_group(_forecast_tables(config, species, found, steps)), *warnings)
