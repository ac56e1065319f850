"""Exports runs as a dataset for publication: Parquet tables, configs, manifests, a dataset card, and checksums."""

import hashlib
import json
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path

import polars as pl

from hedon.export.table import ExportError, TableName, table_of, write_table
from hedon.measure.summary import plain
from hedon.record.column import Column
from hedon.record.folder import CONFIG, MANIFEST
from hedon.record.reader import Run
from hedon.record.schema import run_tables
from hedon.report.markdown import escape_markdown, pipe_table
from hedon.text import brief, count

LICENSE = "cc-by-4.0"
"""Default license of records: an SPDX identifier in lower case, as on dataset hubs."""
CARD, SUMS = "README.md", "SHA256SUMS"
PAPER = (
    "Kanagawa, Y. and Doya, K. (2024). Evolution of Rewards for Food and Motor Action by Simulating Birth and Death. "
    "ALIFE 2024."
)


def write_dataset(
    runs: Sequence[Run], out: Path, title: str | None = None, license_name: str = LICENSE, *, frames: bool = False
) -> list[Path]:
    """Writes some runs as a dataset to a new folder.

    Args:
        runs: Runs with any configs; the names of their folders must differ.
        out: The new folder.
        title: Title of the card; None for one made from the runs' names.
        license_name: License of the dataset.
        frames: Whether to include the positions of all bodies.

    Returns:
        The paths of the files, the card first. The card documents every column, and `SHA256SUMS` has a checksum of
        every other file.

    Raises:
        ExportError: The folder exists or cannot be written, names of runs are equal, or there are no frames.
        RecordError: A part of a table is damaged.
    """
    names = [run.path.resolve().name for run in runs]
    for name in names:
        if names.count(name) > 1:
            raise ExportError(f"two runs are called {brief(name)}: a dataset names runs by their folders")
    if out.exists():
        raise ExportError(f"{brief(str(out))} is there already: choose another folder with --out, or remove it")
    tables: list[TableName] = ["agents", "population", *(["frames"] if frames else [])]
    merged = {table: _joined(runs, names, table) for table in tables}
    try:
        (out / "data").mkdir(parents=True)
        for table, rows in merged.items():
            write_table(rows, "parquet", out / "data" / f"{table}.parquet")
        for run, name in zip(runs, names, strict=True):
            (out / "runs" / name).mkdir(parents=True)
            (out / "runs" / name / CONFIG).write_text(run.config_text, encoding="utf-8")
            manifest = json.dumps(plain(asdict(run.manifest)), indent=2, ensure_ascii=False) + "\n"
            (out / "runs" / name / MANIFEST).write_text(manifest, encoding="utf-8")
        (out / CARD).write_text(_card(runs, names, tables, title, license_name), encoding="utf-8")
        files = sorted(path for path in out.rglob("*") if path.is_file())
        sums = {path.relative_to(out).as_posix(): hashlib.sha256(path.read_bytes()).hexdigest() for path in files}
        text = "".join(f"{digest}  {name}\n" for name, digest in sums.items())
        (out / SUMS).write_text(text, encoding="utf-8")
    except OSError as error:
        raise ExportError(f"cannot write {brief(str(out))}: {error.strerror}") from error
    return [out / CARD, *(path for path in files if path.name != CARD), out / SUMS]


def _joined(runs: Sequence[Run], names: Sequence[str], table: TableName) -> pl.LazyFrame:
    """A table of all runs, with the name of its run in each row; columns that a run lacks are null."""
    pairs = zip(runs, names, strict=True)
    tables = [table_of(run, table).select(pl.lit(name).alias("run"), pl.all()) for run, name in pairs]
    return pl.concat(tables, how="diagonal")


def _card(
    runs: Sequence[Run], names: Sequence[str], tables: Sequence[TableName], title: str | None, license_name: str
) -> str:
    """The card: a description of the records and how they were made, every column, license and citation."""
    heading = title or f"Runs of hedon: {', '.join(names[:3])}" + (" and others" if len(names) > 3 else "")
    worlds = sum(len(run.manifest.seeds) for run in runs)
    lines = ["---", f"license: {json.dumps(license_name)}", f"pretty_name: {json.dumps(heading)}"]
    lines += ["tags:", "- artificial-life", "- evolution", "- reinforcement-learning", "- simulation", "configs:"]
    for table in tables:
        lines += [f"- config_name: {table}", f"  data_files: data/{table}.parquet"]
    lines += ["---", "", f"# {escape_markdown(heading)}", ""]
    lines += [
        f"Records of {count(worlds, 'world')} in {count(len(runs), 'run')} of hedon, a simulation of agents that "
        "live, learn by reinforcement, breed and die, and whose reward functions evolve. Every table has the column "
        "`run`, the folder under `runs/` with the config and the manifest: versions, seeds, digests.",
        "",
        "| run | preset | worlds | steps | made by |",
        "| --- | --- | ---: | ---: | --- |",
    ]
    for run, name in zip(runs, names, strict=True):
        manifest = run.manifest
        kind = f"{manifest.name or manifest.preset or 'unknown'} ({manifest.fidelity or 'unknown'})"
        cells = [
            name,
            kind,
            len(manifest.seeds),
            f"{max(manifest.steps_done, default=0):,}",
            f"hedon {manifest.hedon_version}",
        ]
        lines.append("| " + " | ".join(escape_markdown(str(cell)) for cell in cells) + " |")
    for table in tables:
        table_specs = [run_tables(run.columns)[table] for run in runs]
        columns: dict[str, Column] = {column.name: column for each in table_specs for column in each.columns}
        rows = [
            [each.name, each.dtype + (", null" if each.nullable else ""), each.unit, each.meaning]
            for each in columns.values()
        ]
        lines += ["", f"## data/{table}.parquet", "", f"A row is {table_specs[0].row}.", ""]
        lines.append(pipe_table(["column", "type", "unit", "meaning"], rows).rstrip())
    lines += [
        "",
        "## License and citation",
        "",
        f"License: {escape_markdown(license_name)}. Please cite hedon and the paper whose model it implements: {PAPER}",
        "",
        f"`sha256sum -c {SUMS}` checks the files. A seed gives the same world again: `hedon run runs/NAME/config.toml "
        "--seeds SEED` with the version above.",
        "",
    ]
    return "\n".join(lines)
