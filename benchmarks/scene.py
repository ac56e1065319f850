"""A world after some time; every part takes its agents, foods, networks and rollouts from it."""

from dataclasses import dataclass, fields
from functools import cache

import numpy as np
from numpy.typing import NDArray

from benchmarks.check import check_world
from benchmarks.plan import Plan
from hedon.experiment.simulation import Simulation
from hedon.experiment.world import World

WARM_UP_WINDOWS = 20
"""After these, the baseline has grown from its 50 founders to about 150 agents."""


@dataclass(frozen=True, slots=True, eq=False)
class Scene:
    """Agents and foods of a world, without their history.

    Attributes:
        x, y: Places of the agents [u].
        angle: Their headings [rad].
        energy: Their energies.
        species: Their species, as indices in the order of the config.
        food_x, food_y: Places of the foods [u].
        food_kind: Their kinds.
    """

    x: NDArray[np.float32]
    y: NDArray[np.float32]
    angle: NDArray[np.float32]
    energy: NDArray[np.float32]
    species: NDArray[np.int32]
    food_x: NDArray[np.float32]
    food_y: NDArray[np.float32]
    food_kind: NDArray[np.int32]

    def put_into(self, simulation: Simulation) -> None:
        """Empties every world and puts these agents and foods into it, with new networks from the world's seed."""
        for world in simulation.worlds:
            simulation.engine.set_scene(world.index, *(getattr(self, field.name) for field in fields(self)))

    def tiled(self, across: int, up: int, width: float, height: float) -> "Scene":
        """Copies side by side: `across` along x and `up` along y, each shifted by the size of an arena [u]."""
        copies = across * up
        shift_x = np.tile(np.arange(across, dtype=np.float32) * np.float32(width), up)
        shift_y = np.repeat(np.arange(up, dtype=np.float32) * np.float32(height), across)

        def moved(places: NDArray[np.float32], shift: NDArray[np.float32]) -> NDArray[np.float32]:
            return (shift[:, None] + places[None, :]).ravel()

        return Scene(
            moved(self.x, shift_x),
            moved(self.y, shift_y),
            np.tile(self.angle, copies),
            np.tile(self.energy, copies),
            np.tile(self.species, copies),
            moved(self.food_x, shift_x),
            moved(self.food_y, shift_y),
            np.tile(self.food_kind, copies),
        )


def scene_of(world: World) -> Scene:
    """The agents and foods of a world as they are now."""
    agents, foods = world.agents(), world.foods()
    single = {name: agents[name].astype(np.float32) for name in ("x", "y", "angle", "energy")}
    return Scene(**single, species=agents["species"], food_x=foods["x"], food_y=foods["y"], food_kind=foods["kind"])


def peopled(plan: Plan) -> World:
    """The populated world: the plan's config with seed 1 after the warm-up, at the end of a window; computed once."""
    return _source(plan).worlds[0]


def go_on_from_peopled(plan: Plan, simulation: Simulation) -> None:
    """Replaces every world of a simulation of the plan's config by the populated world, including networks."""
    saved = _source(plan).engine.save(0)
    for world in simulation.worlds:
        simulation.engine.restore(world.index, saved)


@cache
def _source(plan: Plan) -> Simulation:
    config = plan.config()
    simulation = Simulation(config, [1], plan.threads[-1], plan.kernel)
    simulation.run((2 if plan.quick else WARM_UP_WINDOWS) * config.world.rollout_steps)
    check_world(simulation.worlds[0])
    return simulation
