"""Whether a run's folder holds what it says, and what of it can still be used. Needs no engine."""
