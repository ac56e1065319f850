"""Checks the text of a rule before it is compiled, and explains failures to compile it, in one line."""

import ast
import re
import sys
from collections.abc import Collection, Iterator
from importlib.util import find_spec
from typing import Any, TypeGuard

from hedon.text import brief

MEMORY = "memory_"
"""Prefix of the agent's fields that a rule may write."""
SEEDED = ("numpy.random.default_rng", "random.Random")
"""Random number generators that are the same in every run if they are called with a number."""
CHANCE = ("random", "numpy.random", "secrets", "uuid", "os.urandom", "os.getrandom")
CLOCKS = ("time", "datetime")
"""Modules and functions that would make repetitions of a run differ."""
READERS = ("read_text", "read_bytes", "load", "loadtxt", "genfromtxt", "fromfile", "memmap", "read_csv")
"""Methods and functions of modules that read files."""
_NOISE = re.compile(r"Failed in |During: |File \"|There (is|are) \d+ candidate|>>>|<source|$")
_RETURNED = re.compile(r"setitem\(array\(float64, 1d, C\), int64, (.+)\)")


def refusal(text: str, name: str, columns: Collection[str]) -> str:
    """Why a rule is not allowed: it writes something other than memory, or uses random numbers or the time.

    Returns:
        The line and the reason; empty if the rule is allowed.
    """
    tree = ast.parse(text)
    places = _imported(tree)
    seeded = {id(part) for call in ast.walk(tree) if _is_seeded(call, places) for part in ast.walk(call)}
    for node in _reached(tree, name):
        if id(node) in seeded:
            continue
        if (path := _dotted(node, places)) is not None and (source := _source_of(path)):
            kind = "the time" if source in CLOCKS else "chance"
            return (
                f"line {node.lineno}: {path} is {kind}, with which no run could be repeated; a hazard or birth rule "
                "returns a probability and hedon draws from the world's seed, and agent.step is the time"
            )
        if (field := _written(node)) in columns and not field.startswith(MEMORY):
            return (
                f"line {node.lineno}: it writes agent.{field}, which would change nothing: a rule acts by what "
                f"it returns, and may write agent.{MEMORY}1, agent.{MEMORY}2, …, as many as reward.memory says"
            )
    return ""


def unpinned(text: str) -> str:
    """What a rule takes from elsewhere that no run keeps, or under names that cannot be checked.

    Returns:
        The line and the reason; empty if there is nothing.

    Raises:
        SyntaxError, ValueError: Python cannot read the file.
    """
    for node in ast.walk(ast.parse(text)):
        if _reads_file(node):
            return f"line {node.lineno}: it reads a file, which no run keeps: put what it needs into the rule's file"
        if isinstance(node, ast.ImportFrom) and any(alias.name == "*" for alias in node.names):
            return f"line {node.lineno}: it imports * from {node.module}: import by name what it uses"
        if not isinstance(node, ast.Import | ast.ImportFrom):
            continue
        modules = [alias.name for alias in node.names] if isinstance(node, ast.Import) else [node.module or "."]
        for module in modules:
            if not _is_installed(module.partition(".")[0]):
                return (
                    f"line {node.lineno}: it imports {module}, a file of yours: a run keeps the text of the rule's own "
                    "file alone, so put what it needs there"
                )
    return ""


def _reads_file(node: ast.AST) -> TypeGuard[ast.Call]:
    """Whether a node calls `open` or a method that reads files."""
    if not isinstance(node, ast.Call):
        return False
    function = node.func
    return (isinstance(function, ast.Name) and function.id == "open") or (
        isinstance(function, ast.Attribute) and function.attr in ("open", *READERS)
    )


def _is_installed(module: str) -> bool:
    """Whether a module belongs to Python or an installed package, rather than being a user's file."""
    if not module:  # of a relative import
        return False
    if module in sys.stdlib_module_names or module in ("hedon", "hedon_studies"):
        return True
    try:
        spec = find_spec(module)
    except (ImportError, ValueError):
        return True  # missing: Python reports it when it runs the file
    if spec is None:  # missing, too
        return True
    places = [*(spec.submodule_search_locations or ()), spec.origin or ""]
    return any("site-packages" in place or "dist-packages" in place for place in places)


def failure(error: BaseException, file: str) -> str:
    """Why Python cannot read a rule's file, or why the file fails."""
    line, message = None, brief(repr(error))
    if isinstance(error, SyntaxError):
        line, message = error.lineno, f"{type(error).__name__}: {error.msg}"
    trace = error.__traceback__
    while trace is not None and not isinstance(error, SyntaxError):
        line = trace.tb_lineno if trace.tb_frame.f_code.co_filename == file else line
        trace = trace.tb_next
    return f"its file fails{f' at line {line}' if line else ''}: {message}"


def cause(error: BaseException, file: str) -> str:
    """Why Numba cannot compile a rule, without Numba's trace."""
    text = str(error)
    matches = re.findall(rf'File "(?:[^"]*/)?{re.escape(file)}", line (\d+)|\b{re.escape(file)} \((\d+)\)', text)
    return_match = _RETURNED.search(text)
    if return_match and not matches:
        return f"it returns {brief(return_match[1], 40)}: a rule returns one number"
    lines = [line.strip() for line in text.splitlines()]
    message = next((line for line in lines if not _NOISE.match(line)), type(error).__name__)
    call = next((line.removeprefix(">>> ") for line in lines if line.startswith(">>>")), "")
    message = re.sub(r"\s*(found\.)?\s*Raised from .*", "", message)
    message += f" {call}" if message.endswith(":") else ""
    location = f" line {matches[0][0] or matches[0][1]}" if matches else ""
    return f"Numba cannot compile{location or ' it'}: {brief(message)}"


def _reached(tree: ast.Module, name: str) -> Iterator[Any]:
    """Yields all nodes that define a name of the file, and those that define the names that these use."""
    bound: dict[str, list[ast.AST]] = {}
    for statement in tree.body:
        for bound_name in _names(statement):
            bound.setdefault(bound_name, []).append(statement)
    pending, seen = [name], {name}
    while pending:
        for statement in bound.get(pending.pop(), []):
            for node in ast.walk(statement):
                yield node
                if isinstance(node, ast.Name) and node.id not in seen:
                    seen.add(node.id)
                    pending.append(node.id)


def _names(statement: ast.AST) -> set[str]:
    """Names that a statement binds in the file, without those within functions and classes."""
    if isinstance(statement, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
        return {statement.name}
    names = {statement.id} if isinstance(statement, ast.Name) and isinstance(statement.ctx, ast.Store) else set()
    return names.union(*map(_names, ast.iter_child_nodes(statement)))


def _imported(tree: ast.Module) -> dict[str, str]:
    """What imported names of the file stand for, such as `np` for `numpy`."""
    places = {}
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            for alias in node.names:
                places[alias.asname or alias.name.partition(".")[0]] = (
                    alias.name if alias.asname else alias.name.partition(".")[0]
                )
        elif isinstance(node, ast.ImportFrom):
            places |= {alias.asname or alias.name: f"{node.module}.{alias.name}" for alias in node.names}
    return places


def _dotted(node: ast.AST, places: dict[str, str]) -> str | None:
    """Full name that a node reads; None if it is not from a module."""
    if isinstance(node, ast.Attribute):
        prefix = _dotted(node.value, places)
        return None if prefix is None else f"{prefix}.{node.attr}"
    return places.get(node.id) if isinstance(node, ast.Name) else None


def _source_of(path: str) -> str:
    return next((source for source in (*CHANCE, *CLOCKS) if path == source or path.startswith(f"{source}.")), "")


def _is_seeded(node: ast.AST, places: dict[str, str]) -> bool:
    """Whether a node creates a random number generator from a number."""
    return (
        isinstance(node, ast.Call)
        and _dotted(node.func, places) in SEEDED
        and any(isinstance(argument, ast.Constant) and isinstance(argument.value, int) for argument in node.args)
    )


def _written(node: ast.AST) -> str:
    """Field that a node writes, such as `energy` for `agent.energy = 1` and `agent["energy"] = 1`; empty for none."""
    if isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Store):
        return node.attr
    if isinstance(node, ast.Subscript) and isinstance(node.ctx, ast.Store) and isinstance(node.slice, ast.Constant):
        return str(node.slice.value)
    return ""
