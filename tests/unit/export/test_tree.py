"""The tree of descent as a picture, its indices over time, and phylotrackpy as a reader of the ALife table."""

import struct
from importlib import import_module
from pathlib import Path

import numpy as np
import polars as pl
import pytest
from matplotlib.collections import LineCollection
from synthetic_run import write_run

from hedon.analysis.descent.genealogy import ancestry, genealogy
from hedon.export import indices
from hedon.export.indices import index_table
from hedon.export.phylogeny import alife_table, last_step, pedigree, picture
from hedon.export.table import ExportError, write_table
from hedon.figure.tree import MOST, draw_tree
from hedon.record.reader import Run, open_run

systematics = import_module("phylotrackpy.systematics")


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Run:
    return open_run(write_run(tmp_path_factory.mktemp("runs") / "run", intervals=20, worlds=1))


def family() -> pl.DataFrame:
    """Agent 0 has children 1 (at 10), 2 (at 20) and 3 (at 30), agent 2 has 4 (at 40); 0 and 3 are dead; 5 is alone."""
    rows = [(0, None, 0, 50), (1, 0, 10, None), (2, 0, 20, None), (3, 0, 30, 35), (4, 2, 40, None), (5, None, 0, None)]
    table = pl.DataFrame(rows, ["agent_id", "parent_id", "birth_step", "death_step"], orient="row")
    return table.with_columns(w_normal=pl.Series([0.0, 1.0, -1.0, 9.0, -2.0, 0.5]))


def test_the_indices_of_a_family() -> None:
    found = index_table(family(), 100, 10)
    assert found["step"].to_list() == [10, 20, 30, 40, 50, 60, 70, 80, 90, 100]
    assert found["living"].to_list() == [3, 4, 5, 5, 4, 4, 4, 4, 4, 4]
    # At the end, 1 and 2 descend from 0, 4 from 2, and 5 is joined on: four edges; the depths are 1, 1, 2 and 0.
    assert found["phylogenetic_diversity"][-1] == 4
    assert found["mean_depth"][-1] == 1.0
    # Pairs with a common ancestor: 1–2, 2–4 and 1–4, which are 2, 1 and 3 edges apart.
    assert found["mean_pairwise_distance"][-1] == 2.0


def test_indices_agree_with_the_pedigree(run: Run) -> None:
    agents = pedigree(run)
    now = last_step(run, agents)
    found = index_table(agents, now, 7)
    assert found["step"][-1] == now
    tree = genealogy(agents)
    for step, living, diversity, depth in found.select(
        "step", "living", "phylogenetic_diversity", "mean_depth"
    ).iter_rows():
        alive = np.flatnonzero((tree.birth <= step) & (tree.death > step))
        assert living == len(alive)
        assert depth == pytest.approx(agents["generation"].to_numpy()[alive].mean())
        kept = ancestry(tree, alive)
        assert diversity == kept.sum() - 1


def test_phylotrackpy_reads_the_table_of_the_alife_standard(run: Run, tmp_path: Path) -> None:
    agents = pedigree(run)
    write_table(alife_table(agents, run.weight_names).lazy(), "csv", tmp_path / "tree.csv")
    read = systematics.Systematics(lambda organism: organism)
    read.load_from_file(str(tmp_path / "tree.csv"), "id", False)
    assert read.get_num_active() == agents["death_step"].is_null().sum()
    assert read.get_num_roots() == agents["parent_id"].is_null().sum()
    assert read.get_num_taxa() == len(agents)


def test_the_picture_of_a_family() -> None:
    agents = family()
    figure = draw_tree(genealogy(agents), agents["w_normal"].to_numpy(), "w_normal", 100)
    axes, bar = figure.axes
    births, lives = (each for each in axes.collections if isinstance(each, LineCollection))
    weights = np.asarray(lives.get_array())
    drawn = {tuple(line[:, 0]): weight for line, weight in zip(lives.get_segments(), weights, strict=True)}
    # 0 ends with the birth of 2, its last child with a living line; 3 is not drawn.
    assert drawn == {(0.0, 20.0): 0.0, (10.0, 100.0): 1.0, (20.0, 100.0): -1.0, (40.0, 100.0): -2.0, (0.0, 100.0): 0.5}
    assert sorted(line[0, 1] for line in lives.get_segments() if line[1, 0] == 100.0) == [0, 1, 2, 3]
    assert [segment[0, 0] for segment in births.get_segments()] == [10.0, 20.0, 40.0]
    assert bar.get_ylabel() == "weight of normal food"


@pytest.mark.parametrize("seed", range(20))
def test_no_birth_is_drawn_across_a_life(seed: int) -> None:
    """In random families, the line from parent to child crosses no life between them."""
    rng = np.random.default_rng(seed)
    parents: list[int | None] = [None] * 4
    births = [0] * 4
    for step in range(10, 400, 10):
        parents.append(int(rng.integers(0, len(parents))))
        births.append(step)
    last = [
        max([birth, *(b for p, b in zip(parents, births, strict=True) if p == i)]) for i, birth in enumerate(births)
    ]
    deaths = [None if rng.random() < 0.4 else step + 1 for step in last]
    agents = pl.DataFrame(
        {"agent_id": range(len(births)), "parent_id": parents, "birth_step": births, "death_step": deaths},
        schema_overrides={"parent_id": pl.Int64, "death_step": pl.Int64},
    )
    figure = draw_tree(genealogy(agents), np.zeros(len(births)), "w_normal", 400)
    edges, lives = (each.get_segments() for each in figure.axes[0].collections if isinstance(each, LineCollection))
    assert len(edges) > 5
    for edge in edges:
        (at, one), (_, other) = edge
        for (begin, height), (end, _) in lives:
            assert not (begin < at < end and min(one, other) < height < max(one, other))


def test_only_some_of_many_agents_are_drawn_and_none_if_all_are_dead() -> None:
    many = pl.DataFrame(
        {"agent_id": range(1000), "parent_id": [None] * 1000, "birth_step": [0] * 1000, "death_step": [None] * 1000},
        schema_overrides={"parent_id": pl.Int64, "death_step": pl.Int64},
    )
    figure = draw_tree(genealogy(many), np.zeros(1000), "w_normal", 10)
    assert figure.axes[0].get_title("left") == f"{MOST} of 1000 who live, and their ancestors"
    gone = many.with_columns(death_step=pl.lit(5))
    assert "nobody lives" in draw_tree(genealogy(gone), np.zeros(1000), "w_normal", 10).axes[0].texts[0].get_text()


def test_a_picture_can_be_colored_by_any_gene(run: Run) -> None:
    agents = pedigree(run)
    content = picture(agents, last_step(run, agents), run.weight_names, "neutral_1")
    width, height = struct.unpack(">II", content[16:24])
    assert content.startswith(b"\x89PNG")
    assert width > height > 300
    with pytest.raises(ExportError, match=r"--color w_norml: there is no such gene .* did you mean w_normal\?"):
        picture(agents, 10, run.weight_names, "w_norml")


def test_trees_and_indices_need_single_parents_and_phylotrackpy(monkeypatch: pytest.MonkeyPatch) -> None:
    mated = family().with_columns(mate_id=pl.Series([None, 5, None, None, None, None], dtype=pl.Int64))
    for make in (lambda: index_table(mated, 100, 1), lambda: picture(mated, 100, ("w_normal",), None)):
        with pytest.raises(ExportError, match="two parents: there is no tree"):
            make()

    def missing(name: str) -> None:
        raise ImportError(name)

    monkeypatch.setattr(indices, "import_module", missing)
    with pytest.raises(ExportError, match=r"pip install 'hedon\[phylogeny\]'"):
        index_table(family(), 100, 1)
