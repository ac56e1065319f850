"""Writes the script of a Slurm job array, in which each task runs a part of the jobs."""

import shlex
import sys
from collections.abc import Sequence

SIGNAL_SECONDS = 120
"""Time before its limit at which Slurm signals a task, so that it can save its state [s]."""

TEMPLATE = """\
#!/bin/sh
# {name} as a job array of Slurm: submit it with sbatch. Submitted again, it goes on where it was.
#SBATCH --job-name=hedon-{job}
#SBATCH --array=1-{tasks}
#SBATCH --cpus-per-task={workers}
#SBATCH --time={hours}:00:00
#SBATCH --signal=B:TERM@{seconds}
#SBATCH --requeue
#SBATCH --open-mode=append
exec {python} -c 'from hedon.cli.start import main; main()' \\
  {words} --part "$SLURM_ARRAY_TASK_ID/{tasks}"
"""


def slurm_script(name: str, words: Sequence[str], tasks: int, workers: int, hours: int) -> str:
    """The script of a job array.

    Args:
        name: Name of the job.
        words: Words of the command after `hedon`, without --part, which each task adds.
        tasks: Number of tasks in the array.
        workers: Processes per task, one processor each.
        hours: Time limit of a task [h].
    """
    return TEMPLATE.format(
        name=name[:1].upper() + name[1:],
        job="".join(c if c.isalnum() else "-" for c in name.split()[-1]),
        tasks=tasks,
        workers=workers,
        hours=hours,
        seconds=SIGNAL_SECONDS,
        python=shlex.quote(sys.executable),
        words=shlex.join(words),
    )
