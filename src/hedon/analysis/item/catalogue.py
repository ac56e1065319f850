"""All items of the reproduction, by name and in the order in which they are shown."""

from hedon.analysis.item.item import Item

ITEMS: dict[str, Item] = {}
