"""Whatever mechanisms and species meet in a world, every door takes it.

Worlds are drawn so that every pair of mechanisms meets at least once. HEDON_WORLDS=N tries N worlds instead of the few
of the suite, HEDON_RECORDED=N takes N of them through the doors of records too, and HEDON_WORLD=I tries the I-th alone.
"""

import os
import random
import tempfile
from collections import Counter
from itertools import islice
from pathlib import Path

import pytest
from mechanism import Mixture, mechanisms, possible_pairs, worlds
from world_door import CHEAP, RECORDED, Trial, doors, drive_from_outside

from hedon.experiment.rule import Rule

pytest.importorskip("numba", reason='needs the optional package: pip install "hedon[rules]"')

SEED = 1
SIZE = 12
"""Mechanisms of a world."""
WORLDS = int(os.environ.get("HEDON_WORLDS", "0"))
RECORDED_WORLDS = int(os.environ.get("HEDON_RECORDED", "6"))
ONLY = os.environ.get("HEDON_WORLD")
REPORTS = 10
"""One of so many recorded worlds gets a whole report with figures."""
SHOWN = 3
"""Failures that are told in full."""
