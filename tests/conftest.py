"""What all tests share: a config file to write, and how workers share the processors and end together."""

import os
from collections.abc import Callable
from pathlib import Path

import pytest

# Threads of NumPy's library spin while they wait for one another, on processors that another worker could use.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

LONGEST = (
    "test_combination.py",
    "test_assay.py",
    "test_reference_model.py",
    "test_browser.py",
    "test_replay_parts.py",
    "test_resume.py",
    "test_killed.py",
    "test_live.py",
    "test_report.py",
    "test_run.py",
    "test_notebooks.py",
    "test_ray.py",
    "test_ppo.py",
    "test_sweep_run.py",
    "test_module.py",
    "test_story_reader.py",
    "test_story_order.py",
    "test_picture.py",
    "test_docs.py",
    "test_cuda_run.py",
    "test_site.py",
    "test_classics.py",
    "test_store.py",
    "test_damaged_file.py",
    "test_cuda_window.py",
    "test_kernel_symbols.py",
    "test_cli_study.py",
    "test_contest.py",
    "test_lock.py",
    "test_page.py",
)
"""Files of more than some ten seconds of a processor, the longest first."""


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Long files come first, so that no worker is left with one while the other has nothing to do."""
    items.sort(key=lambda item: LONGEST.index(item.path.name) if item.path.name in LONGEST else len(LONGEST))


@pytest.fixture
def write(tmp_path: Path) -> Callable[[str], Path]:
    """Writes a config file and gives its path."""

    def write(text: str) -> Path:
        path = tmp_path / "my.toml"
        path.write_text(text, encoding="utf-8")
        return path

    return write
