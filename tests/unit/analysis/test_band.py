"""Each gene has its own drift band, from its own founders and mutations."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import polars as pl
import pytest
from synthetic_run import write_run

from hedon import load_config
from hedon.analysis.gene.band import drift_bands, drift_genes
from hedon.analysis.gene.drift import standard_drift
from hedon.analysis.gene.weight import last_living
from hedon.analysis.world.record import WorldRecord, read_worlds
from hedon.experiment.plan import RunPlan
from hedon.experiment.run import run
from hedon.record.reader import open_run

MOVED = "reward.pay.moved={coef=0.01, gene={initial_mean=1.0, initial_sd=0.05}}"
TINY = ("population.initial_count=60", "population.capacity=100", 'learning.policy="random"')


@pytest.fixture(scope="module")
def worlds(tmp_path_factory: pytest.TempPathFactory) -> list[WorldRecord]:
    folder = tmp_path_factory.mktemp("band") / "run"
    options = {"intervals": 40, "worlds": 4, "neutral_count": 8, "selection": 0.0, "capacity": 50}
    return read_worlds([open_run(write_run(folder, snapshot=False, **options))])


def changed(worlds: list[WorldRecord], *overrides: str) -> list[WorldRecord]:
    """The same records with another config."""
    return [replace(world, config=load_config("baseline", overrides=list(overrides))) for world in worlds]


def at_end(worlds: list[WorldRecord], weight: str) -> tuple[float, float]:
    band = drift_bands(worlds)[weight]
    return float(band.low[-1]), float(band.high[-1])


def test_a_gene_that_starts_elsewhere_has_its_band_there(tmp_path: Path) -> None:
    """The gene of `moved` starts at 1.0 ± 0.05; its founders' means differ by 0.05/√60, not by 0.5/√60 around 0."""
    config = load_config("appetite", overrides=[MOVED, *TINY])
    run(RunPlan(config, (1,), 1536, tmp_path / "run", 1))
    (world,) = read_worlds([open_run(tmp_path / "run")])
    bands = drift_bands([world])
    moved, food = bands["w_moved"], bands["w_normal"]
    assert (moved.low < 1.0).all()
    assert (moved.high > 1.0).all()
    width = moved.high - moved.low
    assert width[0] == pytest.approx(2 * 1.96 * 0.05 / np.sqrt(60), rel=0.15)
    assert (food.high - food.low)[0] == pytest.approx(2 * 1.96 * 0.5 / np.sqrt(60), rel=0.15)
    (said,) = (drift for drift in standard_drift(world) if drift.weight == "w_moved")
    assert (moved.low[-1], moved.high[-1]) == pytest.approx((said.null_low, said.null_high), abs=0.02)
    genes = drift_genes([world], [last_living(world.agents, world.population)])
    assert np.mean(genes["w_moved"]) == pytest.approx(1.0, abs=0.02)
    assert np.std(genes["w_moved"]) < 0.3 * np.std(genes["w_normal"])


def test_a_gene_with_identical_founders_shows_selection_that_neutral_genes_would_hide(
    worlds: list[WorldRecord],
) -> None:
    alike = changed(worlds, "food.normal.gene.initial_sd=0.0", "genome.mutation.w_normal={scale=0.001}")
    low, high = at_end(alike, "w_normal")
    wide_low, wide_high = at_end(alike, "neutral_1")
    assert wide_low < -0.1 < low < 0.0 < high < 0.1 < wide_high


@pytest.mark.parametrize(
    ("override", "narrower"),
    [
        ("genome.mutation.w_normal={probability=0.1}", True),
        ('genome.mutation.w_normal={law="normal"}', True),
        ("genome.mutation.w_normal={limit=0.05}", True),
        ("genome.mutation.w_normal={scale=0.2}", False),
        ("food.normal.gene.initial_sd=2.0", False),
    ],
)
def test_a_band_follows_the_law_of_its_gene(worlds: list[WorldRecord], override: str, narrower: bool) -> None:
    other = changed(worlds, override)
    widths = {name: np.ptp(at_end(other, name)) for name in ("w_normal", "w_action")}
    assert (widths["w_normal"] < 0.8 * widths["w_action"]) == narrower
    assert (widths["w_normal"] > 1.3 * widths["w_action"]) != narrower


def test_recorded_neutral_genes_stay_in_their_band(worlds: list[WorldRecord]) -> None:
    band = drift_bands(worlds)["neutral_1"]
    times = np.searchsorted(band.step, 1024.0 * np.array([10, 20, 40]) - 1.0)
    inside = []
    for world in worlds:
        rows = world.population.filter(pl.col("step").is_in([10_240, 20_480, 40_960]))
        for name in world.neutral_names:
            values = rows[f"{name}_mean"].to_numpy()
            inside += list((values >= band.low[times]) & (values <= band.high[times]))
    assert 0.85 < np.mean(inside) <= 1.0  # 95 % of 32 genes at three times


def test_without_walks_recorded_neutral_genes_are_a_control_only_for_genes_of_the_same_law(
    worlds: list[WorldRecord],
) -> None:
    pairs = changed(worlds, 'birth.mating="pairs"', "genome.action.initial_mean=1.0")
    bands = drift_bands(pairs)
    assert "w_normal" in bands
    assert "w_action" not in bands
    rows = pl.concat(world.population for world in worlds).filter(pl.col("step") == worlds[0].last_step)
    expected = np.quantile(rows.select("^neutral_.*_mean$").to_numpy(), (0.025, 0.975))
    assert (bands["w_normal"].low[-1], bands["w_normal"].high[-1]) == pytest.approx(expected, rel=1e-5)
    genes = drift_genes(pairs, [last_living(world.agents, world.population) for world in pairs])
    assert "w_normal" in genes
    assert "w_action" not in genes
    assert drift_bands([replace(world, neutral_names=world.neutral_names[:1]) for world in pairs]) == {}
