"""Pages, docstrings, messages and comments are plain English, without the turns that readers stumble over."""

import re

import pytest
from project_files import ROOT, project_files

WRONG = {
    "a relative clause as a noun": (
        r"\bWho (?:is|was|are|has|dies|eats|lives|needs|reads|starves)\b[^?\n]*\.|\b[Ww]hoever\b"
    ),
    "an inversion": r"\b[Oo]f (?:what|whom) (?:do|does|did)\b",
    "a verb before not": r"\b(?:goes|go|counts|knows|says|means|comes|holds|lies) not\b",
    "so much that is left open": r"\bso (?:much|many)\b(?! (?:[^\s]+ ){0,3}(?:that|as)\b)",
    "of whom there is none": r"\bof whom there\b",
}
"""What is wrong, by a name that tells what to look for."""
LATER = ("docs/results/", "src/hedon/view/static/")
PLACES = (
    "README.md",
    "ARCHITECTURE.md",
    "CONTRIBUTING.md",
    "docs/",
    "src/",
    "engine/",
    "web/src/",
    "examples/",
    "benchmarks/",
)
KINDS = {".md", ".py", ".h", ".cpp", ".cu", ".ts", ".js", ".j2"}


@pytest.mark.parametrize("name", WRONG)
def test_no_page_and_no_text_has(name):
    found = []
    for path in project_files(*KINDS):
        place = path.relative_to(ROOT).as_posix()
        if place.startswith(PLACES) and not place.startswith(LATER):
            text = path.read_text(encoding="utf-8")
            found += [
                f"{place}:{text.count(chr(10), 0, match.start()) + 1}: {match.group().strip()}"
                for match in re.finditer(WRONG[name], text, re.MULTILINE)
            ]
    assert not found, "\n".join(found)


@pytest.mark.parametrize(
    ("name", "text"),
    list(
        zip(
            WRONG,
            (
                "Who is eaten eats nothing.",
                "of what do prey die",
                "it goes not with",
                "it explains so much",
                "of whom there",
            ),
            strict=True,
        )
    ),
)
def test_what_is_wrong_is_found_and_what_is_right_is_not(name, text):
    assert re.search(WRONG[name], text)
    assert not re.search(WRONG[name], "So many agents live that some starve. Who eats whom? What do prey die of?")
