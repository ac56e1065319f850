"""Tables as labeled arrays in xarray."""

from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
import pytest
from synthetic_run import write_run

from hedon.config.load import load_config
from hedon.error import ArgumentError
from hedon.experiment.plan import RunPlan
from hedon.experiment.run import run as make_run
from hedon.record import open_run, to_xarray

xarray: Any = pytest.importorskip("xarray", reason='needs the optional package: pip install "hedon[xarray]"')


def test_a_run_is_indexed_by_seed_and_step(tmp_path: Path) -> None:
    run = open_run(write_run(tmp_path / "run", intervals=6, worlds=3, extinct=1))
    found, rows = run.to_xarray(), run.population()
    assert found["alive"].dims == ("seed", "step")
    assert found["seed"].values.tolist() == [1, 2, 3]
    assert found["alive"].attrs["units"] == "1"
    for row in rows.iter_rows(named=True):
        here = found.sel(seed=row["seed"], step=row["step"])
        assert float(here["alive"]) == row["alive"]
        assert float(here["w_normal_mean"]) == pytest.approx(row["w_normal_mean"], nan_ok=True)
    assert int(np.isfinite(found["alive"].values).sum()) == rows.height


def test_a_run_of_two_species_has_them_as_a_dimension(tmp_path: Path) -> None:
    config = load_config("predator", overrides=["world.rollout_steps=64", "learning.minibatch_size=32"])
    make_run(RunPlan(config, (4,), 128, tmp_path / "run", 1))
    found = open_run(tmp_path / "run").to_xarray()
    assert found["births"].dims == ("seed", "species", "step")
    assert found["species"].values.tolist() == ["predator", "prey"]


def test_a_sweep_is_indexed_by_its_factors() -> None:
    rows = pl.DataFrame({"cost": [2.0, 1.0, 1.0], "seed": [7, 7, 8], "alive": [3, 5, None], "kind": ["a", "b", "c"]})
    found = to_xarray(rows, ["cost", "seed"])
    np.testing.assert_array_equal(found["alive"].values, [[5.0, np.nan], [3.0, np.nan]])
    assert found["kind"].fillna("none").values.tolist() == [["b", "c"], ["a", "none"]]
    assert float(found["alive"].sel(cost=2.0, seed=7)) == 3.0
    assert xarray.Dataset.from_dict(found[["alive"]].to_dict()).equals(found[["alive"]])
    with pytest.raises(ArgumentError, match="several rows have the same seed"):
        to_xarray(rows, ["seed"])
    with pytest.raises(ArgumentError, match="there is no column 'costs'"):
        to_xarray(rows, ["costs"])
