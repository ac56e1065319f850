import subprocess
from importlib.metadata import version
from pathlib import Path

import pytest
from command import hedon

from hedon.config import load_config


@pytest.fixture(autouse=True)
def wide(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "160")


def test_presets_are_listed() -> None:
    found = hedon("presets")
    assert found.returncode == 0
    for text in ("relocation", "360 x 360", "poison: energy -0.6, at most 40, uniform", "released"):
        assert text in found.stdout


def test_shown_config_is_a_file_that_loads(tmp_path: Path) -> None:
    found = hedon("config", "show", "poor", "--fidelity", "as_printed", "--set", "sensor.scaling=unit")
    path = tmp_path / "poor.toml"
    path.write_text(found.stdout, encoding="utf-8")
    assert load_config(path) == load_config("poor", "as_printed", ["sensor.scaling=unit"])


def test_one_section_is_shown() -> None:
    assert hedon("config", "show", "poor", "--path", "food.poor").stdout.startswith(
        "[food.poor]\ngives = {energy = 0.2}"
    )
    missing = hedon("config", "show", "poor", "--path", "food.por")
    assert missing.returncode == 2
    assert missing.stderr == 'hedon: poor: --path = "food.por": there is no such section; did you mean food.poor?\n'


def test_diff() -> None:
    assert hedon("config", "diff", "baseline", "small").stdout == "arena.width  480.0 -> 360.0\n"
    assert hedon("config", "diff", "small", "small").stdout == "no setting differs\n"
    found = hedon("config", "diff", "small", "small", "--fidelity-b", "released")
    changes = [line.split() for line in found.stdout.splitlines()]
    assert ["world.mutation_noise", '"independent"', "->", '"tabulated"'] in changes
    assert "food.poor.gives.energy" in hedon("config", "diff", "baseline", "poor").stdout


def test_check_names_all_problems(tmp_path: Path) -> None:
    (tmp_path / "my.toml").write_text('preset = "small"\n[energy]\ninitial = -1\ninital = 3\n')
    found = hedon("config", "check", "my.toml", cwd=tmp_path)
    assert found.returncode == 2
    assert found.stdout == ""
    assert found.stderr == (
        "hedon: my.toml: 2 problems\n"
        "  energy.initial = -1: must be a number from 0 to 1000000 [energy]\n"
        "  energy.inital: unknown name; did you mean initial?\n"
    )
    (tmp_path / "my.toml").write_text('preset = "small"\n')
    found = hedon("config", "check", "my.toml", cwd=tmp_path)
    assert found.stdout.startswith("my.toml: valid (preset small, fidelity corrected)\ndigest ")


@pytest.mark.parametrize(
    ("args", "text"),
    [
        (("presett",), "Did you mean 'presets'"),
        (("config", "shw"), "Did you mean 'show'?"),
        (("config", "show", "basline"), "did you mean baseline?"),
        (("config", "show", "small", "--fidelity", "text"), "did you mean as_printed?"),
        (("config", "show", "small", "--set", "energy.initial"), 'must be "section.name=value"'),
    ],
)
def test_typing_errors_get_the_nearest_name(args: tuple[str, ...], text: str) -> None:
    found = hedon(*args)
    assert found.returncode == 2
    assert text in found.stderr
    assert "Traceback" not in found.stderr


def test_version() -> None:
    answer = subprocess.run(["hedon", "--version"], capture_output=True, text=True, check=False)
    assert (answer.returncode, answer.stdout, answer.stderr) == (0, f"hedon {version('hedon')}\n", "")


def test_a_check_reads_rules_as_a_run_does(tmp_path: Path) -> None:
    """Their text is part of the digest; a file that is missing, fails or lacks the function is an error."""

    def check(text: str | None, name: str = "paid") -> subprocess.CompletedProcess[str]:
        (tmp_path / "rule.py").write_text(text) if text else (tmp_path / "rule.py").unlink()
        return hedon("config", "check", "baseline", "--set", f'reward.rule="rule.py:{name}"', cwd=tmp_path)

    once, twice = (check(f"def paid(agent):\n    return {factor} * agent.linear\n") for factor in (1, 2))
    assert (once.returncode, twice.returncode) == (0, 0)
    assert once.stdout != twice.stdout
    near = check("def paid(agent):\n    return 1.0\n", "payed")
    assert near.returncode == 2
    assert near.stderr.endswith("rule.py:payed: the file has no function payed; did you mean paid?\n")
    assert "its file fails" in check("raise SystemExit(3)").stderr
    unknown = check("def paid(agent):\n    return agent.nothing\n")
    assert (unknown.returncode, unknown.stdout) == (2, "")
    assert "nothing" in unknown.stderr
    missing = check(None)
    assert (missing.returncode, missing.stdout) == (2, "")
    assert "cannot read" in missing.stderr
