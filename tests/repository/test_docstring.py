"""Everything that public packages export is documented: arguments, the shapes of arrays, and errors raised.

Ruff's D417 checks a section of arguments if there is one, but does not require it; its DOC501 also requires errors that
a function raises and catches itself, and those of private functions.
"""

import ast
import re
from collections.abc import Iterator
from pathlib import Path
from textwrap import dedent

import pytest
from project_files import ROOT

Function = ast.FunctionDef | ast.AsyncFunctionDef

SOURCE = ROOT / "src"

FILES = [path for path in sorted(SOURCE.rglob("*.py")) if "_engine" not in path.parts]
EXPORT = re.compile(r"^from \.([\w.]*) import (\w+)", re.MULTILINE)
"""A line of the stub of a public package."""
ARRAY = re.compile(r"\b(NDArray|ndarray|ArrayLike)\b")
OPTION = re.compile(r"\btyper\.(Option|Argument)\b")
"""An argument of a command, which its help documents."""
SHAPE = re.compile(r"shape|\([\w² .:+*/…-]+,[\w² ,.:+*/…-]*\)")
"""The word itself (`any shape`, `the same shape as ages`), or lengths in brackets: `(n,)`, `(worlds, slots + 1)`."""


def patterns(tree: ast.Module) -> tuple[re.Pattern[str], re.Pattern[str]]:
    """The two patterns, extended by a module's own and imported aliases of such types."""
    homes: list[tuple[ast.Module, set[str] | None]] = [(tree, None)]
    for node in tree.body:
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("hedon"):
            home = SOURCE.joinpath(*str(node.module).split(".")).with_suffix(".py")
            if home.is_file():
                homes.append((ast.parse(home.read_text()), {alias.name for alias in node.names}))

    def extended(kind: re.Pattern[str]) -> re.Pattern[str]:
        own = [name for home, names in homes for name in aliases(home, kind, names)]
        return re.compile("|".join([kind.pattern, *(rf"\b{name}\b" for name in own)]))

    return extended(ARRAY), extended(OPTION)


def aliases(tree: ast.Module, kind: re.Pattern[str], wanted: set[str] | None) -> list[str]:
    """The aliases that a module defines for types of a kind."""
    made = [node for node in tree.body if isinstance(node, ast.Assign) and kind.search(ast.unparse(node.value))]
    names = [target.id for node in made for target in node.targets if isinstance(target, ast.Name)]
    return [name for name in names if wanted is None or name in wanted]


def public(tree: ast.Module | ast.ClassDef, path: str = "") -> Iterator[tuple[str, ast.AST, str]]:
    """Public functions, methods and constructors by name, each with its docstring, and the same for fields."""
    doc = ast.get_docstring(tree) or ""
    for node, after in zip(tree.body, [*tree.body[1:], None], strict=True):
        if isinstance(node, ast.ClassDef) and not node.name.startswith("_"):
            yield from public(node, f"{path}{node.name}.")
        elif isinstance(node, Function) and node.name == "__init__":
            yield path + node.name, node, f"{doc}\n{ast.get_docstring(node) or ''}"
        elif isinstance(node, Function) and not node.name.startswith("_") and not is_overload(node):
            yield path + node.name, node, ast.get_docstring(node) or ""
        elif path and isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
            own = after.value.value if isinstance(after, ast.Expr) and isinstance(after.value, ast.Constant) else ""
            if not node.target.id.startswith("_"):
                yield path + node.target.id, node, f"{own}\n{section(doc, 'Attributes').get(node.target.id, '')}"


def exported() -> dict[Path, set[str]]:
    """The names that public packages export, by the files that define them."""
    found: dict[Path, set[str]] = {}
    for stub in (SOURCE / "hedon").rglob("__init__.pyi"):
        for module, name in EXPORT.findall(stub.read_text()):
            home = stub.parent.joinpath(*module.split(".")).with_suffix(".py")
            found.setdefault(home, set()).add(name)
    return found


def is_overload(node: Function) -> bool:
    """Whether a function only declares a signature of the one that follows, for the type checker."""
    return any(isinstance(each, ast.Name) and each.id == "overload" for each in node.decorator_list)


def section(doc: str, name: str) -> dict[str, str]:
    """The entries of a section of a docstring, by the words before their colons; `low, high: …` is one for each."""
    found = re.search(rf"^{name}:\n((?:(?: +.*)?(?:\n|\Z))*)", doc, re.MULTILINE)
    entries = re.split(r"^(?=\S)", dedent(found[1]), flags=re.MULTILINE)[1:] if found else []
    return {word.strip("* "): entry for entry in entries for word in entry.partition(":")[0].split(",")}


def raised(node: ast.AST) -> Iterator[str]:
    """The names of the errors that a function raises itself and does not catch."""
    for child in ast.iter_child_nodes(node):
        if isinstance(child, Function | ast.Lambda | ast.ClassDef):
            continue
        if isinstance(child, ast.Raise) and isinstance(child.exc, ast.Call) and isinstance(child.exc.func, ast.Name):
            if child.exc.func.id[0].isupper():  # not a function that makes an error
                yield child.exc.func.id
        elif isinstance(child, ast.Try):
            caught = {
                each.id
                for handler in child.handlers
                for each in ast.walk(handler.type or handler)
                if isinstance(each, ast.Name)
            }
            within = ast.Module([*child.body, *child.orelse], [])
            yield from () if "Exception" in caught else (error for error in raised(within) if error not in caught)
            after = [each for handler in child.handlers for each in handler.body]
            yield from raised(ast.Module([*after, *child.finalbody], []))
        else:
            yield from raised(child)


def faults(tree: ast.Module) -> Iterator[str]:
    """What the docstrings of a module lack."""
    array, option = patterns(tree)
    for name, node, doc in public(tree):
        if isinstance(node, ast.AnnAssign):
            if array.search(ast.unparse(node.annotation)) and not SHAPE.search(doc):
                yield f"{name}: the shape of the field"
            continue
        assert isinstance(node, Function)
        if not any(option.search(ast.unparse(arg.annotation)) for arg in node.args.args if arg.annotation):
            named = " ".join(section(doc, "Raises"))
            yield from (f"{name}: Raises {error}" for error in dict.fromkeys(raised(node)) if error not in named)
        arguments = [*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs]
        typed = {arg.arg: ast.unparse(arg.annotation) if arg.annotation else "" for arg in arguments}
        typed = {arg: kind for arg, kind in typed.items() if arg not in ("self", "cls") and not option.search(kind)}
        described = section(doc, "Args") or section(doc, "Attributes")
        if len(typed) >= 2 and not described:
            yield f"{name}: Args"
        for arg, kind in typed.items():
            if array.search(kind) and not SHAPE.search(described.get(arg, doc)):
                yield f"{name}: the shape of {arg}"
        if node.returns is not None and array.search(ast.unparse(node.returns)):
            outcome = re.sub(r"^Args:\n(?: +.*\n|\n)*", "", doc, flags=re.MULTILINE)
            if not SHAPE.search(outcome):
                yield f"{name}: the shape of its result"


@pytest.mark.parametrize("source", [
    "def f(a, b):\n  '''Adds.'''",
    "def f(a: NDArray[np.float32]):\n  '''Adds.'''",
    "def f(a, b: Floats):\n  '''Adds.\n\n  Args:\n    a: one\n    b: a row\n  '''\nFloats = NDArray[np.float32]",
    "def f(a: str) -> np.ndarray:\n  '''Adds.'''",
    "class A:\n  '''One.'''\n  b: np.ndarray\n  '''Two.'''",
    "class A:\n  '''One.'''\n  def __init__(self, a, b): ...",
    "def f():\n  '''Fails.'''\n  try:\n    raise KeyError(1)\n  except KeyError:\n    raise ValueError(2) from None",
])  # fmt: skip
def test_what_a_docstring_lacks_is_found(source):
    assert len(list(faults(ast.parse(source)))) == 1


def test_exported_functions_document_their_arguments_and_the_shapes_of_arrays():
    names = exported()
    assert sum(len(own) for path, own in names.items() if path.is_file()) > 100
    missing = [
        f"{path.relative_to(ROOT)}: {fault}"
        for path in FILES
        for fault in faults(ast.parse(path.read_text()))
        if re.split(r"[.:]", fault)[0] in names.get(path, ())
    ]
    assert not missing, f"{len(missing)} missing:\n" + "\n".join(missing)
