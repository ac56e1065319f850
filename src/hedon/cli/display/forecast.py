"""A forecast for the terminal and for reports."""

import math

from rich.console import Group
from rich.text import Text

from hedon.analysis.result import ResultTable, make_table
from hedon.cli.display.analysis import analysis_group
from hedon.config import Config
from hedon.demography.forecast import Forecast


def _forecast_tables(config: Config, species: str, found: Forecast) -> dict[str, ResultTable]:
    """The tables of a forecast, by name."""
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
    fed = "no limit" if math.isinf(found.fed) else f"{found.fed:,.0f} agents"
    food = "it eats no food" if math.isnan(found.fed) else f"{found.supply:g} grow per step: enough for {fed}"
    cost = config.species[species].energy.basic_cost
    note = (
        f"A fresh policy pays {found.need:.2e} per step ({cost:g} for living, the rest for a mean "
        f"force of {found.force:.1f}); {food}. R0 counts the children tried; "
        "refusals are births without a place. Room allows as many agents as leave R0 at 1."
    )
    room = [{"agents in the arena": place.alive, "births that find a place": place.success} for place in found.room]
    sampled = "Sampled, with agents and foods thrown at random. In a run agents gather, and fewer places are free."
    return {
        "life": make_table("life", f"{config.name} ({config.fidelity}): life at constant energy", levels, note),
        "room": make_table("room", "Room for newborns", room, sampled),
    }


def forecast_group(config: Config, species: str, found: Forecast) -> Group:
    """What `hedon forecast` prints.

    Args:
        config: With the settings of the population.
        species: Whose.
        found: What they predict.
    """
    warnings = [Text.assemble(("! ", "bold"), text) for text in found.warnings]
    return Group(analysis_group(_forecast_tables(config, species, found)), *warnings)
