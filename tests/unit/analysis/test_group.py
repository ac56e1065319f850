"""Groups and distances against closed forms."""

import numpy as np
import polars as pl
import pytest
from synthetic_run import write_run

from hedon.analysis.world.group import MOST, company, group_sizes, nearest
from hedon.analysis.world.record import WorldRecord, read_worlds
from hedon.record.reader import open_run


@pytest.fixture(scope="module")
def world(tmp_path_factory: pytest.TempPathFactory) -> WorldRecord:
    folder = tmp_path_factory.mktemp("group") / "run"
    return read_worlds([open_run(write_run(folder, intervals=2, snapshot=False))])[0]


def frame(step: int, kind: str, places: list[tuple[float, float]]) -> pl.DataFrame:
    x, y = zip(*places, strict=True)
    return pl.DataFrame({"step": [step] * len(x), "kind": [kind] * len(x), "id": range(len(x)), "x": x, "y": y})


def test_a_chain_is_one_group_and_a_gap_ends_it() -> None:
    chain = [(100.0 + 25 * i, 50.0) for i in range(5)] + [(231.0, 50.0), (500.0, 500.0), (500.0, 529.0)]
    assert group_sizes(np.array(chain), 30).tolist() == [5, 5, 5, 5, 5, 1, 2, 2]
    assert group_sizes(np.array(chain), 31).tolist() == [6, 6, 6, 6, 6, 6, 2, 2]
    assert group_sizes(np.array([[3.0, 4.0]])).tolist() == [1]


def test_the_nearest_of_others() -> None:
    assert nearest(np.array([[0.0, 0.0], [9.0, 0.0]]), np.array([[3.0, 4.0], [9.0, 2.0]])).tolist() == [5.0, 2.0]


def test_company_is_measured_per_frame_and_chance_is_from_uniform_places(world: WorldRecord) -> None:
    side, height = world.config.arena.width, world.config.arena.height
    agents = [(side / 2 + 10 * i, side / 2) for i in range(20)]
    frames = pl.concat(
        [frame(step, "agent", agents) for step in range(1, 301)]
        + [frame(step, "hunter", [(side / 2 - 30, side / 2)]) for step in range(1, 201)]
        + [frame(step, "food", [(side / 2 + 5, side / 2)]) for step in range(1, 301)]
    )
    found = company(world, frames.lazy(), ["hunter"])
    assert found["alive"].to_list() == [20] * 300
    assert (found["group"] == 20).all()
    assert found["distance"].to_list() == [pytest.approx(125.0)] * 200 + [None] * 100
    grid = np.stack(np.meshgrid((np.arange(200) + 0.5) * side / 200, (np.arange(200) + 0.5) * height / 200), -1)
    even = np.hypot(grid[..., 0] - (side / 2 - 30), grid[..., 1] - side / 2).mean()
    assert found["distance_chance"].to_numpy()[:200].mean() == pytest.approx(even, rel=0.02)
    # With 20 agents in such an arena, neighbors within 30 u are rare: 19 π 30² / area; groups of three add a few.
    rare = 19 * np.pi * 900 / (side * height)
    assert 1 + 0.85 * rare < found["group_chance"].to_numpy().mean() < 1 + rare + 2 * rare**2


def test_long_records_are_read_in_part_and_empty_ones_give_nothing(world: WorldRecord) -> None:
    frames = pl.concat([frame(step, "agent", [(1.0, 1.0)]) for step in range(1, 2 * MOST)])
    found = company(world, frames.lazy(), [])
    assert len(found) == MOST
    assert (found["step"][0], found["step"][-1]) == (1, 2 * MOST - 1)
    assert found["distance"].null_count() == MOST
    assert company(world, frames.head(0).lazy(), ["hunter"]).is_empty()
