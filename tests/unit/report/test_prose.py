"""What a study's author writes in Markdown is shown as such, and HTML in it stays text."""

from hedon.report.page import Page, PageSection, html_page, markdown_page

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
