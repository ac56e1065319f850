"""A run's summary for the terminal: our figures beside the paper's, then world by world."""

from collections.abc import Mapping, Sequence
from typing import Any

from rich.box import SIMPLE_HEAD
from rich.console import Group
from rich.markup import escape
from rich.table import Table
from rich.text import Text

from hedon.analysis.interval import SHOWN_FROM
from hedon.analysis.paper import STEPS
from hedon.analysis.weight import LAST_AGENTS

_NOTHING = "-"
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
        _over_worlds(summary),
        _world_by_world(summary),
        _weights(summary),
        *(Text(note, style="dim") for note in notes),
    )


def format_number(value: float | None) -> str:
    """A number as a reader wants it: whole from 1000 on, else three figures; a dash for None."""
    if value is None:
        return _NOTHING
    if isinstance(value, int) or abs(value) >= 1000:
        return f"{value:,.0f}"
    return f"{value:#.3g}".rstrip(".") if abs(value) >= 0.01 or value == 0 else f"{value:.2g}"


def _over_worlds(summary: Mapping[str, Any]) -> Table:
    count, paper = len(summary["worlds"]), summary["paper"]
    headers = ["mean over worlds", "value", "95 % interval"]
    if paper is not None:
        headers.append(f"paper ({STEPS / 1e6:g}e6 steps)")
    table = _table(escape(f"{_name(summary)}: {count} world{'s' if count > 1 else ''}"), headers)
    for key, (label, source) in _QUANTITIES.items():
        reported = [] if paper is None else [_reported(paper.get(source))]
        table.add_row(escape(label), *_interval(summary[key]), *reported)
    for weight, interval in summary["weights"].items():
        table.add_row(f"weight {weight}", *_interval(interval))
    if paper is not None and paper["claim"]:
        table.caption = f"The paper: {paper['claim']}."
        table.caption_justify = "left"
    return table


def _name(summary: Mapping[str, Any]) -> str:
    """What was run: "baseline (corrected)", or "mushrooms (baseline, corrected, modified)"."""
    name = summary["name"] or summary["preset"] or "run"
    preset = summary["preset"] if summary["preset"] != name else None
    remarks = [text for text in (preset, summary["fidelity"], "modified" if summary["modified"] else None) if text]
    return f"{name} ({', '.join(remarks)})" if remarks else name


def _world_by_world(summary: Mapping[str, Any]) -> Table:
    table = _table("world by world", tuple(_WORLD_COLUMNS.values()))
    for world in summary["worlds"]:
        cells = [str(world["seed"]), *(format_number(world[key]) for key in list(_WORLD_COLUMNS)[1:])]
        table.add_row(*cells, style="dim" if world["extinct"] else None)
    return table


def _weights(summary: Mapping[str, Any]) -> Table:
    names = list(summary["weights"])
    table = _table(f"weights of the agents born last (at most {LAST_AGENTS}), mean ± sd", ("seed", *names))
    for world in summary["worlds"]:
        spreads = [world["weights"][name] for name in names]
        cells = [f"{_weight(spread['mean'])} ± {_weight(spread['sd'])}" for spread in spreads]
        table.add_row(str(world["seed"]), *cells, style="dim" if world["extinct"] else None)
    return table


def _weight(value: float | None) -> str:
    return _NOTHING if value is None else f"{value:.2f}"


def _table(title: str, headers: Sequence[str]) -> Table:
    table = Table(
        title=title, title_justify="left", title_style="bold", box=SIMPLE_HEAD, padding=(0, 1), pad_edge=False
    )
    table.add_column(headers[0])
    for header in headers[1:]:
        table.add_column(header, justify="right")
    return table


def _interval(interval: Mapping[str, Any]) -> tuple[str, str]:
    both = _NOTHING
    if interval["worlds"] >= SHOWN_FROM:
        both = f"{format_number(interval['low'])} … {format_number(interval['high'])}"
    return format_number(interval["mean"]), both


def _reported(value: float | Sequence[int] | None) -> str:
    if isinstance(value, Sequence):
        return " … ".join(str(bound) for bound in value)
    return format_number(value) if value is not None else ""
