"""The table behind tabulated noise and what it predicts, on records whose table is known."""

import dataclasses

import numpy as np
import polars as pl
import pytest

from hedon.analysis.world.record import WorldRecord
from hedon.config import load_config
from hedon_studies.kanagawa_doya_2024.analysis.bias import compare, gene_drift
from hedon_studies.kanagawa_doya_2024.analysis.noise import mutations, noise_table

WINDOW = 1024
GENE = "neutral_1"
PER_WINDOW = 24  # the most births in a window


def make_world(
    table: np.ndarray | None,
    rng: np.random.Generator,
    *,
    windows: int = 120,
    seed: int = 1,
    limit: float = 10.0,
    steady: bool = False,
) -> WorldRecord:
    """A world of 40 agents without selection. Its noise is from the table, by (births in the window, index of the
    birth), or independent if there is no table. If steady, all windows have almost equally many births, so the table
    is small."""
    config = load_config("baseline", "released" if table is not None else "corrected")
    config = config.with_("genome.weight_limit", limit)
    weight = rng.normal(0, 0.1, 40).astype(np.float32).tolist()
    generation, birth, parents = [0] * 40, [0] * 40, [-1] * 40
    living, rows = list(range(40)), []
    for window in range(windows):
        count = int(rng.integers(PER_WINDOW - 1 if steady else PER_WINDOW // 2, PER_WINDOW + 1))
        steps = np.sort(rng.integers(1, WINDOW + 1, count))
        for number, step in enumerate(steps):
            parent = living[int(rng.integers(40))]
            noise = 0.02 * rng.standard_cauchy() if table is None else table[count, number]
            child = np.float32(np.float32(weight[parent]) + np.float32(noise))
            weight.append(float(np.clip(child, -np.float32(limit), np.float32(limit))))
            generation.append(generation[parent] + 1)
            birth.append(window * WINDOW + int(step))
            parents.append(parent)
            living[int(rng.integers(40))] = len(weight) - 1
        mean = (np.mean([values[i] for i in living]) for values in (weight, generation))
        rows.append(dict(zip((f"{GENE}_mean", "generation_mean"), mean, strict=True)))
    agents = pl.DataFrame(
        {"agent_id": range(len(weight)), "parent_id": [p if p >= 0 else None for p in parents], "birth_step": birth}
        | {"generation": generation, "world": [0] * len(weight), "death_step": [None] * len(weight)}
        | {GENE: pl.Series(weight, dtype=pl.Float32)}
    )
    population = pl.DataFrame(rows).with_columns(step=pl.int_range(1, windows + 1) * WINDOW)
    names = (("normal",), ("w_normal", "w_action"), (GENE,))
    return WorldRecord("c", "run", seed, config, *names, agents, population, windows * WINDOW, None)


def make_table(rng: np.random.Generator) -> np.ndarray:
    return np.clip(0.02 * rng.standard_cauchy((PER_WINDOW + 1, PER_WINDOW)), -1.0, 1.0)


def entries(world: WorldRecord) -> tuple[np.ndarray, np.ndarray]:
    """The table entries that the births of a world used: births in the window and index, in order."""
    birth = world.agents.filter(pl.col("parent_id").is_not_null())["birth_step"].to_numpy()
    counts = np.unique(np.bincount((birth - 1) // WINDOW))
    return np.repeat(counts, counts), np.concatenate([np.arange(count) for count in counts])


def test_the_table_is_read_off_the_records() -> None:
    rng = np.random.default_rng(1)
    table = make_table(rng)
    world = make_world(table, rng)
    found = noise_table(mutations(world, GENE))
    assert found.value == pytest.approx(table[entries(world)], abs=2e-6)
    assert found.is_one
    assert 0 < found.disagreement < 2e-6
    assert not found.bound.any()
    # All entries for windows with the same number of births are based on equally many births.
    births, index = entries(world)
    assert [len(set(found.births[births == count])) for count in np.unique(births)] == [1] * len(np.unique(births))
    assert found.births[index == 0].sum() == 120


def test_clipped_children_do_not_hide_the_table() -> None:
    """Weights are pushed to a narrow limit: clipped births show less than the table and are not used."""
    rng = np.random.default_rng(2)
    table = make_table(rng)
    table[:, 3], table[:, 5] = 0.4, -2.5  # the latter is always clipped
    world = make_world(table, rng, limit=1.0, steady=True)
    mutated = mutations(world, GENE)
    assert mutated.clipped.mean() > 0.1
    found = noise_table(mutated)
    births, index = entries(world)
    free = index != 5
    assert found.value[free] == pytest.approx(table[births, index][free], abs=2e-6)
    assert found.is_one
    assert (found.bound == ~free).all()
    assert (found.value[~free] >= -2.0).all()
    assert (found.value[~free] < -0.5).all()  # bounds, of the right sign


def test_independent_noise_has_no_table() -> None:
    rng = np.random.default_rng(3)
    found = noise_table(mutations(make_world(None, rng), GENE))
    assert not found.is_one
    assert found.disagreement > 0.1


def test_births_after_a_gap_have_no_number() -> None:
    rng = np.random.default_rng(4)
    table = make_table(rng)
    world = make_world(table, rng)
    holed = dataclasses.replace(world, agents=world.agents.filter(pl.col("agent_id") != 300))
    found = mutations(holed, GENE)
    assert len(found.change) == 300 - 40
    assert noise_table(found).is_one
    none = dataclasses.replace(world, agents=world.agents.filter(pl.col("parent_id").is_null()))
    assert gene_drift(none, GENE, rng) is None


def test_frozen_noise_predicts_where_a_gene_without_selection_drifts() -> None:
    rng = np.random.default_rng(5)
    # All rows are alike, so both halves of a run share much of their noise.
    rows = [np.clip(make_table(rng)[0], -0.3, 0.3) for _ in range(10)]
    worlds = [make_world(np.tile(row, (PER_WINDOW + 1, 1)), rng, windows=600, seed=i) for i, row in enumerate(rows)]
    drifts = [gene_drift(world, GENE, rng) for world in worlds]
    known = [drift for drift in drifts if drift is not None]
    assert len(known) == 10
    for comparison in ("drift per generation", "bias, first half and second"):
        found = compare(known, comparison)
        assert found["correlation"] > 0.9, (comparison, found)
        assert found["low"] < found["slope"] < found["high"]
        assert found["slope"] == pytest.approx(1.0, abs=0.35)
    end = compare(known, "weight at the end")
    assert end["correlation"] > 0.9
    assert end["slope"] == pytest.approx(1.0, abs=0.35)
    assert sum(d["line_low"] <= d["end"] <= d["line_high"] for d in known) >= 8


def test_lines_stop_at_the_limit() -> None:
    rng = np.random.default_rng(6)
    world = make_world(np.full((PER_WINDOW + 1, PER_WINDOW), 0.1), rng, limit=1.0)
    found = gene_drift(world, GENE, rng)
    assert found is not None
    assert found["generations"] > 20  # enough for twice the limit
    assert found["line_mean"] == found["line_high"] == 1.0
    assert found["end"] == pytest.approx(1.0, abs=0.6)
    assert found["displacement"] < 0.05 < found["bias"]  # the limit hides the bias from the drift per generation


def test_independent_noise_predicts_nothing() -> None:
    rng = np.random.default_rng(7)
    drifts = [gene_drift(make_world(None, rng, seed=seed), GENE, rng) for seed in range(12)]
    found = compare([drift for drift in drifts if drift is not None], "bias, first half and second")
    assert abs(found["rank_correlation"]) < 0.6
    assert 2 <= found["same_sign"] <= 10
