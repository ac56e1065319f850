"""The command `hedon demography`."""

from hedon.cli.config import Fidelity, Overrides, Source
from hedon.cli.console import make_console


def demography(source: Source, fidelity: Fidelity = None, overrides: Overrides = None) -> None:
    """Say before a run whether a setting can live, can die, and what will limit it.

    Prints the length of life and the number of children at constant energy, the energy that is needed and that
    grows, the chance that a newborn finds a place, and warnings. Computed from the settings in seconds.

    \b
    Examples:
      hedon demography baseline
      hedon demography baseline --set food.normal.growth_rate=1.0 --set hazard.kappa=0.02
      hedon demography my.toml --fidelity text
    """
    from hedon.analysis.forecast import forecast
    from hedon.analysis.forecast_table import forecast_group
    from hedon.config import load_config

    config = load_config(source, fidelity, overrides or ())
    make_console().print(forecast_group(config, forecast(config)))
