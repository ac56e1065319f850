from pathlib import Path

import numpy as np
import polars as pl
import pytest
from analysis_tree import lines, random_tree
from synthetic_run import write_run

from hedon.analysis.descent.genealogy import ALIVE, Genealogy, genealogy
from hedon.analysis.descent.lineage import coalescence, lines_through_time, survivors
from hedon.analysis.world.record import read_worlds
from hedon.record.reader import open_run


def weights(count: int) -> pl.DataFrame:
    return pl.DataFrame({"w_normal": np.arange(count, dtype=np.float32)})


def test_a_line_is_carried_until_its_last_heir_is_born() -> None:
    # 0 has 1 (at 10) and 2 (at 30), which are alive; 3, born at 20, leaves no descendants.
    tree = Genealogy(np.array([-1, 0, 0, 0]), np.array([0, 10, 30, 20]), np.array([90, ALIVE, ALIVE, 40]), 0)
    found = lines_through_time(tree, weights(4), ["w_normal"], np.array([0, 10, 20, 30, 50, 90]))
    assert found["lines"].to_list() == [1, 2, 2, 2, 2, 2]
    assert found["line_mean"].to_list() == [0, 0.5, 0.5, 1.5, 1.5, 1.5]
    assert found["alive"].to_list() == [1, 2, 3, 4, 3, 2]
    assert found["living_mean"].to_list() == [0, 0.5, 4 / 3, 1.5, 1.0, 1.5]


def test_lines_agree_with_a_count_one_by_one() -> None:
    rng = np.random.default_rng(3)
    for _ in range(20):
        tree = random_tree(rng, 100, 3)
        paths = [lines(tree, int(i)) for i in survivors(tree)]
        steps = np.arange(0, 140, 7)
        found = lines_through_time(tree, weights(100), ["w_normal"], steps)
        for i, step in enumerate(steps):
            # On each path, the line is carried at this step by the last agent born by then.
            carriers = {
                next(a for a in path if tree.birth[a] <= step) for path in paths if tree.birth[path[-1]] <= step
            }
            assert found["lines"][i] == len(carriers)
            assert found["line_mean"][i] == pytest.approx(np.mean(list(carriers)))


def test_coalescence() -> None:
    tree = Genealogy(np.array([-1, -1, 0, 2, 2]), np.array([0, 0, 5, 10, 20]), np.array([30, 15, 40, ALIVE, ALIVE]), 0)
    early, late = coalescence(tree, 12), coalescence(tree, 50)
    assert (early["alive"], early["families"], early["largest"]) == (4, 2, 0.75)
    assert np.isnan(early["depth"])
    assert (late["alive"], late["families"], late["ancestor_birth"], late["depth"]) == (2, 1, 5, 45)
    dead = Genealogy(tree.parent, tree.birth, np.array([30, 15, 40, 45, 46]), 0)
    assert coalescence(dead, 50)["alive"] == 0
    assert survivors(dead).tolist() == [4]
    nobody = np.empty(0, np.int64)
    assert survivors(Genealogy(nobody, nobody, nobody, 0)).tolist() == []


def test_lines_end_with_the_living(tmp_path: Path) -> None:
    run = open_run(write_run(tmp_path / "run", worlds=2, intervals=60, extinct=1, snapshot=False))
    for world in read_worlds([run]):
        tree = genealogy(world.agents)
        steps = np.linspace(0, world.last_step, 9).astype(np.int64)
        found = lines_through_time(tree, world.agents, world.weight_names, steps)
        assert found.height == 9 * 3
        last = found.filter(pl.col("step") == world.last_step, pl.col("weight") == "w_normal").row(0, named=True)
        if world.extinct_step is None:
            assert last["lines"] == last["alive"] == int(tree.alive.sum())
            assert last["line_mean"] == last["living_mean"]
        else:
            assert (last["alive"], last["living_mean"]) == (0, None)
        counts = found.filter(pl.col("weight") == "w_normal")["lines"].to_numpy()
        assert (counts[:-1] <= counts[1:]).all() or world.extinct_step is not None
