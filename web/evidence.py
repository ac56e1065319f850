"""Takes the numbers of the article's scene 5 from the committed results; as a program, writes them again."""

import csv
import json
from pathlib import Path
from typing import Any

import polars as pl

ROOT = Path(__file__).resolve().parents[1]
RESULTS = ROOT / "docs" / "results"
FILE = ROOT / "web" / "src" / "story" / "evidence.json"
SURFACE = "landscape/baseline/tables/smooth.parquet"
DRIFT = "full/tables/drift_world.csv"
SIDE = 21
"""Points of the map along each weight."""


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
    return {"surface": surface(), "ends": ends()}


def text() -> str:
    """The content of the file."""
    return json.dumps(evidence(), separators=(",", ":")) + "\n"


if __name__ == "__main__":
    FILE.write_text(text())
