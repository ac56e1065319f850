"""Topics of `hedon analyze`: each turns the worlds of some runs into tables."""
