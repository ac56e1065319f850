"""The questions that `hedon analyze` answers: each topic turns the worlds of some runs into tables."""
