"""What a study is: a question, the worlds that answer it, and what is made of them.

A package brings studies of its own by an entry point of the group `hedon.studies`, under the study's name.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from hedon.study.claim import Claim, Order
from hedon.study.item import Item


@dataclass(frozen=True)
class Study:
    """A question, the worlds that answer it, and what is made of them.

    Attributes:
        name: what the command line calls it, and its entry point.
        title: its heading.
        question: what is claimed or asked, with its source.
        items: its figures and tables, each with the conditions and seeds that it needs.
        expectation: what is expected, written before its worlds are run.
        claims: with the rules by which they are judged, wherever a run has their conditions.
        reported: what the source reports of a preset, by the preset: under keys of `summary.json`, numbers or pairs of
            bounds; under `steps`, those of its worlds; under `claim`, a sentence; under `ends`, genomes such as
            "food=5,action=5" where its worlds end.
    """

    name: str
    title: str
    question: str
    items: tuple[Item, ...]
    expectation: str = ""
    claims: tuple[Claim | Order, ...] = ()
    reported: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
