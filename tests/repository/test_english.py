"""Pages, docstrings, messages and comments are idiomatic English, without phrases that readers stumble over.

Some phrases are always wrong. Others are habits: right in places, so their number in each folder may only fall. After
an edit, `PYTHONPATH=tests uv run python -m repository.test_english` updates the numbers.
"""

import csv
import re
from collections import Counter

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
"""Patterns of what is always wrong, by a descriptive name."""
OUTSIDE = ("src/hedon/view/static/", "tests/repository/test_english.py")
PLACES = (
    "README.md",
    "ARCHITECTURE.md",
    "CONTRIBUTING.md",
    "docs/",
    "src/",
    "engine/",
    "web/src/",
    "tests/",
    "examples/",
    "benchmarks/",
)
KINDS = {".md", ".py", ".h", ".cpp", ".cu", ".ts", ".js", ".j2"}


@pytest.mark.parametrize("name", WRONG)
def test_no_page_and_no_text_has(name):
    found = []
    for path in project_files(*KINDS):
        place = path.relative_to(ROOT).as_posix()
        if place.startswith(PLACES) and not place.startswith(OUTSIDE):
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


COUNTS = ROOT / "tests" / "repository" / "habit_counts.csv"
HABITS = {
    "tell and say for report or show": (
        r"\b(?:is|are) told\b"
        r"|\b(?:says?|tells?|told) (?:what|which|how|why|whether|so|of|in|by|where|who|from|all|none|it)\b"
    ),
    "who and nobody for things": (
        r"(?:^|[.;:,(] )[Ww]ho (?:is|was|are|has|have|had|dies|eats|lives|needs|reads|starves|bears?|learns?|asks?)\b"
        r"|\b(?:for|of|by|as|than|to) who(?:m|ever)?\b|\bnobody\b"
    ),
    "by for at, under, with, after": (
        r"\bby (?:ten times|its (?:own |values|senses|rays|settings|seed)|Holm|t\b|keys|[0-9]+ bits|weights of|seed\b)"
    ),
    "where for if and when": (
        r"(?:^|[.;:,] |\| )[Ww]here "
        r"(?:it|they|agents|worlds|food|no|nobody|there|several|both|few|one|two|some|you|many)\b"
    ),
    "a what-clause as the subject": (
        r"(?:^|[.;:,] )[Ww]hat "
        r"(?:it|they|we|an?|each|its|nobody|only|agents|follows|comes?|came|goes|cannot|was|else|holds) "
    ),
    "stand and lie for be": (
        r"\b(?:stands?|stood|lies|lie) (?:in|at|on|beside|above|below|there|under|within|between|with|by|near|over)\b"
    ),
    "mend, anew, go on": r"\bmend(?:s|ed)?\b|\banew\b|\b(?:goes|go|went|gone) on\b",
    "that of and those of": r"\b(?:that|those) of\b",
    "alone after its noun": r"[a-z`)] alone\b",
    "beside": r"\bbeside\b",
}
"""Patterns of phrases that are often a habit, by name."""


def folder_of(place: str) -> str:
    """The folder in which a file is counted: a package of `src`, or two levels of anything else."""
    *folders, _ = place.split("/")
    return "/".join(folders[: 3 if place.startswith("src/") else 2]) or place


def counted() -> Counter[tuple[str, str]]:
    """How often each habit occurs in each folder."""
    found: Counter[tuple[str, str]] = Counter()
    for path in project_files(*KINDS):
        place = path.relative_to(ROOT).as_posix()
        if place.startswith(("CHANGELOG.md", *PLACES)) and not place.startswith(OUTSIDE):
            text = path.read_text(encoding="utf-8")
            for name, pattern in HABITS.items():
                found[folder_of(place), name] += sum(1 for _ in re.finditer(pattern, text, re.MULTILINE))
    return +found


def test_no_habit_spreads():
    with COUNTS.open(newline="") as file:
        most = {(row["folder"], row["habit"]): int(row["count"]) for row in csv.DictReader(file)}
    risen = {key: (most.get(key, 0), count) for key, count in counted().items() if count > most.get(key, 0)}
    assert not risen, f"(folder, habit): (before, now): {risen}; rewrite the new ones"


def test_a_habit_would_be_counted():
    text = "What it does is told. Where it lies beside that of others, nobody goes on alone."
    assert sum(bool(re.search(pattern, text)) for pattern in HABITS.values()) >= 7


if __name__ == "__main__":
    with COUNTS.open("w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["folder", "habit", "count"])
        writer.writerows((*key, count) for key, count in sorted(counted().items()))
