"""Studies written with hedon: a paper of 2024 again, and its sequel on predators and prey."""
