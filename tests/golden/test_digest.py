"""Digests of short lives, so that results never change unnoticed.

There are two kinds: digests of the bytes of the state, and digests of named quantities, which stay equal if only memory
layout or the form of settings changes. AVX2 and AVX-512 give the same bits, and so share one table. After an intended
change of results, write new digests and list the quantities that differ:
`PYTHONPATH=tests python -m golden.test_digest`
"""

import json
import sys
import tempfile
from pathlib import Path
from typing import Any

import pytest
from golden_case import cases, live
from mechanism import mechanisms
from named import Quantities, short_of

from hedon import _engine

GOLDEN = Path(__file__).with_name("digest.json")
WIDE, PORTABLE = "wide", "portable"
SHOWN = 8
"""Maximum number of quantities listed in a message."""
AGAIN = "if it was meant to: PYTHONPATH=tests uv run --extra rules python -m golden.test_digest"


def table_of(kernel: str) -> str:
    """The table with the results of an instruction set."""
    return PORTABLE if kernel == PORTABLE else WIDE


def entry(state: str, quantities: Quantities, table: str) -> dict[str, Any]:
    """The record of a life; for the portable kernel, with a single digest of all quantities."""
    return {"state": state, "named": short_of(quantities) if table == PORTABLE else quantities}


def differences(recorded: Any, found: Any) -> list[str]:
    """The quantities that differ, as "prey: w_action, place"."""
    if not isinstance(recorded, dict) or not isinstance(found, dict):
        return [] if recorded == found else ["some"]
    told = []
    for owner in dict.fromkeys([*recorded, *found]):
        was, now = recorded.get(owner, {}), found.get(owner, {})
        names = [name for name in dict.fromkeys([*was, *now]) if was.get(name) != now.get(name)]
        more = f" and {len(names) - SHOWN} more" if len(names) > SHOWN else ""
        told += [f"{owner}: {', '.join(names[:SHOWN])}{more}"] if names else []
    return told


@pytest.fixture(scope="module")
def recorded() -> dict[str, Any]:
    return json.loads(GOLDEN.read_text())


@pytest.mark.parametrize("kernel", _engine.kernel.kernel_names())
@pytest.mark.parametrize("name", cases())
def test_short_lives_keep_their_bits(name, kernel, recorded, tmp_path):
    if needs_numba(name):
        pytest.importorskip("numba", reason='needs the optional package: pip install "hedon[rules]"')
    table = table_of(kernel)
    assert name in recorded[table], f"nothing is recorded for {name}: {AGAIN}"
    found = entry(*live(cases()[name], tmp_path, kernel), table)
    differ = differences(recorded[table][name]["named"], found["named"])
    assert not differ, f"{name} differs in {'; '.join(differ)}; {AGAIN}"
    assert found["state"] == recorded[table][name]["state"], f"{name}: only the state's bytes differ; {AGAIN}"


def needs_numba(name: str) -> bool:
    """Whether a case has a rule in Python."""
    rules = {each.name for each in mechanisms().values() if "@rule" in str(each.settings)}
    return name.partition(".")[2] in {*rules, "rules_of_two"}


def test_exactly_the_cases_are_recorded(recorded):
    for table in (WIDE, PORTABLE):
        assert set(recorded[table]) == set(cases())


@pytest.mark.parametrize("name", mechanisms())
def test_a_mechanism_makes_a_difference(name, recorded):
    """Otherwise its case would test nothing."""
    own = recorded[WIDE][f"mechanism.{name}"]["named"]
    plain = recorded[WIDE][f"plain.{mechanisms()[name].species}"]["named"]
    assert differences(plain, own)


def write() -> None:
    """Writes the digests of AVX2 and the portable kernel, and lists the differences from the previous ones."""
    before = json.loads(GOLDEN.read_text()) if GOLDEN.exists() else {}
    after: dict[str, dict[str, Any]] = {}
    with tempfile.TemporaryDirectory() as folder:
        for table, kernel in ((WIDE, "avx2"), (PORTABLE, PORTABLE)):
            after[table] = {name: entry(*live(case, Path(folder), kernel), table) for name, case in cases().items()}
    for name, found in after[WIDE].items():
        was = before.get(WIDE, {}).get(name)
        if was != found:
            told = differences(was["named"], found["named"]) if was else ["new"]
            print(f"{name}: {'; '.join(told) or 'only the bytes of the state'}", file=sys.stderr)
    GOLDEN.write_text(_text(after))


def _text(tables: dict[str, dict[str, Any]]) -> str:
    """JSON with a line for each species of a case."""
    lines = []
    for table, entries in tables.items():
        rows = []
        for name, found in entries.items():
            named = found["named"]
            if isinstance(named, dict):
                owners = [f"{json.dumps(owner)}: {json.dumps(each)}" for owner, each in named.items()]
                body = "{\n    " + ",\n    ".join(owners) + "\n  }"
            else:
                body = json.dumps(named)
            rows.append(f'  {json.dumps(name)}: {{"state": {json.dumps(found["state"])}, "named": {body}}}')
        lines.append(f"{json.dumps(table)}: {{\n" + ",\n".join(rows) + "\n}")
    return "{\n" + ",\n".join(lines) + "\n}\n"


if __name__ == "__main__":
    write()
