"""Commands that run many worlds print a note at the start if there are too few seeds for some results."""

from pathlib import Path

import pytest
from command import hedon

NOTE = "hedon: note: "
CROSSED = '[factor]\n"energy.basic_cost" = [0.0005, 0.001]\n'
DRAWN = '[factor]\n"energy.basic_cost" = { range = [0.0005, 0.001] }\n[design]\npoints = 8\n'


@pytest.mark.parametrize(
    ("seeds", "factors", "note"),
    [
        (3, CROSSED, "3 seeds per condition: intervals need 5, and differences between conditions need 6."),
        (6, CROSSED, ""),
        (1, "", "1 seed: intervals need 5."),
        (5, "", ""),
        (1, DRAWN, ""),  # values drawn from a range are grouped with their neighbors
    ],
)
def test_a_sweep(tmp_path: Path, seeds: int, factors: str, note: str) -> None:
    (tmp_path / "mine.toml").write_text(f"steps = 64\nseeds = {seeds}\n{factors}")
    planned = hedon("sweep", "plan", "mine.toml", cwd=tmp_path)
    script = hedon("sweep", "run", "mine.toml", "--slurm", cwd=tmp_path)
    for done in (planned, script):
        assert done.returncode == 0, done.stderr
        assert done.stderr.startswith(NOTE + note if note else "")
        assert bool(note) == (NOTE in done.stderr)


@pytest.mark.parametrize(("seeds", "note"), [("1-4", "4 seeds: intervals need 5."), ("1-5", "")])
def test_an_assay(tmp_path: Path, seeds: str, note: str) -> None:
    done = hedon("assay", "landscape", "baseline", "--seeds", seeds, "--slurm", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert done.stderr.startswith(NOTE + note if note else "")
    assert bool(note) == (NOTE in done.stderr)


@pytest.mark.parametrize(
    ("words", "note"),
    [
        (("fear", "--seeds", "1-2"), "2 seeds per condition: intervals need 5"),
        (("fear", "--seeds", "1-6"), ""),
        (("fear", "--quick"), ""),
        (("hazard", "body"), ""),  # the first needs no world, the second shows just one
    ],
)
def test_a_study(tmp_path: Path, words: tuple[str, ...], note: str) -> None:
    done = hedon("study", "run", *words, "--slurm", cwd=tmp_path)
    assert note in done.stderr
    assert bool(note) == (NOTE in done.stderr)
