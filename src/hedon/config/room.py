"""Capacity limits of the engine. `hedon.config.header` writes them into its header."""

MAX_SPECIES = 4
"""Maximum number of species."""
MAX_FOOD_KINDS = 8
"""Maximum number of food kinds."""
MAX_OBSTACLES = 256
"""Maximum number of obstacles."""
MAX_RAYS = 32
"""Maximum number of rays per agent."""
MAX_TOUCH_BITS = 128
"""Maximum number of types times touch sectors."""
MAX_STORES = 8
"""Maximum number of stores per species, including energy."""
MAX_QUERIES = 4
"""Maximum number of neighbor queries per species."""
MAX_OBSERVED = 15
"""Maximum number of observed stores plus smells times noses, per species."""
MAX_GENES = 64
"""Maximum number of genes per genome."""
MAX_FORCE = 1e6
"""Largest force of a motor; as for all numbers, its square is finite [mass·u/s²]."""
MAX_DISTANCE = 1e6
"""Largest standard deviation of a child's place around its parent [u]."""
MAX_FACTOR = 1000.0
"""Largest factor of a schedule."""
