"""Options shared by several commands: declared once, as fields of a dataclass, and passed to a command together."""

import inspect
from collections.abc import Callable
from dataclasses import fields
from functools import wraps
from typing import Any, get_type_hints

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
