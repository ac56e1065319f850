"""Short, lively worlds for the reference model: one for each mechanism, and some in which mechanisms meet."""

from reference_case.first_paper import FIRST_PAPER
from reference_case.mechanism import MECHANISMS

CASES = FIRST_PAPER | MECHANISMS
