"""The notebooks run from top to bottom in an empty folder, show what they say, and are stored without outputs."""

import json
import re
from pathlib import Path

import pytest
from nbclient import NotebookClient
from nbformat import NotebookNode, read

ROOT = Path(__file__).parents[2]
NOTEBOOKS = sorted((ROOT / "notebooks").glob("*.ipynb"))
PICTURES = {"compare": 1, "descent": 1, "first_run": 1, "own_reward": 0, "power": 1}
"""How many cells of each notebook show one."""


def test_there_are_five():
    assert [path.stem for path in NOTEBOOKS] == sorted(PICTURES)


@pytest.mark.parametrize(
    "path",
    [pytest.param(each, id=each.stem, marks=[pytest.mark.long] * (each.stem != "first_run")) for each in NOTEBOOKS],
)
def test_a_notebook_runs(path: Path, tmp_path: Path):
    if "hedon[rules]" in path.read_text(encoding="utf-8"):
        pytest.importorskip("numba", reason='needs the optional package: pip install "hedon[rules]"')
    notebook = read(path, as_version=4)
    NotebookClient(notebook, timeout=300, resources={"metadata": {"path": str(tmp_path)}}).execute()
    assert sum("image/png" in json.dumps(cell.get("outputs", [])) for cell in notebook.cells) == PICTURES[path.stem]
    shown = [cell for cell in notebook.cells if cell.cell_type == "code" and cell.outputs]
    assert len(shown) >= 3
    assert not [out for cell in shown for out in cell.outputs if out.get("name") == "stderr"]


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_is_stored_without_outputs_and_its_links_lead_somewhere(path: Path):
    notebook = read(path, as_version=4)
    code: list[NotebookNode] = [cell for cell in notebook.cells if cell.cell_type == "code"]
    assert all(not cell.outputs and cell.execution_count is None for cell in code)
    for link in re.findall(r"\]\(([^)#]+)", path.read_text(encoding="utf-8")):
        assert (path.parent / link).is_file(), link
