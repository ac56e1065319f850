from .life import birth_rate as birth_rate
from .life import cumulative_hazard as cumulative_hazard
from .life import expected_lifetime as expected_lifetime
from .life import reproduction_number as reproduction_number
