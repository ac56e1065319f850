"""Studies: what is claimed, the worlds that this needs, and what they say."""
