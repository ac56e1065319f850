"""How often are hedon's numbers wrong? Simulated data of which the truth is known, for each number."""
