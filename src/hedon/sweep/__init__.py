"""Sweeps: many settings and seeds, on one machine or on many, and one table of what came out."""
