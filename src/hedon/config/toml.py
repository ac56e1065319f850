"""Reads TOML into plain tables, and refuses input that is too large or too deep to be a config."""

import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from hedon.config.layer import Table
from hedon.config.problem import ConfigError, Problem

MAX_BYTES = 1_000_000
"""Maximum size of a config file [byte]; the largest valid config has about 30,000."""
MAX_VALUES = 5_000
"""Maximum number of names and values in a config; the maximum number of walls and centers gives 1,500."""
MAX_DEPTH = 8
"""Maximum nesting of tables and lists; settings need five levels."""
MAX_DIGITS = 1000
"""Maximum digits of an integer. Python can read a few thousand. Settings check smaller integers themselves."""


def read_toml(path: Path) -> Table:
    """Reads a TOML file.

    Raises:
        ConfigError: The file cannot be read, or it is not TOML that could be a config.
    """
    origin = str(path)
    try:
        with path.open("rb") as file:
            content = file.read(MAX_BYTES + 1)
    except OSError as error:  # for a folder, Windows reports denied permission
        reason = "it is a folder" if path.is_dir() else error.strerror
        raise ConfigError(origin, [Problem("", f"cannot be read: {reason}")]) from None
    except ValueError as error:  # a path with a null character
        raise ConfigError(origin, [Problem("", f"cannot be read: {error}")]) from None
    if len(content) > MAX_BYTES:
        raise ConfigError(origin, [Problem("", f"is too large for a config (at most {MAX_BYTES:,} bytes)")])
    try:
        text = content.decode("utf-8-sig")  # some editors write a byte order mark
    except UnicodeDecodeError:
        raise ConfigError(origin, [Problem("", "cannot be read: it is not UTF-8 text")]) from None
    return parse_toml(text.replace("\r\n", "\n"), origin)


def parse_toml(text: str, origin: str) -> Table:
    """Parses a TOML text.

    Raises:
        ConfigError: The text is not TOML that could be a config.
    """
    try:
        tables = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        hint = "; a path with \\ stands in single quotes" if str(error).startswith(_ESCAPES) else ""
        raise ConfigError(origin, [Problem("", f"is not valid TOML: {error}{hint}")]) from None
    except RecursionError:
        raise ConfigError(origin, [_TOO_DEEP]) from None
    except ValueError:  # Python refuses integers of thousands of digits
        raise ConfigError(origin, [_TOO_LONG]) from None
    require_plain(tables, origin)
    return tables


def require_plain(tables: Any, origin: str) -> None:
    """Refuses tables deeper or larger than a config can be, and integers with too many digits.

    Raises:
        ConfigError: The tables exceed a limit.
    """
    problems = list(_oversize(tables))
    if problems:
        raise ConfigError(origin, problems)


_ESCAPES = ("Unescaped", "Invalid hex value")
"""Starts of the parser's messages about `\\` in double quotes, as in "C:\\own" and "C:\\Users"."""
_TOO_LONG = Problem("", f"has an integer of more than {MAX_DIGITS:,} digits")
_TOO_DEEP = Problem("", f"has tables or lists nested deeper than {MAX_DEPTH} levels")


def _oversize(tables: Any) -> Iterator[Problem]:
    level, count = [tables], 0
    for _ in range(MAX_DEPTH + 1):
        values = [
            value for container in level for value in (container.values() if isinstance(container, dict) else container)
        ]
        count += len(values)
        if count > MAX_VALUES:
            yield Problem("", f"has more than {MAX_VALUES:,} names and values, which no config has")
            return
        if any(isinstance(value, int) and abs(value) >= 10**MAX_DIGITS for value in values):
            yield _TOO_LONG
            return
        level = [value for value in values if isinstance(value, dict | list | tuple)]
        if not level:
            return
    yield _TOO_DEEP
