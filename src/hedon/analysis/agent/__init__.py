"""Single agents: their lifetimes, food and children."""
