"""Options of commands that can distribute their work over several machines."""

import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

from hedon.error import HedonError

Ray = Annotated[
    str | None, typer.Option(metavar="ADDRESS|local", help="Run on this Ray cluster, or on one started here.")
]
Part = Annotated[str | None, typer.Option(metavar="I/N", help="Do only part I of N of the work, as in 2/10.")]


class ClusterError(HedonError):
    """Work that cannot be distributed in this way."""


@dataclass(frozen=True)
class ClusterOptions:
    """Where the work is done: here, on a Ray cluster, in parts on several machines, or by a Slurm job array."""

    ray: Ray = None
    part: Part = None
    slurm: Annotated[
        bool, typer.Option("--slurm", help="Instead of running anything, write a Slurm job array that does: NAME.sh.")
    ] = False
    jobs: Annotated[
        int, typer.Option("--jobs", help="With --slurm: number of tasks in the array.", min=1, max=100_000)
    ] = 16
    hours: Annotated[int, typer.Option(help="With --slurm: hours that a task may take.", min=1, max=10_000)] = 24

    def write_script(self, path: Path, name: str, words: Sequence[str], most: int, processors: int) -> Path:
        """Writes the script of the job array.

        Raises:
            ClusterError: There is nothing to run, or --ray or --part is given too.
            RecordError: The script cannot be written.
        """
        from hedon.ensemble.slurm import slurm_script
        from hedon.record.atomic import write_atomically

        if self.ray is not None or self.part is not None:
            raise ClusterError("--slurm: its tasks are parts of the work: leave out --ray and --part")
        if not most:
            raise ClusterError("--slurm: no worlds are needed: the same command without it is enough")
        text = slurm_script(name, words, min(self.jobs, most), processors, self.hours)
        write_atomically(path, lambda content: content.write(text.encode()))
        return path


def own_words(*without: str) -> list[str]:
    """Words of this command line, without --slurm and without some options and their values."""
    kept: list[str] = []
    words = iter(sys.argv[1:])
    for word in words:
        name, _, value = word.partition("=")
        if name in without:
            _ = value or next(words, None)
        elif word != "--slurm":
            kept.append(word)
    return kept
