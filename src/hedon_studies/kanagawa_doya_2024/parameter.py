"""The item of all parameters: the meaning, value, unit and source of each setting, taken from the config."""

from collections.abc import Iterator, Sequence
from typing import Any

from hedon.analysis import ResultTable, make_table
from hedon.config import FIDELITIES, PAPER_PRESETS, describe_preset, file_leaves, flatten, format_value
from hedon.study import Condition, Item, ItemInputs
from hedon_studies.kanagawa_doya_2024.condition import BASELINE

CONCERNS: dict[str, tuple[str, tuple[str, ...]]] = {
    "parameters_physics": ("Bodies and physics", ("arena", "body", "physics", "obstacle")),
    "parameters_sense": ("Motors and senses", ("motor", "sensor", "neighbor")),
    "parameters_food": ("Food", ("food", "diet")),
    "parameters_life": ("Energy, birth and death", ("population", "energy", "store", "hazard", "birth")),
    "parameters_evolution": ("Genome and reward", ("genome", "reward")),
    "parameters_learning": ("Learning", ("learning",)),
    "parameters_world": ("Rules of the world", ("world",)),
}
"""The title of each table, and the sections of a config file that it covers; the paper has one species."""
_ORIGIN = (
    'Origin: "paper" is printed in Kanagawa & Doya (2024), "code" is the configuration of its released code, '
    '"ours" is a choice of this project; "paper or code" is the paper\'s value where it prints one, else the code\'s.'
)

Row = dict[str, Any]


def _parameters(inputs: ItemInputs) -> Iterator[ResultTable]:
    fidelity = inputs.fidelity
    rows = list(_settings(fidelity))
    origin_note = f"{_ORIGIN} "
    for name, (title, sections) in CONCERNS.items():
        section_rows = [row for row in rows if row["setting"].split(".")[0] in sections]
        yield make_table(
            name,
            f"{title} (baseline, {fidelity})",
            _without_empty(section_rows),
            origin_note + _differences(section_rows),
        )
        origin_note = ""
    presets = " ".join(f"{preset}: {describe_preset(preset)}" for preset in PAPER_PRESETS)
    note = f"A kind of food that is added is compared with the first kind of the baseline. {presets}"
    yield make_table(
        "parameters_condition", f"What the other conditions change ({fidelity})", _conditions(fidelity), note
    )


def _settings(fidelity: str) -> Iterator[Row]:
    """A row per setting of the baseline, with the values of each fidelity if they differ."""
    values = {other: flatten(BASELINE.config(other)) for other in FIDELITIES}
    for path, setting, value in file_leaves(BASELINE.config(fidelity)):
        by_fidelity = {_column(other): format_value(values[other][path]) for other in FIDELITIES}
        differs = len(set(by_fidelity.values())) > 1
        yield {
            "setting": path,
            "meaning": setting.doc.meaning,
            "value": format_value(value),
            "unit": setting.doc.unit,
            "origin": setting.doc.source,
        } | (by_fidelity if differs else dict.fromkeys(by_fidelity))


def _conditions(fidelity: str) -> Iterator[Row]:
    """A row per setting in which a preset differs from the baseline."""
    baseline = BASELINE.config(fidelity)
    base, first = flatten(baseline), next(iter(baseline.food))
    for preset in PAPER_PRESETS:
        config = Condition(preset, preset).config(fidelity)
        matching_kinds = {f"food.{kind}": f"food.{first}" for kind in config.food if kind not in baseline.food}
        for path, setting, value in file_leaves(config):
            kind = ".".join(path.split(".")[:2])
            # names are not settings
            base_value = base.get(path.replace(kind, matching_kinds.get(kind, kind), 1), value)
            if base_value == value:
                continue
            yield {
                "preset": preset,
                "setting": path,
                "meaning": setting.doc.meaning,
                "baseline": format_value(base_value),
                "value": format_value(value),
                "unit": setting.doc.unit,
            }


def _without_empty(rows: Sequence[Row]) -> list[Row]:
    """The rows without the columns that are missing in all of them."""
    columns = [name for name in rows[0] if any(row[name] is not None for row in rows)]
    return [{name: row[name] for name in columns} for row in rows]


def _differences(rows: Sequence[Row]) -> str:
    if all(row[_column(fidelity)] is None for row in rows for fidelity in FIDELITIES):
        return "The same in all fidelities."
    return f"In {', '.join(FIDELITIES)}: the values of the fidelities, where they differ."


def _column(fidelity: str) -> str:
    return f"in_{fidelity}"


PARAMETERS = Item(
    "parameters",
    "All parameters",
    "The parameters of the model. Some are not printed, and some that are printed differ from the released code.",
    _parameters,
)
