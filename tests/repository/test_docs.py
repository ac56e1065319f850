"""The examples in the documentation work: its Python runs, and its configs load."""

import os
import re
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from importlib.util import find_spec
from math import prod
from pathlib import Path
from typing import Any

import pytest
from setting_page import values
from sweep_case import condition_configs

from hedon.config import load_config
from hedon.ensemble.plan import SweepFile
from hedon.sweep.read import read_sweep

ROOT = Path(__file__).parents[2]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs" / "guide").glob("*.md"))]


def blocks(page: Path, language: str) -> list[str]:
    """The fenced blocks of a page in a language, in order; blocks within a list are not meant to run."""
    return re.findall(rf"^```{language}\n(.*?)^```$", page.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)


def names(language: str) -> list:
    return [pytest.param(page, id=page.stem) for page in PAGES if blocks(page, language)]


def test_blocks_are_found():
    assert len(names("python")) >= 3
    assert len(names("toml")) >= 3


OPTIONAL = {"rule": ("numba", "rules"), "environment": ("pettingzoo", "env")}
"""What a page needs besides hedon itself: a module, and the extra of hedon that installs it."""


@pytest.mark.parametrize("page", names("python"))
def test_python_of_a_page_runs_from_top_to_bottom(page, tmp_path):
    module, extra = OPTIONAL.get(page.stem, ("hedon", ""))
    if find_spec(module) is None:
        pytest.skip(f'needs the optional packages: pip install "hedon[{extra}]"')
    # Each block is put at its line in the page, so that tracebacks give the page's line numbers.
    text = page.read_text(encoding="utf-8")
    program = ""
    for block in blocks(page, "python"):
        line = text[: text.index(f"```python\n{block}")].count("\n") + 1
        program += "\n" * (line - program.count("\n")) + block
    script = tmp_path / f"{page.stem}.py"
    script.write_text(program, encoding="utf-8")
    done = subprocess.run(
        [sys.executable, script],
        cwd=tmp_path,
        env=os.environ | {"MPLBACKEND": "Agg"},
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    assert done.returncode == 0, done.stderr


def test_the_readme_names_every_optional_package():
    (line,) = re.findall(r"`uv sync --extra (.*?);", (ROOT / "README.md").read_text(encoding="utf-8"), re.DOTALL)
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert set(re.findall(r"(?:^|`)([a-z]+)`", line)) == set(project["optional-dependencies"])


def said(table: dict, path: str = "") -> Iterator[tuple[str, Any]]:
    """The values in a block, by the path of each setting."""
    for name, value in table.items():
        if isinstance(value, dict) and value:
            yield from said(value, f"{path}{name}.")
        else:
            yield f"{path}{name}", value


@pytest.mark.parametrize("page", names("toml"))
def test_configs_of_a_page_are_what_they_say(page, tmp_path):
    for i, block in enumerate(blocks(page, "toml")):
        file = tmp_path / f"config{i}.toml"
        file.write_text(block, encoding="utf-8")
        table = tomllib.loads(block)
        told = dict(said(table))
        if "factor" in table:
            assert_every_setting_has_its_value(read_sweep(file), table)
            continue
        config = load_config(file)
        have = values(config)
        tables = [(path, each) for path, each in have.items() if isinstance(each, dict)]
        have |= {f"{path}.{name}": number for path, each in tables for name, number in each.items()}
        for path, value in told.items():
            if "*" in path:
                assert {have[path.replace("*", kind)] for kind in config.food} == {value}, path
            elif value is False and path.startswith("food."):
                assert path.removeprefix("food.") not in config.food
            elif value == {}:
                assert any(name.startswith(f"{path}.") for name in have), path
            else:
                assert have[path] == value, path


def assert_every_setting_has_its_value(sweep: SweepFile, table: dict) -> None:
    counts = [each["count"] if isinstance(each, dict) else len(each) for each in table["factor"].values()]
    conditions = sweep.plan.conditions
    assert len(conditions) == prod(counts) > 1
    assert len({tuple(condition.settings.values()) for condition in conditions}) == prod(counts)
    for condition, config in zip(conditions, condition_configs(sweep), strict=True):
        have = values(config)
        for path, value in {**table.get("set", {}), **condition.settings}.items():
            assert have[path] == value, path


def test_each_change_is_listed_once() -> None:
    lines = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8").splitlines()
    long = [line for line in lines if len(line) > 60]
    assert len(long) == len(set(long))
