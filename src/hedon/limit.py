"""Limits that a system sets to a process."""

import sys


def address_limit() -> int | None:
    """Most memory that this process may reserve, as `ulimit -v` says [byte]; None without a limit, as on Windows."""
    if sys.platform == "win32":
        return None
    import resource

    addresses, _ = resource.getrlimit(resource.RLIMIT_AS)
    return None if addresses == resource.RLIM_INFINITY else addresses
