"""Prevents two processes from running the same jobs of a folder at once."""

from collections.abc import Iterator
from contextlib import contextmanager
from math import gcd
from pathlib import Path

from hedon.ensemble.error import EnsembleError
from hedon.ensemble.store import Store
from hedon.record.error import InUseError
from hedon.record.lock import FolderLock

LOCKS = "locks"


@contextmanager
def lock(store: Store, part: tuple[int, int]) -> Iterator[None]:
    """Locks a part of the jobs of a store while they are run; the lock ends with the process.

    Two parts share jobs if their numbers are equal modulo the greatest common divisor of their counts. For example,
    part 3/10 can run at the same time as part 4/10, but not as part 1/2.

    Nothing is locked behind a URL, since object stores have no locks that end with a process. There, two processes that
    run the same batches write the same rows, so they only waste time.

    Raises:
        EnsembleError: Another process is running jobs of this part.
        RecordError: The folder cannot be written.
    """
    if store.folder is None:
        yield
        return
    number, count = part
    lock_folder = store.folder / LOCKS
    with _lock_folder(lock_folder / f"{number}-of-{count}", store):
        for other in lock_folder.glob("*-of-*"):
            other_number, other_count = map(int, other.name.split("-of-"))
            if (other_number, other_count) != part and (other_number - number) % gcd(other_count, count) == 0:
                with _lock_folder(other, store):
                    pass
        yield


@contextmanager
def _lock_folder(folder: Path, store: Store) -> Iterator[None]:
    try:
        folder_lock = FolderLock(folder)
    except InUseError as error:
        raise EnsembleError(
            f"{store.location} is being made by another process{error.owner}: wait for it, stop it first, or give each "
            "its --part"
        ) from None
    with folder_lock:
        yield
