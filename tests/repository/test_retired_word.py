"""No current page uses a retired name of a setting, a choice, a command or an option.

Pages about earlier versions may: the changelog, the upgrade guide, and results with the commands that made them.
"""

import re
from pathlib import Path

import pytest

from hedon.cli.main import GONE, GONE_OPTIONS
from hedon.config.retired import FIDELITY_NOW, MOVED, VALUES

ROOT = Path(__file__).parents[2]
HISTORY = {"docs/guide/upgrade.md"}
PAGES = sorted(
    page
    for folder in ("docs", "docs/guide", "docs/design")
    for page in (ROOT / folder).glob("*.md")
    if str(page.relative_to(ROOT)) not in HISTORY
) + [ROOT / name for name in ("README.md", "ARCHITECTURE.md", "CONTRIBUTING.md")]
CHOICES = sorted({old for names in (*VALUES.values(), FIDELITY_NOW) for old in names} - {"fed", "hungry"})
"""Only as code, since as words they have other uses."""
RETIRED = {
    **{name: rf"(?<![\w.]){re.escape(name)}(?![\w.])" for name in MOVED},
    **{f"{choice} as a choice": rf"`\"?{choice}\"?`|={choice}\b" for choice in CHOICES},
    **{f"hedon {' '.join(words)}": rf"hedon {' '.join(words)}\b" for words in GONE},
    **{f"hedon {command} {option}": rf"hedon {command}[^\n`]* {option}\b" for command, option in GONE_OPTIONS},
    "neutral gene": r"(?i)neutral\s+markers?\b",
}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_no_name_of_an_earlier_version(page):
    text = page.read_text(encoding="utf-8")
    found = {name: match[0] for name, pattern in RETIRED.items() if (match := re.search(pattern, text))}
    assert not found


def test_retired_names_would_be_found():
    text = (
        "Set `energy.starvation`, the policy `still`, noise=frozen, or call `hedon reproduce` with hedon run x --device"
    )
    assert sum(bool(re.search(pattern, text)) for pattern in RETIRED.values()) >= 4
