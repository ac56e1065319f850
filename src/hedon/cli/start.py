"""Entry point of the command `hedon`: it imports almost nothing, so that Ctrl-C works during all later imports."""

import sys


def main() -> None:
    """Runs the command line; Ctrl-C before it has started exits with code 130, without a traceback."""
    try:
        from hedon.cli.main import main as run_command

        run_command()
    except KeyboardInterrupt:
        sys.stderr.write("hedon: interrupted\n")
        sys.exit(130)  # 128 plus the number of SIGINT, as in shells
