"""How many worlds an experiment needs, and the note for one with fewer."""

import numpy as np
import pytest

from hedon.statistic.contrast import paired_contrast
from hedon.statistic.interval import mean_interval
from hedon.statistic.minimum import FOR_INTERVAL, FOR_PAIRS, few_seeds_note


@pytest.mark.parametrize(
    ("seeds", "compared", "note"),
    [
        (1, False, "1 seed: intervals need 5."),
        (4, False, "4 seeds: intervals need 5."),
        (5, False, ""),
        (3, True, "3 seeds per condition: intervals need 5, and differences between conditions need 6."),
        (5, True, "5 seeds per condition: differences between conditions need 6."),
        (6, True, ""),
    ],
)
def test_the_note_gives_what_few_seeds_cannot_show(seeds: int, compared: bool, note: str) -> None:
    assert few_seeds_note(seeds, compared=compared).partition(" You can")[0] == note


def test_the_numbers_in_the_note_are_those_of_the_analysis() -> None:
    for pairs in range(2, 9):
        values = np.arange(pairs, dtype=np.float64)
        # All pairs change in the same direction, which is the strongest evidence that they can give.
        contrast = paired_contrast(values, values + 1.0 + 0.1 * values)
        assert (contrast.p < 0.05) == (pairs >= FOR_PAIRS)
        assert np.isfinite(contrast.low) == (pairs >= FOR_INTERVAL)
        assert (mean_interval(values.tolist()).low is not None) == (pairs >= FOR_INTERVAL)
