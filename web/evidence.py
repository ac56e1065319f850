"""Takes the numbers of the article's scenes 5 and 6 from the committed results; as a program, writes them again."""

import csv
import json
from pathlib import Path
from typing import Any

import polars as pl

ROOT = Path(__file__).resolve().parents[1]
RESULTS = ROOT / "docs" / "results"
FILE = ROOT / "web" / "src" / "story" / "evidence.json"
COURSE = "start/tables/course.parquet"
START = "start/tables/start.csv"
SURFACE = "landscape/baseline/tables/smooth.parquet"
DRIFT = "full/tables/drift_world.csv"
SIDE = 21
"""Points of the map along each weight."""


def course() -> dict[str, Any]:
    """Mean weights over 512,000 steps from food 5 and action 5, five worlds, and where neutral genes from 5 stay.

    Those are drawn along the pedigrees of these worlds, and begin as the weights do; p is of the same comparison. The
    16 neutral genes that the worlds have begin at 0, so they are no measure of it: weights have limits, and 5 is nearer
    to one of them.
    """
    rows = pl.read_parquet(RESULTS / COURSE)
    genes = {name: own.sort("step") for (name,), own in rows.group_by("gene")}
    with (RESULTS / START).open(newline="") as file:
        p = {row["gene"]: round(float(row["p"]), 5) for row in csv.DictReader(file) if row["p"]}

    def column(gene: str, name: str) -> list[float]:
        return [round(value, 3) for value in genes[gene][name]]

    chance = {bound: column("action", f"drift_{bound}") for bound in ("low", "high")}
    if chance != {bound: column("normal", f"drift_{bound}") for bound in chance}:
        raise ValueError(f"{COURSE}: the two weights do not begin alike, so they need a band each")

    return {
        "source": f"docs/results/{COURSE}",
        "command": "hedon run baseline --seeds 1-5 --steps 512000 --set genome.neutral_count=16 "
        "--set genome.initial_mean_food=5 --set genome.initial_mean_action=5",
        "step": genes["action"]["step"].to_list(),
        "meal": {"mean": column("normal", "mean"), "p": p["normal"]},
        "moving": {"mean": column("action", "mean"), "p": p["action"]},
        "chance": chance,
    }


def surface() -> dict[str, Any]:
    """Living descendants, relative to the mean of a world, over the weights of food and action: the smooth surface."""
    rows = pl.read_parquet(RESULTS / SURFACE).filter(pl.col("measure") == "descendants").sort("w_action", "w_normal")
    food, action = (sorted(set(rows[name].to_list())) for name in ("w_normal", "w_action"))
    value = rows["value"].to_numpy().reshape(len(action), len(food))
    pick = [round(i * (len(food) - 1) / (SIDE - 1)) for i in range(SIDE)]
    return {
        "source": f"docs/results/{SURFACE}",
        "command": "hedon assay landscape baseline --seeds 1-6 --steps 81920 --set population.initial_count=150",
        "low": food[0],
        "high": food[-1],
        "value": [[round(float(value[a, f]), 3) for f in pick] for a in pick],
    }


def ends() -> dict[str, Any]:
    """Where two worlds of ten million steps ended: mean weights of the 5000 born last."""
    with (RESULTS / DRIFT).open(newline="") as file:
        rows = [(int(row["seed"]), row["weight"], round(float(row["mean"]), 2)) for row in csv.DictReader(file)]
    return {
        "source": f"docs/results/{DRIFT}",
        "command": "hedon run baseline --seeds 1-2 --steps 10240000",
        "mean": [{"seed": seed, "weight": weight, "mean": mean} for seed, weight, mean in rows],
    }


def evidence() -> dict[str, Any]:
    """All of it."""
    return {"course": course(), "surface": surface(), "ends": ends()}


def text() -> str:
    """The content of the file."""
    return json.dumps(evidence(), separators=(",", ":")) + "\n"


if __name__ == "__main__":
    FILE.write_text(text())
