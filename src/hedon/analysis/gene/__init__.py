"""Evolved weights: their values, the selection on them, and what drift can explain."""
