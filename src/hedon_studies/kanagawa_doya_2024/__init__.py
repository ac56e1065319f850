"""The paper again: what it reports and claims, its figures and tables, and our studies of what it leaves open."""
