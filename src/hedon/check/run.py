"""Checks a run's folder: compares each of its files with the others."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import polars as pl

from hedon.check.finding import CheckResult, Finding
from hedon.check.founder import check_founders
from hedon.check.genealogy import check_agents
from hedon.check.population import check_population
from hedon.check.table import check_digests, check_numbering, read_parts
from hedon.config.config import Config
from hedon.config.dump import SCHEMA, digest
from hedon.config.load import load_config, parse_config
from hedon.config.problem import ConfigError
from hedon.record.checkpoint import Checkpoint, load_checkpoint
from hedon.record.digest import records_digest
from hedon.record.error import RecordError
from hedon.record.folder import (
    CHECKPOINTS,
    CONFIG,
    FAULT,
    LIVING,
    MANIFEST,
    TABLE_FOLDERS,
    checkpoint_paths,
    holds_run,
    misplaced_checkpoints,
    part_path,
    require_plain,
    require_unicode,
)
from hedon.record.manifest import Manifest, load_manifest
from hedon.record.network import NETWORKS, NetworkError, load_networks
from hedon.record.reader import open_run
from hedon.record.schema import Columns, columns_of, run_tables
from hedon.record.snapshot import load_snapshot


@dataclass
class _Folder:
    """The readable contents of a run's folder, and the results so far."""

    path: Path
    findings: list[Finding] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    manifest: Manifest | None = None
    config: Config | None = None
    checkpoints: list[Checkpoint] = field(default_factory=list)
    """The usable checkpoints, in the order of steps."""
    tables: dict[str, pl.DataFrame] = field(default_factory=dict)
    """The readable rows of `agents` and `population`."""
    whole: bool = True
    """Whether all parts exist and are readable."""

    @property
    def driven(self) -> bool:
        """Whether a program chose the agents' actions, so that no command can continue the run."""
        return self.config is not None and bool(self.config.driven)

    def add(self, findings: Iterator[Finding]) -> int:
        count = len(self.findings)
        self.findings += findings
        return len(self.findings) - count


def check_run(path: Path | str) -> CheckResult:
    """Checks a run's folder. Only reads it, and needs no engine.

    Args:
        path: Path of the folder; the run may be finished, interrupted, killed or in progress.

    Returns:
        Faults, notes, and data that are still usable.

    Raises:
        RecordError: The folder does not contain a run.
    """
    path = Path(path)
    require_unicode(path)
    require_plain(path)
    if not holds_run(path):
        open_run(path)  # raises an error that names what is missing, with a hint to similar names
    folder = _Folder(path)
    _check_manifest(folder)
    _check_config(folder)
    _note_status(folder)
    _check_checkpoints(folder)
    _check_tables(folder)
    _check_rows(folder)
    folder.add(_check_networks(folder))
    folder.add(check_founders(folder.path, folder.config, folder.manifest, folder.tables.get("agents")))
    _check_end(folder)
    return CheckResult(tuple(dict.fromkeys(folder.findings)), tuple(folder.notes), tuple(_usable(folder)))


def _check_networks(folder: _Folder) -> Iterator[Finding]:
    try:
        if folder.config is not None:
            load_networks(folder.path, folder.config)
    except NetworkError as error:
        yield Finding(NETWORKS, f"cannot be used: {str(error).removeprefix(str(folder.path / NETWORKS) + ': ')}")


def _check_manifest(folder: _Folder) -> None:
    try:
        manifest = load_manifest(folder.path)
    except RecordError as error:
        text = str(error).removeprefix(f"damaged manifest {folder.path / MANIFEST}: ")
        folder.findings.append(Finding(MANIFEST, "cannot be used: " + " ".join(text.split())))
        return
    folder.manifest = manifest
    worlds = len(manifest.seeds)
    lists = [("steps_done", manifest.steps_done), ("extinct_steps", manifest.extinct_steps)]
    if manifest.world_digests:
        lists.append(("world_digests", manifest.world_digests))
    for name, values in lists:
        if len(values) != worlds:
            message = f"{name} has {len(values)} entries, but there are {worlds} seeds"
            folder.findings.append(Finding(MANIFEST, message))
            folder.manifest = None
    for step in manifest.steps_done:
        if not 0 <= step <= manifest.steps_asked:
            message = f"steps_done is {step:,}, but must be from 0 to steps_asked = {manifest.steps_asked:,}"
            folder.findings.append(Finding(MANIFEST, message))


def _note_status(folder: _Folder) -> None:
    if folder.manifest is None:
        return
    status, fault = folder.manifest.status, folder.manifest.fault
    if status == "running":
        hint = "" if folder.driven else f" (`hedon resume {folder.path}` continues a killed run)"
        folder.notes.append(
            "the run is still running, or was killed: its last records may be incomplete, and missing agents are not "
            f"reported{hint}"
        )
    if status == "failed":
        folder.notes.append("the run stopped at a fault" + (f": {fault}" if fault else ""))


def _check_config(folder: _Folder) -> None:
    try:
        config = load_config(folder.path / CONFIG)
    except ConfigError as error:
        folder.findings.append(Finding(CONFIG, f"cannot be used: {error}"))
        return
    manifest = folder.manifest
    if manifest is None:
        folder.config = config
        return
    if _is_other(config, manifest):
        folder.findings.append(Finding(CONFIG, "was changed: its digest differs from the one in the manifest"))
    elif not _same_columns(columns_of(config), manifest.columns):
        message = "the species, the kinds of food or the genes differ from those in the config"
        folder.findings.append(Finding(MANIFEST, message))
    else:
        folder.config = config


def _is_other(config: Config, manifest: Manifest) -> bool:
    """Whether a config differs from the one in a manifest; digests under different schemas cannot be compared."""
    return manifest.schema == SCHEMA and manifest.config_digest not in (None, digest(config))


def _same_columns(columns: Columns, other: Columns) -> bool:
    names = [(item.food_kinds, item.species, item.gene_names) for item in (columns, other)]
    return names[0] == names[1]


def _check_checkpoints(folder: _Folder) -> None:
    manifest = folder.manifest
    for path in misplaced_checkpoints(folder.path):
        folder.findings.append(Finding(str(path.relative_to(folder.path)), "is a folder, but should be a checkpoint"))
    for path in checkpoint_paths(folder.path):
        name = str(path.relative_to(folder.path))
        try:
            checkpoint = load_checkpoint(path)
            config = parse_config(checkpoint.head.config, name)
        except (RecordError, ConfigError) as error:
            text = str(error).removeprefix(f"damaged checkpoint {path}: ")
            folder.findings.append(Finding(name, f"cannot be used: {text}"))
            continue
        if manifest is not None and _is_other(config, manifest):
            folder.findings.append(Finding(name, "its config is not the one in the manifest"))
        elif manifest is not None and checkpoint.head.seeds != manifest.seeds:
            folder.findings.append(Finding(name, "its seeds are not those in the manifest"))
        else:
            folder.checkpoints.append(checkpoint)
    for path in checkpoint_paths(folder.path, FAULT):
        try:
            load_checkpoint(path)
        except RecordError as error:
            folder.findings.append(Finding(str(path.relative_to(folder.path)), f"cannot be used: {error}"))
    if not checkpoint_paths(folder.path):
        folder.notes.append(f"{CHECKPOINTS} is empty: the run cannot be continued")


def _check_tables(folder: _Folder) -> None:
    source = folder.manifest or folder.config
    if source is None:
        folder.notes.append("the tables were not checked: without manifest and config, their columns are not known")
        return
    columns = source.columns if isinstance(source, Manifest) else columns_of(source)
    fault_count = 0
    if folder.checkpoints:
        parts = folder.checkpoints[-1].head.parts
        fault_count += sum(
            not part_path(folder.path, table, len(entries) - 1).is_file() for table, entries in parts.items() if entries
        )
        folder.add(check_digests(folder.path, parts))
    for name, table in run_tables(columns).items():
        fault_count += folder.add(check_numbering(folder.path, name))
        if name == "agents" and not (folder.path / LIVING).exists() and not _has_just_begun(folder):
            fault_count += folder.add(iter([Finding(LIVING, "is missing: the living agents are not known")]))
        parts = [pl.DataFrame(schema=table.polars_schema)]
        latest: dict[int, int] = {}
        for part, rows, faults in read_parts(folder.path, table, folder.manifest):
            fault_count += folder.add(iter(faults))
            if rows is None:
                continue
            if name == "frames":  # may be larger than memory, so check each part separately
                folder.add(_check_frames(part, rows, latest))
            else:
                parts.append(rows)
        if name != "frames":
            folder.tables[name] = pl.concat(parts)
    folder.whole = not fault_count


def _has_just_begun(folder: _Folder) -> bool:
    """Whether a run may not have written the living yet: it has no checkpoint, which would be written after them."""
    running = folder.manifest is not None and folder.manifest.status == "running"
    return running and not checkpoint_paths(folder.path)


def _check_frames(name: str, rows: pl.DataFrame, latest: dict[int, int]) -> Iterator[Finding]:
    """Checks that the frames of each world are in order; `latest` is the last step so far, by world."""
    for (world,), frames in rows.group_by("world", maintain_order=True):
        steps = frames["step"]
        if not steps.is_sorted() or steps[0] < latest.get(world, 0):
            yield Finding(name, f"frames of world {world} are out of order")
        latest[world] = max(steps[-1], latest.get(world, 0))


def _check_rows(folder: _Folder) -> None:
    """Compares rows with one another; if parts are missing, checks only single rows."""
    manifest = folder.manifest
    if manifest is None or not folder.tables:
        return
    ended = manifest.status in ("finished", "interrupted")
    agents = folder.tables["agents"]
    if manifest.status == "running":  # agents that died after the living were last written are in both files
        agents = agents.unique(["world", "agent_id"], keep="first", maintain_order=True)
    complete = ended and folder.whole
    pairs = None
    if folder.config is not None:
        pairs = [name for name, species in folder.config.species.items() if species.birth.mating == "pairs"]
    broken_count = folder.add(check_agents(agents, manifest, pairs, complete=complete))
    checked_agents = agents if complete and not broken_count else None
    folder.add(check_population(folder.tables["population"], checked_agents, manifest, ended=ended))


def _check_end(folder: _Folder) -> None:
    """Compares the digests of records and worlds in the manifest with the files."""
    manifest = folder.manifest
    try:
        load_snapshot(folder.path)
    except RecordError as error:
        folder.findings.append(Finding("final.npz", f"cannot be used: {error}"))
    if manifest is None:
        return
    if manifest.status in ("finished", "interrupted") and not manifest.records_digest:
        folder.findings.append(Finding(MANIFEST, "has no digest of the records, which every ended run must have"))
    if manifest.records_digest and folder.whole:
        actual_digest = records_digest(folder.path, manifest.columns)
        if actual_digest != manifest.records_digest:
            folder.findings.append(
                Finding("records", "rows were changed: their digest differs from the one in the manifest")
            )
    if manifest.world_digests and folder.checkpoints:
        head = folder.checkpoints[-1].head
        if head.step == max(manifest.steps_done) and head.digests != manifest.world_digests:
            message = "the digests of the worlds differ from those in the checkpoint of the last step"
            folder.findings.append(Finding(MANIFEST, message))


def _usable(folder: _Folder) -> Iterator[str]:
    names = {finding.where for finding in folder.findings}
    if not names:
        return
    for table in TABLE_FOLDERS:
        parts = len(list((folder.path / table).glob("*.parquet")))
        damaged = sum(name.startswith(f"{table}/") for name in names)
        if parts:
            yield f"{table}: {max(parts - damaged, 0)} of {parts} files are undamaged"
    for checkpoint in () if folder.driven else reversed(folder.checkpoints):
        step, parts = checkpoint.head.step, checkpoint.head.parts
        if folder.manifest is None or CONFIG in names:
            yield f"checkpoint of step {step:,}: undamaged, and usable after the manifest and config are restored"
        elif not any(check_digests(folder.path, parts)):
            yield f"checkpoint of step {step:,}: `hedon resume` can continue from it, and computes later steps again"
            break
        else:
            yield f"checkpoint of step {step:,}: `hedon branch --at {step}` can continue from it in a new folder"
