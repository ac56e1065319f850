"""Study how reward systems evolve: agents that live, learn, breed and die in a continuous world.

Example:
    >>> import hedon
    >>> config = hedon.load_config("baseline", overrides=["population.capacity=100"])
    >>> simulation = hedon.Simulation(config, seeds=[1])
    >>> simulation.run(1024)
    >>> simulation.worlds[0].alive
"""

from importlib.metadata import version

from lazy_loader import attach_stub

from hedon.registration import register_presets

# Imported on first use, because `hedon --help` must not wait for the engine and the table library.
__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)

__version__ = version("hedon")

register_presets()
