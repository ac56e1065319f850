"""What a study's author writes in Markdown is shown as such, and HTML in it stays text."""

from jinja2 import Environment

from hedon.report.page import _html_prose


def test_markdown_becomes_html_and_html_stays_text():
    page = Environment(autoescape=True).from_string("{{ text }}")
    shown = page.render(text=_html_prose("Does `food` *matter*? <script>alert(1)</script> & [here](https://x.org)"))
    assert "<code>food</code> <em>matter</em>" in shown
    assert '<a href="https://x.org">here</a>' in shown
    assert "&lt;script&gt;" in shown
    assert "<script>" not in shown
    assert "href=" not in _html_prose("[x](javascript:alert(1))")
