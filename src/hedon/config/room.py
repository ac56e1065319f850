"""What the engine has room for. `hedon.config.header` tells the engine these numbers."""

MAX_SPECIES = 4
"""Most species."""
MAX_FOOD_KINDS = 8
"""Most kinds of food."""
MAX_OBSTACLES = 256
"""Most obstacles."""
MAX_RAYS = 32
"""Most rays of an agent."""
MAX_TOUCH_BITS = 128
"""Most types times touch sectors."""
MAX_STORES = 8
"""Most stores of a species, energy among them."""
MAX_QUERIES = 4
"""Most queries of a species about its neighbors."""
MAX_OBSERVED = 15
"""Most that a species observes of its stores, and of smells times noses, together."""
MAX_GENES = 64
"""Most genes of a genome."""
MAX_FORCE = 1e6
"""Largest force of a motor, as for all numbers: squares of it are finite [mass·u/s²]."""
MAX_DISTANCE = 1e6
"""Largest standard deviation of a child's place around its parent [u]."""
MAX_FACTOR = 1000.0
"""Largest factor of a schedule."""
