"""Writes the script of a job array for Slurm: each task of the array makes a part of a sweep."""

import shlex
import sys

from hedon.sweep.plan import SweepPlan
from hedon.sweep.store import Store

SIGNAL_SECONDS = 120
"""So long before its time is over Slurm tells a task, which then saves where it is [s]."""

TEMPLATE = """\
#!/bin/sh
# The sweep {name} as a job array of Slurm: submit it with sbatch. Submitted again, it goes on where it was.
#SBATCH --job-name=hedon-{name}
#SBATCH --array=1-{tasks}
#SBATCH --cpus-per-task={workers}
#SBATCH --time={hours}:00:00
#SBATCH --signal=B:TERM@{seconds}
#SBATCH --requeue
#SBATCH --open-mode=append
exec {python} -c 'from hedon.cli.start import main; main()' \\
  sweep resume {place} --workers {workers} --checkpoint {checkpoint:g} --part "$SLURM_ARRAY_TASK_ID/{tasks}"
"""


def slurm_script(plan: SweepPlan, store: Store, tasks: int, workers: int, hours: int, checkpoint: float) -> str:
    """The script of a job array.

    Args:
        plan: of the sweep, which is written already.
        store: where it lives: a folder that all nodes share, or a URL.
        tasks: of the array; at most one for each batch is made.
        workers: processes of a task, one processor each.
        hours: that a task may take [h].
        checkpoint: time between two checkpoints of a batch [s].
    """
    place = store.location if store.folder is None else str(store.folder.absolute())
    return TEMPLATE.format(
        name="".join(c if c.isalnum() else "-" for c in plan.name),
        tasks=min(tasks, len(plan.batches())),
        workers=workers,
        hours=hours,
        checkpoint=checkpoint,
        seconds=SIGNAL_SECONDS,
        python=shlex.quote(sys.executable),
        place=shlex.quote(place),
    )
