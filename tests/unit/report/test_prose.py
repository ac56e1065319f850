"""Markdown written by a study's author is rendered, and HTML in it stays text."""

import polars as pl

from hedon.analysis.result import ResultTable
from hedon.report.page import FigureFile, Page, PageSection, html_page, markdown_page
from hedon.report.table import cells

TEXT = "Does `food` *matter*? <script>alert(1)</script> & [here](https://x.org) [x](javascript:alert(1))"


def test_markdown_becomes_html_and_html_stays_text():
    page = Page("A & B", TEXT, [PageSection("<i>", [TEXT, (TEXT, "second")])], [TEXT])
    shown = html_page(page)
    assert shown.count("<code>food</code> <em>matter</em>") == 4, "lead, caution, paragraph, list"
    assert shown.count('<a href="https://x.org">here</a>') == 4
    assert shown.count("&lt;script&gt;") == 4
    assert "<script>" not in shown
    assert 'href="javascript' not in shown
    assert "<h2>&lt;i&gt;</h2>" in shown
    assert markdown_page(page).count(TEXT) == 4


def test_negative_numbers_have_a_minus_sign_but_code_and_settings_do_not():
    rows = pl.DataFrame({"condition": ["a, x.y=-1", "b-2"], "mean": [-0.02, 3.0]})
    table = ResultTable("means", "Means", rows, "From -3 on.", several=True)
    figure = FigureFile("Which?", "a.svg", b"", "Below -4.")
    page = Page("A", "Of -5, in 1-2.", [PageSection("", ["(-.5) `--set x -6`", ("at -7",), figure, table])])
    for shown in (html_page(page), markdown_page(page)):
        for number in ("From \N{MINUS SIGN}3", "Below \N{MINUS SIGN}4", "Of \N{MINUS SIGN}5", "(\N{MINUS SIGN}.5)"):
            assert number in shown
        assert "\N{MINUS SIGN}7" in shown
        assert "\N{MINUS SIGN}0.02" in shown
        assert all(text in shown for text in ("x.y=-1", "b-2", "1-2", "--set x -6"))
    assert cells(table)[1][0] == ["a, x.y=-1", "-0.0200"], "as a terminal shows it"
