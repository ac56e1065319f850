"""The report of a run can be read on a light and on a dark screen."""

import pytest
from synthetic_run import write_run

from hedon.record.reader import open_run
from hedon.report.run import write_report

axe = pytest.importorskip("axe_playwright_python.sync_playwright", reason="needs axe: uv sync --group browser")

pytest_plugins = ("view_fixture",)


@pytest.fixture(scope="module")
def report(tmp_path_factory):
    folder = write_run(tmp_path_factory.mktemp("report") / "run", intervals=6, worlds=3)
    write_report(open_run(folder))
    return folder / "report.html"


@pytest.mark.parametrize("ground", ["dark", pytest.param("light", marks=pytest.mark.long)])
def test_the_report_follows_the_color_scheme_of_the_screen(ground, report, browser):
    page = browser.new_context(color_scheme=ground).new_page()
    page.goto(report.as_uri())
    page.evaluate("document.querySelectorAll('details').forEach((each) => (each.open = true))")
    channels = page.evaluate("getComputedStyle(document.body).backgroundColor.match(/\\d+/g).map(Number)")
    assert (sum(channels) < 150) == (ground == "dark")
    found = axe.Axe().run(page, options={"runOnly": ["color-contrast"]}).response["violations"]
    assert [node["target"] for each in found for node in each["nodes"]] == []
    # Figures have dark text, so they keep their white background.
    assert (
        page.evaluate("getComputedStyle(document.querySelector('figure img')).backgroundColor") == "rgb(255, 255, 255)"
    )
