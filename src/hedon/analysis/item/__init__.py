"""The paper's figures and tables by name, and the studies of what it leaves open; one file per kind of item."""
