"""A run's folder under hostile or concurrent use: links, two reports at once, kills, a removed folder.

HEDON_REPORTS=N kills N reports instead of one.
"""

import json
import os
import shutil
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest
from resumed_run import small_run
from typer.testing import CliRunner

import hedon
from hedon.cli.main import app
from hedon.record.error import RecordError
from hedon.record.folder import LOCK, checkpoint_paths
from hedon.record.manifest import load_manifest

KILLS = int(os.environ.get("HEDON_REPORTS", "1"))


@pytest.fixture(scope="module")
def original(tmp_path_factory):
    folder = tmp_path_factory.mktemp("original") / "run"
    small_run(folder, 130, frames=32)
    return folder


@pytest.fixture
def run(original, tmp_path):
    return Path(shutil.copytree(original, tmp_path / "run"))


def content(folder: Path) -> dict[str, bytes]:
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def call(*arguments: object) -> subprocess.CompletedProcess[str]:
    return subprocess.run(["hedon", *map(str, arguments)], capture_output=True, text=True, check=False, timeout=120)


COMMANDS = [
    lambda folder: hedon.resume(folder, 200),
    lambda folder: hedon.branch(folder, folder.parent / "branch", steps=200),
    lambda folder: hedon.open_run(folder),
    lambda folder: small_run(folder, 64),
]


@pytest.mark.parametrize(
    "linked", [LOCK, "manifest.json", "frames", "agents", "checkpoints", "figures", "agents/x.parquet"]
)
def test_no_command_follows_a_link_inside_a_run(run, tmp_path, linked):
    outside = tmp_path / "outside"
    target = run / linked
    if target.is_dir() or linked == "figures":
        shutil.copytree(target, outside) if target.is_dir() else outside.mkdir()
        shutil.rmtree(target, ignore_errors=True)
    else:
        outside.write_text("precious")
        target.unlink(missing_ok=True)
    target.symlink_to(outside)
    kept = content(outside) if outside.is_dir() else outside.read_bytes()
    for command in COMMANDS:
        with pytest.raises(RecordError, match="symbolic link") as caught:
            command(run)
        assert str(target) in str(caught.value)
    assert (content(outside) if outside.is_dir() else outside.read_bytes()) == kept


def test_every_command_refuses_links(run, tmp_path):
    (tmp_path / "outside").mkdir()
    (run / "figures").symlink_to(tmp_path / "outside")
    for command in ("resume", "branch", "report", "analyze", "check"):
        answer = CliRunner().invoke(app, [command, str(run)])
        assert "symbolic link" in str(answer.exception) or (answer.exit_code, "symbolic link" in answer.output) == (
            2,
            True,
        )
    assert not list((tmp_path / "outside").iterdir())


def test_a_pipe_in_a_run_is_refused_instead_of_waited_for(run):
    (run / "config.toml").unlink()
    os.mkfifo(run / "config.toml")
    with pytest.raises(RecordError, match="neither a file nor a folder"):
        hedon.open_run(run)


def test_a_run_may_be_reached_through_a_link_to_its_folder(run, tmp_path):
    (tmp_path / "latest").symlink_to(run)
    assert hedon.open_run(tmp_path / "latest").manifest.status == "finished"
    assert hedon.resume(tmp_path / "latest", 200, threads=1).status == "finished"


@pytest.mark.long
def test_two_reports_at_once_do_not_harm_a_run_in_progress(tmp_path):
    go_on = "from killed_run import go; import sys; from pathlib import Path; go(Path(sys.argv[1]))"
    environment = {**os.environ, "PYTHONPATH": str(Path(__file__).parents[1])}
    folder = tmp_path / "run"
    running = subprocess.Popen([sys.executable, "-c", go_on, str(folder)], env=environment)
    while not (folder / "manifest.json").exists():
        time.sleep(0.02)
    both = [subprocess.Popen(["hedon", "report", str(folder)], stderr=subprocess.PIPE) for _ in range(2)]
    for report in both:
        _, said = report.communicate(timeout=240)
        assert report.returncode == 0
        # On a slow machine, it reports its progress.
        assert all(line.startswith("hedon: writing the report: ") for line in said.decode().splitlines())
    assert running.wait(timeout=120) == 0
    assert load_manifest(folder).status == "finished"
    assert (folder / "report.html").stat().st_size > 10_000
    assert not list(folder.rglob("*.tmp"))


@pytest.mark.repeated
def test_a_report_that_is_killed_leaves_nothing_behind(run):
    whole = {path for path in content(run) if not path.startswith(("figures", "analysis", "report", "summary"))}
    for i in range(KILLS):
        report = subprocess.Popen(["hedon", "report", str(run)], stdout=subprocess.DEVNULL)
        time.sleep(3.0 + 3.0 * i / KILLS)  # while it draws its figures
        report.send_signal(signal.SIGKILL)
        report.wait()
        left = set(content(run)) - whole
        assert not [name for name in left if ".tmp" in name or "/." in name]
        for name in left:
            if name.endswith(".svg"):
                assert (run / name).read_bytes().rstrip().endswith(b"</svg>"), name


def test_a_checkpoint_that_is_a_folder_is_skipped(run):
    newest = checkpoint_paths(run)[-1]
    (newest.parent / "step-0000000777.npz").mkdir()
    manifest = hedon.resume(run, 260, threads=1)
    assert manifest.status == "finished"
    assert max(manifest.steps_done) == 260
    assert len(checkpoint_paths(run)) == 2
    answer = call("check", run)
    assert answer.returncode == 1
    assert "step-0000000777.npz: is a folder" in answer.stdout


def test_a_folder_that_is_removed_ends_the_run_at_once(tmp_path):
    def remove() -> None:
        while not (tmp_path / "run" / "manifest.json").exists():
            time.sleep(0.01)
        time.sleep(0.3)
        (tmp_path / "run").rename(tmp_path / "moved")

    thread = threading.Thread(target=remove)
    thread.start()
    begun = time.monotonic()
    with pytest.raises(RecordError, match="was removed or replaced during the run"):
        small_run(tmp_path / "run", 10_000_000)
    thread.join()
    assert time.monotonic() - begun < 20
    assert not (tmp_path / "run").exists(), "the folder was created again"


@pytest.mark.parametrize(
    ("entry", "value", "words"),
    [
        ("food_colors", ["notacolor"], "food_colors"),
        ("food_kinds", ["../x"], "food_kinds"),
        ("frames", -1, "frames = -1"),
        ("neutral_count", 1_000_000_000, "neutral_count"),
        ("neutral_count", 10**30, "neutral_count"),
        ("seeds", [-1], "seeds"),
        ("seeds", ["1"], "seeds"),
        ("status", "fine\u202e", "status"),
    ],
)
def test_an_invalid_manifest_gives_one_message(run, entry, value, words):
    values = json.loads((run / "manifest.json").read_text())
    values[entry] = value
    (run / "manifest.json").write_text(json.dumps(values))
    with pytest.raises(RecordError) as caught:
        hedon.open_run(run)
    assert words in str(caught.value)
    if entry == "status":  # an unprintable character is shown as an escape
        answer = call("report", run)
        assert answer.returncode == 2
        assert "fine\\u202e" in answer.stderr
        assert len(answer.stderr.splitlines()) == 1
