"""What a reward as a rule in Python costs: a world that is paid by its terms, beside one that is paid by a rule."""

import tempfile
from functools import partial
from importlib.util import find_spec
from pathlib import Path

from hedon.benchmark.check import require
from hedon.benchmark.machine import Calibration
from hedon.benchmark.measure import Row, Table, interleave, median, spread
from hedon.benchmark.plan import Plan, PlanError
from hedon.experiment.simulation import Simulation

STEPS = 1000
"""Steps of each timed call."""
UNCHANGING = ("hazard.kappa=0", "hazard.alpha_age=0", "birth.kappa=0", "learning.update_epochs=0")
"""The same agents throughout, which see and act but do not learn: learning would hide the cost."""
TEXT = """
def same(agent):
    return agent.linear
"""
"""A rule that pays what the terms pay, so that both worlds stay the same."""


def measure(plan: Plan, _: Calibration) -> list[Row]:
    """One row: seconds of the same steps, paid by terms and by the rule, a list each.

    Raises:
        PlanError: Numba is not installed.
    """
    if find_spec("numba") is None:
        raise PlanError('rule: needs numba: pip install "hedon[rules]"')
    with tempfile.TemporaryDirectory(prefix="hedon-rule-") as folder:
        file = Path(folder) / "rule.py"
        file.write_text(TEXT, encoding="utf-8")
        terms = Simulation(plan.config(*UNCHANGING), [1], 1, plan.kernel)
        ruled = Simulation(plan.config(*UNCHANGING, f'reward.rule="{file}:same"'), [1], 1, plan.kernel)
    agents, steps = terms.worlds[0].alive, 10 if plan.quick else STEPS
    times = interleave({"terms": partial(terms.run, steps), "rule": partial(ruled.run, steps)}, plan.repeats)
    rewards = [simulation.worlds[0].agents()["reward"].sum() for simulation in (terms, ruled)]
    require(rewards[0] == rewards[1], f"rule: it paid {rewards[1]}, and the terms {rewards[0]}")
    return [{"agents": agents, "steps": steps, **{f"{name}_seconds": values for name, values in times.items()}}]


def table(rows: list[Row], _: Calibration) -> Table:
    """Nanoseconds of an agent's step with terms and with the rule, and what the rule costs."""
    (row,) = rows
    factor = 1e9 / (row["agents"] * row["steps"])
    cost = (median(row["rule_seconds"]) - median(row["terms_seconds"])) * factor
    line = (
        str(row["agents"]),
        *(spread(row[f"{name}_seconds"], 0, factor) for name in ("terms", "rule")),
        f"{cost:.0f}",
    )
    return Table(
        "rule: a reward in Python, on one thread, without learning",
        ("agents", "paid by terms [ns per agent and step]", "by a rule", "cost of the rule"),
        [line],
    )
