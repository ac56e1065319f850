"""Checks whether a run's folder is complete and consistent, and what can still be used. Needs no engine."""
