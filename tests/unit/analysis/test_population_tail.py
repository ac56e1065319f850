"""The last tenth of a world that died out."""

import polars as pl
import pytest

from hedon.analysis.world.population import alive_after_extinction


def _population(ends: list[int], alive: int) -> pl.DataFrame:
    return pl.DataFrame({"species": "agent", "step": ends, "steps": 100, "agent_steps": [100 * alive] * len(ends)})


def test_steps_after_the_last_agent_count_as_empty():
    lived = _population([100, 200, 300, 400, 500, 600, 700, 800, 900, 950], alive=10)
    assert alive_after_extinction(lived, 1000) == pytest.approx(10.0)
    assert alive_after_extinction(_population([100, 200], alive=10), 1000) == 0.0


def test_a_branch_that_starts_within_the_last_tenth_is_averaged_from_its_start():
    assert alive_after_extinction(_population([1000], alive=10), 1000) == pytest.approx(10.0)
    assert alive_after_extinction(_population([9700, 9800], alive=10), 10_000) == pytest.approx(10.0 * 200 / 400)
