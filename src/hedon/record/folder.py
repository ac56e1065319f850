"""Where the files of a run lie."""

from pathlib import Path

CONFIG = "config.toml"
MANIFEST = "manifest.json"
SNAPSHOT = "final.npz"
SUMMARY = "summary.json"
FIGURES = "figures"
LIVING = "agents/living.parquet"
TABLE_FOLDERS = ("agents", "population", "frames")


def holds_run(folder: Path) -> bool:
    """Whether a folder holds a run, or the beginning of one."""
    return any((folder / name).exists() for name in (CONFIG, MANIFEST, *TABLE_FOLDERS))


def part_path(folder: Path, table: str, index: int) -> Path:
    """The path of one part of a table."""
    return folder / table / f"part-{index:06d}.parquet"


def part_paths(folder: Path, table: str) -> list[Path]:
    """The finished parts of a table, in the order in which they were written."""
    return sorted((folder / table).glob("part-*.parquet"))
