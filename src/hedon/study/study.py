"""Defines a study: a question, the worlds that answer it, and the figures and tables made from them.

A package can add studies with entry points of the group `hedon.studies`, each with the name of the study.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from hedon.study.claim import Claim, Order
from hedon.study.item import Item


@dataclass(frozen=True)
class Study:
    """A question, the worlds that answer it, and the figures and tables made from them.

    Attributes:
        name: Its name on the command line, and the name of its entry point.
        title: Its heading.
        question: The claim or question, with its source.
        items: Its figures and tables, each with the conditions and seeds that it needs.
        expectation: The expected result, written before its worlds are run.
        claims: Claims with the rules by which they are judged, in every run that has their conditions.
        reported: Results that the source reports, by preset. Keys are those of `summary.json`, with numbers or pairs of
            bounds; `steps`, the length of its worlds; `claim`, a sentence; and `ends`, genomes such as
            "food=5,action=5" at which its worlds end.
    """

    name: str
    title: str
    question: str
    items: tuple[Item, ...]
    expectation: str = ""
    claims: tuple[Claim | Order, ...] = ()
    reported: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
