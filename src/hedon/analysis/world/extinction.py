"""The share of worlds that die out or lose a species."""

from collections.abc import Sequence

import numpy as np

from hedon.analysis.world.record import WorldRecord
from hedon.statistic.extinction import ExtinctShare, extinct_share


def world_extinction(worlds: Sequence[WorldRecord], until: float) -> ExtinctShare:
    """Share of worlds extinct by a step [step], over worlds of any length.

    Args:
        worlds: Worlds with the ends from their manifests.
        until: Step by which a world counts as extinct.

    Returns:
        The Kaplan–Meier share with its interval; a world that is alive at its end gives no information on later steps.
    """
    return _share(worlds, [world.extinct_step for world in worlds], until)


def species_loss(worlds: Sequence[WorldRecord], until: float) -> ExtinctShare:
    """Share of worlds that have lost a species by a step [step], the records' own or another.

    Args:
        worlds: As for `world_extinction`.
        until: Step by which the species counts as lost.

    Returns:
        The Kaplan–Meier share with its interval.
    """
    steps = [(world.extinct_step, world.apart_step) for world in worlds]
    return _share(
        worlds, [min((step for step in step_pair if step is not None), default=None) for step_pair in steps], until
    )


def _share(worlds: Sequence[WorldRecord], ends: Sequence[int | None], until: float) -> ExtinctShare:
    died = np.array([end is not None for end in ends], np.bool_)
    duration = [world.last_step if end is None else end for world, end in zip(worlds, ends, strict=True)]
    return extinct_share(np.array(duration, np.float64), died, until)
