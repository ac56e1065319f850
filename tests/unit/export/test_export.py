"""Tables and trees as other tools read them back."""

from dataclasses import replace
from pathlib import Path

import dendropy
import polars as pl
import pytest
from polars.testing import assert_frame_equal
from synthetic_run import write_run
from typer.testing import CliRunner

from hedon.cli.export import app
from hedon.config import load_config
from hedon.error import HedonError
from hedon.experiment.branch import branch
from hedon.experiment.plan import RunPlan
from hedon.experiment.run import run
from hedon.export.phylogeny import alife_table, has_two_parents, last_step, newick, pedigree
from hedon.export.table import ExportError
from hedon.record.reader import open_run

READERS = {"csv": pl.read_csv, "parquet": pl.read_parquet, "arrow": pl.read_ipc}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_run(tmp_path_factory.mktemp("runs") / "run", intervals=20, worlds=2)


def invoke(*arguments: str) -> str:
    """Runs the command and returns its output, or the text of an error raised by hedon."""
    result = CliRunner().invoke(app, list(arguments))
    return str(result.exception) if isinstance(result.exception, HedonError) else result.output


@pytest.mark.parametrize("table", ["agents", "population"])
@pytest.mark.parametrize("file_format", READERS)
def test_a_table_reads_back_unchanged(table: str, file_format: str, folder: Path, tmp_path: Path) -> None:
    out = tmp_path / f"out.{file_format}"
    assert invoke(table, str(folder), "--format", file_format, "--out", str(out)) == f"wrote {out}\n"
    wanted = getattr(open_run(folder), table)()
    found = READERS[file_format](out)
    assert found.columns == wanted.columns
    assert_frame_equal(found.cast(dict(wanted.schema)), wanted)  # pyright: ignore[reportArgumentType]


def test_a_long_export_reports_its_progress(folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("hedon.cli.display.step.QUIET_SECONDS", 0.0)
    result = CliRunner().invoke(app, ["agents", str(folder), "--out", str(tmp_path / "out.csv")])
    assert "hedon: exporting: reading agents, step 1 of 2" in result.stderr
    assert result.stdout == f"wrote {tmp_path / 'out.csv'}\n"


def test_the_default_file_is_named_after_the_run(folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert invoke("population", str(folder)) == "wrote run-population.csv\n"
    assert "is there already" in invoke("population", str(folder))
    assert [path.name for path in tmp_path.iterdir()] == ["run-population.csv"]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["frames"], "has no frames: record them with `hedon run --frames 64`"),
        (["agents", "--format", "newick"], "'newick' is not one of 'csv', 'parquet', 'arrow'"),
        (["agents", "--world", "1"], "No such option: --world"),
        (["phylogeny", "--format", "csv"], "'csv' is not one of 'alife', 'newick', 'trees', 'png'"),
        (["phylogeny", "--world", "1", "--color", "w_normal"], "--color is of a picture"),
        (["phylogeny"], "say which world: the run has seeds 1, 2"),
        (["phylogeny", "--world", "3"], "--world 3: there is no such world: the run has seeds 1, 2"),
        (["phylogeny", "--world", "1", "--species", "wolf"], "there is no such species (there are agent)"),
        (["agents", "--out", "/nowhere/out.csv"], "cannot write /nowhere/out.csv: No such file or directory"),
    ],
)
def test_impossible_exports_are_explained(arguments: list[str], message: str, folder: Path) -> None:
    assert message in invoke(arguments[0], str(folder), *arguments[1:])


def family() -> pl.DataFrame:
    """Agent 0 has children 1 (at 10), 2 (at 20) and 3 (at 30), agent 2 has 4 (at 40); 0 and 3 are dead; 5 is alone."""
    rows = [(0, None, 0, 50), (1, 0, 10, None), (2, 0, 20, None), (3, 0, 30, 35), (4, 2, 40, None), (5, None, 0, None)]
    return pl.DataFrame(rows, ["agent_id", "parent_id", "birth_step", "death_step"], orient="row")


def test_the_tree_of_a_family() -> None:
    # 0 forks when 1 is born; its own life then leads only to 2, which forks when 4 is born.
    assert newick(family(), now=100) == b"(1:90,(4:60,2:60):30):10;\n5:100;\n"


def test_the_alife_standard_of_a_family() -> None:
    table = alife_table(family(), ())
    assert table.columns == ["id", "ancestor_list", "origin_time", "destruction_time"]
    assert table["ancestor_list"].to_list() == ["[NONE]", "[0]", "[0]", "[0]", "[2]", "[NONE]"]
    assert table["destruction_time"].to_list() == ["50", "inf", "inf", "35", "inf", "inf"]


def test_another_tool_reads_the_trees(folder: Path, tmp_path: Path) -> None:
    out = tmp_path / "trees.nwk"
    invoke("phylogeny", str(folder), "--world", "2", "--format", "newick", "--out", str(out))
    run = open_run(folder)
    agents, now = pedigree(run, 2), run.manifest.steps_done[1]
    living = agents.filter(pl.col("death_step").is_null())
    trees = dendropy.TreeList.get(path=str(out), schema="newick")
    tips = [leaf.taxon.label for tree in trees for leaf in tree.leaf_node_iter()]
    assert sorted(map(int, tips)) == sorted(living["agent_id"])
    parent = dict(zip(agents["agent_id"], agents["parent_id"], strict=True))
    birth = dict(zip(agents["agent_id"], agents["birth_step"], strict=True))
    for tree in trees:
        assert all(len(node.child_nodes()) == 2 for node in tree.internal_nodes())
        founder = int(next(tree.leaf_node_iter()).taxon.label)
        while parent[founder] is not None:
            founder = parent[founder]
        for leaf in tree.leaf_node_iter():
            length = sum(node.edge_length for node in [leaf, *leaf.ancestor_iter()])
            assert length == now - birth[founder]


def test_a_run_that_was_killed_ends_with_its_last_event(folder: Path) -> None:
    run = open_run(folder)
    killed = replace(run, manifest=replace(run.manifest, steps_done=(0, 0)))
    agents = pedigree(killed, 1)
    assert last_step(killed, agents) == max(agents["birth_step"].max(), agents["death_step"].max())  # pyright: ignore
    assert last_step(run, agents) == run.manifest.steps_done[0]


def test_the_time_of_a_common_ancestor_is_that_of_a_birth(folder: Path) -> None:
    run = open_run(folder)
    agents, now = pedigree(run, 1), run.manifest.steps_done[0]
    births = set(agents["birth_step"])
    tree = dendropy.TreeList.get(data=newick(agents, now).decode(), schema="newick")[0]
    tree.calc_node_ages()
    assert {now - round(node.age) for node in tree.internal_nodes()} <= births


def test_without_survivors_there_is_no_tree() -> None:
    gone = family().with_columns(death_step=pl.col("death_step").fill_null(60))
    with pytest.raises(ExportError, match="nobody lives at the end, so there is no tree of the living"):
        newick(gone, now=100)
    assert alife_table(gone, ()).height == 6


def test_two_parents_are_recognized() -> None:
    pairs = family().with_columns(mate_id=pl.when(pl.col("agent_id") == 4).then(1))
    assert has_two_parents(pairs)
    assert not has_two_parents(family().with_columns(mate_id=pl.lit(None)))
    assert alife_table(pairs, ())["ancestor_list"].to_list()[4] == "[2,1]"


@pytest.fixture(scope="module")
def branched(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A branch of a lively world in which founders died and children were born before the branch started."""
    place = tmp_path_factory.mktemp("branched")
    lively = ("birth.kappa=0.05", "hazard.alpha_age=0.01", "learning.update_epochs=1", "world.rollout_steps=256")
    plan = RunPlan(load_config("small", overrides=lively), seeds=(1,), steps=1024, out=place / "whole")
    run(plan)
    branch(plan.out, place / "branch", steps=1536)
    return place / "branch"


@pytest.mark.parametrize("chosen", ["alife", "newick", "png"])
def test_the_pedigree_of_a_branch_starts_with_the_agents_then_alive(
    chosen: str, branched: Path, tmp_path: Path
) -> None:
    out = tmp_path / f"tree.{chosen}"
    assert invoke("phylogeny", str(branched), "--format", chosen, "--out", str(out)) == f"wrote {out}\n"
    agents = pedigree(open_run(branched), 1)
    roots = agents.filter(pl.col("parent_id").is_null())
    begin = open_run(branched).manifest.parent.step  # pyright: ignore
    assert roots["birth_step"].max() <= begin  # pyright: ignore
    assert roots.filter(pl.col("birth_step") > 0).height > 0, "some were born before the branch started"
    if chosen == "alife":
        ids = set(map(str, agents["agent_id"]))
        named = pl.read_csv(out, infer_schema_length=None)["ancestor_list"].str.strip_chars("[]").to_list()
        assert set(named) - {"NONE"} <= ids
