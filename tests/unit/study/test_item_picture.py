from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.collections import EllipseCollection, LineCollection, PathCollection
from matplotlib.figure import Figure
from matplotlib.image import imread
from matplotlib.patches import Circle, Ellipse, FancyArrowPatch, Wedge
from synthetic_run import synthetic_snapshot

from hedon.config import load_config
from hedon.config.load import PAPER_PRESETS
from hedon.figure.body import draw_body, ray_directions
from hedon.figure.named import NamedFigure
from hedon.figure.style import save_figure
from hedon.record.snapshot import Snapshot
from hedon.study.item import ItemInputs
from hedon_studies.kanagawa_doya_2024.picture import PICTURES

ITEMS = {item.name: item for item in PICTURES}
CONFIG = load_config("baseline")


def make(name: str, **snapshots: Snapshot) -> list[NamedFigure]:
    return [each for each in ITEMS[name].make(ItemInputs("corrected", {}, snapshots)) if isinstance(each, NamedFigure)]


def panels(figure: Figure) -> dict[str, Axes]:
    return {axes.get_title(loc="left"): axes for axes in figure.axes}


def discs(axes: Axes) -> list[int]:
    """How many discs each collection of agents or foods holds."""
    return [len(np.asarray(each.get_offsets())) for each in axes.collections if isinstance(each, EllipseCollection)]


def test_the_body_has_its_parts_where_the_settings_say() -> None:
    body, rays = draw_body(CONFIG).axes
    [mouth] = [patch for patch in body.patches if isinstance(patch, Wedge)]
    assert (mouth.theta1, mouth.theta2, mouth.r) == (30, 150, 10)
    [motors] = [each for each in body.collections if isinstance(each, PathCollection)]
    assert np.asarray(motors.get_offsets()) == pytest.approx(np.array([(-7.071, -7.071), (7.071, -7.071)]), abs=1e-3)
    skin, food = (patch for patch in body.patches if isinstance(patch, Circle))
    assert np.hypot(*food.center) == pytest.approx(skin.radius + food.radius)
    [fan] = [each for each in rays.collections if isinstance(each, LineCollection)]
    segments = np.array(fan.get_segments())
    assert segments.shape == (24, 2, 2)
    assert np.linalg.norm(segments[:, 0], axis=1) == pytest.approx(10)
    assert np.linalg.norm(segments[:, 1], axis=1) == pytest.approx(210)


def test_touch_sectors_are_numbered_counter_clockwise_from_the_heading() -> None:
    body = draw_body(CONFIG).axes[0]
    places = {text.get_text(): text.get_position() for text in body.texts if text.get_text().isdigit()}
    assert sorted(places) == [str(sector) for sector in range(6)]
    for sector, (x, y) in places.items():
        assert np.degrees(np.arctan2(-x, y)) % 360 == pytest.approx(60 * int(sector) + 30)


def test_the_first_ray_points_to_the_right() -> None:
    directions = ray_directions(CONFIG.species["agent"])
    assert directions[0] == pytest.approx([np.sin(np.pi / 3), 0.5])
    assert directions[-1] == pytest.approx([-np.sin(np.pi / 3), 0.5])


def test_the_body_follows_its_settings() -> None:
    config = load_config("baseline", "corrected", ["sensor.touch_sectors=4", "sensor.ray_count=7", "motor.angle=90"])
    body, rays = draw_body(config).axes
    assert len([text for text in body.texts if text.get_text().isdigit()]) == 4
    assert len(rays.collections[0].get_paths()) == 7
    assert np.asarray(body.collections[-1].get_offsets())[0] == pytest.approx([-10, 0], abs=1e-9)


def test_without_a_snapshot_there_is_no_arena() -> None:
    assert make("arena") == []
    assert [condition.preset for condition in ITEMS["arena"].conditions] == ["baseline"]


def test_the_arena_shows_everything_and_the_rays_of_one_agent(tmp_path: Path) -> None:
    [named] = make("arena", baseline=synthetic_snapshot(agents=7))
    axes = named.figure.axes[0]
    assert sorted(discs(axes)) == [1, 7, 12]  # the ring around one, agents, foods
    assert max(len(each.get_segments()) for each in axes.collections if isinstance(each, LineCollection)) == 24
    assert imread(save_figure(named.figure, tmp_path / "arena.png")).shape[1] == 7.2 * 160


def test_an_arena_without_agents_is_drawn() -> None:
    [named] = make("arena", baseline=nobody())
    assert discs(named.figure.axes[0]) == [12]


def test_captions_say_which_world_is_shown_and_when() -> None:
    snapshot = synthetic_snapshot(agents=7)
    when = f"seed {snapshot.seed} at step {snapshot.step:,}"
    assert make("arena", baseline=snapshot)[0].caption == f"World of {when}."
    caption = make("arenas", baseline=snapshot)[0].caption
    assert f"Shown: baseline {when}." in caption
    assert "baseline" not in caption.split("no run:")[1]


def test_every_preset_has_a_panel_of_its_size_at_one_scale() -> None:
    [named] = make("arenas")
    shown = panels(named.figure)
    assert sorted(shown) == sorted(PAPER_PRESETS) == sorted(each.preset for each in ITEMS["arenas"].conditions)
    size = named.figure.get_size_inches()
    for preset, axes in shown.items():
        arena = load_config(preset).arena
        scale = axes.get_position().size * size / np.array([arena.width, arena.height])
        assert scale == pytest.approx(0.00428, abs=1e-5)
        assert (axes.get_xlim(), axes.get_ylim()) == ((0, arena.width), (0, arena.height))
        assert discs(axes) == []
        assert any("no run" in text.get_text() for text in axes.texts)
    assert all(preset in named.caption for preset in PAPER_PRESETS)


def test_panels_do_not_overlap() -> None:
    [named] = make("arenas")
    places = [axes.get_position() for axes in named.figure.axes]
    assert all(place.x0 >= 0 and place.x1 <= 1 and place.y0 >= 0 and place.y1 <= 1 for place in places)
    assert not any(a.overlaps(b) for i, a in enumerate(places) for b in places[:i])


def test_the_law_of_placement_is_drawn_where_food_has_a_place() -> None:
    shown = panels(make("arenas")[0].figure)
    for preset, axes in shown.items():
        rings = [patch for patch in axes.patches if type(patch) is Ellipse and not patch.get_fill()]
        arrows = [patch for patch in axes.patches if isinstance(patch, FancyArrowPatch)]
        expected = {"centered": (1, 0), "relocation": (4, 4)}.get(preset, (0, 0))
        assert (len(rings), len(arrows)) == (2 * expected[0], expected[1])
    rings = [patch for patch in shown["centered"].patches if type(patch) is Ellipse and not patch.get_fill()]
    assert [(ring.center, ring.width, ring.height) for ring in rings] == [
        ((240, 180), 96, 72),
        ((240, 180), 192, 144),
    ]
    numbers = {text.get_text(): text.get_position() for text in shown["relocation"].texts if text.get_text().isdigit()}
    assert numbers == {"1": (360, 270), "2": (360, 90), "3": (120, 90), "4": (120, 270)}


def test_only_panels_with_a_snapshot_hold_agents_and_foods() -> None:
    [named] = make("arenas", poison=synthetic_snapshot(("normal", "poison"), agents=5), centered=nobody())
    shown = panels(named.figure)
    assert sorted(discs(shown["poison"])) == [5, 12, 12]
    assert discs(shown["centered"]) == [12]
    assert any("0 agents, 12 foods" in text.get_text() for text in shown["centered"].texts)
    assert discs(shown["baseline"]) == []
    missing = named.caption.split(":")[-1]
    assert "baseline" in missing
    assert "poison" not in missing


def test_the_legend_explains_each_color_once() -> None:
    [named] = make("arenas")
    labels = [text.get_text() for text in named.figure.legends[0].get_texts()]
    assert labels[:4] == ["agent", "normal food", "poor food", "poison food"]
    assert "1,000 eaten" in labels[-1]


def nobody() -> Snapshot:
    snapshot = synthetic_snapshot()
    names = ("agent_id", "x", "y", "angle", "energy", "rays", "species")
    return replace(snapshot, **{name: getattr(snapshot, name)[:0] for name in names})
