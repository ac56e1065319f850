"""Every color stands out from both backgrounds, means the same everywhere, and keeps its meaning as time passes."""

import io

import numpy as np
import pytest
from matplotlib.image import imread
from view_page import live_server, run_server, serving

from hedon import load_config
from hedon.config import PRESETS, color
from hedon.config.color import food_colors, meal_colors, species_color, weight_colors
from hedon.view.layout import describe

pytest_plugins = ("view_fixture",)
LIGHT, DARK, WHITE = "#eef1f3", "#0c0f13", "#ffffff"
LEAST = 3.0  # WCAG 2.2, 1.4.11
MIDDLES = "Array.from(hedon.frame.id, (_, i) => hedon.arena.scene.toPage(hedon.frame.x[i], hedon.frame.y[i]))"


def luminance(rgb):
    """Relative luminance (WCAG 2.2) of colors from 0 to 1, (…, 3)."""
    rgb = np.asarray(rgb, float)
    linear = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
    return linear @ np.array([0.2126, 0.7152, 0.0722])


def contrast(a, b):
    one, other = luminance(a) + 0.05, luminance(b) + 0.05
    return np.maximum(one, other) / np.minimum(one, other)


def rgb(text):
    return [int(text[i : i + 2], 16) / 255 for i in (1, 3, 5)]


def given_colors():
    names = [each for name in PRESETS for each in describe(load_config(name))["foods"]]
    table = {*color.SPECIES_COLORS, *color.FOOD_COLORS, *color.OTHER_COLORS}
    return sorted(
        table | {color.ACTION_COLOR, color.NEUTRAL_COLOR, color.OBSTACLE_COLOR} | {each["color"] for each in names}
    )


@pytest.mark.parametrize("ground", [LIGHT, DARK, WHITE])
def test_each_color_of_the_table_stands_out(ground):
    pale = [each for each in given_colors() if contrast(rgb(each), rgb(ground)) < LEAST]
    assert pale == []


@pytest.mark.parametrize("preset", PRESETS)
def test_the_page_has_the_colors_of_the_figures(preset):
    config = load_config(preset)
    layout = describe(config)
    meals = meal_colors(config, list(config.species))
    assert {each["name"]: each["color"] for each in [*layout["foods"], *layout["species"]]} == meals
    assert [each["color"] for each in layout["species"]] == [species_color(i) for i in range(len(config.species))]
    names = [gene["name"] for gene in layout["genes"]]
    assert {gene["name"]: gene["color"] for gene in layout["genes"]} == weight_colors(names, meals)


def test_kinds_of_food_that_ask_for_the_same_color_get_different_ones():
    assert food_colors(["a", "b", "c"], ["#3f8f4f"] * 3) == {"a": "#3f8f4f", "b": "#b07d1a", "c": "#8e44ad"}
    assert food_colors(["a", "b"], ["#123456", "#abcdef"]) == {"a": "#123456", "b": "#abcdef"}


def pixels(watched):
    watched.get("(document.querySelector('#look').hidden = true)")
    drawn = watched.get("hedon.pictures")
    watched.until(f"hedon.pictures > {drawn} + 2")
    image = imread(io.BytesIO(watched.page.locator("#scene").screenshot()))[:, :, :3]
    box = watched.page.locator("#scene").bounding_box()
    places = np.array(watched.get(MIDDLES)) - [box["x"], box["y"]]
    return image, places.round().astype(int)


@pytest.mark.parametrize("ground", ["dark", pytest.param("light", marks=pytest.mark.long)])
def test_agents_stand_out_whatever_they_are_colored_by(ground, run_folder, watch):
    """Measured at the middle of each body, next to the eye."""
    with serving(run_server(run_folder)) as server:
        watched = watch(server.link, color_scheme=ground)
        watched.until("hedon.source.lives.size > 0")
        watched.rest_at(1984)
        names = watched.get("[...document.querySelector('#color').options].map((each) => each.value)")
        assert len(names) > 10
        for name in [*names[:9], "neutral"]:
            watched.page.locator("#color").select_option(name)
            image, places = pixels(watched)
            middle = image[places[:, 1], places[:, 0]]
            assert len(middle) > 40
            least = contrast(middle, image[3, 3])
            hollow = np.abs(middle - image[3, 3]).max(axis=1) < 0.02  # nothing is known about it: only a rim
            assert hollow.sum() == 0 or name == "eats"
            assert least[~hollow].min() >= LEAST - 0.05, name


def test_one_mutant_changes_no_other_color(run_folder, watch):
    """A gene a hundred times as large as all others does not change the scale, which fits nearly all lives."""
    with serving(run_server(run_folder)) as server:
        watched = watch(server.link)
        watched.until("hedon.source.lives.size > 0")
        watched.page.locator("#color").select_option("w_normal")
        watched.rest_at(1984)
        before, places = pixels(watched)
        watched.get("hedon.source.lives.get(hedon.frame.id[3]).genome[0] = 100")
        watched.get("hedon.source.lives.put({ ...hedon.source.lives.get(hedon.frame.id[0]), id: 1e6, birth: 1e9 })")
        after, _ = pixels(watched)
        same = (before == after).all(axis=2)[places[:, 1], places[:, 0]]
        assert list(np.flatnonzero(~same)) == [3]


def test_a_scale_stays_the_same_as_time_passes(run_folder, watch):
    with serving(run_server(run_folder)) as server:
        watched = watch(server.link)
        watched.until("hedon.source.lives.size > 0 && hedon.source.series.step.length > 1")
        for name in ("energy", "age", "w_normal", "reward"):
            watched.page.locator("#color").select_option(name)
            scales = set()
            for step in (64, 1024, 2048):
                watched.rest_at(step)
                watched.get("(hedon.panelsDue = 0)")
                watched.until(f"document.querySelector('#clock').textContent.startsWith('step {step:,} of')")
                scales.add(watched.page.locator("#legend .scale").inner_text())
            assert len(scales) == 1


def test_the_legend_names_all_that_is_drawn(watch):
    with serving(live_server("pitfall")) as server:
        watched = watch(server.link)
        watched.until("hedon.frame && hedon.source.obstacles.length > 0")
        watched.get("hedon.next()")
        watched.until("document.querySelector('#legend').textContent.includes('its near kin')")
        text = watched.page.locator("#legend").inner_text()
        for thing in (
            "food normal",
            "mouth",
            "wall",
            "obstacle",
            "chosen agent",
            "near kin",
            "ray",
            "where it came from",
        ):
            assert thing in text
        assert "multiply" not in text
        watched.page.keyboard.press("?")
        watched.until("document.querySelector('#help').textContent.includes('multiply-adds')")
