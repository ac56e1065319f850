"""What studies that compare conditions share: a row for each world, and the figure before there are any."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

import hedon.figure
from hedon.analysis import WorldRecord
from hedon.figure import NamedFigure
from hedon.study import Condition, ItemInputs, missing


def measured_rows(
    inputs: ItemInputs,
    conditions: Mapping[Any, Condition],
    measure: Callable[[WorldRecord], dict[str, Any]],
    key: str = "condition",
) -> list[dict[str, Any]]:
    """A row for each world, with its condition and its measures.

    Args:
        inputs: Worlds of an item.
        conditions: Conditions of the item, by name or number.
        measure: Measures of one world, by name.
        key: Name of the column with the key of the condition.
    """
    return [
        {key: name} | measure(world)
        for name, condition in conditions.items()
        for world in inputs.worlds.get(condition.label, ())
    ]


def each_condition(
    rows: Sequence[Mapping[str, Any]], conditions: Mapping[Any, Condition], key: str = "condition"
) -> Iterator[tuple[Any, list[Mapping[str, Any]]]]:
    """The key and the rows of each condition that has any, in the order of the conditions."""
    for name in conditions:
        if worlds := [row for row in rows if row[key] == name]:
            yield name, worlds


def no_worlds(name: str, question: str, inputs: ItemInputs, conditions: Mapping[Any, Condition]) -> NamedFigure:
    """The figure of an item without worlds, with a list of the missing ones."""
    return NamedFigure(name, question, hedon.figure.draw_message("no worlds yet"), missing(conditions.values(), inputs))
