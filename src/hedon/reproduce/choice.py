"""Which items are meant by the words of a command line."""

from collections.abc import Sequence

from hedon.analysis.item.catalogue import ITEMS
from hedon.analysis.item.item import Item
from hedon.config.problem import nearest
from hedon.error import HedonError

GROUPS = {
    "paper": tuple(name for name, item in ITEMS.items() if item.kind != "study"),
    "studies": tuple(name for name, item in ITEMS.items() if item.kind == "study"),
    "all": tuple(ITEMS),
}
"""Names for several items at once."""
DEFAULT_GROUP = "paper"


class ChoiceError(HedonError):
    """There is no item of that name."""


def choose_items(names: Sequence[str]) -> tuple[Item, ...]:
    """The items of some names, each of an item or a group, in the order of the catalogue; the paper's for none.

    Raises:
        ChoiceError: one of them names nothing.
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
