"""Every door of hedon for one world: from its config to its page, in one process."""

import json
import random
import shutil
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
from mechanism import Mixture
from mechanism_data import begin, founders_of, networks_of
from resumed_run import assert_same_run

from hedon.check.run import check_run
from hedon.config.config import Config
from hedon.config.dump import digest, dump_toml
from hedon.config.load import load_config
from hedon.env.batch import batch
from hedon.experiment.plan import Moment, RunPlan
from hedon.experiment.replay import replay_run
from hedon.experiment.resume import resume
from hedon.experiment.run import run
from hedon.experiment.simulation import Simulation
from hedon.export.indices import index_table
from hedon.export.phylogeny import alife_table, last_step, newick, pedigree
from hedon.export.table import TableName, table_of, write_table
from hedon.record.reader import open_run
from hedon.report.analysis import analyze, write_analysis
from hedon.report.run import write_report
from hedon.report.summary import summarize
from hedon.video.moment import open_footage
from hedon.view.index import RunIndex
from hedon.view.page import to_json

SEEDS = (5, 6)
STEPS = 75
"""At least one window with its learning, and in most worlds two."""
FRAMES = 7
"""Steps between two frames: they do not divide a window."""


@dataclass
class Trial:
    """One world that goes through the doors.

    Attributes:
        world: its mechanisms.
        folder: an empty one.
        draw: for what is drawn on the way.
        seen: configs of earlier worlds, as texts, by their digests.
    """

    world: Mixture
    folder: Path
    draw: random.Random
    seen: dict[str, str] = field(default_factory=dict)

    def config(self) -> Config:
        """The config, as a user's file gives it."""
        return self.world.config(self.folder)

    def plan(self, name: str, steps: int = STEPS, checkpoint_seconds: float = 1e9) -> RunPlan:
        """A run of it in a folder of its own."""
        config = self.config()
        given = {"founders": founders_of(self.world, config), "networks": networks_of(self.world, config)}
        return RunPlan(config, SEEDS, steps, self.folder / name, 1, FRAMES, checkpoint_seconds, **given)


def doors(trial: Trial, *, report: bool) -> Iterator[tuple[str, Callable[[Trial], None]]]:
    """The doors that a world goes through, in their order, by name; with a report there are figures too."""
    yield from CHEAP.items()
    if not trial.world.any("driven"):
        yield from RECORDED.items()
        if report:
            yield "report", _report


def _config(trial: Trial) -> None:
    """What a config says comes back from its text, and nothing else has its digest."""
    config = trial.config()
    text = dump_toml(config)
    file = trial.folder / "again.toml"
    file.write_text(text)
    again = load_config(file)
    assert again == config
    assert digest(again) == digest(config)
    plain = "\n".join(line for line in text.splitlines() if not line.startswith(("name =", "color =")))
    assert trial.seen.setdefault(digest(config), plain) == plain, "two configs with one digest"


def _piece(trial: Trial) -> None:
    """Threads, pieces and a restore change nothing, and the ledger closes."""
    config = trial.config()
    whole = begin(trial.world, config, SEEDS[:1], 1)
    _drive(whole)
    whole.run(STEPS)
    parts, at = begin(trial.world, config, SEEDS[:1], 2), 0
    _drive(parts)
    cut = trial.draw.randrange(1, STEPS)
    while at < STEPS:
        steps = min(trial.draw.choice((1, 3, 16, 40)), STEPS - at, cut - at if at < cut else STEPS)
        parts.run(steps)
        at += steps
        if at == cut:
            fresh = Simulation(config, SEEDS[:1], 1)
            fresh.engine.restore(0, parts.engine.save(0))
            fresh.run(STEPS - cut)
            _same(whole, fresh, "a restored world differs")
    _same(whole, parts, "two threads and pieces differ")
    _close(whole.worlds[0])


CHEAP: dict[str, Callable[[Trial], None]] = {"config": _config, "simulation": _piece}


def _drive(simulation: Simulation) -> None:
    """Tells the agents that wait for a caller what to do."""
    for i, species in enumerate(simulation.config.agents.values()):
        if species.learning.policy == "external":
            actions = np.tile(
                np.array([0.8, -0.3], np.float32), (len(simulation.worlds), species.population.capacity, 1)
            )
            simulation.engine.command(i, actions)


def _same(one: Simulation, other: Simulation, what: str) -> None:
    assert [w.digest() for w in one.worlds] == [w.digest() for w in other.worlds], what


def _close(world: Any) -> None:
    """The energy of each species is what its ledger says."""
    agents = world.agents()
    hunted, damage = world.view("hunt_counters.energy_hunted"), world.view("obstacle_counters.energy_damage")
    for i, name in enumerate(world.config.agents):
        c = world.counters_of(i)
        income = c["energy_initial"] + c["energy_eaten"] + c["energy_forgiven"] + (hunted[i] if len(hunted) else 0.0)
        spent = c["energy_basic"] + c["energy_action"] + c["energy_capped"] + c["energy_lost"]
        spent += damage[i] if len(damage) else 0.0
        held = agents["energy"][agents["species"] == i].sum()
        assert abs(held - income + spent) < 1e-9 * (income + spent + 1.0), f"the ledger of {name} is open"


def _killed(trial: Trial) -> None:
    """A copy of the folder at a moment is what a kill at that moment leaves: it goes on to the same end."""
    trial.draw.seed(trial.draw.random())
    copied = _Copy(trial.folder / "run", trial.folder / "killed", trial.draw.randrange(STEPS))
    run(trial.plan("run", checkpoint_seconds=0.0), copied)
    assert not check_run(trial.folder / "killed").findings, "of the killed run"
    resume(trial.folder / "killed", threads=1)
    assert_same_run(trial.folder / "killed", trial.folder / "run")


class _Copy:
    """A display that copies the run's folder once, at the first moment from a step on."""

    def __init__(self, folder: Path, target: Path, step: int) -> None:
        self.folder, self.target, self.step = folder, target, step

    def update(self, moment: Moment) -> None:
        if moment.step >= self.step and not self.target.exists():
            shutil.copytree(self.folder, self.target, ignore=shutil.ignore_patterns("*.tmp"))


def _longer(trial: Trial) -> None:
    """A run that ended is made longer, to the same end."""
    run(trial.plan("longer", trial.draw.randrange(1, STEPS)))
    resume(trial.folder / "longer", STEPS, threads=1)
    assert_same_run(trial.folder / "longer", trial.folder / "run")


def _check(trial: Trial) -> None:
    found = check_run(trial.folder / "run").findings + check_run(trial.folder / "longer").findings
    assert not found, [f"{each.where}: {each.what}" for each in found]
    found, note = replay_run(trial.folder / "longer", 1)
    assert not found, [f"{each.where}: {each.what}" for each in found]
    assert "computed again" in note or "no checkpoint before" in note


def _summary(trial: Trial) -> None:
    opened = open_run(trial.folder / "run")
    summary = summarize(opened)
    json.dumps(summary, allow_nan=False)
    assert summary["agents"] == opened.agents().height


def _analysis(trial: Trial) -> None:
    write_analysis(analyze([open_run(trial.folder / "run")]), trial.folder / "analysis")


def _report(trial: Trial) -> None:
    files = write_report(open_run(trial.folder / "run"), folder=trial.folder / "report")
    assert all(file.stat().st_size for file in files)


def _export(trial: Trial) -> None:
    opened = open_run(trial.folder / "run")
    tables: tuple[TableName, ...] = ("agents", "population", "frames")
    for name in tables:
        out = trial.folder / f"{name}.csv"
        write_table(table_of(opened, name), "csv", out)
        assert len(out.read_text().splitlines()) == 1 + table_of(opened, name).collect().height
    agents = opened.agents()
    for species in opened.columns.species or (None,):
        mine = agents if "species" not in agents.columns else agents.filter(pl.col("species") == species)
        if not mine.filter(pl.col("world") == 0).height:
            continue
        tree = pedigree(opened, SEEDS[0], species if "species" in agents.columns else None)
        now = last_step(opened, tree)
        assert alife_table(tree, opened.weight_names).height == tree.height
        assert newick(tree, now)
        assert index_table(tree, now, 5).height


def _view(trial: Trial) -> None:
    """Every recorded step has as many agents as lived then, wherever it is looked up."""
    folder = trial.folder / "run"
    index = RunIndex(folder)
    told = index.describe()
    to_json(told)
    assert set(index.files()) == {part["file"] for parts in told["files"].values() for part in parts}
    opened = open_run(folder)
    agents, frames = opened.agents(), opened.frames().collect()
    names = [each["name"] for each in told["layout"]["species"]]
    for i in range(len(SEEDS)):
        lives = agents.filter(pl.col("world") == i)
        rows = frames.filter((pl.col("world") == i) & pl.col("kind").is_in(names))
        steps = sorted(set(frames.filter(pl.col("world") == i)["step"]))
        last = told["steps"][i]
        assert steps == [step for step in range(FRAMES, STEPS + 1, FRAMES) if step <= last and _alive(lives, step)]
        shown = {snapshot.step: len(snapshot.agent_id) for snapshot in _moments(folder, SEEDS[i], steps)}
        for step in steps:
            ids = set(rows.filter(pl.col("step") == step)["id"])
            assert ids == _alive(lives, step), f"agents of step {step}"
            assert shown[step] == len(ids), f"the moment of step {step}"
    first_last = [(part["first"], part["last"]) for part in told["files"]["frames"]]
    assert all(a[1] < b[0] for a, b in zip(first_last, first_last[1:], strict=False)), "a step is in two parts"


def _alive(lives: pl.DataFrame, step: int) -> set[int]:
    living = (pl.col("birth_step") <= step) & (pl.col("death_step").is_null() | (pl.col("death_step") > step))
    return set(lives.filter(living)["agent_id"])


def _moments(folder: Path, seed: int, steps: Sequence[int]) -> Iterator[Any]:
    return open_footage(folder, seed).moments(steps[0], steps[-1], FRAMES) if steps else iter(())


RECORDED: dict[str, Callable[[Trial], None]] = {
    "run, kill, resume": _killed,
    "resume": _longer,
    "check": _check,
    "summary": _summary,
    "analysis": _analysis,
    "export": _export,
    "view": _view,
}


def drive_from_outside(trial: Trial) -> None:
    """Driven through `hedon.env`, with repeated steps or one by one."""
    config = trial.config()
    worlds = [batch(config, SEEDS, threads=1) for _ in range(2)]
    paid = []
    for each, repeat in zip(worlds, (1, 5), strict=True):
        for _ in range(30 // repeat):
            for group in each.groups.values():
                group.actions[...] = 0.4
            each.step(repeat)
        paid.append([world.agents()["reward"].sum() for world in each.simulation.worlds])
    _same(worlds[0].simulation, worlds[1].simulation, "repeated steps differ")
    assert paid[0] == paid[1]
