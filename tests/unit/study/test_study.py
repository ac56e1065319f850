"""The items of the studies: what they run, and that they can be made from whatever worlds exist."""

import dataclasses
from collections.abc import Mapping, Sequence

import numpy as np
import polars as pl
import pytest
from synthetic_run import write_run

from hedon.analysis.result import ResultTable
from hedon.analysis.world.record import WorldRecord, read_worlds
from hedon.config import diff, digest, load_config
from hedon.figure.named import NamedFigure
from hedon.measure import MEASURES
from hedon.measure.response import RESPONSES, at_common_age, common_age, measured
from hedon.record.reader import open_run
from hedon.report.table import cells
from hedon.study.item import Item, ItemInputs
from hedon_studies.kanagawa_doya_2024 import acting, entropy, fault, noise, released, supply
from hedon_studies.kanagawa_doya_2024.analysis.appetite import AppetiteBin, appetite, half_way_weight
from hedon_studies.kanagawa_doya_2024.analysis.fate import EXTINCT, HEADING, STANDING, fate

ITEMS = [fault.FAULTS, supply.SUPPLY, released.RELEASED, noise.NOISE, entropy.ENTROPY, acting.ACTING]


@pytest.fixture(scope="module")
def worlds(tmp_path_factory: pytest.TempPathFactory) -> list[WorldRecord]:
    """Three worlds, of which the second dies out."""
    path = tmp_path_factory.mktemp("study") / "run"
    return read_worlds([open_run(write_run(path, intervals=60, extinct=1, snapshot=False))])


def made(item: Item, worlds: Mapping[str, Sequence[WorldRecord]]) -> tuple[dict[str, ResultTable], list[NamedFigure]]:
    parts = list(item.make(ItemInputs("corrected", worlds)))
    tables = {part.name: part for part in parts if isinstance(part, ResultTable)}
    drawn = [part for part in parts if isinstance(part, NamedFigure)]
    assert len(tables) + len(drawn) == len(parts)
    return tables, drawn


@pytest.mark.parametrize("item", ITEMS, ids=lambda item: item.name)
def test_an_item_is_made_from_no_world_one_and_several(item: Item, worlds: list[WorldRecord]) -> None:
    labels = [condition.label for condition in item.conditions]
    assert len(set(labels)) == len(labels)
    tables, _ = made(item, {})
    assert any(f"Not run yet: {'; '.join(labels)}." in part.note for part in tables.values())
    cut = [world.until(30 * 1024) for world in worlds]
    cases = ((worlds[:1], False, True), (worlds[1:2], True, False), (worlds, True, True), (cut, True, True))
    for chosen, dies, breeds in cases:
        tables, drawn = made(item, dict.fromkeys(labels, chosen))
        assert drawn
        shown = [
            part
            for part in tables.values()
            if part.shown and (breeds or not part.name.endswith(("prediction", "gene")))
        ]
        assert all(part.rows.height for part in shown)
        assert any("Died out, and counted" in part.note for part in tables.values()) == dies


def test_arms_share_runs_with_other_items() -> None:
    """All faults are settings of the paper's program, and the arm without faults is the corrected baseline, whatever
    fidelity is asked for."""
    faults = {condition.label: condition.config("as_printed") for condition in fault.CONDITIONS}
    assert list(faults) == list(fault.CELLS)
    assert len({digest(config) for config in faults.values()}) == 16
    released_digest = digest(load_config("baseline", "released"))
    corrected_digest = digest(load_config("baseline", "corrected"))
    changes = diff(faults["none"], faults["all"])
    assert [path for path, _, _ in changes] == [
        "physics.solver",
        "food.normal.growth_rate",
        "world.mutation_noise",
        "learning.critic_target",
    ]
    released_has = {
        path: value for path, _, value in diff(load_config("baseline"), load_config("baseline", "released"))
    }
    assert all(released_has[path] == value for path, _, value in changes)
    assert released_digest == digest(released.CONDITIONS[0].config("as_printed"))
    assert digest(faults["none"]) == corrected_digest
    assert [digest(condition.config("as_printed")) for condition in noise.CONDITIONS] == [
        digest(faults["noise"]),
        released_digest,
        corrected_digest,
    ]
    with_bonus, without = (condition.config("as_printed") for condition in entropy.CONDITIONS)
    assert digest(with_bonus) == corrected_digest
    assert [arm.species["agent"].learning.entropy_coef for arm in (with_bonus, without)] == [0.001, 0.0]


def test_an_effect_of_growth_is_found(worlds: list[WorldRecord]) -> None:
    """In all cells, worlds with growth have twice as many agents as the same worlds without."""
    living = worlds[::2]
    doubled = [dataclasses.replace(w, population=w.population.with_columns(pl.col("agent_steps") * 2)) for w in living]
    tables, _ = made(fault.FAULTS, {label: doubled if cell[0] else living for label, cell in fault.CELLS.items()})
    rows = tables["fault_effects"].rows.filter(pl.col("measure") == "alive_mean")
    alive = np.mean([MEASURES["alive_mean"].value(world) or 0.0 for world in living])
    assert rows["effect"][0] == "growth"
    assert rows["estimate"][0] == pytest.approx(alive)
    assert rows["estimate"][1:].to_numpy() == pytest.approx(0.0, abs=1e-9)
    # A rate per step lived is halved, as a ratio.
    food = tables["fault_effects"].rows.filter(pl.col("measure") == "food_per_agent_step")
    assert (food["scale"][0], food["estimate"][0]) == ("ratio", pytest.approx(0.5))
    cells = tables["fault_cells"].rows
    assert cells["condition"].to_list() == list(fault.CELLS)
    assert cells.filter(pl.col("condition") == "growth")["alive_mean"][0] == pytest.approx(2 * alive)


def test_missing_cells_are_named(worlds: list[WorldRecord]) -> None:
    tables, _ = made(fault.FAULTS, {"none": worlds, "growth": worlds})
    assert set(tables["fault_effects"].rows["effect"]) == {"growth"}
    note = tables["fault_effects"].note
    assert "left out: noise, critic, solver," in note
    assert "estimated from some cells only: growth (of all measures)" in note


def test_an_extinct_world_counts_as_empty(worlds: list[WorldRecord]) -> None:
    assert worlds[1].end_step == 60 * 1024
    found = measured(worlds[1], at_common_age(RESPONSES, common_age(worlds)))
    assert (found["alive_mean"], found["extinct"], found["mean_energy"]) == (0.0, 1.0, None)
    assert found["mean_lifetime"] is not None
    assert found["restricted_lifetime"] is not None
    assert found["w_normal_last"] is not None
    alone = MEASURES["alive_mean"].value(worlds[1].until(worlds[1].last_step))
    assert alone is not None  # up to the end of its own records, agents lived in the last tenth
    assert 0 < alone < 50


def test_lifetimes_are_averaged_up_to_an_age_that_all_long_lives_share(worlds: list[WorldRecord]) -> None:
    common = common_age(worlds)
    assert common == common_age(worlds[::2])  # the extinct world's short lives are known in full
    assert 6000 < common <= 60 * 1024
    assert common_age([]) == 0.0


def test_the_rule_of_decline() -> None:
    def world(alive: Sequence[int], extinct: int | None = None) -> WorldRecord:
        steps = np.arange(1, len(alive) + 1) * 1000
        rows = {"step": steps, "steps": [1000] * len(alive), "agent_steps": np.array(alive) * 1000}
        names = (("normal",), ("w_normal", "w_action"), ())
        config = load_config("baseline")
        return WorldRecord("c", "r", 1, config, *names, pl.DataFrame(), pl.DataFrame(rows), int(steps[-1]), extinct)

    assert fate(world([50, 150, *[100] * 7, 75])).fate == STANDING  # a half is not less than a half
    found = fate(world([50, 150, *[100] * 7, 74]))
    assert (found.fate, found.early, found.late, found.kept) == (HEADING, 150.0, 74.0, pytest.approx(74 / 150))
    assert fate(world([50, 150, *[100] * 7, 200], extinct=10_000)).fate == EXTINCT
    risen = fate(world([50, 150, 100, 70, 70, *[100] * 5]))
    assert (risen.fate, risen.recovered) == (STANDING, True)
    assert not fate(world([50, 150, *[100] * 8])).recovered  # the first tenth, with the founders, is no low
    assert not fate(world([50])).is_lost


def test_survivors_are_distinguished_from_all_worlds(worlds: list[WorldRecord]) -> None:
    tables, _ = made(released.RELEASED, {"released": worlds})
    fates = {row["fate"]: row["count"] for row in tables["released_fate"].rows.iter_rows(named=True)}
    assert fates["extinct"] == 1
    assert fates["extinct or heading for it"] == 1
    headers, _ = cells(tables["released_fate"])
    assert "95 % interval" not in headers, "a share of three worlds has none"
    rows = tables["released_survivors"].rows.filter(pl.col("measure") == "alive_mean")
    assert rows["worlds"].to_list() == [3, 2, 2]
    assert rows["mean"][0] == pytest.approx(rows["mean"][1] * 2 / 3)
    assert rows["low"].null_count() == 3, "so few worlds show no interval"
    assert "bias_w_normal" in tables["released_worlds"].rows.columns


def test_appetite_by_weight(worlds: list[WorldRecord]) -> None:
    lives = pl.DataFrame(
        {
            "world": 0,
            "agent_id": range(60),
            "birth_step": 0,
            "death_step": [5120] * 40 + [5119] * 20,  # the last twenty did not live through five windows
            "w_normal": [-0.5] * 20 + [2.0] * 40,
            "eaten_normal": [1] * 20 + [10] * 40,
        }
    )
    found = appetite(dataclasses.replace(worlds[0], agents=lives))
    assert [(b.low, b.high, b.agents, b.steps) for b in found] == [
        (-1.0, -0.3, 20, 20 * 5120),
        (1.0, 3.0, 20, 20 * 5120),
    ]
    assert [b.eaten for b in found] == pytest.approx([1000 / 5120, 10_000 / 5120])
    # The rate halfway between those of two bins is at the weight halfway between theirs.
    assert half_way_weight(found) == pytest.approx(0.75)


def test_the_half_way_weight() -> None:
    def bins(*rates: float) -> list[AppetiteBin]:
        weights = (-1.0, 0.5, 2.0, 5.0)
        return [AppetiteBin(w - 0.5, w + 0.5, 100, w, 1000, rate) for w, rate in zip(weights, rates, strict=False)]

    assert half_way_weight(bins(1.0, 1.0, 3.0, 2.5)) == pytest.approx(1.25)  # at 2, halfway to the best, 3
    assert half_way_weight(bins(1.0, 2.5, 1.5, 3.0)) == pytest.approx(3.0)  # a dip counts: they eat well from then on
    assert half_way_weight(bins(2.0, 1.0)) is None
    assert half_way_weight(bins(2.0)) is None
    assert half_way_weight([]) is None


def test_entropy_is_compared_seed_by_seed(worlds: list[WorldRecord]) -> None:
    living = worlds[::2]
    halved = [
        dataclasses.replace(w, population=w.population.with_columns(pl.col("agent_steps") * 2))
        for w in reversed(living)
    ]
    tables, _ = made(entropy.ENTROPY, {entropy.WITH: living, entropy.WITHOUT: halved})
    rows = {row["measure"]: row for row in tables["entropy"].rows.iter_rows(named=True)}
    food = rows["food_per_agent_step"]
    assert (food["change"], food["change_low"], food["change_high"]) == pytest.approx((0.5, 0.5, 0.5))
    assert (food["seeds"], food["low"], food["scale"]) == (2, None, "ratio")
    assert rows["w_normal_last"]["change"] == 0.0


def test_acting_is_compared_seed_by_seed(worlds: list[WorldRecord]) -> None:
    doubled = [dataclasses.replace(w, population=w.population.with_columns(pl.col("agent_steps") * 2)) for w in worlds]
    tables, drawn = made(acting.ACTING, {acting.FULL: worlds, acting.HALF: doubled})
    assert [figure.name for figure in drawn] == ["acting_courses"]
    rows = {row["measure"]: row for row in tables["acting"].rows.iter_rows(named=True)}
    assert rows["food_per_agent_step"]["change"] == pytest.approx(0.5)
    assert rows["mean_lifetime"]["change"] == pytest.approx(1.0)
    assert rows["mean_lifetime"]["low"] is None, "three seeds have no interval"
    precisions = [
        condition.config("as_printed").species["agent"].learning.acting_weights for condition in acting.CONDITIONS
    ]
    assert precisions == [acting.FULL, acting.HALF]


def test_courses_of_unequal_length_share_one_axis(worlds: list[WorldRecord]) -> None:
    short = [world.until(1024) for world in worlds]  # on their own, these would be drawn in steps, not in thousands
    _, drawn = made(acting.ACTING, {acting.FULL: worlds, acting.HALF: short})
    assert drawn[0].figure.axes
    for axes in drawn[0].figure.axes:
        ends = [float(np.max(line.get_xdata())) for line in axes.lines]
        assert max(ends) <= axes.get_xlim()[1] < 100
        assert min(ends) < 5


def test_one_seed_of_each_arm_may_be_missing(worlds: list[WorldRecord]) -> None:
    tables, _ = made(entropy.ENTROPY, {entropy.WITH: worlds[:1], entropy.WITHOUT: worlds[2:]})
    assert tables["entropy"].rows["seeds"].to_list()[0] == 0
    assert tables["entropy"].rows["change"].null_count() == tables["entropy"].rows.height
