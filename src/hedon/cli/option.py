"""Options shared by several commands, passed to a command together; and the message for a value that is refused."""

import inspect
from collections.abc import Callable
from dataclasses import fields
from functools import wraps
from typing import Any, get_type_hints

import typer

from hedon.text import brief

Command = Callable[..., None]


def with_options(kind: type) -> Callable[[Command], Command]:
    """Adds the options of a dataclass to a command, after its own; the command gets them together, as `options`."""
    hints = get_type_hints(kind, include_extras=True)
    place = inspect.Parameter.KEYWORD_ONLY
    shared = [
        inspect.Parameter(each.name, place, default=each.default, annotation=hints[each.name]) for each in fields(kind)
    ]

    def wrap(command: Command) -> Command:
        @wraps(command)
        def call(**arguments: Any) -> None:
            options = kind(**{each.name: arguments.pop(each.name) for each in shared})
            command(**arguments, options=options)

        parameters = inspect.signature(command, eval_str=True).parameters.values()
        unshared = [parameter for parameter in parameters if parameter.name != "options"]
        call.__dict__["__signature__"] = inspect.Signature([*unshared, *shared])  # typer reads this
        return call

    return wrap


def refused_value(error: typer.BadParameter) -> str:
    """A message with the value and what is allowed, such as "--steps 0: must be an integer of at least 1".

    Args:
        error: The parser's error; its own words describe the parser's types.

    Returns:
        The message; empty if the parameter is missing.
    """
    if not error.message or error.param is None:
        return ""
    name = max(error.param.opts, key=len)
    bounds = [getattr(error.param, bound, None) for bound in ("min", "max")]
    is_integer = "integer" in error.message or any(isinstance(bound, int) for bound in bounds)
    if not is_integer and "number" not in error.message and bounds == [None, None]:
        return f"{name}: {error.message.removeprefix('Value error, ').rstrip('.')}"
    details = getattr(error.__cause__, "errors", list)()
    value = f" {brief(str(details[0]['input']))}" if details else ""
    return f"{name}{value}: must be {'an integer' if is_integer else 'a number'}{_range(*bounds)}" + (
        ", such as 10000 or 10_000" if "valid integer" in error.message else ""
    )


def _range(least: float | None, most: float | None) -> str:
    low, high = (
        "" if bound is None else f"{bound:,}" if isinstance(bound, int) else f"{bound:g}" for bound in (least, most)
    )
    if low and high:
        return f" from {low} to {high}"
    return f" of at least {low}" if low else f" of at most {high}" if high else ""
