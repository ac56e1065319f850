"""Studies of what the paper leaves open, one question per file."""
