"""A run's summary for the terminal: its numbers next to those from the sources of studies, then world by world."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from rich.console import Group
from rich.text import Text

from hedon.cli.display.table import PrintedTable
from hedon.measure.catalogue import MEASURES
from hedon.report.table import NOTHING, format_number
from hedon.statistic.minimum import FOR_INTERVAL
from hedon.text import count

_WORLD_COLUMNS = {  # header by key of a world
    "seed": "seed",
    "steps": "steps",
    "steps_per_second": "steps/s",
    "alive": "alive",
    "births": "births",
    "deaths": "deaths",
    "mean_lifetime": "life",
    "food_per_step": "food",
    "prey_per_step": "prey",
    "mean_energy": "energy",
    "generation": "gen.",
}


def summary_table(summary: Mapping[str, Any]) -> Group:
    """Final output of `hedon run` and `hedon report`; with several species, it covers each."""
    notes = []
    if summary["extinct_worlds"]:
        notes.append(
            f"{summary['extinct_worlds']} of {len(summary['worlds'])} worlds died out; they count in the means above."
        )
    parts = [_Part(*each) for each in _parts(summary)]
    for part in parts:
        gone = sum(fare["extinct"] for fare in part.fares) - summary["extinct_worlds"]
        if part.species and gone:
            rest = "; these worlds count in its means" if gone < len(part.fares) else ""
            notes.append(f"The species {part.species} died out in {gone} of {len(part.fares)} worlds{rest}.")
    if any(fare["alive"] for part in parts for fare in part.fares):
        notes.append("Agents that still live have no lifetime yet: where lives are long, the mean is too small.")
    if summary["damaged_parts"]:
        notes.append(f"Damaged files, left out: {', '.join(summary['damaged_parts'])}")
    shown = [_over_worlds(summary, part) for part in parts]
    return Group(
        *(table for tables in shown for table in tables),
        _world_by_world(summary, parts),
        *(_weights(summary, part) for part in parts),
        *(Text(note, style="dim") for note in notes),
    )


def answer_lines(answers: Mapping[str, Sequence[str]]) -> Iterator[Text]:
    """Last lines of `hedon run` and `hedon report`: what evolved, in words."""
    for condition, lines in answers.items():
        yield Text(f"What evolved in {condition}?", style="bold")
        yield from (Text(f"  {line}") for line in lines)


@dataclass(frozen=True)
class _Part:
    """One species in a summary: its name, empty if it is the only one, its means, and its numbers in each world."""

    species: str
    means: Mapping[str, Any]
    fares: Sequence[Mapping[str, Any]]

    @property
    def shown(self) -> list[str]:
        """The weights, and the first neutral gene."""
        neutral = [name for name in self.means["weights"] if name.startswith("neutral_")]
        return [name for name in self.means["weights"] if name not in neutral[1:]]


def _parts(summary: Mapping[str, Any]) -> Iterator[tuple[str, Mapping[str, Any], Sequence[Mapping[str, Any]]]]:
    """Yields the species of a summary, as arguments of `_Part`."""
    if "species" not in summary:
        yield "", summary, summary["worlds"]
    for name, means in summary.get("species", {}).items():
        yield name, means, [world["species"][name] for world in summary["worlds"]]


def _over_worlds(summary: Mapping[str, Any], part: _Part) -> list[PrintedTable | Text]:
    worlds, sources = len(summary["worlds"]), summary["reported"]
    headers = ["mean over worlds", "value", "95 % interval"]
    headers += [f"{name} ({source['steps'] / 1e6:g}e6 steps)" for name, source in sources.items()]
    rows = []
    titles = {each.name: each.title for each in MEASURES.values() if each.averaged} | summary["measures"]
    for key, label in titles.items():
        if key in part.means and (not part.species or part.means[key]["mean"] is not None):
            reported = [_reported(source.get(key)) for source in sources.values()]
            rows.append([label, *_interval(part.means[key]), *reported])
    rows += [[f"weight {weight}", *_interval(part.means["weights"][weight])] for weight in part.shown]
    if worlds < FOR_INTERVAL:
        for line in (headers, *rows):
            del line[2]
    of = f", {part.species}" if part.species else ""
    title = f"{_name(summary)}{of}: {count(worlds, 'world')}"
    said = [
        Text(f"{name}: {source['claim']}.", style="dim italic")
        for name, source in sources.items()
        if source.get("claim")
    ]
    return [PrintedTable(headers, rows, title=title), *said]


def _name(summary: Mapping[str, Any]) -> str:
    """Name of what was run: "baseline (corrected)", or "mushrooms (baseline, corrected, modified)"."""
    name = summary["name"] or summary["preset"] or "run"
    preset = summary["preset"] if summary["preset"] != name else None
    remarks = [text for text in (preset, summary["fidelity"], "modified" if summary["modified"] else None) if text]
    return f"{name} ({', '.join(remarks)})" if remarks else name


def _world_by_world(summary: Mapping[str, Any], parts: Sequence[_Part]) -> PrintedTable:
    """A row per world; with several species, a row of totals, then one for each species."""
    several = bool(parts[0].species)
    known = {key for part in parts for fare in part.fares for key in (*fare, "steps", "steps_per_second")}
    keys = [key for key in list(_WORLD_COLUMNS)[1:] if key in known]
    headers = [_WORLD_COLUMNS["seed"], *(["species"] if several else []), *(_WORLD_COLUMNS[key] for key in keys)]
    rows, dim = [], []
    for i, world in enumerate(summary["worlds"]):
        lines = {"total": world | world["total"]} if several else {}
        lines |= (
            {part.species: {**part.fares[i], "steps": world["steps"]} for part in parts} if several else {"": world}
        )
        for name, line in lines.items():
            if line.get("extinct", world["extinct"]):
                dim.append(len(rows))
            cells = [format_number(line[key]) if key in line else "" for key in keys]
            rows.append([str(world["seed"]), *([name] if several else []), *cells])
    return PrintedTable(headers, rows, title="world by world", dim=dim)


def _weights(summary: Mapping[str, Any], part: _Part) -> PrintedTable:
    rows = []
    for world, fare in zip(summary["worlds"], part.fares, strict=True):
        spreads = [fare["weights"][name] for name in part.shown]
        cells = [f"{_weight(spread['mean'])} ± {_weight(spread['sd'])}" for spread in spreads]
        rows.append([str(world["seed"]), *cells])
    of = f"{part.species}: " if part.species else ""
    title = f"{of}weights of those alive at the end, mean ± sd"
    dim = [i for i, fare in enumerate(part.fares) if fare["extinct"]]
    return PrintedTable(("seed", *part.shown), rows, title=title, dim=dim)


def _weight(value: float | None) -> str:
    return NOTHING if value is None else f"{value:z.2f}"


def _interval(interval: Mapping[str, Any]) -> tuple[str, str]:
    both = NOTHING
    if interval["worlds"] >= FOR_INTERVAL:
        both = f"{format_number(interval['low'])} … {format_number(interval['high'])}"
    return format_number(interval["mean"]), both


def _reported(value: float | Sequence[int] | None) -> str:
    if isinstance(value, Sequence):
        return " … ".join(str(bound) for bound in value)
    return format_number(value) if value is not None else ""
