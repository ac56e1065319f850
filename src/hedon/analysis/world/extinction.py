"""Which share of some worlds dies out?"""

from collections.abc import Sequence

import numpy as np

from hedon.analysis.world.record import WorldRecord
from hedon.statistic.extinction import ExtinctShare, extinct_share


def world_extinction(worlds: Sequence[WorldRecord], until: float) -> ExtinctShare:
    """The share of worlds extinct by a step [step], over worlds of any length.

    Args:
        worlds: with their manifests' ends.
        until: the step by which a world counts as extinct.

    Returns:
        The Kaplan–Meier share with its interval: a world that lives at its end tells nothing of later steps.
    """
    died = np.array([world.extinct_step is not None for world in worlds], np.bool_)
    lasted = [world.last_step if world.extinct_step is None else world.extinct_step for world in worlds]
    return extinct_share(np.array(lasted, np.float64), died, until)
