"""What rules in Python cost: a world that lives by its config's formulas, beside one that asks rules for the same."""

import tempfile
from functools import partial
from importlib.util import find_spec
from pathlib import Path

from benchmarks.check import require
from benchmarks.machine import Calibration
from benchmarks.measure import Row, Table, interleave, median, spread
from benchmarks.plan import Plan, PlanError
from hedon.experiment.simulation import Simulation

STEPS = 1000
"""Steps of each timed call."""
UNCHANGING = ("hazard.kappa=0", "hazard.alpha_age=0", "birth.kappa=0", "learning.update_epochs=0")
"""The same agents throughout, which see and act but do not learn: learning would hide the cost."""
TEXT = """
def paid(agent):
    return agent.linear

def chance(agent):
    return agent.chance
"""
"""Rules that answer what the formulas give, so that all worlds stay the same."""
RULES = {
    "formulas": {},
    "reward": {"reward": "paid"},
    "hazard": {"hazard": "chance"},
    "birth": {"birth": "chance"},
    "all": {"reward": "paid", "hazard": "chance", "birth": "chance"},
}
"""The worlds: which of their formulas a rule replaces."""


def measure(plan: Plan, _: Calibration) -> list[Row]:
    """One row for each world: seconds of the same steps, a list.

    Raises:
        PlanError: Numba is not installed.
    """
    if find_spec("numba") is None:
        raise PlanError('rule: needs numba: pip install "hedon[rules]"')
    with tempfile.TemporaryDirectory(prefix="hedon-rule-") as folder:
        file = Path(folder) / "rule.py"
        file.write_text(TEXT, encoding="utf-8")
        worlds = {
            name: Simulation(
                plan.config(*UNCHANGING, *(f'{use}.rule="{file}:{rule}"' for use, rule in chosen.items())),
                [1],
                1,
                plan.kernel,
            )
            for name, chosen in RULES.items()
        }
    steps = 10 if plan.quick else STEPS
    times = interleave({name: partial(each.run, steps) for name, each in worlds.items()}, plan.repeats)
    ends = {name: each.worlds[0].agents()["reward"].sum() for name, each in worlds.items()}
    for name, reward in ends.items():
        require(reward == ends["formulas"], f"rule: with rules for {name}, agents got {reward}, not {ends['formulas']}")
    agents = worlds["formulas"].worlds[0].alive
    return [{"rules": name, "agents": agents, "steps": steps, "seconds": times[name]} for name in RULES]


def table(rows: list[Row], _: Calibration) -> Table:
    """Nanoseconds of an agent's step, and how much of it is the rule's."""
    factor = 1e9 / (rows[0]["agents"] * rows[0]["steps"])
    none = median(rows[0]["seconds"])
    lines = [
        (
            row["rules"],
            str(row["agents"]),
            spread(row["seconds"], 0, factor),
            f"{(median(row['seconds']) - none) * factor:.0f}",
        )
        for row in rows
    ]
    return Table(
        "rule: rules in Python, on one thread, without learning",
        ("rules for", "agents", "time [ns per agent and step]", "cost of the rules"),
        lines,
    )
