"""Limits that the system sets for a process."""

import sys


def address_limit() -> int | None:
    """Memory that this process may reserve, by `ulimit -v` [byte]; None without a limit, as on Windows."""
    if sys.platform == "win32":
        return None
    import resource

    addresses, _ = resource.getrlimit(resource.RLIMIT_AS)
    return None if addresses == resource.RLIM_INFINITY else addresses
