"""Finds the items that the words of a command line name."""

from collections.abc import Sequence

from hedon.config.problem import nearest
from hedon.error import HedonError
from hedon.study.catalogue import ITEMS
from hedon.study.item import Item

GROUPS = {
    "paper": tuple(name for name, item in ITEMS.items() if item.kind in ("figure", "table")),
    "studies": tuple(name for name, item in ITEMS.items() if item.kind == "study"),
    "sequel": tuple(name for name, item in ITEMS.items() if item.kind == "sequel"),
    "all": tuple(ITEMS),
}
"""Names that stand for several items."""
DEFAULT_GROUP = "paper"


class ChoiceError(HedonError):
    """There is no item of that name."""


def choose_items(names: Sequence[str]) -> tuple[Item, ...]:
    """The items with some names, in the order of the catalogue; each name is of an item or a group.

    Without names, the items of the paper.

    Raises:
        ChoiceError: there is no item or group of one of the names.
    """
    wanted: set[str] = set()
    for name in names or (DEFAULT_GROUP,):
        if name not in ITEMS and name not in GROUPS:
            near = nearest(name, [*ITEMS, *GROUPS])
            hint = "; `list` comes first" if name == "list" else f"; did you mean {near}?" if near else ""
            raise ChoiceError(
                f"there is no item {name!r}{hint}\nItems: {', '.join(ITEMS)}\nGroups: {', '.join(GROUPS)}"
            )
        wanted.update(GROUPS.get(name, (name,)))
    return tuple(item for name, item in ITEMS.items() if name in wanted)
