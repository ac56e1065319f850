import dataclasses
from collections.abc import Sequence

import numpy as np
import pytest
from synthetic_run import write_run

from hedon.analysis.result import ResultTable
from hedon.analysis.world.extinction import world_extinction
from hedon.analysis.world.record import WorldRecord, read_worlds
from hedon.config import digest, load_config
from hedon.record.reader import open_run
from hedon.statistic.contrast import fisher_mid_p
from hedon.study.item import ItemInputs
from hedon_studies.kanagawa_doya_2024.extinction import CONDITIONS, EXTINCTIONS
from hedon_studies.kanagawa_doya_2024.paper import EXTINCTION, EXTINCTION_STEP

ITEM = EXTINCTIONS
OWN, DEAR = "0.001, 2e-5", "0.002, 2e-5"


@pytest.fixture(scope="module")
def ten(tmp_path_factory: pytest.TempPathFactory) -> list[WorldRecord]:
    """Ten worlds of 50 intervals, of which the first died out."""
    folder = tmp_path_factory.mktemp("extinction") / "run"
    worlds = read_worlds([open_run(write_run(folder, worlds=10, intervals=50, extinct=0, snapshot=False))])
    assert [world.seed for world in worlds if world.extinct_step is not None] == [1]
    return worlds


def make(worlds: dict[str, Sequence[WorldRecord]]) -> tuple[ResultTable, ResultTable]:
    first, second = ITEM.make(ItemInputs("corrected", worlds))
    assert isinstance(first, ResultTable)
    assert isinstance(second, ResultTable)
    return first, second


def died(worlds: Sequence[WorldRecord], *steps: int) -> list[WorldRecord]:
    """The same worlds, the first of them extinct at these steps."""
    gone = [dataclasses.replace(w, last_step=s, extinct_step=s) for w, s in zip(worlds, steps, strict=False)]
    return [*gone, *worlds[len(steps) :]]


def test_the_arms_are_the_papers_settings() -> None:
    energies = [condition.config("corrected").species["agent"].energy for condition in CONDITIONS]
    costs = [(energy.basic_cost, energy.action_cost) for energy in energies]
    assert dict(zip(costs, CONDITIONS.values(), strict=True)) == EXTINCTION
    assert [condition.label for condition in ITEM.conditions] == [
        DEAR,
        "0.0015, 2e-5",
        "0.001, 4e-5",
        "0.001, 3e-5",
        OWN,
    ]
    assert (ITEM.scale.seeds, ITEM.scale.steps) == (tuple(range(1, 11)), EXTINCTION_STEP)


@pytest.mark.parametrize("fidelity", ["corrected", "released"])
def test_the_arm_of_the_baseline_shares_its_runs(fidelity: str) -> None:
    digests = {condition.label: digest(condition.config(fidelity)) for condition in CONDITIONS}
    assert digests[OWN] == digest(load_config("baseline", fidelity))
    assert len(set(digests.values())) == len(CONDITIONS)


def test_the_share_of_extinct_worlds_with_its_interval(ten: list[WorldRecord]) -> None:
    found, by_world = make({OWN: ten[1:], DEAR: died(ten, 1024, 5120, 3072)})
    dear, own = found.rows.rows(named=True)  # in the paper's order
    assert (dear["costs"], dear["extinct"], dear["worlds"], round(dear["share"], 9)) == (DEAR, 3, 10, 0.3)
    share = world_extinction(died(ten, 1024, 5120, 3072), 50 * 1024)
    assert (dear["low"], dear["high"]) == (share.low, share.high)
    assert 0.07 < share.low < 0.1 < 0.6 < share.high < 0.65  # three of ten
    assert dear["p_paper"] is None  # not known up to the paper's step
    assert (dear["paper"], own["paper"]) == (0.9, 0.0)
    assert (own["extinct"], own["share"], own["by_step"]) == (0, 0.0, 50 * 1024)
    assert (dear["median_step"], own["median_step"]) == (None, None)
    tail = [world.population.filter(world.population["step"] > 45 * 1024) for world in ten[1:]]
    alive = [t["agent_steps"].to_numpy().sum() / t["steps"].to_numpy().sum() for t in tail]
    energy = [float(np.average(t["energy_mean"].to_numpy(), weights=t["alive"].to_numpy())) for t in tail]
    assert own["alive"] == pytest.approx(np.mean(alive))
    assert own["energy"] == pytest.approx(np.mean(energy), rel=1e-5)
    assert by_world.rows.height == 19
    assert by_world.rows.filter(by_world.rows["costs"] == DEAR)["extinct_step"].to_list()[:4] == [
        1024,
        5120,
        3072,
        None,
    ]
    assert not by_world.shown


def test_the_median_step_counts_survivors(ten: list[WorldRecord]) -> None:
    steps = (1024, 2048, 3072, 4096, 5120)
    half = make({DEAR: died(ten, *steps)})[0].rows.row(0, named=True)
    assert half["median_step"] == 5120  # half of all ten worlds, not of the five that died
    assert half["share"] == pytest.approx(0.5)


def test_a_world_that_dies_out_after_the_papers_step_counts_as_alive(ten: list[WorldRecord]) -> None:
    late = [dataclasses.replace(w, last_step=2 * EXTINCTION_STEP, extinct_step=EXTINCTION_STEP + 1024) for w in ten]
    row = make({OWN: late})[0].rows.row(0, named=True)
    assert (row["extinct"], row["by_step"], row["median_step"]) == (0, EXTINCTION_STEP, None)
    assert row["alive"] is not None


def test_worlds_of_unequal_length_are_censored_where_they_end(ten: list[WorldRecord]) -> None:
    worlds = [ten[1].until(10_240), *died(ten[2:], 20_480)]
    row = make({OWN: worlds})[0].rows.row(0, named=True)
    assert (row["extinct"], row["worlds"], row["by_step"]) == (1, 9, 50 * 1024)
    assert row["share"] == pytest.approx(1 / 8)  # one of the eight at risk then


def test_the_papers_shares_are_compared_as_counts_of_ten(ten: list[WorldRecord]) -> None:
    late = [dataclasses.replace(w, last_step=2 * EXTINCTION_STEP, extinct_step=None) for w in ten]
    rows = make({OWN: late, DEAR: late})[0].rows
    assert dict(zip(rows["costs"], rows["p_paper"], strict=True)) == {
        DEAR: pytest.approx(fisher_mid_p(0, 10, 9, 10)),
        OWN: 0.5,  # none of ten in both: the only possible table, counted half
    }


def test_if_all_died_out_the_share_is_known_at_the_papers_step(ten: list[WorldRecord]) -> None:
    row = make({DEAR: ten[:1]})[0].rows.row(0, named=True)
    assert (row["share"], row["worlds"], row["by_step"]) == (1.0, 1, EXTINCTION_STEP)
    assert row["median_step"] == ten[0].extinct_step
    assert row["alive"] is None


def test_arms_without_worlds_are_named(ten: list[WorldRecord]) -> None:
    found, _ = make({OWN: ten[:2]})
    assert found.note.endswith("Not run yet: 0.002, 2e-5; 0.0015, 2e-5; 0.001, 4e-5; 0.001, 3e-5.")
    nothing, by_world = make({})
    assert nothing.rows.is_empty()
    assert by_world.rows.is_empty()
