import dataclasses
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import polars as pl
import pytest
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from synthetic_run import write_run

from hedon.analysis.world.record import WorldRecord, read_worlds
from hedon.figure.named import NamedFigure
from hedon.figure.style import save_figure
from hedon.record.reader import open_run
from hedon.study.item import ItemInputs
from hedon_studies.kanagawa_doya_2024.evolved_weight import WEIGHTS
from hedon_studies.kanagawa_doya_2024.paper import STEPS

ITEMS = {item.name: item for item in WEIGHTS}


@pytest.fixture(scope="module")
def five(tmp_path_factory: pytest.TempPathFactory) -> list[WorldRecord]:
    folder = tmp_path_factory.mktemp("weight") / "run"
    return read_worlds([open_run(write_run(folder, worlds=5, intervals=20, extinct=2, snapshot=False))])


def draw(name: str, **worlds: Sequence[WorldRecord]) -> tuple[str, Figure]:
    (made,) = ITEMS[name].make(ItemInputs("corrected", worlds))
    assert isinstance(made, NamedFigure)
    assert made.name == name
    return made.caption, made.figure


def panels(figure: Figure) -> list[Axes]:
    return [axes for axes in figure.axes if axes.get_xlabel()]


def texts(figure: Figure) -> list[str]:
    return [text for axes in figure.axes for text in (axes.get_title("left"), *(t.get_text() for t in axes.texts))]


def test_the_items_are_those_of_the_paper_at_its_scale() -> None:
    assert list(ITEMS) == ["weights-baseline", "weights-sizes", "weights-places", "weights-poor", "weights-poison"]
    assert {item.scale.seeds for item in WEIGHTS} == {(1, 2, 3, 4, 5)}
    assert {item.scale.steps for item in WEIGHTS} == {STEPS}
    presets = {item.name: [condition.preset for condition in item.conditions] for item in WEIGHTS}
    assert presets["weights-sizes"] == ["small", "baseline", "large"]
    assert presets["weights-places"] == ["baseline", "centered", "relocation"]


def test_each_arm_shows_its_own_agents_on_the_same_axes(five: list[WorldRecord]) -> None:
    groups = {"small": five[:2], "baseline": five, "large": five[3:]}
    _, figure = draw("weights-sizes", **groups)
    shown = panels(figure)
    assert len(shown) == 3
    assert len({(axes.get_xlim(), axes.get_ylim()) for axes in shown}) == 1
    for axes, worlds in zip(shown, groups.values(), strict=True):
        agents = pl.concat(world.agents for world in worlds)  # fewer than 5000 per world
        points = np.asarray(axes.collections[0].get_offsets())
        assert sorted(points[:, 0]) == pytest.approx(sorted(agents["w_normal"]))
        assert sorted(points[:, 1]) == pytest.approx(sorted(agents["w_action"]))


def test_the_axes_reach_as_far_as_the_agents_of_the_widest_condition(five: list[WorldRecord]) -> None:
    agents = five[0].agents.with_columns(w_action=pl.lit(7.0, pl.Float32))
    _, figure = draw("weights-sizes", small=five[1:2], large=[dataclasses.replace(five[0], agents=agents)])
    assert len(panels(figure)) == 2
    for axes in panels(figure):
        assert axes.get_ylim()[1] > 7.0


def test_a_panel_names_its_arm_its_worlds_and_those_that_died_out(five: list[WorldRecord]) -> None:
    _, figure = draw("weights-sizes", small=five[:2], baseline=five, large=five[2:3])
    found = texts(figure)
    assert {"small", "baseline", "large"} <= set(found)
    assert "2 worlds, 20,480 steps\nnone died out" in found
    assert "5 worlds, 20,480 steps\nseed 3 died out" in found
    assert f"1 world\ndied out at step {five[2].extinct_step:,}" in found


def test_a_seed_has_the_same_color_in_each_condition(five: list[WorldRecord]) -> None:
    _, figure = draw("weights-sizes", small=five[1:2], baseline=five[:2])
    small, baseline = (axes.collections[0] for axes in panels(figure))
    (color,) = np.unique(np.asarray(small.get_facecolor()), axis=0)
    offsets, colors = np.asarray(baseline.get_offsets()), np.asarray(baseline.get_facecolor())
    second = np.isin(offsets[:, 0].astype(np.float32), five[1].agents["w_normal"].to_numpy())
    assert second.sum() == five[1].agents.height
    assert (colors[second] == color).all()
    assert not (colors[~second] == color).all(axis=1).any()


def test_arms_without_worlds_are_named(five: list[WorldRecord]) -> None:
    caption, figure = draw("weights-sizes", baseline=five, small=[])
    assert len(panels(figure)) == 1
    assert caption.endswith("Not run yet: small; large.")
    caption, figure = draw("weights-poor")
    assert texts(figure)[-1] == "no worlds yet"
    assert caption.endswith("Not run yet: poor.")
    assert "Not run yet" not in draw("weights-baseline", baseline=five)[0]


def test_poison_is_drawn_in_the_axes_of_the_paper(tmp_path: Path) -> None:
    run = write_run(tmp_path / "run", worlds=2, intervals=5, food_kinds=("normal", "poison"), snapshot=False)
    worlds = read_worlds([open_run(run)])
    _, figure = draw("weights-poison", poison=worlds)
    (axes,) = panels(figure)
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("weight of normal food", "weight of poison")
    agents = pl.concat(world.agents for world in worlds)
    points = np.asarray(axes.collections[0].get_offsets())
    assert sorted(points[:, 0]) == pytest.approx(sorted(agents["w_normal"]))
    assert sorted(points[:, 1]) == pytest.approx(sorted(agents["w_poison"]))
    assert texts(figure).count("2 worlds, 5,120 steps\nnone died out") == 1


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("worlds", [1, 2, 5])
def test_any_number_of_worlds_is_drawn(five: list[WorldRecord], worlds: int, tmp_path: Path) -> None:
    some = five[:worlds]
    _, figure = draw("weights-places", uniform=some, centered=some, relocation=five[2:3])
    assert figure.get_size_inches()[0] <= 10
    assert save_figure(figure, tmp_path / "weights.svg").stat().st_size > 20_000
