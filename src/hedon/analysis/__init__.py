"""What is computed from the records of runs: of worlds, agents, descent and genes; `topic` makes tables of it."""
