"""Takes one world through every public entry point of hedon, from its config to its page, in one process."""

import json
import multiprocessing
import os
import random
import signal
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
import pytest
from mechanism import Mixture
from mechanism_data import begin, founders_of, networks_of
from resumed_run import assert_same_run

from hedon.check.run import check_run
from hedon.config.config import Config
from hedon.config.dump import digest, dump_toml
from hedon.config.load import load_config
from hedon.env.make import make
from hedon.error import ArgumentError
from hedon.experiment.plan import Moment, RunPlan
from hedon.experiment.replay import replay_run
from hedon.experiment.resume import resume
from hedon.experiment.run import run
from hedon.experiment.simulation import Simulation
from hedon.export.dataset import write_dataset
from hedon.export.indices import index_table
from hedon.export.phylogeny import alife_table, last_step, newick, pedigree
from hedon.export.table import ExportError, TableName, table_of, write_table
from hedon.export.tree_sequence import tree_sequence
from hedon.measure.summary import summarize
from hedon.record.reader import open_run
from hedon.report.analysis import analyze, write_analysis
from hedon.report.run import write_report
from hedon.video.moment import open_footage
from hedon.view.index import RunIndex
from hedon.view.page import to_json

SEEDS = (5, 6)
STEPS = 75
"""At least one window with learning, and in most worlds two."""
FRAMES = 7
"""Steps between frames; not a divisor of a window."""


@dataclass
class Trial:
    """One world that goes through the entry points.

    Attributes:
        world: Its mechanisms.
        folder: Initially empty folder.
        draw: Source of random choices.
        seen: Configs of earlier worlds, as text, by digest.
    """

    world: Mixture
    folder: Path
    draw: random.Random
    seen: dict[str, str] = field(default_factory=dict)

    def config(self) -> Config:
        """The config, loaded from a file like a user's."""
        return self.world.config(self.folder)

    def plan(self, name: str, steps: int = STEPS, checkpoint_seconds: float = 1e9) -> RunPlan:
        """A plan for a run in a separate folder."""
        config = self.config()
        given = {"founders": founders_of(self.world, config), "networks": networks_of(self.world, config)}
        return RunPlan(config, SEEDS, steps, self.folder / name, 1, FRAMES, checkpoint_seconds, **given)


def doors(trial: Trial, *, recorded: bool, report: bool) -> Iterator[tuple[str, Callable[[Trial], None]]]:
    """The entry points for a world, in order, with names; optionally also for records, and a report with figures."""
    yield from CHEAP.items()
    if trial.world.any("driven"):
        yield "environment", _driven
    elif recorded:
        yield from RECORDED.items()
        if report:
            yield "report", _report


def _config(trial: Trial) -> None:
    """A config survives the round trip through its text, and no other config has its digest."""
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
    """Threads, splitting and restoring change nothing, and the ledger balances."""
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


def _value(trial: Trial) -> None:
    """Worlds that are saved, copied or restarted continue identically, in the same slots."""
    config = trial.config()
    one = begin(trial.world, config, SEEDS, 1)
    _drive(one)
    one.run(trial.draw.randrange(1, STEPS))
    kept, copied = one.save(), one.clone()
    one.run(STEPS)
    copied.run(STEPS)
    _same(one, copied, "a clone differs")
    copied.restore(kept)
    copied.run(STEPS)
    _same(one, copied, "a restored world differs")
    for mine, theirs in zip(one.worlds, copied.worlds, strict=True):
        np.testing.assert_array_equal(mine.living, theirs.living)
    if not (trial.world.any("founders") or trial.world.any("networks")):  # which new worlds do not get automatically
        copied.reset(SEEDS)
        fresh = begin(trial.world, config, SEEDS, 1)
        for each in (copied, fresh):
            _drive(each)
            each.run(STEPS)
        _same(copied, fresh, "a world that was begun again differs")


CHEAP: dict[str, Callable[[Trial], None]] = {"config": _config, "simulation": _piece, "value": _value}


def _drive(simulation: Simulation) -> None:
    """Sets actions for agents that are driven externally."""
    for i, species in enumerate(simulation.config.species.values()):
        if species.learning.policy == "external":
            actions = np.tile(
                np.array([0.8, -0.3], np.float32), (len(simulation.worlds), species.population.capacity, 1)
            )
            simulation.engine.set_actions(i, actions)


def _same(one: Simulation, other: Simulation, what: str) -> None:
    assert [w.digest() for w in one.worlds] == [w.digest() for w in other.worlds], what


def _close(world: Any) -> None:
    """The energy of each species matches its ledger."""
    agents = world.agents()
    hunted, damage = world.view("hunt_counters.energy_hunted"), world.view("obstacle_counters.energy_damage")
    for i, name in enumerate(world.config.species):
        c = world.counters_of(i)
        income = c["energy_initial"] + c["energy_eaten"] + c["energy_forgiven"] + (hunted[i] if len(hunted) else 0.0)
        spent = c["energy_basic"] + c["energy_action"] + c["energy_capped"] + c["energy_lost"]
        spent += damage[i] if len(damage) else 0.0
        held = agents["energy"][agents["species"] == i].sum()
        assert abs(held - income + spent) < 1e-9 * (income + spent + 1.0), f"the ledger of {name} does not balance"


def _killed(trial: Trial) -> None:
    """A killed run resumes and ends like one that was never killed."""
    run(trial.plan("run"))
    process = _context.Process(target=_run_until_killed, args=(trial, trial.draw.randrange(STEPS)))
    process.start()
    process.join(120)
    folder = trial.folder / "killed"
    if process.exitcode == 0:  # all agents died earlier
        assert_same_run(folder, trial.folder / "run")
        return
    assert process.exitcode == -signal.SIGKILL
    assert not check_run(folder).findings, [f"{each.where}: {each.what}" for each in check_run(folder).findings]
    resume(folder, threads=1)
    assert_same_run(folder, trial.folder / "run")


def _run_until_killed(trial: Trial, step: int) -> None:
    run(trial.plan("killed", checkpoint_seconds=0.0), [_Death(step)])


class _Death:
    """A callback that kills its process at the first moment at or after a step."""

    def __init__(self, step: int) -> None:
        self.step = step

    def __call__(self, moment: Moment) -> None:
        if moment.step >= self.step:
            os.kill(os.getpid(), signal.SIGKILL)


_context = multiprocessing.get_context("forkserver")
_context.set_forkserver_preload(["world_door"])


def _longer(trial: Trial) -> None:
    """A finished run is extended, with the same result."""
    folder = trial.folder / "longer"
    manifest = run(trial.plan("longer", trial.draw.randrange(1, STEPS)))
    if None in manifest.extinct_steps:
        resume(folder, STEPS, threads=1)
    assert_same_run(folder, trial.folder / "run")


def _check(trial: Trial) -> None:
    found = check_run(trial.folder / "run").findings + check_run(trial.folder / "longer").findings
    assert not found, [f"{each.where}: {each.what}" for each in found]
    found, note = replay_run(trial.folder / "longer", 1)
    assert not found, [f"{each.where}: {each.what}" for each in found]
    assert "computed again" in note or "no checkpoint before" in note


def _summary(trial: Trial) -> None:
    """The summary has plain values, and the same number of agents of each species as the records."""
    opened = open_run(trial.folder / "run")
    summary, agents = summarize(opened), opened.agents()
    json.dumps(summary, allow_nan=False)
    several = opened.columns.several
    assert (summary["total"] if several else summary)["agents"] == agents.height
    for i, world in enumerate(summary["worlds"]):
        living = agents.filter((pl.col("world") == i) & pl.col("death_step").is_null())
        if not several:
            assert world["alive"] == living.height
        for name, told in world.get("species", {}).items():
            assert told["alive"] == living.filter(pl.col("species") == name).height


def _analysis(trial: Trial) -> None:
    write_analysis(analyze([open_run(trial.folder / "run")]), trial.folder / "analysis")


def _report(trial: Trial) -> None:
    files = write_report(open_run(trial.folder / "run"), folder=trial.folder / "report")
    assert all(file.stat().st_size for file in files)


def _export(trial: Trial) -> None:
    opened = open_run(trial.folder / "run")
    tables: list[TableName] = ["agents", "population"]
    if opened.frames().collect().height:  # otherwise all agents died before the first frame
        tables.append("frames")
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
        if "mate_id" in tree.columns and tree["mate_id"].is_not_null().any():
            continue  # with two parents, there is no tree
        lives = tree_sequence(tree, opened.weight_names, now)
        assert (lives.num_individuals, lives.num_samples) == (tree.height, tree["death_step"].null_count())
        assert index_table(tree, now, 5).height
        if tree["death_step"].null_count():
            assert newick(tree, now)
            continue
        with pytest.raises(ExportError, match="nobody lives at the end"):
            newick(tree, now)
    assert opened.to_xarray()["alive"].notnull().sum() == opened.population().height
    made = write_dataset([opened], trial.folder / "dataset", frames="frames" in tables)
    assert len(made) == 6 + ("frames" in tables)


def _view(trial: Trial) -> None:
    """Every recorded step shows the agents alive at that time, wherever it is looked up."""
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
        spans = [part["worlds"][i] for part in told["files"]["frames"] if part["worlds"][i] is not None]
        assert all(a[1] < b[0] for a, b in pairwise(spans)), "a step is split across two parts"


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


def _driven(trial: Trial) -> None:
    """Externally driven agents give the same worlds on any number of threads; a run refuses them."""
    config, repeat = trial.config(), trial.draw.randrange(1, 7)
    pair = [make(config, len(SEEDS), SEEDS, repeat=repeat, threads=threads) for threads in (1, 2)]
    for each in pair:
        for _ in range(STEPS // repeat):
            for group in each.groups.values():
                group.actions[...] = 0.4
            each.step(each.actions)
            if each is pair[1] and trial.draw.random() < 0.2:
                each.restore(each.clone().save())
    _same(pair[0].simulation, pair[1].simulation, "two threads differ")
    for name, group in pair[0].groups.items():
        np.testing.assert_array_equal(group.observations, pair[1].groups[name].observations)
    with pytest.raises(ArgumentError, match="external"):
        trial.plan("run")
