"""The command `hedon demography`."""

from hedon.cli.config import Fidelity, Overrides, Source
from hedon.cli.console import make_console


def demography(source: Source, fidelity: Fidelity = None, overrides: Overrides = None) -> None:
    """Predict, before a run, whether a population can grow, can die out, and what limits it.

    Prints the length of life and the number of children at constant energy, the energy that agents need and that
    food supplies, the probability that a newborn finds a free place, and warnings. Computed from the settings alone;
    takes seconds.

    \b
    Examples:
      hedon demography baseline
      hedon demography baseline --set food.normal.growth_rate=1.0 --set hazard.kappa=0.02
      hedon demography my.toml --fidelity text
    """
    from hedon.cli.display.forecast import forecast_group
    from hedon.config import load_config
    from hedon.demography.forecast import forecast

    config = load_config(source, fidelity, overrides or ())
    make_console().print(forecast_group(config, forecast(config)))
