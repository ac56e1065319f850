"""Creates realistic runs without an engine: births, deaths, drift, and a balanced ledger."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from hedon.record.manifest import Manifest
from hedon.record.schema import Columns
from hedon.record.snapshot import Snapshot, save_snapshot
from hedon.record.writer import Writer

Rows = dict[str, np.ndarray]

INTERVAL = 1024
STATISTICS = {
    "mean": np.mean,
    "sd": np.std,
    "min": np.min,
    "q25": lambda v: np.quantile(v, 0.25),
    "median": np.median,
    "q75": lambda v: np.quantile(v, 0.75),
    "max": np.max,
}


@dataclass
class SyntheticWorld:
    """One world: `step()` simulates an interval and returns the rows of the dead and of the population."""

    index: int
    seed: int
    food_kinds: tuple[str, ...] = ("normal",)
    neutral_count: int = 1
    initial_count: int = 50
    capacity: int = 200
    lifetime: float = 6000.0
    birth_factor: float = 1.25
    selection: float = 0.05

    def __post_init__(self) -> None:
        self.rng = np.random.default_rng(self.seed)
        self.names = Columns(self.food_kinds, self.neutral_count).gene_names
        self.now = 0
        self.next_id = 0
        self.living = self._spawn(self.initial_count, 0)
        for name in self.names:
            self.living[name] = self.rng.normal(0, 0.1, self.initial_count).astype(np.float32)

    def step(self) -> tuple[Rows, dict[str, float]]:
        """Simulates one interval."""
        rng, living, before = self.rng, self.living, len(self.living["agent_id"])
        counts: dict[str, float] = {"energy_basic": 1e-3 * INTERVAL * before, "energy_eaten": 0.0}
        counts |= {"energy_action": 1e-3 * INTERVAL * before, "energy_forgiven": 0.0, "energy_capped": 0.0}
        spent = 2e-3 * INTERVAL
        gained = np.zeros(before)
        for i, kind in enumerate(self.food_kinds):
            appetite = np.clip(0.001 * (1 + 0.2 * living[f"w_{kind}"]), 1e-5, 4e-3)
            foods = rng.poisson(INTERVAL * appetite).astype(np.int32)
            living[f"eaten_{kind}"] += foods
            gained += foods * (1.0, 0.2, -0.6)[i % 3]
            counts[f"eaten_{kind}"] = int(foods.sum())
        counts["energy_eaten"] = float(gained.sum())
        after = living["energy"].astype(np.float64) + gained - spent
        counts["energy_forgiven"] = float(-np.minimum(after, 0).sum())
        counts["energy_capped"] = float(np.maximum(after - 400, 0).sum())
        living["energy"] = np.clip(after, 0, 400).astype(np.float32)
        counts["energy_forgiven"] += float((living["energy"] - np.clip(after, 0, 400)).sum())  # rounding
        living["energy_gained"] += gained.astype(np.float32)
        living["energy_spent"] += np.float32(spent)
        living["distance"] += np.float32(0.3 * INTERVAL)
        self.now += INTERVAL
        born = self._give_birth(counts)
        dead = self._die(counts)
        self.living = {name: np.concatenate([self.living[name], born[name]]) for name in self.living}
        return dead, self._row(counts, before)

    def living_rows(self) -> Rows:
        """Rows of the living, without death_step."""
        return {name: values.copy() for name, values in self.living.items()}

    def _give_birth(self, counts: dict[str, float]) -> Rows:
        weights = np.clip(1 + self.selection * self.living["w_" + self.food_kinds[0]], 0.2, 3)
        chance = self.birth_factor * INTERVAL / self.lifetime * weights
        wish = np.flatnonzero(self.rng.random(len(weights)) < chance)
        no_space = self.rng.random(len(wish)) < 0.15
        parents = wish[~no_space][: max(self.capacity - len(weights), 0)]
        counts["births_failed_space"] = int(no_space.sum())
        counts["births_failed_full"] = int((~no_space).sum() - len(parents))
        counts["births"] = len(parents)
        born = self._spawn(len(parents), self.now)
        born["parent_id"] = self.living["agent_id"][parents]
        born["generation"] = self.living["generation"][parents] + np.int32(1)
        share = np.float32(0.4) * self.living["energy"][parents]
        counts["energy_shared"] = float(share.astype(np.float64).sum())
        self.living["energy"][parents] -= share
        self.living["children"][parents] += 1
        born["energy"] = born["birth_energy"] = share
        for name in self.names:
            noise = 0.02 * self.rng.standard_cauchy(len(parents))
            born[name] = np.clip(self.living[name][parents] + noise, -10, 10).astype(np.float32)
        return born

    def _die(self, counts: dict[str, float]) -> Rows:
        gone = self.rng.random(len(self.living["agent_id"])) < INTERVAL / self.lifetime
        dead = {name: values[gone] for name, values in self.living.items()}
        dead["death_step"] = np.full(gone.sum(), self.now)
        self.living = {name: values[~gone] for name, values in self.living.items()}
        counts["deaths"] = int(gone.sum())
        counts["energy_lost"] = float(dead["energy"].astype(np.float64).sum())
        return dead

    def _row(self, counts: dict[str, float], before: int) -> dict[str, float]:
        living, nobody = self.living, len(self.living["agent_id"]) == 0
        row = counts | {"world": self.index, "seed": self.seed, "step": self.now, "steps": INTERVAL}
        row |= {"alive": len(living["agent_id"]), "agent_steps": before * INTERVAL, "learners": before}
        age = (self.now - living["birth_step"]).astype(np.float32)
        for quantity, values in (("energy", living["energy"]), ("age", age)):
            for name, statistic in STATISTICS.items():
                row[f"{quantity}_{name}"] = np.nan if nobody else float(statistic(values))
        row["generation_mean"] = np.nan if nobody else float(np.mean(living["generation"]))
        row["generation_max"] = -1 if nobody else int(np.max(living["generation"]))
        for name in self.names:
            row[f"{name}_mean"] = np.nan if nobody else float(np.mean(living[name]))
            row[f"{name}_sd"] = np.nan if nobody else float(np.std(living[name]))
        for kind in self.food_kinds:
            row[f"food_{kind}"] = int(self.rng.integers(5, 40))
        row["energy_total"] = float(living["energy"].astype(np.float64).sum())
        return row

    def _spawn(self, count: int, step: int) -> Rows:
        ids = np.arange(self.next_id, self.next_id + count)
        self.next_id += count
        rows: Rows = {"agent_id": ids, "parent_id": np.full(count, -1), "birth_step": np.full(count, step)}
        rows |= {"world": np.full(count, self.index, np.int32), "seed": np.full(count, self.seed)}
        for name in ("generation", "children", *(f"eaten_{kind}" for kind in self.food_kinds)):
            rows[name] = np.zeros(count, np.int32)
        for name in ("energy_gained", "energy_spent", "distance", "reward_sum"):
            rows[name] = np.zeros(count, np.float32)
        for name in ("birth_energy", "energy"):
            rows[name] = np.full(count, 40.0, np.float32)
        for name in ("mean_force_left", "mean_force_right"):
            rows[name] = self.rng.uniform(10, 50, count).astype(np.float32)
        for name in self.names:
            rows[name] = np.zeros(count, np.float32)
        return rows


def population_rows(rows: list[dict[str, float]]) -> Rows:
    """Columns from a list of population rows."""
    return {name: np.array([row[name] for row in rows]) for name in rows[0]}


def write_run(
    folder: Path,
    *,
    intervals: int = 60,
    worlds: int = 3,
    food_kinds: tuple[str, ...] = ("normal",),
    neutral_count: int = 1,
    extinct: int | None = None,
    preset: str | None = "baseline",
    name: str | None = "baseline",
    modified: bool | None = False,
    snapshot: bool = True,
    status: str = "finished",
    unsaved: int = 0,
    **options: Any,
) -> Path:
    """Writes a whole run. World `extinct` has no births and short lives; `options` apply to every world.

    Agents of the last `unsaved` intervals are missing, as in a killed run.
    """
    manifest = Manifest(
        food_kinds=food_kinds,
        neutral_count=neutral_count,
        seeds=tuple(range(1, worlds + 1)),
        steps_asked=intervals * INTERVAL,
        preset=preset,
        fidelity="corrected",
        name=name,
        modified=modified,
        hedon_version="0.1.0",
        backend="portable",
        status=status,
        run_seconds=10.0,
    )
    done, extinct_steps = [], []
    others = "".join(f"[food.{kind}]\ngives.energy = 0.2\n" for kind in food_kinds if kind != "normal")
    with Writer(folder, f'preset = "baseline"\n{others}', manifest) as writer:
        last = []
        for index, seed in enumerate(manifest.seeds):
            dying: dict[str, Any] = {"birth_factor": 0.0, "lifetime": 3000.0} if index == extinct else {}
            world = SyntheticWorld(index, seed, food_kinds, neutral_count, **(options | dying))
            rows, living = [], world.living_rows()
            while len(rows) < intervals and len(world.living["agent_id"]):
                dead, row = world.step()
                rows.append(row)
                if len(rows) <= intervals - unsaved:
                    writer.append("agents", dead)
                    living = world.living_rows()
            if rows:
                writer.append("population", population_rows(rows))
            last.append(living)
            done.append(world.now)
            extinct_steps.append(None if len(world.living["agent_id"]) else world.now)
        writer.replace_living(*last)
        writer.save_manifest(
            Manifest(**{**vars(manifest), "steps_done": tuple(done), "extinct_steps": tuple(extinct_steps)})
        )
    if snapshot:
        save_snapshot(folder, synthetic_snapshot(food_kinds))
    return folder


def synthetic_snapshot(food_kinds: tuple[str, ...] = ("normal",), agents: int = 40, rays: int = 24) -> Snapshot:
    """The last state of a world of 480×360 u; the rays detect only the walls, computed in closed form."""
    rng = np.random.default_rng(5)
    grid = np.stack(np.meshgrid(np.arange(25, 460, 30), np.arange(25, 340, 30)), axis=-1).reshape(-1, 2)
    count = agents + 12 * len(food_kinds)
    places = rng.permutation(grid)[:count] + rng.uniform(-4, 4, (count, 2))
    x, y = places[:agents].T
    angle = rng.uniform(0, 2 * np.pi, agents)
    directions = angle[:, None] + np.radians(np.linspace(-60, 60, rays))
    cos, sin = -np.sin(directions), np.cos(directions)
    with np.errstate(divide="ignore"):
        reach_x = np.where(cos > 0, (480 - x[:, None]) / cos, -x[:, None] / cos)
        reach_y = np.where(sin > 0, (360 - y[:, None]) / sin, -y[:, None] / sin)
    distance = np.minimum(reach_x, reach_y) - 10
    readings = np.full((agents, rays, 2 + len(food_kinds)), -1.0, np.float32)
    readings[..., -1] = np.where(distance <= 200, 1 - distance / 200, -1)
    corners = np.array([(0, 0), (480, 0), (480, 360), (0, 360)], np.float32)
    return Snapshot(
        world=0,
        seed=1,
        step=61_440,
        agent_id=np.arange(agents),
        x=x.astype(np.float32),
        y=y.astype(np.float32),
        angle=angle.astype(np.float32),
        energy=rng.uniform(0, 120, agents).astype(np.float32),
        rays=readings,
        food_kind=np.repeat(np.arange(len(food_kinds)), 12).astype(np.int32),
        food_x=places[agents:, 0].astype(np.float32),
        food_y=places[agents:, 1].astype(np.float32),
        walls=np.concatenate([corners, np.roll(corners, -1, axis=0)], axis=1),
        food_kinds=food_kinds,
        species=np.zeros(agents, np.int32),
        radius=np.array([10.0]),
        ray_count=np.array([rays]),
        ray_length=np.array([200.0]),
        ray_spread=np.array([60.0]),
        mouth_spread=np.array([60.0]),
        mouth_center=np.array([0.0]),
    )
