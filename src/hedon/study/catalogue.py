"""Finds installed studies, and selects those named on a command line.

Any installed package may provide studies with entry points of the group `hedon.studies`, as hedon itself does.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cache
from importlib.metadata import EntryPoint, entry_points
from typing import Any

from hedon.config.problem import did_you_mean
from hedon.error import HedonError
from hedon.study.study import Study

GROUP = "hedon.studies"
"""Group of the entry points, each of which loads the `Study` of the same name."""
ALL = "all"
"""Stands for every study."""


class StudyError(HedonError):
    """No study or item has this name, it cannot be loaded, or it fails."""


@cache
def installed() -> tuple[Mapping[str, Study], Mapping[str, str]]:
    """The studies of all installed packages, by name, and the errors of those that cannot be loaded, by name."""
    studies, faults = dict[str, Study](), dict[str, str]()
    for point in sorted(entry_points(group=GROUP), key=_order):
        package = point.dist.name if point.dist else "an unknown package"
        origin = f"the study {point.name!r} of {package} ({point.value})"
        try:
            study = point.load()
        except Exception as error:  # other packages may raise anything on import
            faults[point.name] = f"{origin} cannot be loaded: {type(error).__name__}: {error}"
            continue
        if not isinstance(study, Study) or study.name != point.name:
            faults[point.name] = f"{origin} is no hedon.study.Study of this name"
        elif point.name in studies:
            faults[f"{package}:{point.name}"] = f"{origin} has a name that is taken: it is left out"
        else:
            studies[point.name] = study
    return studies, faults


def _order(point: EntryPoint) -> tuple[bool, str]:
    """A sort key that puts hedon's own studies first."""
    return (point.dist is None or point.dist.name != "hedon", point.name)


def choose(names: Sequence[str]) -> tuple[Study, ...]:
    """The studies with some names, each reduced to its named items. A name refers to a study, an item, or `ALL`.

    If several studies have an item of the same name, it must be given as STUDY/ITEM.

    Raises:
        StudyError: No study or item has one of the names, or several have it.
    """
    studies, faults = installed()
    chosen_items: dict[str, set[str]] = {}
    for name in studies if ALL in names else names:
        for study, items in _find(name, studies, faults).items():
            chosen_items.setdefault(study, set()).update(items)
    return tuple(
        replace(study, items=tuple(item for item in study.items if item.name in chosen_items[name]))
        for name, study in studies.items()
        if name in chosen_items
    )


def _find(name: str, studies: Mapping[str, Study], faults: Mapping[str, str]) -> dict[str, list[str]]:
    """Names of items, by study."""
    if name in studies:
        return {name: [item.name for item in studies[name].items]}
    if name in faults:
        raise StudyError(faults[name])
    holders = {
        holder: [item.name]
        for holder, study in studies.items()
        for item in study.items
        if name in (item.name, f"{holder}/{item.name}")
    }
    if len(holders) > 1:
        raise StudyError(
            f"several studies have an item {name!r}: say {' or '.join(f'{holder}/{name}' for holder in holders)}"
        )
    if not holders:
        items = [item.name for study in studies.values() for item in study.items]
        hint = did_you_mean(name, [*studies, *items])
        raise StudyError(
            f"there is no study or item {name!r}{hint}\nStudies: {', '.join(studies)}\nItems: {', '.join(items)}"
        )
    return holders


def reported_figures(preset: str | None) -> dict[str, Mapping[str, Any]]:
    """The results that the sources of installed studies report for a preset, by study; see `Study.reported`."""
    reported = {name: study.reported.get(preset or "") for name, study in installed()[0].items()}
    return {name: results for name, results in reported.items() if results is not None}
