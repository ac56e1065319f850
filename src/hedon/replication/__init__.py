"""The paper again: what it reports and claims, its figures and tables, our studies of it, and the runs for all that."""
