"""How Sphinx makes the site: `make docs` writes it to build/docs.

The source is the whole repository, so that links between pages, to pictures and to files of the code work here as they
do on a code host. README.md is the first page; `contents.md` beside this file lists the others and is added to it here.
"""

import shutil
from importlib.metadata import version as installed_version
from pathlib import Path
from typing import Any

from docutils import nodes
from latex2mathml.converter import convert

HERE = Path(__file__).parent
ROOT = HERE.parents[1]

project = "hedon"
author = "the authors of hedon"
copyright = author  # noqa: A001 - Sphinx's name
release = version = installed_version("hedon")

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon"]
root_doc = "README"
include_patterns = ["*.md", "docs/**", "benchmarks/*.md", "src/hedon_studies/*/*.md"]
exclude_patterns = [
    ".*",
    "build",
    "dist",
    "engine",
    "src/hedon",
    "tests",
    "web",
    "runs",
    "docs/site/contents.md",
]

myst_enable_extensions = ["dollarmath", "amsmath", "strikethrough"]
myst_heading_anchors = 4

default_role = "code"  # of `names` in docstrings
autodoc_member_order = "bysource"
autodoc_mock_imports = ["stable_baselines3"]  # with PyTorch, some gigabytes
autodoc_typehints_format = "short"
napoleon_numpy_docstring = False
napoleon_use_ivar = True

html_theme = "furo"
html_title = f"hedon {release}"
html_static_path = ["static"]
html_css_files = ["site.css"]
html_math_renderer = "mathml"
html_extra_path = ["extra"]
html_copy_source = False
html_show_copyright = False


FOLDER = "\n```{toctree}\n:hidden:\n:glob:\n\n*\n```\n"
ALONE = "---\norphan: true\n---\n\n"


def add_contents(app: Any, docname: str, source: list[str]) -> None:
    """Puts lists of pages, of which Sphinx makes the navigation, below the first page and the README of each folder.

    Pages that programs wrote below `docs/results`, and what a study expected, are reached by links alone.
    """
    if docname == root_doc:
        source[0] += "\n" + (HERE / "contents.md").read_text(encoding="utf-8")
    elif docname.startswith("docs/") and docname.endswith("/README"):
        if len(list((ROOT / docname).parent.glob("*.md"))) > 1:
            source[0] += FOLDER
    elif (docname.startswith("docs/results/") and docname.count("/") > 2) or docname.endswith("/expected"):
        source[0] = ALONE + source[0]


def copy_demo(app: Any, exception: Exception | None) -> None:
    """Copies the demo of the live page, which `make demo` builds, to where the site links to it."""
    if exception is None:
        shutil.copytree(ROOT / app.config.demo, Path(app.outdir) / "docs" / "live", dirs_exist_ok=True)


def show_inline(writer: Any, node: Any) -> None:
    """An equation within a line, as MathML, which browsers draw themselves."""
    writer.body.append(convert(node.astext()))
    raise nodes.SkipNode


def show_block(writer: Any, node: Any) -> None:
    """An equation on its own."""
    writer.body.append(f'<div class="math">{convert(node.astext(), display="block")}</div>')
    raise nodes.SkipNode


def setup(app: Any) -> dict[str, bool]:
    """Called by Sphinx."""
    app.connect("source-read", add_contents)
    app.add_config_value("demo", "build/demo", "", str)
    app.connect("build-finished", copy_demo)
    app.add_html_math_renderer("mathml", (show_inline, None), (show_block, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
