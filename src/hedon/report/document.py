"""Generates `docs/records.md` from the schema: `python -m hedon.report.document > docs/records.md`.

Also generates the table of figures in `docs/figures.md`; a test compares the two.
"""

import sys
from collections.abc import Mapping
from dataclasses import fields
from inspect import cleandoc

from hedon.measure.summary_key import CAUSE_KEYS, INTERVAL_KEYS, RUN_KEYS, SEVERAL_KEYS, WORLD_KEYS, WORLD_SEVERAL_KEYS
from hedon.record.column import Table
from hedon.record.manifest import ChannelNote, Manifest, Session
from hedon.record.schema import FORMAT_VERSION, Columns, run_tables
from hedon.record.snapshot import Snapshot
from hedon.report.figure import FIGURES

_HEAD = f"""\
# What a run leaves behind

This page is made from the schema by `uv run python -m hedon.report.document > docs/records.md`.
Format {FORMAT_VERSION}.

```
RUN/
  config.toml                    the complete config; loadable again
  founders.csv                   whose genes the founders have, only with `--founders`
  networks.npz                   what agents that never learn act by, only with `--networks`
  manifest.json                  with what the run was made
  agents/part-000000.parquet …   agents that have died
  agents/living.parquet          agents alive when records were last written
  population/part-….parquet      one row per world and interval
  frames/part-….parquet          positions, only if the plan has frames
  checkpoints/step-….npz         the newest two, for `hedon resume` and `hedon branch`
  fault/step-….npz               where a run stopped at a fault: the worlds as they were found
  final.npz                      last state of one world, for a picture
  summary.json, figures/*.svg    made at the end of the run, and again by `hedon report RUN`
  report.html, report.md         likewise: everything on one page
  analysis/                      likewise, and by `hedon analyze RUN`: every number, as JSON and CSV
```

Files appear whole or not at all, so a run can be read while it goes on, and what was written before a crash
stays readable. From Python:

```python
import hedon

run = hedon.open_run("runs/baseline")
run.agents()      # polars.DataFrame: the dead, then the living (death_step is null)
run.population()  # polars.DataFrame, by world and step
run.frames()      # polars.LazyFrame
```

Types: i32, i64, f32, f64 are integers and floats of that many bits; "null" means that a value may be
missing. The tables are shown for one food kind `normal` and one neutral gene. With more kinds,
`eaten_<kind>`, `food_<kind>`, `w_<kind>`, `w_<kind>_mean` and `w_<kind>_sd` repeat in the order of the
config; with more neutral genes so do `neutral_<i>`, `neutral_<i>_mean` and `neutral_<i>_sd`. Below each table stand the
columns of worlds with further mechanisms; where species differ, a gene that a species lacks is missing.
"""

_MECHANISMS = {
    "several species": Columns(("normal",), 1, species=("prey", "predator"), causes=False),
    "children with two parents": Columns(("normal",), 1, mating=True),
    "death by starvation, or agents that eat agents": Columns(("normal",), 1, causes=True),
    "agents that eat agents, here those of a species `prey`": Columns(("normal",), 1, prey=("prey",), causes=True),
    "obstacles": Columns(("normal",), 1, obstacles=True),
    "other stores than energy, here `water`": Columns(("normal",), 1, stores=("water",), levels=True),
}
"""Mechanisms that add columns to the tables, each with the columns of a run that has it."""

_LEDGER = """\
The ledger closes in each interval, but for rounding:
energy_total = energy_total before + energy_eaten + energy_forgiven - energy_basic - energy_action -
energy_capped - energy_lost, where agents eat agents + energy_hunted, and with obstacles - energy_damage. Each species
has a ledger of its own. What parents share stays within it. `energy_eaten` is what food holds,
also where part of it is destroyed at the cap; `energy_basic` and `energy_action` are what was charged, also
where part of it was forgiven. What an eaten agent held is in the `energy_lost` of its species; the share that its eater
gains is `energy_hunted`, and the rest is gone.
"""

_SUMMARY = """\
Written by `hedon report`. A number that does not exist (nobody died, one world) is null.
Means over worlds are objects with these keys:
"""

_HUNTS = """\
Each world, or each species of it, has these keys too. Where agents eat agents, the run has `prey_per_step` and
`prey_per_agent_step` beside `food_per_step`, as means and intervals.
"""

_SPECIES = """\
Prey and predators are not averaged with one another: each species has numbers of its own, and sums over all of them are
called totals. These keys replace those of one species; a sweep's table has them as `prey.alive_mean` and
`total_alive_mean`.
"""


def records_page() -> str:
    """The page, as Markdown."""
    tables = run_tables(Columns(("normal",), 1))
    parts = [_HEAD]
    for table in tables.values():
        parts.append(_table_section(table))
        parts.append(_further_columns(table))
        if table.name == "population":
            parts.append(_LEDGER)
    parts.append(f"## manifest.json\n\n{_attributes(Manifest)}")
    parts.append(f"### Each of `sessions`\n\n{_attributes(Session)}")
    parts.append(f"### Each of `channels`\n\n{_attributes(ChannelNote)}")
    parts.append(f"## final.npz\n\nPlain NumPy arrays, one per field.\n\n{_attributes(Snapshot)}")
    parts.append(f"## summary.json\n\n{_SUMMARY}\n{_key_table(INTERVAL_KEYS)}")
    parts.append(f"### The run\n\n{_key_table(RUN_KEYS)}")
    parts.append(f"### Each of `worlds`\n\n{_key_table(WORLD_KEYS)}")
    parts.append(f"### Where agents starve to death, or eat agents\n\n{_HUNTS}\n{_key_table(CAUSE_KEYS)}")
    parts.append(f"### The run, with several species\n\n{_SPECIES}\n{_new_keys(SEVERAL_KEYS, RUN_KEYS)}")
    parts.append(f"### Each of `worlds`, with several species\n\n{_new_keys(WORLD_SEVERAL_KEYS, WORLD_KEYS)}")
    return "\n".join(parts)


def figure_table() -> str:
    """The figures of a report, as a Markdown table: file, question, caption."""
    rows = [f"| `{kind.name}.svg` | {kind.question} | {kind.caption} |" for kind in FIGURES]
    return "\n".join(["| figure | question | what is drawn, and how to read it |", "|---|---|---|", *rows]) + "\n"


def _table_section(table: Table) -> str:
    rows = [
        f"## {table.name}",
        "",
        f"A row is {table.row}.",
        "",
        "| column | type | unit | meaning |",
        "|---|---|---|---|",
    ]
    for column in table.columns:
        dtype = f"{column.dtype}, null" if column.nullable else column.dtype
        rows.append(f"| `{column.name}` | {dtype} | {column.unit} | {column.meaning} |")
    return "\n".join(rows) + "\n"


def _further_columns(table: Table) -> str:
    """The columns of a table that exist only in worlds with further mechanisms."""
    column_names = {column.name for column in table.columns}
    rows = ["| only with | column | type | unit | meaning |", "|---|---|---|---|---|"]
    for mechanism, columns in _MECHANISMS.items():
        for column in run_tables(columns)[table.name].columns:
            if column.name not in column_names:
                column_names.add(column.name)
                dtype = f"{column.dtype}, null" if column.nullable else column.dtype
                rows.append(f"| {mechanism} | `{column.name}` | {dtype} | {column.unit} | {column.meaning} |")
    return "\n".join(rows) + "\n"


def _key_table(keys: Mapping[str, str]) -> str:
    rows = [f"| `{key}` | {meaning} |" for key, meaning in keys.items()]
    return "\n".join(["| key | meaning |", "|---|---|", *rows]) + "\n"


def _new_keys(keys: Mapping[str, str], other_keys: Mapping[str, str]) -> str:
    """A table of the keys that are missing from `other_keys` or have another meaning there."""
    return _key_table({key: meaning for key, meaning in keys.items() if other_keys.get(key) != meaning})


def _attributes(kind: type) -> str:
    """A table of the attributes of a dataclass, taken from its docstring."""
    section = cleandoc(kind.__doc__ or "").split("Attributes:\n")[1]  # Python before 3.13 keeps indentation
    entries: list[str] = []
    for line in section.rstrip().splitlines():
        if line.startswith(" " * 8):
            entries[-1] += " " + line.strip()
        elif line.strip():
            entries.append(line.strip())
    rows = [entry.split(": ", 1) for entry in entries]
    described = {name for names, _ in rows for name in names.split(", ")}
    missing = {field.name for field in fields(kind)} ^ described
    if missing:
        raise ValueError(f"{kind.__name__}: fields and docstring differ in {sorted(missing)}")
    cells = [f"| {', '.join(f'`{n}`' for n in names.split(', '))} | {text} |" for names, text in rows]
    return "\n".join(["| field | meaning |", "|---|---|", *cells]) + "\n"


if __name__ == "__main__":
    sys.stdout.write(records_page())
