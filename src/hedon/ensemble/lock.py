"""Keeps two processes from making the same jobs in a folder at once."""

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
    """Locks a part of the jobs of a store while they are made; the lock ends with the process.

    Two parts have jobs in common where their numbers are equal modulo what their counts have in common, so the
    third of ten goes with the fourth of ten, and not with the first of two.

    Nothing is locked behind a URL: object stores have no locks that end with a process. There, two that make the same
    batches write the same rows, so they lose time alone.

    Raises:
        EnsembleError: another process makes jobs of this part.
        RecordError: the folder cannot be written.
    """
    if store.folder is None:
        yield
        return
    number, count = part
    place = store.folder / LOCKS
    with _lock_folder(place / f"{number}-of-{count}", store):
        for other in place.glob("*-of-*"):
            its_number, its_count = map(int, other.name.split("-of-"))
            if (its_number, its_count) != part and (its_number - number) % gcd(its_count, count) == 0:
                with _lock_folder(other, store):
                    pass
        yield


@contextmanager
def _lock_folder(folder: Path, store: Store) -> Iterator[None]:
    try:
        held = FolderLock(folder)
    except InUseError as error:
        raise EnsembleError(
            f"{store.location} is being made by another process{error.owner}: wait for it, stop it first, or give each "
            "its --part"
        ) from None
    with held:
        yield
