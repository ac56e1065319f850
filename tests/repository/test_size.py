"""A checkout stays small: it has nothing that a command builds, and pictures have few colors."""

from PIL import Image
from project_files import ROOT, project_files

MOST = 22_000_000
"""Bytes of all files of the repository."""


def test_a_checkout_is_small():
    assert sum(path.stat().st_size for path in project_files()) <= MOST


def test_pictures_of_the_documentation_have_palettes():
    pictures = [path for path in project_files(".png") if path.is_relative_to(ROOT / "docs")]
    assert pictures
    full = [str(path.relative_to(ROOT)) for path in pictures if Image.open(path).mode != "P"]
    assert not full, f"run python -m release.palette {' '.join(full)}"
