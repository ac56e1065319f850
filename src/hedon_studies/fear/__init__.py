"""The sequel to the paper, on prey that see predators: its claims and figures."""
