from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import StepPatch
from scipy.integrate import trapezoid

from hedon.analysis.descent.walk import MutationLaw, lineages, mutation_law
from hedon.config import load_config
from hedon.config.gene import gene_of
from hedon.figure.named import NamedFigure
from hedon.figure.style import svg_bytes
from hedon.figure.walk import LENGTHS, draw_walks, unlimited_share
from hedon.study.item import ItemInputs
from hedon_studies.kanagawa_doya_2024.law import LAWS, window_births

CONFIG = load_config("baseline")
LAW = mutation_law(CONFIG, gene_of(CONFIG, "neutral_1"))


@cache
def item_made(name: str, fidelity: str) -> list[object]:
    """Everything that an item makes, cached so that figures of thousands of walks are drawn only once."""
    return list({item.name: item for item in LAWS}[name].make(ItemInputs(fidelity)))


def make(name: str, fidelity: str = "corrected") -> NamedFigure:
    """The figure of this name, which is that of its item, or that with `_lines` added."""
    [named] = [made for made in item_made(name.removesuffix("_lines"), fidelity) if getattr(made, "name", "") == name]
    assert isinstance(named, NamedFigure)
    return named


def panel(figure: Figure, title: str) -> Axes:
    [axes] = [axes for axes in figure.axes if axes.get_title(loc="left").startswith(title)]
    return axes


def labeled(axes: Axes) -> dict[str, Line2D]:
    return {str(line.get_label()): line for line in axes.lines if not str(line.get_label()).startswith("_")}


def xy(line: Line2D) -> tuple[np.ndarray, np.ndarray]:
    return np.asarray(line.get_xdata(), np.float64), np.asarray(line.get_ydata(), np.float64)


def test_the_hazard_by_energy_follows_the_formula() -> None:
    curves = labeled(panel(make("hazard").figure, "hazard by energy"))
    assert list(curves) == ["0", "500,000", "1,000,000", "1,500,000"]
    energy, young = xy(curves["0"])
    assert young[0] == pytest.approx(0.01 * (1 - 1 / 1.02) + 2e-7)
    odds = 0.02 * np.exp(-0.2 * energy)
    _, old = xy(curves["1,000,000"])
    assert old == pytest.approx(0.01 * odds / (1 + odds) + 2e-7 * np.exp(4.0))


def test_the_hazard_by_age_starts_at_the_hazard_by_energy() -> None:
    curves = labeled(panel(make("hazard").figure, "hazard by age"))
    assert list(curves) == ["0", "5", "10", "20", "40"]
    age, rate = xy(curves["20"])
    assert rate[0] == pytest.approx(3.9e-6, rel=1e-2)
    assert rate - rate[0] == pytest.approx(2e-7 * np.expm1(4e-6 * 1e6 * age), abs=1e-12)


def test_the_legend_gives_the_mean_of_each_survival_curve() -> None:
    curves = labeled(panel(make("hazard").figure, "survival"))
    means = [float(label.split(": ")[1].replace(",", "")) for label in curves]
    assert means == sorted(means)
    assert means[0] == pytest.approx(5090, rel=2e-3)
    for mean, line in zip(means, curves.values(), strict=True):
        age, share = xy(line)
        assert (np.diff(share) <= 0).all()
        area = age[0] + trapezoid(share, age)  # nearly all are alive where the axis starts
        assert area == pytest.approx(mean, rel=0.02)


def test_the_chance_of_a_birth_follows_the_formula() -> None:
    energy, chance = xy(panel(make("birth").figure, "chance").lines[0])
    assert chance == pytest.approx(0.4 / (1 + np.exp(-0.1 * energy)))


def test_an_agent_without_energy_just_replaces_itself() -> None:
    named = make("birth")
    children = panel(named.figure, "children")
    curve, level, start = children.lines
    assert xy(level)[1] == pytest.approx([1, 1])
    assert xy(start)[1] == pytest.approx([1.02], abs=5e-3)
    assert xy(curve)[1][0] == xy(start)[1][0]
    assert "1.02" in named.caption
    assert any("1.02" in text.get_text() for text in children.texts)


def test_the_axis_of_energy_has_one_slope_where_its_parts_meet() -> None:
    """Otherwise the curve would have a kink there that the function does not have."""
    scale = panel(make("birth").figure, "children").get_xaxis().get_transform()
    below, at, above = (scale.transform(np.array([energy])).item() for energy in (0.999, 1.0, 1.001))
    assert (above - at) / (at - below) == pytest.approx(1.0, abs=2e-3)


@pytest.mark.parametrize("fidelity", ["corrected", "released"])
def test_walks_are_drawn_for_both_lengths(fidelity: str) -> None:
    figure = make("walk_lines", fidelity).figure
    walks = [axes for axes in figure.axes if axes.get_ylabel() == "weight"]
    assert len(walks) == len(LENGTHS)
    for axes, length in zip(walks, LENGTHS, strict=True):
        lines = [line for line in axes.lines if len(np.asarray(line.get_xdata())) == length + 1]
        assert len(lines) == 8
        assert len({line.get_color() for line in lines}) == (4 if fidelity == "released" else 8)
        assert all(np.abs(xy(line)[1]).max() <= 10 for line in lines)
        [shares] = [p for p in panel(figure, f"after {length:,}").patches if isinstance(p, StepPatch)]
        assert np.sum(shares.get_data()[0]) == pytest.approx(100)


@pytest.mark.parametrize("fidelity", ["corrected", "released"])
def test_two_weights_gather_in_the_corners(fidelity: str) -> None:
    shares = []
    for axes, length in zip(make("walk", fidelity).figure.axes, LENGTHS, strict=True):
        assert axes.get_title(loc="left") == f"after {length:,} mutations"
        points = np.asarray(axes.collections[0].get_offsets())
        assert points.shape == (10_000, 2)
        assert np.abs(points).max() == 10
        corner = (np.abs(points) >= 9).all(axis=1)
        shares.append(corner.mean())
        told = [float(text.get_text().removesuffix(" %")) for text in axes.texts]
        assert sum(told) == pytest.approx(100 * corner.mean(), abs=0.2)
        sides = np.sign(points[corner])
        assert len(np.unique(sides, axis=0)) == 4
    assert shares[1] > 5 * shares[0]


def test_frozen_noise_is_explained_where_it_is_drawn() -> None:
    for name in ("walk", "walk_lines"):
        assert "frozen" not in make(name).caption
        assert f"{window_births(CONFIG)} entries" in make(name, "released").caption
    assert window_births(CONFIG) == round(200 * 2e-4 * 1024)


@pytest.mark.parametrize("fidelity", ["corrected", "released"])
def test_the_walk_has_the_same_bytes_each_time(fidelity: str) -> None:
    first = svg_bytes(make("walk", fidelity).figure)
    item_made.cache_clear()
    assert svg_bytes(make("walk", fidelity).figure) == first


def test_other_seeds_give_other_walks() -> None:
    one, other = (svg_bytes(draw_walks(LAW, 41, np.random.default_rng(seed))) for seed in (1, 2))
    assert one != other


def test_mutations_add_up_to_the_closed_form_if_nothing_is_clipped() -> None:
    wide = replace(LAW, limit=1e9)
    ends = lineages(wide, 50, 20_000, 1, np.random.default_rng(3))[-1].ravel()
    # The quartiles of Cauchy noise are at ± its scale.
    assert np.quantile(ends, [0.25, 0.5, 0.75]) == pytest.approx([-1, 0, 1], abs=0.05)
    edges = np.linspace(-10, 10, 21)
    assert np.histogram(ends, edges)[0] / len(ends) == pytest.approx(unlimited_share(wide, 50, edges), abs=0.02)


def test_lines_begin_with_the_law_of_founders_and_stay_within_the_limit() -> None:
    law = MutationLaw(mean=2.0, sd=0.5, scale=0.5, limit=3.0, tabulated=False, window=1024, late=False)
    genes = lineages(law, 30, 4000, 2, np.random.default_rng(4))
    assert genes.shape == (31, 4000, 2, 1)
    assert genes[0].mean() == pytest.approx(2.0, abs=0.03)
    assert np.abs(genes).max() == 3.0


def test_frozen_lines_of_a_world_share_a_table() -> None:
    frozen = replace(LAW, tabulated=True, limit=1e9)
    genes = lineages(frozen, 200, 3, 50, np.random.default_rng(5), births=4).astype(np.float64)
    steps = np.diff(genes, axis=0)
    for world in range(3):
        size = max(np.abs(steps[:, world]).max(), 1e-3)
        assert len(np.unique(np.round(steps[:, world] / size, 4))) <= 2 * 4  # rounding splits at most a few of the four
    assert np.abs(steps[:, 0]).max() != np.abs(steps[:, 1]).max()
