"""Records what happens in the worlds of the article's scenes 2 and 4, for the tables of its handout.

As a program it writes `web/src/story/recorded.json`, which takes some minutes. The handout shows these numbers to
readers who have not run the worlds themselves.
"""

import json
from pathlib import Path
from typing import Any

import numpy as np

from hedon import Simulation, load_config
from hedon.view.story import SCENES

FILE = Path(__file__).resolve().parent / "src" / "story" / "recorded.json"
ROUNDS, FEW, WINDOW = (5, 20, 40, 60, 80), 5, 1024
"""The last rounds of learning of each row, and how many rounds and steps each of them covers."""
QUARTER, QUARTERS = 3072, 4
"""The steps of scene 4 between two columns, and the number of columns after the first."""
MOVING, RATE = "genome.action.initial_mean", "learning.learning_rate"


def learning(moving: float) -> list[float]:
    """Meals per 1,000 steps in each row of a creature that likes food and to which moving feels like `moving`."""
    simulation = _simulation("learning", f"{MOVING}={moving}")
    meals = [0]
    for _ in range(ROUNDS[-1]):
        simulation.run(WINDOW)
        meals.append(int(simulation.worlds[0].agents()["eaten"][0][0]))
    return [round(1000 * (meals[last] - meals[last - FEW]) / (FEW * WINDOW), 1) for last in ROUNDS]


def evolve(learns: bool, quarters: int = QUARTERS) -> dict[str, list[float]]:
    """Mean feeling about food in each column, and the mean of the neutral gene that has moved furthest at the end."""
    simulation = _simulation("evolve", *([] if learns else [f"{RATE}=0"]))
    names = [gene.name for gene in simulation.worlds[0].layouts[0].genes]
    idle = [i for i, name in enumerate(names) if name.startswith("neutral")]
    means = [simulation.worlds[0].agents()["genome"].mean(0)]
    for _ in range(quarters):
        simulation.run(QUARTER)
        means.append(simulation.worlds[0].agents()["genome"].mean(0))
    course = np.array(means)
    furthest = max(idle, key=lambda gene: abs(course[-1, gene] - course[0, gene]))
    return {
        name: [round(float(value), 2) for value in course[:, gene]]
        for name, gene in (("feeling", names.index("w_normal")), ("neutral", furthest))
    }


def _simulation(scene: str, *changes: str) -> Simulation:
    """The world of seed 1, with the bits that it has in the browsers of most readers."""
    return Simulation(load_config(SCENES / f"{scene}.toml", overrides=changes), seeds=[1])


def recorded() -> dict[str, Any]:
    """All of it."""
    return {
        "learning": [{"meal": 1.0, "moving": moving, "rates": learning(moving)} for moving in (0.0, -10.0)],
        "evolve": [{"learns": learns, **evolve(learns)} for learns in (True, False)],
    }


if __name__ == "__main__":
    FILE.write_text(json.dumps(recorded(), separators=(",", ":")) + "\n")
