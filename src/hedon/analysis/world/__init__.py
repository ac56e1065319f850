"""Whole worlds: their records, numbers, energy, regimes and extinctions."""
