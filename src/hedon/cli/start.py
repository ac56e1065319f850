"""Entry point of the command `hedon`: it imports almost nothing, so that Ctrl-C works during all later imports."""

import gc
import sys

OBJECTS_BEFORE_COLLECTION = 100_000
"""Imports and figures create many objects that live on; looking for garbage among them took 8 % of a report."""


def main() -> None:
    """Runs the command line; Ctrl-C before it has started exits with code 130, without a traceback."""
    gc.set_threshold(OBJECTS_BEFORE_COLLECTION)
    try:
        from hedon.cli.main import main as run_command

        run_command()
    except KeyboardInterrupt:
        sys.stderr.write("hedon: interrupted\n")
        sys.exit(130)  # 128 plus the number of SIGINT, as in shells
