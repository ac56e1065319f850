"""What precedes the numbers of a comparison: the step, the differing settings, the design, and cautions."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from hedon.check.difference import changed_line
from hedon.compare.length import step_sentence
from hedon.compare.match import ContrastDesign
from hedon.compare.source import CONDITION, SOURCE, WorldTable
from hedon.config.dump import diff
from hedon.report.markdown import escape_markdown
from hedon.report.page import Page, PageSection
from hedon.text import count

MOST_SHOWN = 10
"""Largest number of settings that are listed."""
MOST_CLEAR = 3
"""Largest number of differing settings without a caution."""
_OF_RUNS = (SOURCE, CONDITION)
"""Factors whose values have known settings if runs hold the worlds."""


@dataclass(frozen=True)
class Preface:
    """The sentences before the numbers of a comparison.

    Attributes:
        sentences: The step at which worlds are compared, which conditions these are, and the design.
        settings_title: Heading of the settings; empty if they are unknown or equal.
        settings: Lines with the differing settings.
        cautions: Sentences on what the settings do not allow to conclude.
        content: Fields of the JSON file.
    """

    sentences: Sequence[str]
    settings_title: str
    settings: Sequence[str]
    cautions: Sequence[str]
    content: Mapping[str, Any]

    @property
    def lead(self) -> str:
        """The sentences, in Markdown, each a paragraph."""
        return "\n\n".join(map(escape_markdown, self.sentences))

    @property
    def lines(self) -> list[str]:
        """All of it, as lines of a terminal."""
        title = [f"{self.settings_title}:"] if self.settings_title else []
        return [*self.sentences, *title, *(f"  {line}" for line in self.settings), *self.cautions]

    def on_page(self, page: Page) -> Page:
        """A page with the settings before its sections, and with the cautions."""
        lines = tuple(map(escape_markdown, self.settings))
        first = [PageSection("", [f"{escape_markdown(self.settings_title)}:", lines])] if lines else []
        return replace(page, sections=[*first, *page.sections], cautions=tuple(map(escape_markdown, self.cautions)))


def make_preface(worlds: WorldTable, by: str, names: Sequence[str], design: ContrastDesign) -> Preface:
    """The sentences before the numbers of a comparison."""
    step = step_sentence(worlds.steps, worlds.lengths)
    labels = [worlds.labels[name] for name in names if name in worlds.labels]
    pair = f"{names[1]} against {names[0]}."
    sentences = [step, pair if by == SOURCE else f"{by}: {pair}", _described(names, labels), design.sentence]
    content: dict[str, Any] = {"steps": worlds.steps, "compared_at": step} if worlds.steps else {}
    content |= {"paired": design.paired, "design": design.sentence}
    content |= {"conditions": labels} if labels else {}
    title, lines, cautions = "", list[str](), list[str]()
    if by in _OF_RUNS and all(name in worlds.configs for name in names):
        changes = diff(*(worlds.configs[name] for name in names))
        rows = [row for row in changes if not row[0].endswith(".color")]  # colors change no world
        lines, cautions = _setting_lines(rows), _setting_cautions(rows)
        title = f"Settings that differ, {names[0]} -> {names[1]}" if rows else ""
        content["settings"] = [{"setting": path, "values": list(values)} for path, *values in rows]
        content["setting_cautions"] = cautions
    return Preface(list(filter(None, sentences)), title, lines, cautions, content)


def _setting_lines(rows: Sequence[tuple[str, Any, Any]]) -> list[str]:
    """A line for each setting, as `hedon check A --against B` shows it; beyond `MOST_SHOWN`, their number."""
    lines = [changed_line(*row) for row in rows[:MOST_SHOWN]]
    return lines + ([f"and {count(len(rows) - MOST_SHOWN, 'other setting')}"] if len(rows) > MOST_SHOWN else [])


def _setting_cautions(rows: Sequence[tuple[str, Any, Any]]) -> list[str]:
    """Sentences on what a comparison of conditions that differ in these settings cannot show."""
    if not rows:
        return ["No setting differs: these are two samples of the same condition."]
    if len(rows) > MOST_CLEAR:
        return [f"{len(rows)} settings differ: the comparison cannot tell which of them matters."]
    return []


def _described(names: Sequence[str], labels: Sequence[str]) -> str:
    """Names the condition of each of two sources, as reports do; empty if they are unknown."""
    if len(labels) < len(names):
        return ""
    if labels[0] == labels[1]:
        return f"Both are {labels[0]}."
    return "; ".join(f"{name} is {label}" for name, label in zip(names, labels, strict=True)) + "."
