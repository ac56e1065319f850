"""Records what the article opens with: a world in which a feeling evolves, small enough to load at once.

As a program it writes `web/public/hero.gz`, which the page plays, and `hero.jpg`, its last moment, shown until the
recording is there and where no program runs.
"""

import gzip
import json
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import polars as pl
from numpy.typing import NDArray
from PIL import Image, ImageDraw

import hedon
from hedon.record.reader import Run

PUBLIC = Path(__file__).resolve().parent / "public"
PRESET, SEED, STEPS, EVERY = "appetite", 1, 20_480, 64
FEELING, NEUTRAL = "w_normal", "neutral_2"
LIMIT = 1.5
"""Feelings beyond are stored, and colored, as this."""
PICTURE = (1200, 630)
"""Size of the picture [pixel]: what pages that link to others show."""
HATES, NEITHER, LOVES = (31, 111, 224), (123, 133, 143), (200, 100, 0)
"""Colors of a feeling, as in `color.ts`."""
FOOD = "#3f8f4f"
COLOR_SPAN = 2.0
"""How much of the range of feelings has colors of its own: half of it; beyond, all are as blue or orange."""


Moments = tuple[pl.DataFrame, pl.DataFrame, pl.DataFrame]


def moments(run: Run) -> Moments:
    """What is drawn: agents with their two genes, where each was at each moment, and where each piece of food lay.

    Returns:
        agents: by id; from which moment on it was there, for how many, `feeling` and `neutral`.
        places: x and y [u] of each agent at its moments, agent after agent.
        foods: x and y [u], from which moment on, for how many.
    """
    rows = run.frames().with_columns(moment=pl.col("step") // EVERY).collect()
    places = rows.filter(pl.col("kind") == "agent").sort("id", "moment")
    span = {"first": pl.col("moment").min(), "count": pl.len()}
    genes = run.agents().select(id="agent_id", feeling=FEELING, neutral=NEUTRAL)
    agents = places.group_by("id", maintain_order=True).agg(**span).join(genes, "id", "left", maintain_order="left")
    foods = rows.filter(pl.col("kind") != "agent").group_by("x", "y").agg(**span).sort("first", "x", "y")
    return agents, places, foods


def recording(run: Run, shown: Moments) -> bytes:
    """The recording: a line of JSON, then the columns that it names, each as its low bytes and then its high bytes.

    Numbers are whole: moments, units of length, and genes in 127ths of `LIMIT`. Places are differences from the moment
    before, 0 before the first.
    """
    agents, places, foods = shown
    begins = places["id"].is_first_distinct().to_numpy()
    columns = {
        "first": agents["first"].to_numpy(),
        "count": agents["count"].to_numpy(),
        "feeling": whole(agents["feeling"].to_numpy() * 127 / LIMIT, 127),
        "neutral": whole(agents["neutral"].to_numpy() * 127 / LIMIT, 127),
        "x": steps(places["x"].to_numpy(), begins),
        "y": steps(places["y"].to_numpy(), begins),
        "foodFirst": np.diff(foods["first"].to_numpy(), prepend=0),
        "foodCount": foods["count"].to_numpy(),
        "foodX": whole(foods["x"].to_numpy()),
        "foodY": whole(foods["y"].to_numpy()),
    }
    config = run.config
    (species,) = config.species.values()
    head = {
        "width": config.arena.width,
        "height": config.arena.height,
        "radius": species.body.radius,
        "foodRadius": config.world.food_radius,
        "every": EVERY,
        "moments": STEPS // EVERY + 1,
        "limit": LIMIT,
        "columns": {name: len(values) for name, values in columns.items()},
    }
    planes = [values.astype("<i2").view(np.uint8).reshape(-1, 2).T.tobytes() for values in columns.values()]
    return json.dumps(head).encode() + b"\n" + b"".join(planes)


def whole(values: NDArray[np.floating], limit: float = np.inf) -> NDArray[np.int64]:
    """Rounded, and within a limit."""
    return np.rint(np.clip(values, -limit, limit)).astype(np.int64)


def steps(places: NDArray[np.floating], begins: NDArray[np.bool_]) -> NDArray[np.int64]:
    """From each place to the next, in whole units that add up; the place itself where an agent begins."""
    at = whole(places)
    return np.where(begins, at, np.diff(at, prepend=0))


def picture(run: Run, shown: Moments) -> Image.Image:
    """The last moment, drawn as the page draws it."""
    agents, places, foods = shown
    last = STEPS // EVERY
    config = run.config
    (species,) = config.species.values()
    scale = max(PICTURE[0] / config.arena.width, PICTURE[1] / config.arena.height)
    fine = 3  # pixels of the drawing per pixel of the picture
    image = Image.new("RGB", (PICTURE[0] * fine, PICTURE[1] * fine), "#f1eee6")
    ink = ImageDraw.Draw(image)

    def disc(x: float, y: float, radius: float, color: tuple[int, int, int] | str) -> None:
        at = (
            np.array([(x - config.arena.width / 2) * scale, -(y - config.arena.height / 2) * scale])
            + np.array(PICTURE) / 2
        )
        ink.circle(tuple(at * fine), radius * scale * fine, fill=color)

    for x, y in foods.filter(pl.col("first") + pl.col("count") > last).select("x", "y").iter_rows():
        disc(x, y, config.world.food_radius, FOOD)
    before = {row["id"]: row for row in places.filter(pl.col("moment") == last - 1).iter_rows(named=True)}
    feelings = dict(agents.select("id", "feeling").iter_rows())
    for row in places.filter(pl.col("moment") == last).iter_rows(named=True):
        disc(row["x"], row["y"], species.body.radius, color_of(feelings[row["id"]]))
        old = before.get(row["id"], row)
        ahead = np.arctan2(row["y"] - old["y"], row["x"] - old["x"])
        for side in (-0.6, 0.6):
            for far, size, color in ((0.6, 0.27, "white"), (0.7, 0.13, "#101418")):
                x, y = (
                    row[axis] + far * species.body.radius * turn(ahead + side)
                    for axis, turn in (("x", np.cos), ("y", np.sin))
                )
                disc(x, y, size * species.body.radius, color)
    return image.resize(PICTURE, Image.Resampling.LANCZOS)


def color_of(feeling: float) -> tuple[int, int, int]:
    """Of a feeling: blue hates food, orange loves it."""
    share = min(abs(feeling) / LIMIT * COLOR_SPAN, 1.0)
    end = LOVES if feeling > 0 else HATES
    red, green, blue = (round(a + (b - a) * share) for a, b in zip(NEITHER, end, strict=True))
    return red, green, blue


def main() -> None:
    """Runs the world and writes both files."""
    PUBLIC.mkdir(exist_ok=True)
    with TemporaryDirectory() as folder:
        out = Path(folder) / "run"
        hedon.run(hedon.RunPlan(hedon.load_config(PRESET), (SEED,), STEPS, out, frames=EVERY))
        run = hedon.open_run(out)
        shown = moments(run)
        (PUBLIC / "hero.gz").write_bytes(gzip.compress(recording(run, shown), 9, mtime=0))
        picture(run, shown).save(PUBLIC / "hero.jpg", quality=80, optimize=True)


if __name__ == "__main__":
    main()
