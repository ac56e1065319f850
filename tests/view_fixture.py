"""A pytest plugin: a browser, a run to watch, and pages that must not report errors."""

from typing import Any

import pytest
from view_page import CHROMIUM, FLAGS, SIZE, Watched, record


@pytest.fixture(scope="session")
def browser():
    playwright = pytest.importorskip("playwright.sync_api", reason="needs Playwright: uv sync --group browser")
    if not CHROMIUM.exists():
        pytest.skip(f"needs {CHROMIUM}: apt-get install chromium")
    with playwright.sync_playwright() as tool:
        opened = tool.chromium.launch(executable_path=str(CHROMIUM), args=FLAGS)
        yield opened
        opened.close()


@pytest.fixture(scope="session")
def run_folder(tmp_path_factory):
    return record(tmp_path_factory.mktemp("view") / "run", 2048)


@pytest.fixture
def watch(browser):
    """Opens links; at the end, no page may have reported an error or sent a request to another host.

    Keyword arguments go to Playwright's context: `viewport`, `color_scheme`, `has_touch`, `reduced_motion`.
    """
    opened = []

    def open_link(link: str, **how: Any) -> Watched:
        context = browser.new_context(**{"viewport": SIZE, **how})
        opened.append((context, Watched(context.new_page(), link)))
        return opened[-1][1]

    yield open_link
    for context, watched in opened:
        context.close()
        assert watched.faults == []
