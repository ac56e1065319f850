"""Writes the paper as PDF: `python docs/site/paper.py build/docs/docs/paper/paper.pdf`, as `make docs` does.

Pandoc turns its Markdown into the markup of Typst, which sets it. Links to other pages lead to the site beside the PDF.
"""

import re
import sys
from pathlib import Path
from typing import Any

import pypandoc
import typst

ROOT = Path(__file__).parents[2]
SOURCE = ROOT / "docs" / "paper" / "paper.md"


def markup(text: str) -> str:
    """The paper in the markup of Typst.

    Args:
        text: its Markdown; pictures lie in the repository, whose root is Typst's.
    """
    text = re.sub(r"^# .*\n", "", text, count=1, flags=re.MULTILINE)  # the title stands in the head
    text = re.sub(r"(!\[[^]]*\]\()\.\.", r"\1/docs", text)
    text = re.sub(r"(?<!!)\[([^]]*)\]\(([^):#]*)\.md([^)]*)\)", r"[\1](\2.html\3)", text)
    return pypandoc.convert_text(text, "typst", "markdown", extra_args=["--standalone", "-V", "papersize=a4"])


def main(out: Path) -> None:
    """Writes the PDF.

    Args:
        out: where.
    """
    out.parent.mkdir(parents=True, exist_ok=True)
    compiler: Any = typst  # its types want a root of the type of the source
    out.write_bytes(compiler.compile(markup(SOURCE.read_text(encoding="utf-8")).encode(), root=str(ROOT)))


if __name__ == "__main__":
    main(Path(sys.argv[1]).resolve())
