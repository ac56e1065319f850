"""Makes rows of the records, and the data for the picture of the end, from a world."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from hedon.config.arena import walls
from hedon.experiment.simulation import World
from hedon.record.checkpoint import Sampled
from hedon.record.schema import weight_names
from hedon.record.snapshot import Snapshot

Rows = dict[str, Any]

COUNTED = ("agent_steps", "births", "deaths", "births_failed_full", "births_failed_space", "learners")
LEDGER = (
    "energy_eaten",
    "energy_basic",
    "energy_action",
    "energy_forgiven",
    "energy_capped",
    "energy_lost",
    "energy_shared",
)


def agent_rows(world: World, lives: dict[str, NDArray[Any]]) -> Rows:
    """Rows of the table `agents` from the engine's rows (`take_rows`, `living_rows`)."""
    kinds = tuple(world.config.food)
    end = np.where(lives["death_step"] < 0, world.step, lives["death_step"])
    steps = np.maximum(end - lives["birth_step"], 1)
    direct = ("agent_id", "parent_id", "generation", "birth_step", "death_step", "birth_energy", "energy")
    direct += ("energy_gained", "energy_spent", "children", "distance")
    return {
        "world": world.index,
        "seed": world.seed,
        **{name: lives[name] for name in direct},
        **{f"eaten_{kind}": lives["eaten"][:, k] for k, kind in enumerate(kinds)},
        "mean_force_left": lives["force_left"] / steps,
        "mean_force_right": lives["force_right"] / steps,
        "reward_sum": lives["reward"],
        **{name: lives["genome"][:, g] for g, name in enumerate(_genes(world))},
    }


class PopulationSampler:
    """Makes rows of the table `population` of one world: its state now, and counts since the last row.

    Args:
        world: The world.
        since: What the next row counts from; None for the world's present state.
    """

    def __init__(self, world: World, since: Sampled | None = None) -> None:
        self.world = world
        self.since = since or self._now()

    def advance(self) -> None:
        """Makes the next row count from now."""
        self.since = self._now()

    def row(self) -> Rows:
        """The row of the interval that ends now."""
        world, since = self.world, self.since
        lives = world.agents()
        now = self._now()
        present = world.view("food_stock.present")
        row: Rows = {
            "world": world.index,
            "seed": world.seed,
            "step": world.step,
            "steps": world.step - since.step,
        }
        row["alive"] = world.alive
        row |= {name: now.counters[name] - since.counters[name] for name in (*COUNTED, *LEDGER)}
        row |= _spread("energy", lives["energy"]) | _spread("age", lives["age"])
        generation = lives["generation"]
        row["generation_mean"] = generation.mean() if len(generation) else np.nan
        row["generation_max"] = generation.max() if len(generation) else -1
        for g, name in enumerate(_genes(world)):
            weight = lives["genome"][:, g]
            row[f"{name}_mean"] = weight.mean() if len(weight) else np.nan
            row[f"{name}_sd"] = weight.std() if len(weight) else np.nan
        for k, kind in enumerate(world.config.food):
            row[f"food_{kind}"] = int(present[k])
            row[f"eaten_{kind}"] = now.eaten[k] - since.eaten[k]
        row["energy_total"] = lives["energy"].sum()
        return row

    def _now(self) -> Sampled:
        world = self.world
        return Sampled(world.step, world.counters, tuple(world.view("food_stock.eaten").tolist()))


def frame_rows(world: World) -> list[Rows]:
    """Rows of the table `frames`: every agent and every food of a world as it is now."""
    lives, foods = world.agents(), world.foods()
    here = {"world": world.index, "step": world.step}
    agents = {name: lives[name] for name in ("x", "y", "angle", "energy")}
    rows = [{**here, "kind": "agent", "id": lives["agent_id"], **agents}]
    for k, kind in enumerate(world.config.food):
        mine = foods["kind"] == k
        rows.append({**here, "kind": kind, "x": foods["x"][mine], "y": foods["y"][mine]})
    return rows


def snapshot(world: World) -> Snapshot:
    """The present state of a world, for a picture."""
    lives, foods, config = world.agents(), world.foods(), world.config
    return Snapshot(
        world=world.index,
        seed=world.seed,
        step=world.step,
        **{name: lives[name] for name in ("agent_id", "x", "y", "angle", "energy")},
        rays=world.rays(),
        food_kind=foods["kind"],
        food_x=foods["x"],
        food_y=foods["y"],
        walls=walls(config.arena),
        food_kinds=tuple(config.food),
        radius=config.body.radius,
        food_radius=config.body.food_radius,
        ray_length=config.sensor.ray_length,
        ray_spread=config.sensor.ray_spread,
        mouth_spread=config.sensor.mouth_spread,
        energy_capacity=config.energy.capacity,
    )


def _genes(world: World) -> tuple[str, ...]:
    return weight_names(tuple(world.config.food), world.config.genome.neutral_count)


def _spread(name: str, values: NDArray[Any]) -> Rows:
    statistics = ("mean", "sd", "min", "q25", "median", "q75", "max")
    if len(values) == 0:
        return {f"{name}_{statistic}": np.nan for statistic in statistics}
    numbers = (values.mean(), values.std(), *np.quantile(values, (0.0, 0.25, 0.5, 0.75, 1.0)))
    return {f"{name}_{statistic}": number for statistic, number in zip(statistics, numbers, strict=True)}
