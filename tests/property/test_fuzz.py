"""Nonsense in, one message out: no config and no command line ends in a traceback, a hang, or half a run.

HEDON_FUZZ=N tries N examples of each kind instead of the default number.
"""

import os
import shutil
import tomllib
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from resumed_run import SMALL, small_run
from typer.testing import CliRunner

from hedon.cli.main import app
from hedon.config.config import Config
from hedon.config.dump import dump_toml
from hedon.config.field import Setting, leaves
from hedon.config.load import PRESETS, load_config
from hedon.config.problem import ConfigError
from hedon.error import EngineError, HedonError
from hedon.experiment.memory import COLD, memory_needed
from hedon.experiment.simulation import Simulation
from hedon.record.folder import holds_run

EXAMPLES = int(os.environ.get("HEDON_FUZZ", "0"))
FUZZ = {"deadline": None, "suppress_health_check": list(HealthCheck)}
DUMPS = {preset: dump_toml(load_config(preset)) for preset in PRESETS}
TABLES = (
    *(f"{own}reward.pay.see_{name}" for own in ("", "species.prey.", "species.predator.") for name in ("prey", "pray")),
    *(f"{owner}reward.pay.smell_{name}" for owner in ("", "species.prey.") for name in ("normal", "normel")),
    *(
        f"genome.{table}.{name}"
        for table in ("learning", "family", "mutation")
        for name in ("gamma", "threshold", "w_x")
    ),
    *(f"species.predator.genome.{name}" for name in ("learning.gamma", "learning.gama", "mutation.w_prey", "family.x")),
    *("hazard.schedule.scale", "species.prey.hazard.schedule.scole", "food.normal.schedule.capacity", "species.shark"),
)
"""Tables that a config may have, and some with misspelled names."""
PATHS = [path for preset in ("poison", "predator", "pitfall") for path, _, _ in leaves(load_config(preset))]
PLAIN = [
    (path, setting)
    for path, setting, _ in leaves(load_config("baseline"))
    if setting.type in (int, float) or setting.choices
]
SECTIONS = [*sorted({path.rpartition(".")[0] for path in PATHS} - {""}), *TABLES]

text = st.one_of(
    st.sampled_from(
        ["", " ", "\t", "\n", "0", "-1", "nan", "baseline", "../x", "~", "a" * 300, "ü☃", "\udcff", "-", "--"]
    ),
    st.text(st.characters(blacklist_characters="\0"), max_size=12),
)
number = st.one_of(
    st.sampled_from(["0", "-0.0", "1e-45", "-1", "1", "2", "nan", "inf", "-inf", "1e38", "1e39", "1e308", "1e999"]),
    st.sampled_from([str(2**31 - 1), str(2**31), str(2**63), str(2**64), str(10**40), "0x10", "0b1", "1_000", "07"]),
    st.integers(-(10**6), 10**6).map(str),
    st.floats(width=32).map(repr),
)
value = st.one_of(
    number,
    st.sampled_from(["true", "'x'", '"floor"', '"death"', '"fixed"', "[]", "[[]]", "[1, 2]", "[[1, 2, 3, 4]]", "{}"]),
    st.sampled_from(
        ["{a = 1}", "1979-05-27", "07:32:00", "1979-05-27T07:32:00Z", '"""x"""', "[1, 'a']", "=", "[", "#"]
    ),
)
name = st.one_of(
    st.sampled_from([path.rpartition(".")[2] for path in PATHS]), st.sampled_from(["x", "preset", "ü", '""'])
)


def mutate(source: str, edits: list[tuple[int, int, str]]) -> str:
    """Replaces, deletes or inserts parts of a text."""
    for where, length, new in edits:
        at = where % (len(source) + 1)
        source = source[:at] + new + source[at + length :]
    return source


line = st.one_of(
    st.builds("{} = {}".format, name, value),
    st.builds("{} = {}".format, st.sampled_from(PATHS), value),
    st.builds("{} = {{}}".format, st.sampled_from(TABLES)),
    st.builds("[{}]".format, st.one_of(st.sampled_from(SECTIONS), text)),
    st.builds("[[{}]]".format, st.sampled_from(SECTIONS)),
    st.builds('preset = "{}"'.format, st.sampled_from([*PRESETS, "none"])),
    st.builds('fidelity = "{}"'.format, st.sampled_from(["released", "as_printed", "none"])),
    st.sampled_from(["complete = true", "complete = 1", "food = 3", "arena = []", "food.normal = {}", "food.x = {}"]),
)


def allowed(path: str, setting: Setting) -> st.SearchStrategy[str]:
    """A line that gives a setting a value that is valid, at least on its own."""
    if setting.choices:
        return st.sampled_from(setting.choices).map(lambda choice: f'{path} = "{choice}"')
    low, high = (-1e3 if setting.doc.range.ge is None else setting.doc.range.ge), setting.doc.range.le
    values = st.integers(int(low), int(min(high or 1e3, 1e3))) if setting.type is int else st.floats(low, high or 1e3)
    return values.map(lambda value: f"{path} = {value!r}")


document = st.one_of(
    st.lists(line, max_size=8).map("\n".join),
    st.lists(line, max_size=4).map(lambda lines: "\n".join(['preset = "predator"', *lines])),
    st.lists(st.one_of([allowed(*each) for each in PLAIN]), min_size=1, max_size=3).map("\n".join),
    st.builds(
        mutate,
        st.sampled_from(list(DUMPS.values())),
        st.lists(st.tuples(st.integers(0, 10**5), st.integers(0, 40), st.one_of(value, text)), min_size=1, max_size=4),
    ),
)
override = st.one_of(
    st.builds("{}={}".format, st.one_of(st.sampled_from([*PATHS, *TABLES]), name), value),
    st.builds("{}={{}}".format, st.sampled_from(TABLES)),
    text,
)


@pytest.mark.repeated
def test_any_text_is_a_config_or_an_error_that_names_the_place(tmp_path):
    path, found = tmp_path / "fuzz.toml", Counter()

    @settings(max_examples=EXAMPLES or 300, **FUZZ)
    @given(
        content=document, overrides=st.lists(override, max_size=2), fidelity=st.sampled_from([None, "as_printed", "x"])
    )
    def trial(content: str, overrides: list[str], fidelity: str | None) -> None:
        path.write_text(content, encoding="utf-8", errors="surrogatepass")
        said, config = outcome(lambda: load_config(path, fidelity, overrides), ConfigError)
        found["config" if said is None else "error"] += 1
        if config is None:
            assert "fuzz.toml" in str(said) or ", with changes" in str(said)
            return
        assert load_from_text(dump_toml(config), path) == config
        if memory_needed(config, 1, 1)[COLD] < 10**8:
            found["lived"] += run_briefly(config)

    trial()
    print(dict(found))
    assert min(found["config"], found["error"], found["lived"]) > 0.04 * found.total()


def load_from_text(content: str, path: Path) -> Config:
    tomllib.loads(content)
    path.write_text(content, encoding="utf-8")
    return load_config(path)


def run_briefly(config: Config) -> bool:
    """Every valid config can be simulated, or the engine says why not."""
    size = [own.population for own in config.species.values()]
    if any(config.physics.substeps * own.capacity > 10**5 or own.initial_count > 500 for own in size):
        return False
    said, _ = outcome(lambda: Simulation(config, (1,), 1).run(3), EngineError)
    assert said is None or ":" in said
    return said is None


def outcome(call: Callable[[], Any], error: type[HedonError]) -> tuple[Any, Any]:
    """The error message of a call that fails, and the result of one that does not."""
    try:
        return None, call()
    except error as raised:
        return str(raised), None


@pytest.fixture(scope="module")
def place(tmp_path_factory):
    """A folder with a run, an empty folder, a file and a config."""
    folder = tmp_path_factory.mktemp("place")
    small_run(folder / "run", 70)
    (folder / "empty").mkdir()
    (folder / "file").write_text("no run")
    (folder / "my.toml").write_text('preset = "small"')
    return folder


SOURCES = ["baseline", "poison", "baselin", "my.toml", "none.toml", "file", "empty", "run/config.toml", "/", "."]
OPTIONS = {
    "run": ["--seeds", "--threads", "--out", "--frames", "--checkpoint", "--fidelity", "--set", "--no-report"],
    "resume": ["--threads", "--checkpoint", "--steps", "--no-report"],
    "branch": ["--out", "--at", "--steps", "--set", "--threads", "--frames", "--checkpoint"],
    "check": ["--replay", "--against", "--fault", "--threads"],
    "report": ["--out"],
    "analyze": ["--only", "--out"],
    "forecast": ["--fidelity", "--set", "--steps"],
    "presets": [],
    "config show": ["--fidelity", "--set", "--path"],
    "config check": ["--fidelity", "--set"],
    "config diff": ["--fidelity-a", "--fidelity-b"],
    "": ["--version", "--help", "--install-completion-x"],
}
argument = st.one_of(
    st.sampled_from(SOURCES),
    st.sampled_from(["run", "run", "empty", "file", "nowhere", "run/agents"]),
    st.sampled_from(["3", "0", "-1", "70", "64", "1-5", "5-1", "1,1", "1e3", "text", "released", "food.normal", "out"]),
    override,
    text,
)


@st.composite
def command_lines(draw: st.DrawFn) -> list[str]:
    command = draw(st.sampled_from(list(OPTIONS)))
    words = command.split()
    words += draw(st.lists(argument, max_size=3 if command != "run" else 1))
    for option in draw(st.lists(st.sampled_from(OPTIONS[command] or ["--x"]), max_size=3)):
        words += [option, *draw(st.lists(argument, min_size=1, max_size=1))]
    return words


@pytest.mark.repeated
@settings(max_examples=EXAMPLES or 150, **FUZZ)
@given(words=command_lines())
def test_any_command_line_does_what_it_says_or_ends_with_a_message(place, monkeypatch, words):
    monkeypatch.chdir(place)
    monkeypatch.setattr("hedon.cli.run.show_report", lambda run, console: None)
    monkeypatch.setattr("hedon.cli.report.show_report", lambda *runs, **options: None)
    if words[:1] == ["run"]:  # short and small, whatever else is asked for
        small = [word for setting in SMALL for word in ("--set", setting)]
        words = [*words, "--steps", "3", *small]
    elif words[:1] in (["resume"], ["branch"]):
        words = [*words, "--steps", "72"]
    kept = {path.name for path in place.iterdir()}
    answer = CliRunner().invoke(app, words)
    error = answer.exception
    refused = isinstance(error, HedonError) or (isinstance(error, OSError) and error.filename is not None)
    if refused:
        assert str(answer.exception).strip()
    else:
        assert answer.exception is None or isinstance(answer.exception, SystemExit), words
        assert answer.exit_code in ((0, 1, 2) if words[:1] == ["check"] else (0, 2)), words
        assert answer.exit_code == 0 or answer.output.strip()
    new = [path for path in place.iterdir() if path.name not in kept]
    for path in new:
        assert not (refused or answer.exit_code == 2) or not holds_run(path), words
        shutil.rmtree(path) if path.is_dir() else path.unlink()
