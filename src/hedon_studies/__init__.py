"""Studies written with hedon: the paper of 2024, its sequel, claims of other authors, and our own questions."""
