"""Commands that take seconds report their progress and the time left; short ones print nothing."""

import io

from rich.console import Console

from hedon.cli.display.step import StepDisplay


def told(*seconds: float, terminal: bool = False) -> str:
    """The output of three steps that start at these times."""
    stream, now = io.StringIO(), [0.0]
    console = Console(file=stream, width=120, force_terminal=terminal, highlight=False)
    with StepDisplay("analyzing", console, lambda: now[0]) as tell:
        for done, (at, step) in enumerate(zip(seconds, ("records", "lives", "drift"), strict=True)):
            now[0] = at
            tell(done, 3, step)
    return stream.getvalue()


def test_a_short_command_prints_nothing() -> None:
    assert told(0.0, 0.5, 1.9) == ""


def test_a_long_command_prints_its_step_and_the_time_left() -> None:
    assert told(0.0, 8.0, 60.0).splitlines() == [
        "hedon: analyzing: lives, step 2 of 3, about 16 s left",
        "hedon: analyzing: drift, step 3 of 3, about 30 s left",
    ]


def test_a_terminal_is_updated_at_once() -> None:
    assert "analyzing: records, step 1 of 3" in told(0.0, 8.0, 60.0, terminal=True)
