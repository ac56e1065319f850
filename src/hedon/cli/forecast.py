"""The command `hedon forecast`."""

from typing import Annotated

import typer

from hedon.cli.config import Fidelity, Overrides, Source
from hedon.cli.console import make_console
from hedon.cli.run import DEFAULT_STEPS
from hedon.experiment.argument import MAX_STEPS


def forecast(
    source: Source,
    species: Annotated[
        str | None, typer.Option(help="The species, if there are several; by default the first.")
    ] = None,
    steps: Annotated[
        int, typer.Option(help="Steps of the run that you plan, for its number of generations.", min=1, max=MAX_STEPS)
    ] = DEFAULT_STEPS,
    fidelity: Fidelity = None,
    overrides: Overrides = None,
) -> None:
    """Predict, before a run, whether a population can grow, can die out, and what limits it.

    Prints the length of life and the number of children at constant energy, the energy that agents need and that
    food supplies, the probability that a newborn finds a free place, how much of each food agents eat before they
    have learned, the number of generations in a run, and warnings. Uses only the settings; takes seconds.

    \b
    Examples:
      hedon forecast baseline
      hedon forecast baseline --set food.normal.growth_rate=1.0 --set hazard.kappa=0.02
      hedon forecast predator --species predator
      hedon forecast my.toml --fidelity as_printed --steps 1024000
    """
    from hedon.cli.display.forecast import forecast_group
    from hedon.config import load_config
    from hedon.config.layout import choose_species
    from hedon.demography.forecast import forecast as predict

    config = load_config(source, fidelity, overrides or ())
    species = choose_species(species, config)
    make_console().print(forecast_group(config, species, predict(config, species), steps))
