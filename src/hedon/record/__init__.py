"""The files of a run: tables, manifest, checkpoints and last state; writing and reading them."""
