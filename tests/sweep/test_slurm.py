"""The script for Slurm runs a sweep on a real one-node Slurm, installed by `apt-get install slurm-wlm munge`."""

import json
import os
import shutil
import signal
import socket
import stat
import subprocess
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path

import polars as pl
import pytest
from sweep_case import assert_same_table, planned, sweep_file, table_of, under_way
from typer.testing import CliRunner

from hedon.cli.main import app
from hedon.ensemble.batch import RUNS, WORK, batch_job

NEEDED = ("munged", "slurmctld", "slurmd", "sbatch", "sinfo", "squeue")
WHERE = os.environ["PATH"] + ":/usr/sbin:/sbin"

pytestmark = [
    pytest.mark.long,
    pytest.mark.skipif(
        os.geteuid() != 0 or any(shutil.which(name, path=WHERE) is None for name in NEEDED),
        reason="needs Slurm, and to be root: apt-get install slurm-wlm munge",
    ),
]

STEPS = 20_480
"""Steps of each world, which take a few seconds."""
CONFIG = """\
ClusterName=hedon
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={control}
SlurmdPort={daemon}
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket,cred_expire=10
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


@pytest.fixture(scope="module")
def cluster(tmp_path_factory) -> Iterator[Path]:
    """The folder with the logs of a Slurm started for these tests."""
    with pytest.MonkeyPatch.context() as monkeypatch:
        yield from run_slurm(tmp_path_factory.mktemp("slurm"), monkeypatch)


def run_slurm(folder: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
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


@pytest.fixture(scope="module")
def whole(tmp_path_factory) -> pl.DataFrame:
    """The table of the sweep, made in this process."""
    folder = tmp_path_factory.mktemp("alone")
    plan, store = planned(file_of(folder), str(folder / "whole"))
    for batch in plan.batches():
        batch_job(store.location, plan, batch, folder / batch.name, 1e9).make(1, None)
    return table_of(store.location)


def file_of(folder: Path) -> Path:
    """Two batches, whose runs are kept."""
    file = sweep_file(folder, STEPS)
    file.write_text('keep = ["run"]\n' + file.read_text())
    return file


def begin(cluster: Path, folder: Path) -> tuple[Path, Path]:
    """Submits the script of a sweep with two tasks; returns script and sweep folder once both tasks are under way."""
    place = folder / "shared place"
    words = ["sweep", "run", str(file_of(folder)), "--slurm", "--out", str(place), "--jobs", "2", "--hours", "1"]
    done = CliRunner().invoke(app, [*words, "--checkpoint", "0"])
    assert done.exit_code == 0, done.output
    script = place.with_name(f"{place.name}.sh")
    submit(cluster, script, f"{folder.name}-first")
    under_way = "*/checkpoints/step-*[1-9]*.npz"
    wait_for("both tasks are under way", lambda: len({path.parents[1] for path in (place / WORK).glob(under_way)}) == 2)
    return script, place


def submit(cluster: Path, file: Path, name: str) -> None:
    log = str(cluster / f"{name}-%a.log")
    subprocess.run(["sbatch", "--output", log, str(file)], check=True, cwd=file.parent)


def wait_for(what: str, is_so: Callable[[], bool], seconds: float = 300) -> None:
    until = time.monotonic() + seconds
    while not is_so():
        assert time.monotonic() < until, f"not within {seconds:g} s: {what}"
        time.sleep(0.1)


def queue_is_empty() -> bool:
    return not subprocess.run(["squeue", "-h"], capture_output=True, text=True, check=True).stdout.strip()


def logs(cluster: Path, name: str) -> list[str]:
    return [path.read_text() for path in sorted(cluster.glob(f"{name}-*.log"))]


def sessions(place: Path) -> list[list[dict]]:
    """The sessions of the run of each batch."""
    return [json.loads(path.read_text())["sessions"] for path in sorted((place / RUNS).glob("*/manifest.json"))]


def test_tasks_that_run_out_of_time_save_their_state(cluster, tmp_path, whole):
    script, place = begin(cluster, tmp_path)
    # What Slurm does when the time of a task is nearly over.
    subprocess.run(["scancel", "--signal=TERM", "--batch", "--name", "hedon-small"], check=True)
    wait_for("both tasks have ended", queue_is_empty)
    told = logs(cluster, f"{tmp_path.name}-first")
    assert len(told) == 2, "each task of the array has a log"
    assert not any("All done" in text for text in told), told
    submit(cluster, script, f"{tmp_path.name}-second")
    wait_for("the rest is made", queue_is_empty)
    assert all("All done" in text for text in logs(cluster, f"{tmp_path.name}-second"))
    for first, second in sessions(place):
        assert first["ended"] is not None, "it shut down cleanly"
        assert second["from_step"] > 0
    assert_same_table(table_of(str(place)), whole)


def test_killed_tasks_continue_from_their_checkpoints(cluster, tmp_path, whole):
    script, place = begin(cluster, tmp_path)
    batches = [process for process, _ in under_way(place).values()]
    for process in batches:  # so that none notices the loss of the task's first process and shuts down cleanly
        os.kill(process, signal.SIGSTOP)
    subprocess.run(["scancel", "--signal=KILL", "--full", "--name", "hedon-small"], check=True)
    for process in batches:
        with suppress(ProcessLookupError):
            os.kill(process, signal.SIGKILL)
    wait_for("both tasks have ended", queue_is_empty)
    submit(cluster, script, f"{tmp_path.name}-second")
    wait_for("the rest is made", queue_is_empty)
    assert all("All done" in text for text in logs(cluster, f"{tmp_path.name}-second"))
    for first, second in sessions(place):
        assert first["ended"] is None, "it had no time to shut down cleanly"
        assert second["from_step"] > 0
    assert_same_table(table_of(str(place)), whole)


def test_requeued_tasks_continue_by_themselves(cluster, tmp_path, whole):
    """Slurm itself requeues tasks when a node fails or a job of higher priority needs it."""
    _, place = begin(cluster, tmp_path)
    jobs = subprocess.run(["squeue", "-h", "-o", "%F"], capture_output=True, text=True, check=True).stdout.split()
    subprocess.run(["scontrol", "requeue", *set(jobs)], check=True)
    wait_for("the rest is made", queue_is_empty)
    assert all("All done" in text for text in logs(cluster, f"{tmp_path.name}-first"))
    for _, second in sessions(place):
        assert second["from_step"] > 0
    assert_same_table(table_of(str(place)), whole)
