"""Finds files of an earlier answer or analysis, which a new one in the same folder replaces."""

import json
import re
from pathlib import Path


def earlier_names(summary: Path, key: str) -> set[str]:
    """The names listed under a key of a summary; none if the file is missing or was not written by hedon."""
    try:
        content = json.loads(summary.read_text(encoding="utf-8"))
    except (OSError, ValueError, RecursionError):
        return set()
    names = content.get(key) if isinstance(content, dict) else None
    return {name for name in names if re.fullmatch(r"[\w-]+", str(name))} if isinstance(names, dict | list) else set()
