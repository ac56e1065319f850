"""What a run leaves behind: tables, manifest and last state, how they are written and how they are read."""
