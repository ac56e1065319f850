import shutil
import subprocess
from dataclasses import replace
from pathlib import Path

import matplotlib as mpl
import numpy as np
import polars as pl
import pytest
from matplotlib.figure import Figure
from matplotlib.image import imread
from synthetic_run import synthetic_snapshot, write_run

from hedon.analysis.gene.band import DriftBand
from hedon.analysis.gene.weight import last_agents
from hedon.analysis.world.population import history
from hedon.config.color import food_colors
from hedon.config.title import weight_title
from hedon.error import ArgumentError
from hedon.figure.film import Film
from hedon.figure.history import HistoryRow, draw_histories
from hedon.figure.outline import wall_outline
from hedon.figure.population import draw_population
from hedon.figure.style import COLUMN, PAGE, draw_message, png_bytes, save_figure, step_unit
from hedon.figure.trace import over_worlds
from hedon.figure.weight import draw_weights
from hedon.figure.world import draw_world, ray_segments, telling_agent
from hedon.record.reader import open_run
from hedon.record.snapshot import Snapshot


def test_style_leaves_the_callers_settings_alone(tmp_path: Path) -> None:
    with mpl.rc_context({"font.size": 33.0}):
        save_figure(draw_world(synthetic_snapshot(), food_colors(("normal",))), tmp_path / "world.png")
        assert mpl.rcParams["font.size"] == 33.0


def test_weights_have_a_panel_per_kind_and_its_points(tmp_path: Path) -> None:
    run = open_run(write_run(tmp_path / "run", intervals=10, worlds=2, food_kinds=("normal", "poison")))
    last = last_agents(run.agents(), 30)
    figure = draw_weights(last, run.reward_names, {})
    labels = [axes.get_xlabel() for axes in figure.axes]
    assert [label for label in labels if label] == ["weight of normal food", "weight of poison"]
    points = np.asarray(figure.axes[0].collections[0].get_offsets())
    assert len(points) == 60
    assert sorted(points[:, 0]) == pytest.approx(sorted(last["w_normal"]))


def test_weights_of_a_few_agents_do_not_squeeze_the_others(tmp_path: Path) -> None:
    run = open_run(write_run(tmp_path / "run", intervals=10, worlds=2))
    far = pl.int_range(pl.len()) < 3
    agents = run.agents().with_columns(
        w_normal=pl.when(far).then(9.5).otherwise(pl.col("w_normal").clip(-0.5, 0.5)).cast(pl.Float32),
        w_action=pl.col("w_action").clip(-0.5, 0.5),
    )
    figure = draw_weights(agents, run.reward_names, {"w_normal": np.linspace(-2.0, 2.0, 101)})
    axes = figure.axes[0]
    assert axes.get_xlim() == axes.get_ylim() == (-1, 1)
    marks = np.asarray(axes.collections[-1].get_offsets())
    assert marks[:, 0].tolist() == [1, 1, 1]
    told = [text.get_text() for text in figure.legends[0].get_texts()]
    assert told[2:] == ["all agents", "drift alone: not known of w_action", "3 agents beyond"]


def test_each_weight_is_drawn_over_its_own_drift(tmp_path: Path) -> None:
    run = open_run(write_run(tmp_path / "run", intervals=10, worlds=1))
    times, half = np.array([0.0, 10_240.0]), np.array([0.01, 0.2])
    drift = {"w_normal": DriftBand(times, 1.0 - half, 1.0 + half), "neutral_1": DriftBand(times, -half, half)}
    row = HistoryRow(run.population(), drift=drift)
    figure = draw_histories([row], run.reward_names, run.neutral_names, food_colors(run.food_kinds))
    food, action, neutral = figure.axes
    for axes, middle in ((food, 1.0), (neutral, 0.0)):
        points = np.asarray(axes.collections[0].get_paths()[0].vertices)
        assert (points[:, 1].min(), points[:, 1].max()) == pytest.approx((middle - 0.2, middle + 0.2))
    assert not action.collections
    assert [text.get_text() for axes in figure.axes for text in axes.texts] == ["no band of drift"]
    assert food.get_ylim()[1] > 1.2
    values = {"w_normal": np.full(10, 1.0), "w_action": np.full(10, -1.0)}
    figure = draw_weights(run.agents(), run.reward_names, values)
    top, side = (axes for axes in figure.axes if not axes.axison)
    for axes, along, at in ((top, 0, 1.0), (side, 1, -1.0)):
        (outline,) = (patch for patch in axes.patches if not patch.get_fill())
        points = np.asarray(outline.get_path().vertices)
        assert points[points[:, 1 - along] > 0.5, along].mean() == pytest.approx(at, abs=0.05)


def test_history_draws_the_mean_over_worlds(tmp_path: Path) -> None:
    run = open_run(write_run(tmp_path / "run", intervals=10, worlds=3))
    rows = [HistoryRow(run.population())]
    figure = draw_histories(rows, run.reward_names, run.neutral_names, food_colors(run.food_kinds))
    assert [axes.get_title("left") for axes in figure.axes] == [
        "weight of normal food",
        "weight of action",
        "neutral genes",
    ]
    thick = [line for line in figure.axes[0].lines if line.get_linewidth() == 2.0]
    expected = run.population().group_by("step").agg(pl.col("w_normal_mean").mean())
    assert thick[0].get_ydata() == pytest.approx(expected.sort("step")["w_normal_mean"].to_numpy())


def test_band_needs_five_worlds(tmp_path: Path) -> None:
    rows = history(open_run(write_run(tmp_path / "run", intervals=4, worlds=5)).population(), ("normal",))
    _, mean, low, high = over_worlds(rows, "alive")
    assert (low <= mean).all()
    assert (mean <= high).all()
    _, mean, low, _ = over_worlds(rows.filter(rows["world"] < 4), "alive")
    assert np.isfinite(mean).all()
    assert np.isnan(low).all()


def test_population_axes_start_at_zero(tmp_path: Path) -> None:
    run = open_run(write_run(tmp_path / "run", intervals=10, worlds=1))
    figure = draw_population(run.population(), run.food_kinds, food_colors(run.food_kinds))
    assert len(figure.axes) == 6
    assert all(axes.get_ylim()[0] == 0 for axes in figure.axes)


def test_world_shows_agents_and_foods_where_they_are(tmp_path: Path) -> None:
    snapshot = synthetic_snapshot()
    colors = food_colors(("normal",), ["#ff00ff"])
    figure = draw_world(snapshot, colors)
    image = imread(save_figure(figure, tmp_path / "world.png"))[..., :3]
    assert image.shape[1] == 7.2 * 160
    for x, y in zip(snapshot.food_x.tolist()[:5], snapshot.food_y.tolist()[:5], strict=True):
        assert _pixel(figure, image, x, y) == pytest.approx([1, 0, 1], abs=0.02)
    back = [snapshot.x - 4 * np.sin(snapshot.angle + np.pi), snapshot.y + 4 * np.cos(snapshot.angle + np.pi)]
    order = np.argsort(snapshot.energy)
    brightness = [_pixel(figure, image, float(back[0][i]), float(back[1][i])).sum() for i in (order[0], order[-1])]
    assert brightness[0] > brightness[1] + 0.5  # the more energy, the darker


def test_the_legend_shows_what_rays_see() -> None:
    kinds = ("normal", "poison")
    figure = draw_world(synthetic_snapshot(kinds), food_colors(kinds), [0])
    labels = [text.get_text() for text in figure.legends[0].get_texts()]
    foods = ["normal food", "poison food"]
    seen = ["sees normal food", "sees poison food", "sees a wall", "sees nothing"]
    assert labels == [*foods, "ray that sees an agent", *seen]


def crowded_snapshot() -> Snapshot:
    """A world with three foods, two species and an obstacle."""
    plain = synthetic_snapshot(("normal", "toadstool", "fruit"))
    each = ("radius", "ray_count", "ray_length", "ray_spread", "mouth_spread", "mouth_center")
    return replace(
        plain,
        species_names=("grazer", "hunter"),
        obstacles=np.array([[(200, 200), (220, 200), (210, 220)]], np.float32),
        rays=np.full((40, 24, 7), -1.0, np.float32),
        **{name: np.full(2, getattr(plain, name)) for name in each},
    )


def test_a_legend_with_many_names_fits_in_the_figure() -> None:
    many = crowded_snapshot()
    kinds = many.food_kinds
    figure = draw_world(many, food_colors(kinds), [0])
    png_bytes(figure)
    legend, (axes, *_) = figure.legends[0], figure.axes
    assert len(legend.get_texts()) == 13
    boxes = [legend.get_window_extent(), *(text.get_window_extent() for text in legend.get_texts())]
    for box in boxes:
        assert figure.bbox.x0 <= box.x0
        assert box.x1 <= figure.bbox.x1
        assert box.y0 >= figure.bbox.y0
        assert box.y1 <= axes.get_window_extent().y0
    plain = draw_world(synthetic_snapshot(kinds), food_colors(kinds), [0])
    png_bytes(plain)
    assert axes.get_window_extent().width == pytest.approx(plain.axes[0].get_window_extent().width, rel=0.02)


@pytest.mark.parametrize(("width", "beside"), [(160, False), (320, False), (1280, True)])
def test_the_title_of_a_film_leaves_room_for_its_legend(width: int, beside: bool) -> None:
    many = crowded_snapshot()
    film = Film(many, food_colors(many.food_kinds), width, 100.0)
    film.draw(many)
    figure, title, legend = film._figure, film._caption.get_window_extent(), film._figure.legends[0]
    names = [text.get_window_extent() for text in legend.get_texts()]
    assert len(names) == 5
    assert film.height % 2 == 0
    for box in (title, *names):
        assert figure.bbox.x0 <= box.x0
        assert box.x1 <= figure.bbox.x1
        assert film._axes.get_window_extent().y1 <= box.y0
        assert box.y1 <= figure.bbox.y1
    for box in names:
        assert title.x1 < box.x0 if beside else box.y1 <= title.y0


def test_rays_end_on_the_walls() -> None:
    snapshot = synthetic_snapshot()  # its rays see only walls
    for index in range(len(snapshot.x)):
        segments, kind = ray_segments(snapshot, index)
        starts = segments[:, 0] - [snapshot.x[index], snapshot.y[index]]
        assert np.linalg.norm(starts, axis=1) == pytest.approx(np.full(24, 10.0))
        x, y = segments[kind >= 0, 1].T
        gap = np.minimum(np.minimum(np.abs(x), np.abs(480 - x)), np.minimum(np.abs(y), np.abs(360 - y)))
        assert gap == pytest.approx(np.zeros(len(x)), abs=1e-2)
        assert set(kind.tolist()) <= {-1, 2}
        assert np.linalg.norm(np.diff(segments[kind < 0], axis=1), axis=-1) == pytest.approx(200.0)


def test_the_first_ray_is_the_rightmost() -> None:
    snapshot = replace(synthetic_snapshot(agents=1), angle=np.zeros(1))  # facing +y
    segments, _ = ray_segments(snapshot, 0)
    assert segments[0, 0, 0] > snapshot.x[0] > segments[-1, 0, 0]


def test_an_empty_world_is_drawn(tmp_path: Path) -> None:
    nobody = _without_agents(synthetic_snapshot())
    assert telling_agent(nobody) is None
    path = save_figure(draw_world(nobody, food_colors(("normal",))), tmp_path / "world.png")
    assert path.stat().st_size > 5000


def test_outline_follows_walls_in_any_order_and_skips_inner_walls() -> None:
    square = np.array([(0, 0, 4, 0), (4, 4, 0, 4), (4, 0, 4, 4), (0, 0, 0, 4), (1, 1, 2, 2)], np.float32)
    outline = wall_outline(square)
    assert outline is not None
    assert outline.tolist() == [[0, 0], [4, 0], [4, 4], [0, 4]]
    assert wall_outline(square[:2]) is None
    assert wall_outline(square[:0]) is None


def test_colors_and_units() -> None:
    assert food_colors(("a", "b"), ("red", "blue")) == {"a": "red", "b": "blue"}
    assert len(set(food_colors(tuple("abcdefgh")).values())) == 8
    assert [step_unit(n)[1] for n in (100, 2e4, 1e7)] == ["steps", "thousand steps", "million steps"]


def _pixel(figure: Figure, image: np.ndarray, x: float, y: float) -> np.ndarray:
    column, row = figure.axes[0].transData.transform((x, y)) * 160 / figure.dpi
    return image[image.shape[0] - 1 - int(row), int(column)]


def _without_agents(snapshot: Snapshot) -> Snapshot:
    names = ("agent_id", "x", "y", "angle", "energy", "rays", "species")
    return replace(snapshot, **{name: getattr(snapshot, name)[:0] for name in names})


@pytest.mark.parametrize(
    ("gene", "title"),
    [
        ("w_normal", "weight of normal food"),
        ("w_normal_old", "weight of normal food, when old"),
        ("w_action_scale", "weight of action, power of ten"),
        ("w_see_prey", "weight of seeing prey"),
        ("w_smell_prey", "weight of smelling prey"),
        ("w_prey", "weight of prey"),
        ("w_near_adult", "weight of near adult"),
        ("g_gamma", "gamma, power of ten"),
        ("set_point", "gene set_point"),
    ],
)
def test_what_a_gene_is_called(gene: str, title: str) -> None:
    assert weight_title(gene) == title


def test_a_pdf_has_its_fonts_embedded_as_truetype(tmp_path):
    figure = draw_message("A letter, a µ and a Ω")
    content = save_figure(figure, tmp_path / "message.pdf").read_bytes()
    assert content.startswith(b"%PDF-")
    assert b"/FontFile2" in content
    assert b"/CIDFontType2" in content
    assert b"/Type3" not in content
    assert save_figure(figure, tmp_path / "again.pdf").read_bytes() == content
    if shutil.which("pdffonts"):
        said = subprocess.run(["pdffonts", tmp_path / "message.pdf"], capture_output=True, text=True, check=True).stdout
        rows = said.splitlines()[2:]
        assert rows
        assert all("TrueType" in row and row.split()[-5] == "yes" for row in rows), "every font is embedded"


def test_a_figure_is_laid_out_for_the_width_of_a_column(tmp_path):
    figure = draw_message("no worlds yet")
    widths = {"page": PAGE, "column": COLUMN}
    wide, narrow = (imread(save_figure(figure, tmp_path / f"{name}.png", width)) for name, width in widths.items())
    assert (wide.shape[1], narrow.shape[1]) == (round(PAGE * 160), round(COLUMN * 160))
    assert wide.shape[0] / wide.shape[1] == pytest.approx(narrow.shape[0] / narrow.shape[1], rel=0.01)


@pytest.mark.parametrize(
    ("name", "width", "says"),
    [
        ("a.pfd", None, r"path = a\.pfd: must end in \.svg, \.pdf, \.png; did you mean \.pdf\?"),
        ("a", None, r"path = a: must end in \.svg, \.pdf, \.png"),
        ("a.pdf", 0, "width = 0: must be a number above 0, in inches"),
    ],
)
def test_a_figure_that_cannot_be_written_is_refused(name, width, says):
    with pytest.raises(ArgumentError, match=says):
        save_figure(draw_message(""), name, width)
