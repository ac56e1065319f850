import json
import re
from html.parser import HTMLParser
from pathlib import Path

import matplotlib.colors as mpl_colors
import numpy as np
import polars as pl
import pytest
from markdown_it import MarkdownIt
from synthetic_run import write_run

from hedon.config.color import weight_colors
from hedon.config.title import weight_titles
from hedon.figure.lineage import draw_lineages
from hedon.figure.regime import REGIME_COLORS, draw_regimes
from hedon.figure.selection import draw_selection
from hedon.figure.style import svg_bytes
from hedon.figure.survival import draw_survival
from hedon.record.error import RecordError
from hedon.record.reader import open_run
from hedon.report.analysis import Analysis, analyze
from hedon.report.figure import FIGURES
from hedon.report.page import FigureFile, html_page, markdown_page
from hedon.report.run import report_page, write_report

# Both lead to the same names for their figures, and contain characters with a meaning in Markdown or HTML.
FOLDERS = ["a|b *c* <i>d `e` [f](g) &lt; #", "_a_ ~~b~~ \\| $c$\n# <i>d e f g lt"]
NAME = "baseline (corrected)"
CONDITION = "<b>mush & room</b> | *x*"
VOID = {"meta", "img", "br", "hr"}


class Outline(HTMLParser):
    """Checks that elements nest, and collects images, links, tags and text."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.images: list[dict] = []
        self.links: list[str] = []
        self.ids: set[str] = set()
        self.tags: set[str] = set()
        self.text = ""

    def handle_starttag(self, tag: str, attrs: list) -> None:
        values = dict(attrs)
        self.ids.add(values.get("id", ""))
        self.tags.add(tag)
        if tag == "img":
            self.images.append(values)
        if tag == "a":
            self.links.append(values["href"])
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag: str, attrs: list) -> None:
        self.handle_starttag(tag, attrs)

    def handle_data(self, data: str) -> None:
        self.text += data

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag


@pytest.fixture(scope="module")
def report(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("page")
    first = write_run(folder / FOLDERS[0], intervals=30, worlds=4, extinct=2)
    second = write_run(folder / FOLDERS[1], intervals=20, worlds=2, name=CONDITION, modified=True)
    write_report(open_run(first), open_run(second), folder=folder / "out")
    return folder / "out"


def test_the_page_is_self_contained(report: Path) -> None:
    text = (report / "report.html").read_text(encoding="utf-8")
    outline = Outline()
    outline.feed(text)
    assert outline.open == []
    assert len(outline.images) == 2 * 9  # every figure for both conditions, each with one of a world
    assert all(image["src"].startswith("data:image/svg+xml;base64,") for image in outline.images)
    assert all(image["alt"] for image in outline.images)
    assert all(link.startswith("#") and link[1:] in outline.ids for link in outline.links)
    assert not re.search(r"(src|href)=\"https?:", text)
    assert "url(" not in text
    assert 'name="viewport"' in text
    assert "@media print" in text


def test_every_figure_says_how_to_read_it(report: Path) -> None:
    html, markdown = ((report / name).read_text(encoding="utf-8") for name in ("report.html", "report.md"))
    for kind in FIGURES:
        assert len(kind.caption) > 100
        assert markdown.count(kind.caption) == 2
        assert html.replace("&#39;", "'").count(f"<figcaption>{kind.caption}</figcaption>") == 2


def test_the_page_shows_results_settings_and_manifest(report: Path) -> None:
    text = (report / "report.html").read_text(encoding="utf-8")
    assert "Died out: seed 3 at step" in text
    assert '<span class="badge undecided">undecided</span>' in text
    assert "&lt;b&gt;mush &amp; room&lt;/b&gt;" in text
    assert "<b>mush" not in text
    assert "R0 is 1.02 at energy 0" in text
    assert "The settings are those of baseline (corrected)." in text
    assert "growth_rate = 0.2" in text
    assert "&#34;seeds&#34;: [" in text  # the manifest
    assert "starving, limited by room" in text


def test_markdown_has_the_same_tables_and_links_to_its_figures(report: Path) -> None:
    text = (report / "report.md").read_text(encoding="utf-8")
    figures = re.findall(r"!\[[^\]]*\]\(([^)]+)\)", text)
    assert len(figures) == 18
    assert len(set(figures)) == 18
    assert all((report / figure).is_file() for figure in figures)
    assert "| food weight positive |" in text
    assert "\n\n\n\n" not in text
    for line in re.findall(r"^\|.*$", text, re.MULTILINE):
        assert line.endswith("|")
    manifest = re.findall(r"^```json\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)[0]
    assert json.loads(manifest)["seeds"] == [1, 2, 3, 4]


def test_names_are_escaped_in_markdown_and_html(report: Path) -> None:
    markdown = (report / "report.md").read_text(encoding="utf-8")
    rendered = MarkdownIt("commonmark").enable(["table", "strikethrough"]).render(markdown)
    page = (report / "report.html").read_text(encoding="utf-8")
    for html, names in ((rendered, [" ".join(name.split()) for name in FOLDERS]), (page, FOLDERS)):
        outline = Outline()
        outline.feed(html)
        assert outline.text.count(f"{CONDITION} (corrected), modified") > 20  # in headings, and in a column of tables
        assert all(f"Manifest of {name} (finished)" in outline.text for name in names)
        assert not {"b", "i", "em", "s"} & outline.tags


def test_the_same_records_give_the_same_page(analysis: Analysis) -> None:
    figures = [draw_regimes(analysis.tables["regime_time"].rows) for _ in range(2)]
    first, second = (FigureFile("What?", "a.svg", svg_bytes(figure)) for figure in figures)
    assert first == second
    assert first.svg.startswith(b"<?xml")
    again = analyze(analysis.runs)
    one, other = report_page(analysis, {NAME: [first]}), report_page(again, {NAME: [second]})
    assert (html_page(one), markdown_page(one)) == (html_page(other), markdown_page(other))


def test_changed_settings_and_damaged_files_are_shown(tmp_path: Path) -> None:
    folder = write_run(tmp_path / "run", intervals=5, worlds=1)
    (folder / "config.toml").write_text('preset = "baseline"\n[energy]\ninitial = 33.0\n')
    (folder / "agents/part-000000.parquet").write_bytes(b"torn")
    (folder / "final.npz").write_bytes(b"torn")
    with pytest.raises(RecordError, match="damaged snapshot"):  # after everything else is written
        write_report(open_run(folder))
    text = (folder / "report.html").read_text()
    assert "<tr><td>energy.initial</td><td>40.0</td><td>33.0</td></tr>" in text
    assert "agents/part-000000.parquet" in text


@pytest.fixture(scope="module")
def analysis(tmp_path_factory: pytest.TempPathFactory) -> Analysis:
    folder = tmp_path_factory.mktemp("figures") / "run"
    return analyze([open_run(write_run(folder, intervals=60, worlds=5, snapshot=False))])


def test_figures_draw_their_tables(analysis: Analysis) -> None:
    tables = {name: table.rows for name, table in analysis.tables.items()}
    titles = weight_titles(("w_normal", "w_action"), ("neutral_1", "neutral_2"))
    assert list(titles) == ["w_normal", "w_action", "neutral_1"]
    colors = weight_colors(titles, {"normal": "#00ff00"})
    assert colors["w_normal"] == "#00ff00"

    survival = draw_survival(tables["survival"], tables["lifetime_world"]).axes[0]
    first = tables["survival"].filter(pl.col("seed") == 1)
    np.testing.assert_allclose(np.asarray(survival.lines[0].get_ydata(), float), first["share"])

    panels = draw_selection(tables["selection_window"], tables["selection_world"], titles, colors).axes
    means = tables["selection_window"].filter(pl.col("fitness") == "children", pl.col("weight") == "w_normal")
    dots = np.asarray(panels[0].collections[-1].get_offsets())
    np.testing.assert_allclose(sorted(dots[:, 1]), sorted(means.drop_nulls()["mean"]))

    lineage = draw_lineages(tables["lineage"], titles, colors).axes
    assert len(lineage) == 4
    assert np.asarray(lineage[0].lines[0].get_ydata())[-1] == tables["lineage"].filter(pl.col("seed") == 1)["lines"][-1]


def test_regimes_are_drawn_at_their_steps() -> None:
    names = ["between", "starving, limited by room", "starving, limited by room", "extinct"]
    rows = pl.DataFrame({"seed": [7] * 4, "step": [10, 20, 30, 40], "steps": [10] * 4, "regime": names})
    bars = draw_regimes(rows).axes[0].collections[0]
    spans = [(path.get_extents().x0, path.get_extents().x1) for path in bars.get_paths()]
    assert spans == [(0, 10), (10, 30), (30, 40)]
    shown = [mpl_colors.to_hex(color) for color in np.asarray(bars.get_facecolor())]
    assert shown == [REGIME_COLORS[name].lower() for name in (names[0], names[1], names[3])]
