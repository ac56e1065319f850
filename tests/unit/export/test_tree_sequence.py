"""Tree sequences, read back by tskit: once simplified, they are the trees of the Newick export."""

from pathlib import Path
from typing import Any

import dendropy
import numpy as np
import polars as pl
import pytest
from synthetic_run import write_run
from typer.testing import CliRunner

from hedon.cli.main import app
from hedon.config.load import load_config
from hedon.experiment.plan import RunPlan
from hedon.experiment.run import run as make_run
from hedon.export.phylogeny import last_step, newick, pedigree
from hedon.export.table import ExportError
from hedon.export.tree_sequence import LAST_BIRTH, tree_sequence
from hedon.record.reader import Run, open_run

tskit: Any = pytest.importorskip("tskit", reason='needs the optional package: pip install "hedon[phylogeny]"')


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Run:
    """A run in which agents are born up to the last step."""
    settings = ["world.rollout_steps=64", "learning.minibatch_size=32", "birth.kappa=0.02", "hazard.alpha_age=0.003"]
    folder = tmp_path_factory.mktemp("run") / "run"
    make_run(RunPlan(load_config("baseline", overrides=settings), (3,), 400, folder, 1))
    return open_run(folder)


@pytest.fixture(scope="module")
def synthetic(tmp_path_factory: pytest.TempPathFactory) -> Run:
    return open_run(write_run(tmp_path_factory.mktemp("runs") / "run", intervals=20, worlds=1))


def shape(node: Any) -> tuple[Any, ...]:
    """A tree with its lengths, in an order that does not depend on the order of branches."""
    length = round(node.edge.length or 0.0, 6)
    return (length, node.taxon.label) if node.taxon else (length, *sorted(map(shape, node.child_nodes()), key=repr))


def trees(text: str) -> set[tuple[Any, ...]]:
    """The trees of a text without the lengths of their roots, which a simplified sequence does not have."""
    read = dendropy.TreeList.get(data=text, schema="newick", suppress_internal_node_taxa=True)
    return {shape(tree.seed_node)[1:] for tree in read}


@pytest.mark.parametrize("name", ["made", "synthetic"])
def test_the_simplified_sequence_is_the_tree_of_the_newick_export(name: str, request: pytest.FixtureRequest) -> None:
    run: Run = request.getfixturevalue(name)
    agents = pedigree(run)
    now = last_step(run, agents)
    births_at_the_end = agents.filter(pl.col("birth_step") == now)
    if births_at_the_end.height:  # their branches have a different length
        now += 1
    sequence = tree_sequence(agents, run.weight_names, now)
    simple = sequence.simplify()
    tree = simple.first()
    assert sequence.num_trees == 1
    assert sequence.num_samples == agents["death_step"].is_null().sum() > 10
    ids = {leaf: str(simple.individual(simple.node(leaf).individual).metadata["agent_id"]) for leaf in tree.leaves()}
    text = "".join(tree.as_newick(root=root, node_labels=ids) for root in tree.roots)
    assert trees(text) == trees(newick(agents, now).decode())


def test_a_file_has_all_lives(made: Run, tmp_path: Path) -> None:
    out = tmp_path / "lives.trees"
    done = CliRunner().invoke(app, ["export", "phylogeny", str(made.path), "--format", "trees", "--out", str(out)])
    assert done.exit_code == 0, done.output
    sequence, agents = tskit.load(out), pedigree(made)
    assert sequence.time_units == "steps"
    assert sequence.num_individuals == agents.height
    kept = pl.DataFrame([each.metadata for each in sequence.individuals()])
    assert kept["agent_id"].to_list() == agents["agent_id"].to_list()
    assert kept["w_normal"].to_list() == pytest.approx(agents["w_normal"].to_list(), nan_ok=True)
    roots = agents.filter(pl.col("parent_id").is_null()).height
    births = agents.height - roots
    assert sequence.num_nodes == births + sequence.num_samples + roots
    times = np.array([node.time for node in sequence.nodes()])
    assert times.min() == 0
    assert times.max() == last_step(made, agents)


def test_a_birth_in_the_last_step_is_dated_half_a_step_earlier() -> None:
    rows = [(0, None, 0, None), (1, 0, 10, None)]
    agents = pl.DataFrame(rows, ["agent_id", "parent_id", "birth_step", "death_step"], orient="row")
    tree = tree_sequence(agents, (), 10).first()
    assert tree.time(tree.mrca(1, 2)) == LAST_BIRTH


def test_pedigrees_with_two_parents_are_refused() -> None:
    rows = [(0, None, None, 0, None), (1, None, None, 0, None), (2, 0, 1, 10, None)]
    agents = pl.DataFrame(rows, ["agent_id", "parent_id", "mate_id", "birth_step", "death_step"], orient="row")
    with pytest.raises(ExportError, match="two parents: there is no tree"):
        tree_sequence(agents, (), 10)
