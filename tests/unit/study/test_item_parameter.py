import pytest
from setting_page import page_rows

from hedon.analysis.result import ResultTable
from hedon.config import FIDELITIES, Config, diff, load_config
from hedon.config.dump import flatten
from hedon.config.field import sections
from hedon.config.problem import format_value
from hedon.config.schema.species import PER_SPECIES
from hedon.report.table import cells
from hedon.study.item import ItemInputs
from hedon_studies.kanagawa_doya_2024.parameter import CONCERNS, PARAMETERS


def tables(fidelity: str) -> dict[str, ResultTable]:
    item = PARAMETERS
    return {each.name: each for each in item.make(ItemInputs(fidelity)) if isinstance(each, ResultTable)}


def settings(fidelity: str) -> list[dict]:
    found = tables(fidelity)
    return [row for name in CONCERNS for row in found[name].rows.iter_rows(named=True)]


def test_every_section_belongs_to_one_concern() -> None:
    assert sorted(name for _, names in CONCERNS.values() for name in names) == sorted(
        {*sections(Config), *PER_SPECIES} - {"species", "measure"}
    )


@pytest.mark.parametrize("fidelity", FIDELITIES)
def test_every_setting_appears_once_with_its_value_and_the_text_of_the_settings_page(fidelity: str) -> None:
    config = load_config("baseline", fidelity)
    rows = {row["setting"]: row for row in settings(fidelity)}
    assert len(rows) == len(settings(fidelity))
    assert sorted(rows) == sorted(flatten(config))
    page, have = page_rows({"food.<kind>": "food.normal"}), flatten(config)
    for path, row in rows.items():
        told = page[path.removesuffix(".energy") if ".gives." in path else path]
        assert row["value"] == format_value(have[path]), path
        assert (row["meaning"], row["unit"], row["origin"]) == (told.meaning, told.unit, told.source)


def test_fidelities_are_listed_exactly_where_they_differ() -> None:
    corrected, *others = (load_config("baseline", fidelity) for fidelity in FIDELITIES)
    expected = {path for other in others for path, _, _ in diff(corrected, other)}
    told = {row["setting"]: row for row in settings("corrected") if row.get("in_as_printed") is not None}
    assert told.keys() == expected
    growth = told["food.normal.growth_rate"]
    assert [growth[f"in_{fidelity}"] for fidelity in FIDELITIES] == ["0.2", "1.0", "0.02"]


def test_columns_without_any_difference_are_left_out() -> None:
    found = tables("corrected")
    assert "The same in all fidelities" not in "".join(each.note for each in found.values())
    assert "in_as_printed" in found["parameters_learning"].rows.columns
    assert "The same" not in found["parameters_learning"].note


def test_conditions_show_what_presets_change() -> None:
    rows = list(tables("released")["parameters_condition"].rows.iter_rows(named=True))
    changes = {(row["preset"], row["setting"]): (row["baseline"], row["value"]) for row in rows}
    assert len(changes) == len(rows)
    assert changes["small", "arena.width"] == ("480.0", "360.0")
    assert changes["poison", "food.poison.gives.energy"] == ("1.0", "-0.6")
    assert ("poison", "food.poison.growth_rate") not in changes  # the same as for normal food, even if released
    assert not any(preset == "baseline" for preset, _ in changes)
    for preset in ("small", "large", "centered", "relocation"):
        expected = {path for path, _, _ in diff(load_config("baseline"), load_config(preset))}
        assert {path for name, path in changes if name == preset} == expected


def test_nothing_that_a_reader_needs_is_hidden_on_a_page() -> None:
    headers, _ = cells(tables("corrected")["parameters_food"])
    columns = ["setting", "meaning", "value", "unit", "origin", "in corrected", "in released", "in as printed"]
    assert headers == columns
