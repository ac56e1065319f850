"""What the text of a rule shows before it is compiled, and what a failure to compile it means, in one line."""

import ast
import re
from collections.abc import Iterator
from typing import Any

from hedon.text import brief

MEMORY = "memory_"
"""Fields of an agent that a rule may write begin so."""
CHANCE = ("random", "numpy.random", "secrets", "uuid", "os.urandom", "os.getrandom")
CLOCKS = ("time", "datetime")
"""Modules and functions by which the same run would come out otherwise."""
_NOISE = re.compile(r"Failed in |During: |File \"|There (is|are) \d+ candidate|>>>|<source|$")
_RETURNED = re.compile(r"setitem\(array\(float64, 1d, C\), int64, (.+)\)")


def refusal(text: str, name: str) -> str:
    """What a rule does that no rule may: it writes what is not a memory, or asks for chance or the time.

    Args:
        text: Of the file, which Python can read.
        name: Of the rule in it; what it does not reach by names of the file is not judged.

    Returns:
        The line and what is wrong there; empty if nothing is.
    """
    tree = ast.parse(text)
    places = _imported(tree)
    for node in _reached(tree, name):
        if (path := _dotted(node, places)) is not None and (found := _source_of(path)):
            what = "the time" if found in CLOCKS else "chance"
            return (
                f"line {node.lineno}: {path} is {what}, with which no run could be repeated; a hazard or birth rule "
                "returns a probability and hedon draws from the world's seed, and agent.step is the time"
            )
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef) and (wrote := _written(node)) is not None:
            return (
                f"line {wrote.lineno}: it writes agent.{wrote.attr}, which would change nothing: a rule acts by what "
                f"it returns, and may write agent.{MEMORY}1, agent.{MEMORY}2, …, as many as reward.memory says"
            )
    return ""


def failure(error: BaseException, file: str) -> str:
    """Why Python cannot read the file of a rule, or why it fails there.

    Args:
        error: That was raised.
        file: As its code has it.
    """
    line, said = None, brief(repr(error))
    if isinstance(error, SyntaxError):
        line, said = error.lineno, f"{type(error).__name__}: {error.msg}"
    trace = error.__traceback__
    while trace is not None and not isinstance(error, SyntaxError):
        line = trace.tb_lineno if trace.tb_frame.f_code.co_filename == file else line
        trace = trace.tb_next
    return f"its file fails{f' at line {line}' if line else ''}: {said}"


def cause(error: BaseException, file: str) -> str:
    """Why Numba cannot compile a rule, without the ways by which it found out.

    Args:
        error: That it raised.
        file: As the code of the rule has it.
    """
    text = str(error)
    own = re.findall(rf'File "(?:[^"]*/)?{re.escape(file)}", line (\d+)|\b{re.escape(file)} \((\d+)\)', text)
    returned = _RETURNED.search(text)
    if returned and not own:
        return f"it returns {brief(returned[1], 40)}: a rule returns one number"
    lines = [line.strip() for line in text.splitlines()]
    said = next((line for line in lines if not _NOISE.match(line)), type(error).__name__)
    call = next((line.removeprefix(">>> ") for line in lines if line.startswith(">>>")), "")
    said = re.sub(r"\s*(found\.)?\s*Raised from .*", "", said)
    said += f" {call}" if said.endswith(":") else ""
    place = f" line {own[0][0] or own[0][1]}" if own else ""
    return f"Numba cannot compile{place or ' it'}: {brief(said)}"


def _reached(tree: ast.Module, name: str) -> Iterator[Any]:
    """All nodes of what a name of the file is made of, and of what that names in turn."""
    bound: dict[str, list[ast.AST]] = {}
    for statement in tree.body:
        names = {node.id for node in ast.walk(statement) if isinstance(node, ast.Name) and _is_store(node)}
        names |= {statement.name} if isinstance(statement, ast.FunctionDef | ast.AsyncFunctionDef) else set()
        for each in names:
            bound.setdefault(each, []).append(statement)
    left, seen = [name], {name}
    while left:
        for statement in bound.get(left.pop(), []):
            for node in ast.walk(statement):
                yield node
                if isinstance(node, ast.Name) and node.id not in seen:
                    seen.add(node.id)
                    left.append(node.id)


def _is_store(node: ast.Name) -> bool:
    return isinstance(node.ctx, ast.Store)


def _imported(tree: ast.Module) -> dict[str, str]:
    """What names of the file stand for, as `np` for `numpy`."""
    places = {}
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            for each in node.names:
                places[each.asname or each.name.partition(".")[0]] = (
                    each.name if each.asname else each.name.partition(".")[0]
                )
        elif isinstance(node, ast.ImportFrom):
            places |= {each.asname or each.name: f"{node.module}.{each.name}" for each in node.names}
    return places


def _dotted(node: ast.AST, places: dict[str, str]) -> str | None:
    """The full name that a node reads, None if it is none of a module."""
    if isinstance(node, ast.Attribute):
        before = _dotted(node.value, places)
        return None if before is None else f"{before}.{node.attr}"
    return places.get(node.id) if isinstance(node, ast.Name) else None


def _source_of(path: str) -> str:
    return next((each for each in (*CHANCE, *CLOCKS) if path == each or path.startswith(f"{each}.")), "")


def _written(function: ast.FunctionDef | ast.AsyncFunctionDef) -> ast.Attribute | None:
    """What a function writes of its first parameter that is not a memory."""
    first = next(iter([*function.args.posonlyargs, *function.args.args]), None)
    for node in ast.walk(function):
        if (
            first is not None
            and isinstance(node, ast.Attribute)
            and isinstance(node.ctx, ast.Store)
            and isinstance(node.value, ast.Name)
            and node.value.id == first.arg
            and not node.attr.startswith(MEMORY)
        ):
            return node
    return None
