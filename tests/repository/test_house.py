"""The table of rooms in ARCHITECTURE is what the tree has.

Count them again: `PYTHONPATH=tests uv run python -m repository.test_house`.
"""

import ast
import io
import re
import tokenize

import pytest
from project_files import ROOT, project_files

ROOMS = ("engine", "src/hedon", "src/hedon/config", "src/hedon_studies", "benchmarks")
NEAR = 0.05
"""How far the table may lag behind the tree."""
NO_CODE = {
    tokenize.COMMENT,
    tokenize.NL,
    tokenize.NEWLINE,
    tokenize.INDENT,
    tokenize.DEDENT,
    tokenize.ENDMARKER,
}


def code_lines_of_python(text: str) -> int:
    """Lines of a program without blank ones, comments and docstrings."""
    texts, code = set(), set()
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str):
            texts.update(range(node.lineno, (node.end_lineno or node.lineno) + 1))
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type not in NO_CODE:
            code.update(range(token.start[0], token.end[0] + 1))
    return len(code - texts)


def code_lines_of_engine(text: str) -> int:
    """Lines of a C++ file without blank ones and comments, all of which begin with `//` here."""
    return sum(bool(line.partition("//")[0].strip()) for line in text.splitlines())


def count(room: str) -> tuple[int, int]:
    """Lines of all kinds of a room, and those of code alone."""
    texts = [
        (path, path.read_text(encoding="utf-8"))
        for path in project_files(".py", ".h", ".cpp", ".cu")
        if path.is_relative_to(ROOT / room)
    ]
    code = [code_lines_of_python(text) if path.suffix == ".py" else code_lines_of_engine(text) for path, text in texts]
    return sum(len(text.splitlines()) for _, text in texts), sum(code)


def count_imports() -> int:
    """Pairs of a package of `src/hedon` and another one, or a module beside it, that it imports."""
    house = ROOT / "src" / "hedon"
    pairs = set()
    for path in project_files(".py"):
        if path.is_relative_to(house) and path.parent != house:
            room = path.relative_to(house).parts[0]
            found = re.findall(r"^\s*(?:from|import) hedon\.(\w+)", path.read_text(encoding="utf-8"), re.MULTILINE)
            pairs.update((room, other) for other in found if other != room)
    return len(pairs)


def said(row: str) -> list[int]:
    """The numbers in the last column of a row of the table."""
    text = (ROOT / "ARCHITECTURE.md").read_text(encoding="utf-8")
    line = next(line for line in text.splitlines() if line.startswith(f"| {row}"))
    return [int(number.replace(",", "")) for number in re.findall(r"\d[\d,]*", line.split("|")[-2])]


@pytest.mark.parametrize("room", ROOMS)
def test_a_room_has_the_lines_that_the_table_says(room: str):
    row = f"of it `{room.rpartition('/')[2]}`" if room.count("/") == 2 else f"`{room}`"
    assert said(row) == pytest.approx(count(room), rel=NEAR)


def test_the_packages_import_each_other_as_the_table_says():
    assert said("imports between") == pytest.approx([count_imports()], rel=NEAR)


if __name__ == "__main__":
    for each in ROOMS:
        print(f"{each}: {count(each)[0]:,} ({count(each)[1]:,})")
    print("imports:", count_imports())
