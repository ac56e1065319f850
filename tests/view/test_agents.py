"""The table of agents matches the records; its filter, and a rectangle in the scatter plot, select agents."""

import csv

import numpy as np
import polars as pl
import pytest
from split_run import record_species
from view_page import numbers, run_live, run_server, serving

from hedon import load_config
from hedon.record.reader import open_run
from hedon.view.live import live_world
from hedon.view.server import Server

pytest_plugins = ("view_fixture",)
STEP = 1984
ROWS = """[...document.querySelectorAll('.agents tbody tr')]
  .map((row) => [...row.cells].map((each) => each.textContent.replaceAll(',', '')))"""
PICKED = "[...hedon.arena.picked].sort((a, b) => a - b)"
COUNT = "document.querySelector('#agents-count').textContent"


def living(folder, step):
    """All agents alive in a frame, with their life histories, ordered by id."""
    recorded = open_run(folder)
    frame = recorded.frames().filter(pl.col("step") == step).collect()
    names = recorded.agents()
    own = names["species"].unique().to_list() if "species" in names.columns else ["agent"]
    frame = frame.filter(pl.col("kind").is_in(own)).select(
        pl.col("id").alias("agent_id"), pl.col("energy").alias("now"), "kind"
    )
    meals = [name for name in names.columns if name.startswith("eaten_")]
    return (
        frame.join(names.with_columns(pl.col("agent_id").cast(frame["agent_id"].dtype)), on="agent_id")
        .with_columns(age=step - pl.col("birth_step"), meals=pl.sum_horizontal(meals))
        .sort("agent_id")
    )


@pytest.fixture
def table(run_folder, watch):
    with serving(run_server(run_folder)) as server:
        watched = watch(server.link)
        watched.until("hedon.source.loaded && hedon.source.lives.size > 0")
        watched.page.locator("#tab-agents").click()
        watched.rest_at(STEP)
        watched.until("document.querySelectorAll('.agents tbody tr').length > 0")
        yield watched


def write(watched, text, count):
    watched.page.locator("#filter").fill(text)
    watched.until(f"{COUNT}.startsWith('{count} ')")


def test_the_table_lists_the_agents_alive_in_the_records(table, run_folder):
    rows = living(run_folder, STEP)
    table.until(f"{COUNT} === '{rows.height} agents alive.'")
    columns = [
        "agent_id",
        "age",
        "now",
        "generation",
        "children",
        "meals",
        "reward_sum",
        "w_normal",
        "w_poison",
        "w_action",
    ]
    heads = table.get("[...document.querySelectorAll('.agents th')].map((each) => each.dataset.column)")
    assert heads == [
        "id",
        "age",
        "energy",
        "generation",
        "children",
        "meals",
        "reward",
        "w_normal",
        "w_poison",
        "w_action",
    ]
    shown = np.array([[numbers(cell)[0] for cell in row] for row in table.get(ROWS)])
    assert shown == pytest.approx(rows.select(columns).to_numpy().astype(float), abs=6e-4)


def test_a_click_on_a_header_sorts_and_a_second_click_reverses_the_order(table, run_folder):
    rows = living(run_folder, STEP)
    for name, column in (("energy", "now"), ("w_poison", "w_poison"), ("meals", "meals")):  # meals have ties
        for order in ("descending", "ascending"):
            table.page.locator(f".agents th[data-column={name}] button").click()
            assert table.page.locator(f".agents th[data-column={name}]").get_attribute("aria-sort") == order
            wanted = rows.sort([column, "agent_id"], descending=[order == "descending", False])["agent_id"].to_list()
            table.until(f"document.querySelector('.agents tbody button').textContent === '{wanted[0]}'")
            assert [int(row[0]) for row in table.get(ROWS)] == wanted, (name, order)
    sorts = table.get("[...document.querySelectorAll('.agents th')].map((each) => each.ariaSort)")
    assert sorts.count("none") == len(sorts) - 1


def test_a_row_chooses_its_agent(table):
    row = table.page.locator(".agents tbody tr").nth(7)
    agent = int(row.locator("button").inner_text())
    row.locator("td").nth(3).click()
    table.until(f"document.querySelector('#agent h2')?.textContent === 'Agent {agent}'")
    table.page.locator("#tab-agents").click()
    table.until(f"document.querySelector('.agents tr.chosen button').textContent === '{agent}'")
    table.page.locator(".agents tbody button").first.focus()
    for _ in range(3):
        table.page.keyboard.press("ArrowDown")
    third = int(table.get("document.activeElement.textContent"))
    assert table.get("hedon.frame.step") == STEP
    table.page.keyboard.press("Enter")
    table.until(f"hedon.chosen === {third}")


FILTERS = {
    "age > 500 and w_normal < 0": (pl.col("age") > 500) & (pl.col("w_normal") < 0),
    "not (age >= 500 or w_normal<0)": ~((pl.col("age") >= 500) | (pl.col("w_normal") < 0)),
    "age > 500 or w_poison > 0 and w_action > 0": (pl.col("age") > 500)
    | (pl.col("w_poison") > 0) & (pl.col("w_action") > 0),
    "\N{MINUS SIGN}0.1 < w_normal <= 1e-1": (pl.col("w_normal") > -0.1) & (pl.col("w_normal") <= 0.1),
    "w_normal > w_poison": pl.col("w_normal") > pl.col("w_poison"),
    "eaten_normal != eaten_poison AND neutral_2 > 0": (pl.col("eaten_normal") != pl.col("eaten_poison"))
    & (pl.col("neutral_2") > 0),
    "children == 0": pl.col("children") == 0,
    "not parent > 20": pl.col("parent_id") <= 20,  # founders have none
}


def test_a_filter_marks_and_lists_the_agents_that_match(table, run_folder):
    rows = living(run_folder, STEP)
    for text, condition in FILTERS.items():
        wanted = rows.filter(condition)["agent_id"].to_list()
        assert 0 < len(wanted) < rows.height or text.startswith("not parent"), text
        write(table, text, len(wanted))
        assert table.get(COUNT) == f"{len(wanted)} of {rows.height} agents match and are ringed in the arena."
        assert table.get(PICKED) == wanted, text
        assert sorted(int(row[0]) for row in table.get(ROWS)) == wanted
    table.page.locator("#filter").fill("")
    table.until("hedon.arena.picked.size === 0")


def test_the_filter_is_in_the_link_and_follows_time(table, run_folder, watch):
    write(table, "energy > 20", living(run_folder, STEP).filter(pl.col("now") > 20).height)
    again = watch(table.get("location.href"))
    again.until(f"hedon.frame?.step === {STEP} && hedon.source.loaded")
    for step in (STEP, 640):
        again.rest_at(step)
        wanted = living(run_folder, step).filter(pl.col("now") > 20)["agent_id"].to_list()
        again.until(f"hedon.arena.picked.size === {len(wanted)}")
        assert again.get(PICKED) == wanted
    again.page.locator("#tab-agents").click()
    assert again.page.locator("#filter").input_value() == "energy > 20"


WRONG = {
    "agee > 3": ("“agee” is not a known name. The nearest one is “age”.", "Columns are id, age, energy"),
    "age > 3 && energy < 2": ("“&” cannot be used here.", "and, or, not"),
    "age > 3 adn energy < 2": ("“adn” cannot follow a complete comparison", "Did you mean “and”?"),
    "age": ("“age” has to be compared with something, as in: age > 100",),
    "age >": ("a name or a number is missing at its end",),
    "age > and": ("A name or a number is missing before “and”.",),
    "(age > 3": ("A “)” is missing.",),
    "age > 3)": ("“)” has no “(” before it.",),
    "W_normal > 1": ("The nearest one is “w_normal”.",),
    "alert(1)": ("“alert” is not a known name.",),
}


def test_an_invalid_filter_is_explained_and_selects_no_agent(table):
    for text, parts in WRONG.items():
        table.page.locator("#filter").fill(text)
        table.until(f"document.querySelector('#filter-problem').textContent.includes('{parts[0]}')")
        message = table.page.locator("#filter-problem").inner_text()
        assert all(part in message for part in parts), message
        assert table.page.locator("#filter").get_attribute("aria-invalid") == "true"
        assert table.get("hedon.arena.picked.size") == 0
    table.page.locator("#filter").fill("age > 3")
    table.until("document.querySelector('#filter-problem').textContent === ''")


def test_the_table_is_saved_in_its_order_with_every_digit(table, run_folder, tmp_path):
    rows = living(run_folder, STEP).filter(pl.col("age") > 500).sort(["w_normal", "agent_id"], descending=[True, False])
    write(table, "age > 500", rows.height)
    table.page.locator(".agents th[data-column=w_normal] button").click()
    table.until(f"document.querySelector('.agents tbody button').textContent === '{rows['agent_id'][0]}'")
    with table.page.expect_download() as download:
        table.page.locator("#save-agents").click()
    assert download.value.suggested_filename == f"agents-step-{STEP}.csv"
    download.value.save_as(tmp_path / "agents.csv")
    with (tmp_path / "agents.csv").open(newline="") as file:
        saved = list(csv.DictReader(file))
    assert [int(row["id"]) for row in saved] == rows["agent_id"].to_list()
    for name, column in (("energy", "now"), ("reward", "reward_sum"), ("w_normal", "w_normal")):
        assert [float(row[name]) for row in saved] == pytest.approx(rows[column].to_list(), rel=1e-7)


def test_species_have_a_column_and_can_be_named_in_the_filter(tmp_path, watch):
    folder = record_species(tmp_path / "run", seeds=(1, 2))
    with serving(run_server(folder)) as server:
        watched = watch(f"{server.link}#world=1")
        watched.until("hedon.source.loaded && hedon.source.lives.size > 0")
        watched.page.locator("#tab-agents").click()
        watched.rest_at(256)
        watched.until("document.querySelectorAll('.agents tbody tr').length > 0")
        recorded = open_run(folder)
        frame = recorded.frames().filter((pl.col("step") == 256) & (pl.col("world") == 1)).collect()
        predators = sorted(frame.filter(pl.col("kind") == "predator")["id"].to_list())
        watched.page.locator("#filter").fill("species = predator")
        watched.until(f"hedon.arena.picked.size === {len(predators)}")
        assert watched.get(PICKED) == predators
        assert {row[1] for row in watched.get(ROWS)} == {"predator"}
        assert all(row[-1] != "NaN" for row in watched.get(ROWS))
        # A predator has no weight for normal food, so neither this comparison nor its negation is true.
        for text in ("species = predator and w_normal < 0", "species = predator and not w_normal < 0"):
            watched.page.locator("#filter").fill(text)
            watched.until("hedon.arena.picked.size === 0")
        for text, message in {
            "species = predater": "The nearest one is “predator”.",
            "age = prey": "“prey” cannot be compared with “age”",
            "species < prey": "“<” cannot be used for species",
        }.items():
            watched.page.locator("#filter").fill(text)
            watched.until(f"document.querySelector('#filter-problem').textContent.includes('{message}')")


def test_at_most_two_hundred_agents_are_listed(watch):
    many = load_config("baseline", overrides=["population.capacity=300", "population.initial_count=230"])
    page = {"run": False, "worlds": [live_world(many, "many")]}
    with serving(Server({"page": lambda: page}, dict)) as server:
        watched = watch(server.link)
        watched.page.locator("#tab-agents").click()
        run_live(watched, 10)
        watched.get("hedon.seek(hedon.source.last)")
        watched.until("hedon.frame.step === hedon.source.last")
        alive = watched.get("hedon.source.around(hedon.source.last).before.id.length")
        assert alive > 200
        watched.until(f"{COUNT} === '{alive} agents alive. The first 200 are listed.'")
        assert watched.page.locator(".agents tbody tr").count() == 200


SCATTER = "document.querySelector('#scatter')"


def drag(watched, *corners):
    """Drags in the scatter plot between corners, which are fractions of its size."""
    watched.page.locator("#scatter").scroll_into_view_if_needed()
    box = watched.page.locator("#scatter").bounding_box()
    (x, y), *rest = [(box["x"] + box["width"] * x, box["y"] + box["height"] * y) for x, y in corners]
    watched.page.mouse.move(x, y)
    watched.page.mouse.down()
    for x, y in rest:
        watched.page.mouse.move(x, y, steps=3)
    watched.page.mouse.up()


def test_a_rectangle_in_the_scatter_plot_picks_out_its_agents(table, run_folder):
    rows = living(run_folder, STEP)
    table.page.locator("#tab-plots").click()
    table.page.get_by_label("Gene along y").select_option(label="weight of action")
    genes = rows.select("w_normal", "w_action").to_numpy()
    # The axes end 8 % beyond the 98th percentile of the absolute values, as in the page.
    sizes = np.sort(np.abs(genes).ravel())
    limit = 1.08 * sizes[int(0.98 * len(sizes))]
    table.until(
        f"{SCATTER}.ariaLabel === 'Two genes of {rows.height} agents' && {SCATTER}.classList.contains('brushed')"
    )
    drag(table, (0.3, 0.25), (0.5, 0.5), (0.75, 0.6))
    low, high = np.array([-0.4, -0.2]) * limit, np.array([0.5, 0.5]) * limit
    edge = 0.02 * limit  # pixels
    surely = ((genes > low + edge) & (genes < high - edge)).all(axis=1)
    perhaps = ((genes > low - edge) & (genes < high + edge)).all(axis=1)
    assert 0 < surely.sum() <= perhaps.sum() < rows.height
    table.until("hedon.arena.picked.size > 0")
    picked = np.isin(rows["agent_id"].to_numpy(), table.get(PICKED))
    assert (picked[surely]).all()
    assert not (picked & ~perhaps).any()
    table.page.locator("#tab-agents").click()
    table.until(f"{COUNT}.startsWith('{picked.sum()} of ')")
    assert sorted(int(row[0]) for row in table.get(ROWS)) == table.get(PICKED)
    area = table.page.locator("#agents-area").inner_text()
    assert area.startswith("In the rectangle of the scatter plot: w_normal \N{MINUS SIGN}")
    wanted = rows.filter(pl.Series(picked) & (pl.col("age") > 500))["agent_id"].to_list()  # filter and rectangle
    write(table, "age > 500", len(wanted))
    assert table.get(PICKED) == wanted
    table.page.locator("#filter").fill("")
    table.page.get_by_role("button", name="Remove the rectangle").click()
    table.until(f"hedon.arena.picked.size === 0 && {COUNT} === '{rows.height} agents alive.'")


def test_a_click_or_other_axes_remove_the_rectangle(table):
    table.page.locator("#tab-plots").click()
    table.until(f"{SCATTER}.classList.contains('brushed')")
    for remove in (
        lambda: drag(table, (0.5, 0.5)),
        lambda: table.page.get_by_label("Gene along x").select_option(label="weight of poison"),
    ):
        drag(table, (0.01, 0.01), (0.99, 0.99))
        table.until("hedon.arena.picked.size === hedon.frame.id.length")  # including those beyond the axes
        remove()
        table.until("hedon.arena.picked.size === 0")


def test_at_most_twenty_selected_agents_have_trails_and_rays(table):
    lines = "hedon.arena.scene.lines.count"
    before = table.get(lines)
    write(table, "id >= 0", table.get("hedon.frame.id.length"))
    rays = table.get("hedon.source.layout.species[0].rays.count")
    table.until(f"{lines} === {before} + 2 * 20 * {rays}")
    table.page.locator("#show-rays").click()
    table.until(f"{lines} === {before}")
    table.page.keyboard.press("Escape")
    table.get("hedon.seek(2048)")
    table.until(f"hedon.frame.step === 2048 && {lines} > {before}")  # a line between positions
    assert table.get(lines) <= before + 2 * 20
    table.page.locator("#show-trail").click()
    table.until(f"{lines} === {before}")
