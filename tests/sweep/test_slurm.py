"""The script for Slurm runs a sweep on a real Slurm of one node, as `apt-get install slurm-wlm munge` brings it."""

import os
import shutil
import socket
import stat
import subprocess
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from sweep_case import assert_same_table, planned, sweep_file, table_of
from typer.testing import CliRunner

from hedon.cli.main import app
from hedon.sweep.work import WORK, make_batch, make_task

NEEDED = ("munged", "slurmctld", "slurmd", "sbatch", "sinfo", "squeue")
WHERE = os.environ["PATH"] + ":/usr/sbin:/sbin"

pytestmark = [
    pytest.mark.long,
    pytest.mark.skipif(
        os.geteuid() != 0 or any(shutil.which(name, path=WHERE) is None for name in NEEDED),
        reason="needs Slurm, and to be root: apt-get install slurm-wlm munge",
    ),
]

CONFIG = """\
ClusterName=hedon
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={control}
SlurmdPort={daemon}
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
CredType=cred/munge
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
ReturnToService=2
MpiDefault=none
NodeName={host} NodeAddr=127.0.0.1 CPUs={cpus} State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""


def free_port() -> int:
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


@pytest.fixture
def cluster(tmp_path, monkeypatch) -> Iterator[Path]:
    """A folder with the logs of a Slurm that runs for one test."""
    folder = tmp_path / "slurm"
    for name in ("state", "spool"):
        (folder / name).mkdir(parents=True)
    key = folder / "munge.key"
    key.write_bytes(os.urandom(1024))
    key.chmod(stat.S_IRUSR | stat.S_IWUSR)
    host = socket.gethostname().partition(".")[0]
    config = folder / "slurm.conf"
    config.write_text(
        CONFIG.format(folder=folder, host=host, control=free_port(), daemon=free_port(), cpus=os.cpu_count() or 1)
    )
    (folder / "cgroup.conf").write_text("CgroupPlugin=cgroup/v1\n")
    monkeypatch.setenv("SLURM_CONF", str(config))
    monkeypatch.setenv("PATH", WHERE)
    files = [f"--{name}-file={folder}/munged.{name}" for name in ("pid", "log", "seed")]
    commands = [
        ["munged", "--foreground", "--force", f"--key-file={key}", f"--socket={folder}/munge.socket", *files],
        ["slurmctld", "-D", "-f", str(config)],
        ["slurmd", "-D", "-f", str(config), "-N", host],
    ]
    daemons = []
    try:
        with (folder / "daemons.log").open("w") as log:
            for command in commands:
                daemons.append(subprocess.Popen(command, stdout=log, stderr=log))
                time.sleep(2)
        until = time.monotonic() + 120
        while "idle" not in subprocess.run(["sinfo", "-h", "-o", "%t"], capture_output=True, text=True).stdout:
            assert time.monotonic() < until, (folder / "slurmctld.log").read_text()[-3000:]
            time.sleep(1)
        yield folder
    finally:
        for daemon in reversed(daemons):
            daemon.terminate()
            daemon.wait(60)


def script(file: Path, place: Path) -> Path:
    """The script of two tasks that make a sweep."""
    words = ["sweep", "script", str(file), "--slurm", "--out", str(place), "--jobs", "2", "--hours", "1"]
    done = CliRunner().invoke(app, words)
    assert done.exit_code == 0, done.output
    return place.with_name(f"{place.name}.sh")


def submit(cluster: Path, file: Path, name: str) -> None:
    log = str(cluster / f"{name}-%a.log")
    subprocess.run(["sbatch", "--output", log, str(file)], check=True, cwd=file.parent)


def wait_for(what: str, is_so: Callable[[], bool], seconds: float = 300) -> None:
    until = time.monotonic() + seconds
    while not is_so():
        assert time.monotonic() < until, f"not within {seconds:g} s: {what}"
        time.sleep(0.5)


def queue_is_empty() -> bool:
    return not subprocess.run(["squeue", "-h"], capture_output=True, text=True, check=True).stdout.strip()


def logs(cluster: Path, name: str) -> list[str]:
    return [path.read_text() for path in sorted(cluster.glob(f"{name}-*.log"))]


def test_a_job_array_makes_the_table_also_when_it_runs_out_of_time(cluster, tmp_path):
    file = sweep_file(tmp_path, 6400)
    plan, store = planned(file, str(tmp_path / "alone"))
    for batch in plan.batches():
        make_batch(make_task(store.location, plan, batch, tmp_path / batch.name, 1e9), 1, None)
    made = script(file, tmp_path / "shared place")
    submit(cluster, made, "first")
    runs = tmp_path / "shared place" / WORK
    wait_for("both tasks have begun", lambda: len(list(runs.glob("*/manifest.json"))) == 2)
    # What Slurm does where the time of a task is nearly over.
    subprocess.run(["scancel", "--signal=TERM", "--batch", "--name", "hedon-small"], check=True)
    wait_for("both tasks have ended", queue_is_empty)
    told = logs(cluster, "first")
    assert len(told) == 2, "each task of the array has a log"
    assert not any("All done" in text for text in told), told
    assert len(list(runs.glob("*/checkpoints/*.npz"))) >= 2, "what was done is kept"
    submit(cluster, made, "second")
    wait_for("the rest is made", queue_is_empty)
    assert all("All done" in text for text in logs(cluster, "second")), logs(cluster, "second")
    assert_same_table(table_of(str(tmp_path / "shared place")), table_of(store.location))
