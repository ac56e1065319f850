"""The measures that studies take of each world, and the age up to which lifetimes of several worlds are comparable."""

from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np

from hedon.analysis.agent.lifetime import durations
from hedon.analysis.world.record import WorldRecord
from hedon.measure.catalogue import MEASURES, last_born_mean
from hedon.measure.measure import Measure
from hedon.statistic.interval import AMOUNT
from hedon.statistic.survival import SurvivalCurve, restricted_mean, survival_curve

_NEGLIGIBLE = 0.01
"""Share of a mean lifetime that may come from ages beyond the one up to which a curve is trusted."""
RESTRICTED = "restricted_lifetime"
"""The measure that depends on the worlds it is compared with; see `common_age`."""


def restricted_lifetime(until: float) -> Measure:
    """The mean of min(lifetime, age limit), with the living treated as censored.

    Args:
        until: The age limit [step]; at 0 no world has a value.
    """

    def of(world: WorldRecord) -> float | None:
        curve = survival_curve(*durations(world.born, world.last_step))
        return restricted_mean(curve, until).mean if until and len(curve.age) else None

    title = "lifetime, the living counted [step]"
    return Measure(RESTRICTED, title, of, AMOUNT, "mean of min(lifetime, an age that all worlds share)", ratio=True)


def _size_of(measure: Measure) -> Measure:
    def of(world: WorldRecord) -> float | None:
        value = measure.of(world)
        return None if value is None else abs(value)

    return replace(measure, name=f"{measure.name}_size", title=f"|{measure.title}|", of=of, within=AMOUNT)


_NEUTRAL = last_born_mean("neutral_1")
RESPONSES: tuple[Measure, ...] = (
    MEASURES["alive_mean"],
    MEASURES["mean_lifetime"],
    restricted_lifetime(0.0),
    MEASURES["food_per_step"],
    MEASURES["food_per_agent_step"],
    last_born_mean("w_normal"),
    last_born_mean("w_action"),
    _NEUTRAL,
    _size_of(_NEUTRAL),
    MEASURES["refused"],
    MEASURES["generation"],
    MEASURES["mean_energy"],
    MEASURES["extinct"],
)
"""The measures that studies take of a baseline world; `at_common_age` sets the age limit of the restricted lifetime."""


def at_common_age(measures: Iterable[Measure], until: float) -> list[Measure]:
    """The same measures, with restricted lifetimes taken up to the given age.

    Args:
        measures: Any measures.
        until: The age limit [step].
    """
    return [restricted_lifetime(until) if measure.name == RESTRICTED else measure for measure in measures]


def common_age(worlds: Iterable[WorldRecord]) -> float:
    """The age up to which lifetimes can be averaged in every one of these worlds [step]; 0 if there is no such age.

    A survival curve is trusted up to the age that 20 agents reached. The common age is the largest of these ages that
    requires no curve beyond its trusted age, except for survivors too few to change its mean by a
    hundredth. In an extinct world no lifetime is censored, so its curve can be read at any age.
    """
    worlds = list(worlds)
    curves = [survival_curve(*durations(w.born, w.last_step)) for w in worlds if w.extinct_step is None]
    curves_by_age = {curve.trusted_age(): curve for curve in curves if curve.trusted_age() > 0}
    if not curves_by_age:  # every world died out, or no agent died
        ages = [survival_curve(*durations(w.born, w.last_step)).trusted_age() for w in worlds]
        return max(ages, default=0.0)
    return max(
        (age for age in curves_by_age if all(_readable(c, a, age) for a, c in curves_by_age.items())), default=0.0
    )


def _readable(curve: SurvivalCurve, trusted_age: float, until: float) -> bool:
    """Whether a curve's mean up to an age can be computed without reading it beyond its trusted age."""
    if until <= trusted_age:
        return True
    surviving_share = float(curve.share[np.searchsorted(curve.age, trusted_age)])
    return surviving_share * (until - trusted_age) <= _NEGLIGIBLE * restricted_mean(curve, trusted_age).mean


def measured(world: WorldRecord, measures: Sequence[Measure]) -> dict[str, float | None]:
    """The measures of one world, by name."""
    return {measure.name: measure.value(world) for measure in measures}
