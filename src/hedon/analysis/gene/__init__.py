"""The evolved weights: where they stand, what selects them, and what drift alone explains."""
