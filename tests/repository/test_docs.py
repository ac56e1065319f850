"""What the documentation shows can be done as it is shown: its Python runs, its configs load."""

import os
import re
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

from hedon.config import load_config
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
"""What a page needs beside hedon itself: a module, and the optional packages of hedon that bring it."""


@pytest.mark.parametrize("page", names("python"))
def test_python_of_a_page_runs_from_top_to_bottom(page, tmp_path):
    module, extra = OPTIONAL.get(page.stem, ("hedon", ""))
    if find_spec(module) is None:
        pytest.skip(f'needs the optional packages: pip install "hedon[{extra}]"')
    # Each block at its place in the page, so that a traceback names the line there.
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


@pytest.mark.parametrize("page", names("toml"))
def test_configs_of_a_page_load(page, tmp_path):
    for i, block in enumerate(blocks(page, "toml")):
        file = tmp_path / f"config{i}.toml"
        file.write_text(block, encoding="utf-8")
        if "[factor]" in block:
            assert read_sweep(file).conditions, block
        else:
            assert load_config(file).food, block
