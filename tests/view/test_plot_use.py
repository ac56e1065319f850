"""The plots of the page show their values, and can be zoomed, smoothed, and saved as tables and pictures."""

import io

import numpy as np
import polars as pl
import pytest
from matplotlib.image import imread
from split_run import record_species
from view_page import live_server, numbers, run_live, run_server, serving, sized

from hedon import load_config
from hedon.experiment.plan import RunPlan
from hedon.experiment.run import run
from hedon.record.reader import open_run

pytest_plugins = ("view_fixture",)

ROWS = 16
FIRST = ".u-over >> nth=0"
READOUTS = """Object.fromEntries([...document.querySelectorAll('.readout')].map((each) => [
  each.closest('#plots') && [...document.querySelectorAll('.plot-title')][
    [...document.querySelectorAll('.readout')].indexOf(each)].innerText.split(/ \\[/)[0], each.textContent]))"""
RANGES = "hedon.plots.plots.map(({ chart }) => [chart.scales.x.min, chart.scales.x.max])"


@pytest.fixture(scope="module")
def recorded(tmp_path_factory):
    """A run of one species with a row every 128 steps."""
    config = load_config(
        "poison", overrides=["world.rollout_steps=128", 'learning.policy="random"', "learning.minibatch_size=128"]
    )
    folder = tmp_path_factory.mktemp("plots") / "run"
    run(RunPlan(config, (3,), 128 * ROWS, folder, 1, 128))
    return open_run(folder)


@pytest.fixture(scope="module")
def species(tmp_path_factory):
    return open_run(record_species(tmp_path_factory.mktemp("species") / "run", steps=640, seeds=(1,)))


def opened(watch, server, rows, **how):
    """The page with its panel of plots, paused, once all records are loaded."""
    watched = watch(server.link, **how)
    watched.until(f"hedon.source.series.step.length === {rows} && hedon.source.loaded")
    watched.rest_at(128)
    watched.get("hedon.tab('plots')")
    watched.until(f"hedon.plots.points === {rows} && hedon.plots.plots[0].chart.width > 200")
    return watched


def center(watched, row):
    """The screen position of a row in the first plot, at mid-height."""
    box = watched.page.locator(FIRST).bounding_box()
    left = watched.get(
        f"(({{ chart }}) => chart.valToPos(chart.data[0][{row}], 'x'))(hedon.plots.plots[0])",
    )
    return box["x"] + left, box["y"] + box["height"] / 2


def assert_read(watched, rows, row):
    """Checks that every plot of the poison run shows the numbers of a row."""
    said = watched.get(READOUTS)
    one = rows.row(row, named=True)
    columns = {
        "agents alive": ("alive",),
        "mean energy": ("energy_mean",),
        "food present": ("food_normal", "food_poison"),
        "food eaten since the row before": ("eaten_normal", "eaten_poison"),
        "weight of normal food": ("w_normal_mean",),
    }
    for title, names in columns.items():
        wanted = [one["step"], *(one[name] for name in names)]
        assert numbers(said[title])[: len(wanted)] == pytest.approx(wanted, abs=1e-3), title
    assert said["food present"].startswith(f"step {one['step']:,}: normal ")


def test_the_values_under_mouse_finger_and_focus_match_the_table(recorded, watch):
    rows = recorded.population().sort("step")
    with serving(run_server(recorded.path)) as server:
        watched = opened(watch, server, ROWS)
        assert_read(watched, rows, 0)  # the moment that is shown
        watched.page.mouse.move(*center(watched, 9))
        watched.until("hedon.plots.plots[3].chart.cursor.idx === 9")
        assert_read(watched, rows, 9)
        watched.page.mouse.move(5, 5)
        watched.until("hedon.plots.plots[3].chart.cursor.idx === null")
        assert_read(watched, rows, 0)

        watched.page.locator(FIRST).focus()
        keyboard = watched.page.keyboard
        for key in ("End", "ArrowLeft", "ArrowLeft", "Shift+ArrowLeft", "ArrowRight"):
            keyboard.press(key)
        assert_read(watched, rows, ROWS - 12)
        slider = watched.page.get_by_role("slider", name="weight of normal food at a step")
        assert numbers(slider.get_attribute("aria-valuetext"))[0] == rows["step"][ROWS - 12]
        assert int(slider.get_attribute("aria-valuenow")) == rows["step"][ROWS - 12]
        assert watched.get("hedon.now") == 128  # the world has not moved
        keyboard.press("Enter")
        assert watched.get("hedon.now") == rows["step"][ROWS - 12]

        phone = opened(watch, server, ROWS, **sized(390))
        phone.page.locator(FIRST).scroll_into_view_if_needed()
        phone.page.touchscreen.tap(*center(phone, 5))
        phone.until("hedon.plots.plots[0].chart.cursor.idx === 5")
        assert_read(phone, rows, 5)
        assert abs(phone.get("hedon.now") - rows["step"][5]) < 64


def test_a_drag_zooms_all_plots_and_a_click_still_seeks(recorded, watch):
    rows = recorded.population().sort("step")
    whole = [[rows["step"][0], rows["step"][-1]]]
    with serving(run_server(recorded.path)) as server:
        watched = opened(watch, server, ROWS)
        plots, mouse = watched.get("hedon.plots.plots.length"), watched.page.mouse
        button = watched.page.get_by_role("button", name="Whole time")
        assert watched.get(RANGES) == whole * plots
        assert button.is_disabled()

        def drag(start, end):
            mouse.move(*center(watched, start))
            mouse.down()
            mouse.move(*center(watched, (start + end) // 2))
            mouse.move(*center(watched, end))
            mouse.up()

        drag(4, 8)
        ranges = watched.get(RANGES)
        assert ranges == ranges[:1] * plots
        assert ranges[0] == pytest.approx([rows["step"][4], rows["step"][8]], abs=8)
        assert watched.get("hedon.now") == 128  # a drag is not a click
        watched.until("hedon.plots.plots[0].marked === 128")
        watched.get("hedon.plots.points = -1")  # as after a new row
        watched.until(f"hedon.plots.points === {ROWS}")
        assert watched.get(RANGES) == ranges
        mouse.click(*center(watched, 6))
        assert watched.get("hedon.now") == pytest.approx(rows["step"][6], abs=8)
        assert watched.get(RANGES) == ranges
        watched.until("hedon.plots.now === hedon.now")
        now = watched.get("hedon.now")
        mouse.dblclick(*center(watched, 5))
        assert watched.get(RANGES) == whole * plots
        assert watched.get("hedon.now") == now  # its first click does not move the world permanently
        drag(10, 3)
        assert watched.get(RANGES)[-1] == pytest.approx([rows["step"][3], rows["step"][10]], abs=8)
        button.click()
        assert watched.get(RANGES) == whole * plots

        watched.page.locator(FIRST).focus()
        for key in ("Home", "ArrowRight", "ArrowRight", "+"):
            watched.page.keyboard.press(key)
        low, high = watched.get(RANGES)[2]
        assert (low, high) == (128, rows["step"][2] + (rows["step"][-1] - 128) / 4)
        assert watched.get("hedon.plots.plots[0].chart.cursor.idx") == 2


def test_a_finger_zooms_sideways(recorded, watch):
    steps = recorded.population().sort("step")["step"].to_list()
    with serving(run_server(recorded.path)) as server:
        watched = opened(watch, server, ROWS, **sized(390))
        watched.page.locator(FIRST).scroll_into_view_if_needed()
        fingers = watched.page.context.new_cdp_session(watched.page)

        def touch(kind, row):
            x, y = center(watched, row)
            points = [] if kind == "touchEnd" else [{"x": x, "y": y}]
            fingers.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})

        for kind, row in [("touchStart", 3), *(("touchMove", row) for row in range(4, 11)), ("touchEnd", 10)]:
            touch(kind, row)
        watched.until("hedon.plots.zoom")
        low, high = watched.get("hedon.plots.zoom")
        assert [low, high] == pytest.approx([steps[3], steps[10]], abs=40)


def smoothed(values, window):
    """For each row, the mean of the rows around it."""
    before = window // 2
    return [np.mean(values[max(i - before, 0) : i - before + window]) for i in range(len(values))]


def test_smoothing_draws_a_running_mean_over_the_numbers_and_is_remembered(recorded, watch):
    rows = recorded.population().sort("step")
    alive = rows["alive"].to_list()
    title = "hedon.plots.plots.find(({ content }) => content.title === 'agents alive')"
    drawn = f"{title}.chart.data.map((column) => [...column])"
    with serving(run_server(recorded.path)) as server:
        watched = opened(watch, server, ROWS)
        assert watched.get(drawn) == [rows["step"].to_list(), alive]
        for window in (5, 20):
            watched.page.get_by_label("Smoothing").select_option(f"{window} rows")
            step, faint, thick = watched.get(drawn)
            assert (step, faint) == (rows["step"].to_list(), alive)
            assert thick == pytest.approx(smoothed(alive, window))
        watched.page.mouse.move(*center(watched, 9))
        watched.until("hedon.plots.plots[0].chart.cursor.idx === 9")
        assert numbers(watched.get(READOUTS)["agents alive"]) == pytest.approx(
            [rows["step"][9], alive[9], thick[9]], abs=1e-3
        )
        watched.page.reload()
        watched.until("window.hedon && hedon.source && hedon.source.series.step.length > 1")
        assert watched.page.get_by_label("Smoothing").input_value() == "20"
        watched.get("hedon.tab('plots')")
        watched.until(f"{title}.chart.data.length === 3")
        watched.page.get_by_label("Smoothing").select_option("off")
        assert watched.get(f"{title}.chart.data.length") == 2


def saved(watched, name):
    """The content and the name of the file that a button saves."""
    with watched.page.expect_download() as download:
        watched.page.get_by_role("button", name=name, exact=True).click()
    with open(download.value.path(), "rb") as file:
        return file.read(), download.value.suggested_filename


def test_csv_has_the_numbers_of_the_table(recorded, watch):
    rows = recorded.population().sort("step")
    with serving(run_server(recorded.path)) as server:
        watched = opened(watch, server, ROWS)
        for title, names in {
            "agents alive": ["alive"],
            "food present": ["food_normal", "food_poison"],
            "food eaten since the row before": ["eaten_normal", "eaten_poison"],
            "mean energy": ["energy_mean"],
            "weight of poison": ["w_poison_mean"],
        }.items():
            text, file = saved(watched, f"CSV of {title}")
            table = pl.read_csv(io.BytesIO(text))
            assert file.startswith("run-s3-")
            assert table.columns[: 2 + len(names)] == ["seed", "step", *names]
            for name in ["seed", "step", *names]:
                assert table[name].to_list() == rows[name].to_list(), name
        weight = pl.read_csv(io.BytesIO(saved(watched, "CSV of weight of poison")[0]))
        assert weight.columns[3:] == ["drift_low", "drift_high"]
        high, low = watched.get("hedon.plots.plots[2].chart.data.slice(-2).map((column) => [...column])")
        assert (weight["drift_low"].to_list(), weight["drift_high"].to_list()) == (low, high)


def test_csv_has_a_row_for_each_species(species, watch):
    rows = species.population().sort("species", "step", descending=[True, False])
    with serving(run_server(species.path)) as server:
        watched = opened(watch, server, rows["step"].n_unique())
        for title, name in (("agents alive", "alive"), ("mean energy", "energy_mean")):
            table = pl.read_csv(io.BytesIO(saved(watched, f"CSV of {title}")[0]))
            assert table.columns == ["seed", "species", "step", name]
            assert table["species"].unique(maintain_order=True).to_list() == ["prey", "predator"]
            for column in table.columns:
                assert table[column].to_list() == rows[column].to_list()
        text, file = saved(watched, "CSV of predator: weight of prey")
        assert file == "run-s1-predator-w_prey_mean.csv"
        own = rows.filter(pl.col("species") == "predator")
        assert pl.read_csv(io.BytesIO(text))["w_prey_mean"].to_list() == own["w_prey_mean"].to_list()


def test_csv_of_a_live_world_has_its_series(watch):
    with serving(live_server("small")) as server:
        watched = watch(server.link)
        for step in (256, 512):
            run_live(watched, step)
        watched.get("hedon.tab('plots')")
        watched.until("hedon.plots.points === 2")
        text, file = saved(watched, "CSV of mean energy")
        table = pl.read_csv(io.BytesIO(text))
        assert file == "small-s1-energy_mean.csv"
        assert table["step"].to_list() == [256, 512]
        assert table["energy_mean"].to_list() == watched.get("hedon.source.series.get('energy_mean')")


@pytest.mark.parametrize("ground", ["light", "dark"])
def test_a_picture_has_title_key_and_lines_on_the_background_of_the_page(recorded, watch, ground):
    with serving(run_server(recorded.path)) as server:
        watched = opened(watch, server, ROWS, color_scheme=ground)
        content, file = saved(watched, "PNG of food present")
        image = imread(io.BytesIO(content))[:, :, :3]
        assert file == "run-s3-food.png"
        width = watched.get("hedon.plots.plots[0].chart.width")
        assert image.shape[1] == 2 * (width + 2 * 12)
        card = watched.get("getComputedStyle(document.documentElement).getPropertyValue('--card')")

        def close(area, color):
            wanted = [int(color[i : i + 2], 16) / 255 for i in (1, 3, 5)]
            return abs(area - wanted).max(axis=2) < 0.05

        assert close(image[:10], card).all()
        title, key, chart = image[20:60], image[60:96], image[110:]
        for area in (title, key):
            assert 0.7 < close(area, card).mean() < 0.99
        assert close(image, card).mean() < 0.98
        for color in watched.get("hedon.source.layout.foods.map((food) => food.color)"):
            assert close(key, color).sum() > 50, "dot"
            assert close(chart, color).sum() > width, "line"
