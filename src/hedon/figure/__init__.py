"""Pictures: one question per file, drawn from numbers that are there. Nothing is computed here but what is drawn."""
