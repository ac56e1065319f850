"""Options that several commands share: declared once, as the fields of a dataclass, and given to a command as one."""

import inspect
from collections.abc import Callable
from dataclasses import fields
from functools import wraps
from typing import Any, get_type_hints

Command = Callable[..., None]


def with_options(kind: type) -> Callable[[Command], Command]:
    """Gives a command the options of a dataclass after its own. The command takes them together, as `options`."""
    hints = get_type_hints(kind, include_extras=True)
    place = inspect.Parameter.KEYWORD_ONLY
    shared = [
        inspect.Parameter(each.name, place, default=each.default, annotation=hints[each.name]) for each in fields(kind)
    ]

    def wrap(command: Command) -> Command:
        @wraps(command)
        def call(**given: Any) -> None:
            options = kind(**{each.name: given.pop(each.name) for each in shared})
            command(**given, options=options)

        own = inspect.signature(command, eval_str=True).parameters.values()
        mine = [each for each in own if each.name != "options"]
        call.__dict__["__signature__"] = inspect.Signature([*mine, *shared])  # what typer reads
        return call

    return wrap
