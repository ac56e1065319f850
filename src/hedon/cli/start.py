"""The first lines of the command `hedon`: they load almost nothing, so that Ctrl-C works during all later imports."""

import sys


def main() -> None:
    """Runs the command line; Ctrl-C before it has begun ends it without a traceback, with exit code 130."""
    try:
        from hedon.cli.main import main as run_command

        run_command()
    except KeyboardInterrupt:
        sys.stderr.write("hedon: interrupted\n")
        sys.exit(130)  # 128 plus the number of SIGINT, as shells do
