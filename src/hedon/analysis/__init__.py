"""From tables to numbers to figures: one question per file, functions first."""
