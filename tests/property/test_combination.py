"""Every door, that is, every way to use a world, accepts every combination of mechanisms and species.

Worlds are drawn to combine every pair of mechanisms, then again with other values. HEDON_WORLDS=N tries N worlds
instead of the first ones, which cover every pair once; HEDON_RECORDED=N also takes N of them through the doors for
records; HEDON_WORLD=I tries only the I-th world, through all doors.
"""

import os
import random
import tempfile
from collections.abc import Iterator
from pathlib import Path

import pytest
from mechanism import Mixture, possible_pairs, worlds
from world_door import Trial, doors

from hedon.experiment.rule import Rule

pytest.importorskip("numba", reason='needs the optional package: pip install "hedon[rules]"')

SEED = 1
SIZE = 18
"""Number of mechanisms in a world."""
WORLDS = int(os.environ.get("HEDON_WORLDS", "0"))
RECORDED = int(os.environ.get("HEDON_RECORDED", "4"))
ONLY = os.environ.get("HEDON_WORLD")
PARTS = 16 if WORLDS else 1
"""Number of parts into which many worlds are split, for several processes at once."""
REPORTED = 20
"""One in this many recorded worlds gets a report with figures."""
SHOWN = 3
"""Number of failures shown in full."""
FULL = 100
"""At most one in this many worlds may be refused because its first agents and foods do not fit."""


def tried() -> Iterator[tuple[int, Mixture]]:
    """The worlds to try, each with its number."""
    missing = len(possible_pairs())
    for i, (world, new) in enumerate(worlds(SEED, SIZE)):
        missing -= len(new)
        if ONLY is None or i == int(ONLY):
            yield i, world
        if ONLY is not None and i == int(ONLY):
            return
        if ONLY is None and (i + 1 == WORLDS or (not WORLDS and missing == 0)):
            return


def failures(trial: Trial, every: int, number: int) -> Iterator[str]:
    """The doors that refuse a world, each with its error."""
    recorded = ONLY is not None or number % every == 0
    report = ONLY is not None or number % (every * REPORTED) == every
    for door, enter in doors(trial, recorded=recorded, report=report):
        try:
            enter(trial)
        except Exception as error:
            yield f"{door}: {type(error).__name__}: {error}"
            return  # the next doors need what this one makes


@pytest.fixture
def compiled_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """Compiles each rule once for all doors, since it takes half a second; these rules depend only on their text."""
    compiled = Rule.compiled.func
    kept: dict[tuple[object, ...], object] = {}

    def once(rule: Rule) -> object:
        key = (rule.source.text, rule.source.name, rule.columns, rule.neutral)
        if key not in kept:
            kept[key] = compiled(rule)
        return kept[key]

    monkeypatch.setattr(Rule, "compiled", property(once))


@pytest.mark.repeated
@pytest.mark.usefixtures("compiled_once")
@pytest.mark.parametrize("part", range(PARTS))
def test_every_door_takes_every_combination(part, tmp_path, capsys):
    every = max((WORLDS or 57) // max(RECORDED, 1), 1)
    seen: dict[str, str] = {}
    pairs, count, full, failed = set(), 0, 0, []
    for number, world in tried():
        if WORLDS and number * PARTS // WORLDS != part:
            continue
        with tempfile.TemporaryDirectory(dir=tmp_path) as folder:
            trial = Trial(world, Path(folder), random.Random(number), seen)
            for failure in failures(trial, every, number):
                if "EngineError: initial_placement" in failure:
                    full += 1
                    continue
                again = f"HEDON_WORLD={number} uv run --extra rules pytest {os.path.relpath(__file__)}"
                failed.append(f"world {number}, {failure}\n\n{world.text}\n{again}")
        pairs |= world.pairs
        count += 1
    with capsys.disabled():
        covered = f"pairs covered {len(pairs)} of {len(possible_pairs())} in {count} worlds"
        print(f"\n{covered}, {len(failed)} failed, {full} had no room")
    assert not failed, "\n\n".join(failed[:SHOWN])
    assert full <= max(1, count // FULL), f"{full} of {count} worlds had no room"
    assert ONLY or WORLDS or pairs == possible_pairs()
