"""The tables, the JSON summary and the page of a landscape assay."""

from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

import numpy as np

from hedon.analysis.result import ResultTable, make_table
from hedon.assay.end import End, on_surface
from hedon.assay.figure_landscape import draw_landscape
from hedon.assay.landscape import Landscape, measure_landscape
from hedon.assay.outcome import MEASURES
from hedon.assay.report import assay_answer, world_line, world_table
from hedon.assay.sample import Sample
from hedon.figure.named import NamedFigure
from hedon.report.answer import Answer
from hedon.report.table import format_p

OUTCOMES = "founders-outcome.csv"
_QUADRATIC = ("slope", "curvature", "interaction", "optimum")
_SMOOTH = ("slope", "optimum", "at_edge", "freedom", "axes", "value", "low", "high")
"""What the summary contains of each surface."""


def landscape_answer(genes: tuple[str, str], species: str, ends: Sequence[End], samples: Sequence[Sample]) -> Answer:
    """The results of a landscape assay: the surfaces, the effect of each gene, and fitness at the ends of runs.

    Raises:
        AssayError: All worlds died out before anything could be measured.
    """
    landscape = measure_landscape(samples[0], genes, species)
    tables = [_surfaces(landscape), _effects(landscape), *_ends(landscape, ends), world_table(_slopes(landscape))]
    headline = f"{landscape.founders} founders in each world, no mutation. {world_line(samples)}"
    intro = "\n".join([headline, "", *(f"- **{name}**: {meaning}" for name, meaning in MEASURES.items())])
    files = {OUTCOMES: landscape.outcomes.write_csv()}
    figure = NamedFigure("landscape", "How fit is each reward?", draw_landscape(landscape, ends))
    return assay_answer("landscape", samples, _landscape_json(landscape), tables, intro, figure, files)


def _slopes(landscape: Landscape) -> list[dict[str, Any]]:
    """The slope of relative fitness at 0 along each gene of the surface, in each world separately."""
    rows = []
    for (seed,), founders in landscape.outcomes.group_by("seed", maintain_order=True):
        row = {"seed": seed}
        for measure in landscape.surfaces:
            fitness = founders[measure].to_numpy().astype(np.float64)
            for gene in landscape.genes if fitness.mean() > 0 else ():
                z = founders[gene].to_numpy().astype(np.float64)
                # A parabola, as for all worlds together.
                row[f"{measure}: slope of {_short(gene)}"] = float(np.polyfit(z, fitness / fitness.mean(), 2)[1])
        rows.append(row)
    return rows


def _landscape_json(landscape: Landscape) -> dict[str, Any]:
    """The contents of the summary besides the tables."""
    surfaces = {}
    for name, surface in landscape.surfaces.items():
        values = asdict(surface)
        surfaces[name] = {
            **{key: values[key] for key in ("mean", "worlds", "flat_p")},
            "quadratic": {key: values["quadratic"][key] for key in _QUADRATIC},
            "smooth": {key: values["smooth"][key] for key in _SMOOTH},
        }
    return {
        "founders": landscape.founders,
        "extinct": list(landscape.extinct),
        "genes": list(landscape.genes),
        "measures": dict(MEASURES),
        "surfaces": surfaces,
    }


def _surfaces(landscape: Landscape) -> ResultTable:
    rows = []
    for measure, surface in landscape.surfaces.items():
        pairs = (
            ("optimum, smooth surface", surface.smooth.optimum),
            ("slope at 0, smooth surface", surface.smooth.slope),
            ("slope at 0, quadratic", surface.quadratic.slope),
            ("curvature, quadratic", surface.quadratic.curvature),
            ("optimum, quadratic", surface.quadratic.optimum),
        )
        for quantity, estimates in pairs:
            for gene, estimate in zip(landscape.genes, estimates, strict=True):
                row = {"fitness": measure, "quantity": quantity, "gene": _short(gene)}
                rows.append(row | vars(estimate))
        row = {"fitness": measure, "quantity": "interaction, quadratic", "gene": "both"}
        rows.append(row | vars(surface.quadratic.interaction))
    edges = [name for name, surface in landscape.surfaces.items() if surface.smooth.at_edge]
    note = "Fitness is relative to the mean of the own world. Intervals: bootstrap over worlds. The smooth surface "
    note += "is too low at a narrow peak, and its interval misses the true height there in two of three cases. "
    note += f"By {', '.join(edges)} the surface is highest at the edge of the founders' range. " if edges else ""
    flat = ", ".join(f"{name} {format_p(surface.flat_p)}" for name, surface in landscape.surfaces.items())
    note += f"Chance that two genes explain this much or more if they do nothing (permutation within worlds): {flat}."
    return make_table("surface", "Fitness over two genes", rows, note)


def _effects(landscape: Landscape) -> ResultTable:
    rows = []
    for measure, surface in landscape.surfaces.items():
        neutral = [effect for effect in surface.effects if effect.gene.startswith("neutral_")]
        slopes, curvatures = (
            np.array([getattr(effect, name) for effect in neutral]) for name in ("slope", "curvature")
        )
        for effect in surface.effects:
            if effect in neutral:
                continue
            rows.append(
                {
                    "fitness": measure,
                    "gene": _short(effect.gene),
                    "slope at 0": effect.slope,
                    "low": effect.slope_low,
                    "high": effect.slope_high,
                    "p slope": effect.slope_p,
                    "z slope": _score(effect.slope, slopes),
                    "curvature": effect.curvature,
                    "p curvature": effect.curvature_p,
                    "z curvature": _score(effect.curvature, curvatures),
                }
            )
        if neutral:
            false = [sum(getattr(effect, name) < 0.05 for effect in neutral) for name in ("slope_p", "curvature_p")]
            rows.append(
                {
                    "fitness": measure,
                    "gene": f"{len(neutral)} neutral: p < 0.05",
                    "p slope": false[0] / len(neutral),
                    "p curvature": false[1] / len(neutral),
                }
            )
    note = (
        "p: fitness exchanged among the founders of a world. z: by the spread of the neutral genes' values. In the "
        "rows of the neutral genes stands the share with p below 0.05: about 0.05 if all is well."
    )
    return make_table("gene", "Fitness and each gene by itself", rows, note)


def _ends(landscape: Landscape, ends: Sequence[End]) -> list[ResultTable]:
    surface_ends = on_surface(ends, landscape.genes)
    if not surface_ends:
        return []
    points = np.array([point for _, point in surface_ends])
    rows = []
    for measure, surface in landscape.surfaces.items():
        low, high = surface.smooth.axes[:, 0], surface.smooth.axes[:, -1]
        clipped = np.clip(points, low, high)
        top = float(surface.smooth.value.max())
        for (end, point), estimate in zip(surface_ends, surface.smooth.at(clipped), strict=True):
            genes = {_short(gene): value for gene, value in zip(landscape.genes, point, strict=True)}
            row = {"fitness": measure, "end": end.source, **genes, **vars(estimate)}
            rows.append(row | {"of the highest": estimate.value / top if top > 0 else None})
    note = "Relative fitness on the smooth surface; ends beyond its range count as at its edge."
    return [make_table("end", "Fitness where evolution ended", rows, note)]


def _score(value: float, neutral: np.ndarray) -> float | None:
    scale = float(np.sqrt(np.mean(neutral**2))) if len(neutral) else 0.0
    return value / scale if scale > 0 else None


def _short(gene: str) -> str:
    return gene.removeprefix("w_")
