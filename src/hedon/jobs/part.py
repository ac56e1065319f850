"""The part of some jobs that one of several processes makes."""

from hedon.jobs.error import JobError


def parse_part(text: str | None) -> tuple[int, int]:
    """The number of a part, from 1 on, and how many there are, from "3/10"; all of it for None.

    Raises:
        JobError: the text is not such a part.
    """
    if text is None:
        return 1, 1
    first, _, second = text.partition("/")
    if first.isdecimal() and second.isdecimal() and len(text) < 20 and 1 <= int(first) <= int(second):
        return int(first), int(second)
    raise JobError(f"--part = {text!r}: must be I/N, the part I of N, as in 3/10")
