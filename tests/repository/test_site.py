"""The site builds without warnings, has every page of the documentation, and has no broken links."""

import json
import re
import subprocess
import sys
from html import unescape
from pathlib import Path
from urllib.parse import unquote

import pytest
from command import hedon
from project_files import ROOT, project_files

from hedon.view.page import page_files

pytest.importorskip("furo", reason="needs Sphinx and its theme: uv sync --group docs")

NO_PAGES = {"web", "docs/site/contents.md"}
"""Markdown that is not a page: a part of the project read in its folder, and a part of another page."""


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out, run, demo = (tmp_path_factory.mktemp("site") / name for name in ("site", "run", "demo"))
    recorded = hedon("run", "appetite", "--steps", 1024, "--frames", 256, "--out", run)
    assert recorded.returncode == 0, recorded.stderr
    exported = hedon("view", run, "--story", "--export", demo)
    assert exported.returncode == 0, exported.stderr
    sphinx = ("sphinx", "--quiet", "--fail-on-warning", "--conf-dir", "docs/site", "--define", f"demo={demo}")
    command = [sys.executable, "-m", *sphinx, ".", str(out)]
    made = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=300, check=False)
    assert made.returncode == 0, made.stderr
    return out


def test_every_page_is_in_it(site: Path) -> None:
    pages = [page.relative_to(ROOT) for page in project_files(".md")]
    wanted = [page for page in pages if not NO_PAGES & {page.parts[0], page.as_posix()}]
    assert len(wanted) > 60
    assert [page for page in wanted if not (site / page).with_suffix(".html").is_file()] == []


def test_its_links_lead_somewhere(site: Path) -> None:
    names: dict[Path, set[str]] = {}
    broken = []
    for page in sorted(site.rglob("*.html")):
        for link in re.findall(r'(?:href|src)="([^"]*)"', page.read_text(encoding="utf-8")):
            path, _, anchor = unquote(unescape(link)).partition("#")
            if re.match(r"[a-z]+:|//", path):
                continue
            target = (page.parent / path.partition("?")[0]).resolve() if path else page
            if not target.is_file():
                broken.append((page.name, link))
            elif anchor and "=" not in anchor and target.suffix == ".html":  # with "=", a state of the live page
                if target not in names:
                    names[target] = set(re.findall(r'\bid="([^"]*)"', target.read_text(encoding="utf-8")))
                if anchor not in names[target]:
                    broken.append((page.name, link))
    assert broken == []
    assert len(names) > 40


def test_a_page_asks_no_other_host_for_anything(site: Path) -> None:
    """Neither for scripts, styles or pictures, nor from programs within the page."""
    asked = []
    for page in sorted(site.rglob("*.html")):
        text = page.read_text(encoding="utf-8")
        asked += re.findall(r'<(?:script|img|iframe)[^>]*\bsrc="((?:https?:)?//[^"]*)"', text)
        asked += re.findall(r'<link[^>]*rel="(?:stylesheet|preload|icon)"[^>]*href="((?:https?:)?//[^"]*)"', text)
        for script in re.findall(r"<script\b[^>]*>(.*?)</script>", text, flags=re.DOTALL):
            asked += re.findall(r"""["'](https?://[^"']*)["']""", script)
    assert asked == []


def test_docstrings_and_equations_are_shown(site: Path) -> None:
    runs = (site / "docs/site/api/run.html").read_text(encoding="utf-8")
    assert "All agents of one moment" in runs
    model = (site / "docs/model.html").read_text(encoding="utf-8")
    assert model.count("<math") > 50
    assert "$" not in re.sub(r"<(script|style|pre|code)\b.*?</\1>|<[^>]*>", "", model, flags=re.DOTALL)


def test_the_demo_of_the_live_page_is_in_it(site: Path) -> None:
    live = site / "docs" / "live"
    for name, path in page_files().items():
        if name not in ("single.js", "hero.gz", "hero.jpg"):  # of the article, not of the live page
            assert (live / name).read_bytes() == path.read_bytes()
    assert json.loads((live / "data/page.json").read_text(encoding="utf-8"))["run"] is True
