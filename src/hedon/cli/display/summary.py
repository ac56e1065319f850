"""A run's summary for the terminal: our figures beside the paper's, then world by world."""

from collections.abc import Mapping, Sequence
from typing import Any

from rich.console import Group
from rich.text import Text

from hedon.analysis.gene.weight import LAST_AGENTS
from hedon.cli.display.table import PrintedTable
from hedon.replication.paper import STEPS
from hedon.report.table import NOTHING, format_number
from hedon.statistic.interval import SHOWN_FROM

_QUANTITIES = {  # key of the summary: name, key among the paper's figures
    "mean_lifetime": ("mean lifetime of the dead [step]", "mean_lifetime"),
    "food_per_step": ("food per step, mean over agents [1/step]", "food_per_step"),
    "food_per_agent_step": ("food per step lived [1/step]", ""),
    "alive": ("agents alive", "population"),
    "mean_energy": ("mean energy", ""),
    "generation": ("mean generation", "generation"),
}
_WORLD_COLUMNS = {  # key of a world: header
    "seed": "seed",
    "steps": "steps",
    "steps_per_second": "steps/s",
    "alive": "alive",
    "births": "births",
    "deaths": "deaths",
    "mean_lifetime": "life",
    "food_per_step": "food",
    "mean_energy": "energy",
    "generation": "gen.",
}


def summary_table(summary: Mapping[str, Any]) -> Group:
    """What `hedon run` and `hedon report` print at the end.

    Args:
        summary: of `summary.summarize`, or as read from `summary.json`.
    """
    notes = []
    if summary["extinct_worlds"]:
        count = summary["extinct_worlds"]
        notes.append(f"{count} of {len(summary['worlds'])} worlds died out; they count in the means above.")
    if any(world["alive"] for world in summary["worlds"]):
        notes.append("Agents that still live have no lifetime yet: where lives are long, the mean is too small.")
    if summary["damaged_parts"]:
        notes.append(f"Damaged files, left out: {', '.join(summary['damaged_parts'])}")
    return Group(
        *_over_worlds(summary),
        _world_by_world(summary),
        _weights(summary),
        *(Text(note, style="dim") for note in notes),
    )


def _over_worlds(summary: Mapping[str, Any]) -> list[PrintedTable | Text]:
    count, paper = len(summary["worlds"]), summary["paper"]
    headers = ["mean over worlds", "value", "95 % interval"]
    if paper is not None:
        headers.append(f"paper ({STEPS / 1e6:g}e6 steps)")
    rows = []
    for key, (label, source) in _QUANTITIES.items():
        reported = [] if paper is None else [_reported(paper.get(source))]
        rows.append([label, *_interval(summary[key]), *reported])
    rows += [[f"weight {weight}", *_interval(summary["weights"][weight])] for weight in _shown(summary)]
    if count < SHOWN_FROM:
        for line in (headers, *rows):
            del line[2]
    title = f"{_name(summary)}: {count} world{'s' if count > 1 else ''}"
    claim = [Text(f"The paper: {paper['claim']}.", style="dim italic")] if paper is not None and paper["claim"] else []
    return [PrintedTable(headers, rows, title=title), *claim]


def _name(summary: Mapping[str, Any]) -> str:
    """What was run: "baseline (corrected)", or "mushrooms (baseline, corrected, modified)"."""
    name = summary["name"] or summary["preset"] or "run"
    preset = summary["preset"] if summary["preset"] != name else None
    remarks = [text for text in (preset, summary["fidelity"], "modified" if summary["modified"] else None) if text]
    return f"{name} ({', '.join(remarks)})" if remarks else name


def _world_by_world(summary: Mapping[str, Any]) -> PrintedTable:
    keys = list(_WORLD_COLUMNS)[1:]
    rows = [[str(world["seed"]), *(format_number(world[key]) for key in keys)] for world in summary["worlds"]]
    return PrintedTable(tuple(_WORLD_COLUMNS.values()), rows, title="world by world", dim=_extinct(summary))


def _weights(summary: Mapping[str, Any]) -> PrintedTable:
    names = _shown(summary)
    rows = []
    for world in summary["worlds"]:
        spreads = [world["weights"][name] for name in names]
        cells = [f"{_weight(spread['mean'])} ± {_weight(spread['sd'])}" for spread in spreads]
        rows.append([str(world["seed"]), *cells])
    title = f"weights of the agents born last (at most {LAST_AGENTS}), mean ± sd"
    return PrintedTable(("seed", *names), rows, title=title, dim=_extinct(summary))


def _shown(summary: Mapping[str, Any]) -> list[str]:
    """The weights, and of the neutral markers the first."""
    neutral = [name for name in summary["weights"] if name.startswith("neutral_")]
    return [name for name in summary["weights"] if name not in neutral[1:]]


def _extinct(summary: Mapping[str, Any]) -> list[int]:
    return [i for i, world in enumerate(summary["worlds"]) if world["extinct"]]


def _weight(value: float | None) -> str:
    return NOTHING if value is None else f"{value:.2f}"


def _interval(interval: Mapping[str, Any]) -> tuple[str, str]:
    both = NOTHING
    if interval["worlds"] >= SHOWN_FROM:
        both = f"{format_number(interval['low'])} … {format_number(interval['high'])}"
    return format_number(interval["mean"]), both


def _reported(value: float | Sequence[int] | None) -> str:
    if isinstance(value, Sequence):
        return " … ".join(str(bound) for bound in value)
    return format_number(value) if value is not None else ""
