"""What a study asks of each world: one figure per question, by name, with the scale on which worlds are compared."""

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import numpy as np
import polars as pl

from hedon.analysis.agent.food import food_per_agent_step, food_per_step
from hedon.analysis.agent.lifetime import durations, mean_lifetime
from hedon.analysis.gene.weight import last_mean
from hedon.analysis.world.population import alive_after_extinction, last_generation, mean_alive, mean_energy, run_tail
from hedon.analysis.world.record import WorldRecord
from hedon.statistic.survival import SurvivalCurve, restricted_mean, survival_curve

_NEGLIGIBLE = 0.01
"""Share of a mean lifetime that may lie beyond the age up to which a curve is trusted."""


@dataclass(frozen=True)
class Common:
    """What all worlds of a study share, so that their figures can be compared.

    Attributes:
        end: step up to which the longest world reaches [step]; an extinct one counts as empty from its end to there.
        until: age up to which lifetimes are averaged, where censored lives count [step]; 0 where there is none.
    """

    end: int
    until: float


@dataclass(frozen=True)
class Response:
    """One figure of a world.

    Attributes:
        name: of its column.
        title: in words, with its unit.
        measure: of one world; None where it has none.
        ratio: whether worlds are compared by the logarithm, so that effects are ratios.
        sure: whether differences get an interval; a 0 or 1 per world has no normal law to take one from.
    """

    name: str
    title: str
    measure: Callable[[WorldRecord, Common], float | None]
    ratio: bool = False
    sure: bool = True

    def value(self, world: WorldRecord, common: Common) -> float | None:
        """The figure of a world; None where it has none or, for a ratio, where it is not above 0.

        Args:
            world: a world with its records.
            common: what the responses of one world share, computed once.
        """
        value = self.measure(world, common)
        return None if value is None or not math.isfinite(value) or (self.ratio and value <= 0) else value

    def scaled(self, value: float) -> float:
        """On the scale on which worlds are compared."""
        return math.log(value) if self.ratio else value

    def unscaled(self, value: float | None) -> float | None:
        """Back from that scale: of a difference, the difference or the ratio."""
        return math.exp(value) if self.ratio and value is not None else value


def common_to(worlds: Iterable[WorldRecord]) -> Common:
    """The end and the age that all of some worlds share.

    A curve is trusted up to the age that 20 agents reached. The common age is the largest of these at which no curve
    would have to be read further than it is trusted, but for survivors too few to move its mean by a
    hundredth. In an extinct world no life is censored, so its curve can be read at any age.
    """
    worlds = list(worlds)
    curves = [survival_curve(*durations(w.born, w.last_step)) for w in worlds if w.extinct_step is None]
    trusted = {curve.trusted_age(): curve for curve in curves if curve.trusted_age() > 0}
    until = max((age for age in trusted if all(_readable(c, a, age) for a, c in trusted.items())), default=0.0)
    if not trusted:  # every world died out, or nobody did
        gone = [survival_curve(*durations(w.born, w.last_step)).trusted_age() for w in worlds]
        until = max(gone, default=0.0)
    return Common(max((world.last_step for world in worlds), default=0), until)


def _readable(curve: SurvivalCurve, trusted: float, until: float) -> bool:
    """Whether a curve's mean up to an age needs nothing beyond the age up to which it is trusted."""
    if until <= trusted:
        return True
    left = float(curve.share[np.searchsorted(curve.age, trusted)])
    return left * (until - trusted) <= _NEGLIGIBLE * restricted_mean(curve, trusted).mean


def figures(world: WorldRecord, common: Common, responses: Sequence[Response]) -> dict[str, float | None]:
    """All figures of one world, by name.

    Args:
        world: a world with its records.
        common: what the responses of one world share, computed once.
        responses: what is measured.
    """
    return {response.name: response.value(world, common) for response in responses}


def _alive(world: WorldRecord, common: Common) -> float | None:
    if world.extinct_step is None:
        return mean_alive(run_tail(world.population))
    return alive_after_extinction(world.population, common.end)


def _energy(world: WorldRecord, _common: Common) -> float | None:
    return mean_energy(run_tail(world.population)) if world.extinct_step is None else None


def _restricted(world: WorldRecord, common: Common) -> float | None:
    curve = survival_curve(*durations(world.born, world.last_step))
    return restricted_mean(curve, common.until).mean if common.until and len(curve.age) else None


def _food_agent(world: WorldRecord, _common: Common) -> float | None:
    return food_per_step(world.agents, world.food_kinds)


def _food_step(world: WorldRecord, _common: Common) -> float | None:
    return food_per_agent_step(world.population, world.food_kinds)


def _refused(world: WorldRecord, _common: Common) -> float | None:
    sums = world.population.select(pl.col("births", "births_failed_full", "births_failed_space").sum()).row(0)
    return (sums[1] + sums[2]) / sum(sums) if sum(sums) else None


def _weight(name: str) -> Callable[[WorldRecord, Common], float | None]:
    return lambda world, _common: last_mean(name, world) if name in world.weight_names else None


def _size(name: str) -> Callable[[WorldRecord, Common], float | None]:
    signed = _weight(name)
    return lambda world, common: None if (value := signed(world, common)) is None else abs(value)


RESPONSES = (
    Response("alive", "agents alive, last tenth", _alive),
    Response("lifetime", "lifetime of the dead [step]", lambda w, _: mean_lifetime(w.born), ratio=True),
    Response("restricted_lifetime", "lifetime, the living counted [step]", _restricted, ratio=True),
    Response("food_agent", "food, mean over agents [1/step]", _food_agent, ratio=True),
    Response("food_step", "food per step lived [1/step]", _food_step, ratio=True),
    Response("w_food", "weight of food", _weight("w_normal")),
    Response("w_action", "weight of action", _weight("w_action")),
    Response("neutral", "neutral marker", _weight("neutral_1")),
    Response("neutral_size", "|neutral marker|", _size("neutral_1")),
    Response("refused", "share of births without a place", _refused),
    Response("generation", "generation at the end", lambda w, _: last_generation(w.population)),
    Response("energy", "mean energy, last tenth", _energy),
    Response("extinct", "extinct", lambda w, _: float(w.extinct_step is not None), sure=False),
)
"""Responses of a baseline world; those of weights are means over the 5000 agents born last."""
