"""The meaning of the keys of `summary.json`: the single source of its documentation."""

from hedon.measure.catalogue import MEASURES

MANIFEST_KEYS: dict[str, str] = {
    "name": "what the config is called: the preset, or its file without the ending; or null",
    "preset": "name of the preset, or null",
    "fidelity": "corrected, released or as_printed, or null",
    "modified": "whether any setting differs from the preset with the fidelity; null where the manifest does not say",
    "hedon_version": "version that made the run",
    "backend": "what computed: an instruction set, or a device",
    "status": "running, finished, interrupted or failed",
    "config_digest": "digest of the resolved config",
    "food_kinds": "names, in the order of the config",
    "seeds": "one per world",
    "steps_asked": "steps that each world was to make",
}
"""Keys whose values are copied from the manifest."""

_BEGIN: dict[str, str] = {**MANIFEST_KEYS, "steps": "steps made by all worlds together"}


def _averaged(*, everywhere: bool) -> dict[str, str]:
    """Keys of the means over worlds: of the measures that all worlds have, or of the other measures."""
    averaged = [
        measure.name for measure in MEASURES.values() if measure.averaged and (measure.condition is None) == everywhere
    ]
    return {name: f"worlds' `{name}`, mean and interval" for name in averaged}


MEAN_KEYS: dict[str, str] = {
    "agents": "agents in the record, dead and alive",
    "extinct_worlds": "number of worlds in which nobody is left",
    **_averaged(everywhere=True),
    "weights": "by genome column: worlds' mean weight as mean and interval; neutral genes show drift alone",
    "pooled": "over the dead of all worlds, each agent alike: agents, mean_lifetime, food_per_step",
    "surviving": "the same means and intervals without the extinct worlds, which papers tend to replace",
}
"""The numbers of one species over all worlds."""

_END: dict[str, str] = {
    "reported": "by study, what its source reports of this preset: numbers or bounds under keys of this file, `steps` "
    "of its worlds, a `claim`, `ends`; empty unless `modified` is false",
    "measures": "by name: titles of the measures that the config adds; each is also a key of every world, and its mean "
    "over worlds one of the run, or of the species",
    "damaged_parts": "files that could not be read and are missing in all numbers",
    "worlds": "list, one entry per world, see below",
}

RUN_KEYS: dict[str, str] = _BEGIN | MEAN_KEYS | _END
"""Keys of a run with one species."""

SEVERAL_KEYS: dict[str, str] = {
    **_BEGIN,
    "extinct_worlds": "number of worlds in which nobody is left, of no species",
    "total": "over all species: `agents` in the record, dead and alive, and `alive_mean`, worlds' total `alive_mean` "
    "as mean and interval",
    "species": "by name: " + ", ".join(f"`{name}`" for name in MEAN_KEYS) + ", each of this species alone",
    **_END,
}
"""Keys of a run with several species."""

HUNT_KEYS: dict[str, str] = _averaged(everywhere=False)
"""Keys in addition to `MEAN_KEYS` if agents eat agents."""

INTERVAL_KEYS: dict[str, str] = {
    "mean": "over the worlds that have a value, or null",
    "low": "bound of the 95 % interval, Student's t over worlds; null with fewer than two worlds",
    "high": "upper bound",
    "worlds": "number of worlds that have a value",
}

_WORLD: dict[str, str] = {
    "seed": "of the world",
    "steps": "steps made",
    "steps_per_second": "steps of this world per second, all worlds sharing the machine; or null",
}

FARE_KEYS: dict[str, str] = {
    **{measure.name: measure.documentation for measure in MEASURES.values() if measure.condition is None},
    "eaten": "by food kind: foods eaten; and by species: agents eaten",
    "weights": "by genome column: mean and sd over the living at the end, or when somebody lived last",
    "ledger": "sums of energy: initial, eaten, forgiven, basic, action, capped, lost, shared, final; and "
    "residual, the largest gap in an interval, only rounding where the ledger closes; where agents eat agents also "
    "hunted, gained by that, and with obstacles damage, charged for touching them",
}
"""The numbers of one species in a world."""

WORLD_KEYS: dict[str, str] = _WORLD | FARE_KEYS
"""Keys of a world with one species."""

WORLD_SEVERAL_KEYS: dict[str, str] = {
    **_WORLD,
    "extinct": "true if nobody is left, of no species",
    "extinct_step": "step at which nobody was left, or null",
    "total": "over all species: `alive`, `alive_mean`, `births`, `deaths`, `births_failed_full`, "
    "`births_failed_space`, `eaten`",
    "species": "by name: " + ", ".join(f"`{name}`" for name in FARE_KEYS) + ", each of this species alone",
}
"""Keys of a world with several species."""

CAUSE_KEYS: dict[str, str] = {
    measure.name: measure.documentation for measure in MEASURES.values() if measure.condition is not None
}
"""Keys in addition to `FARE_KEYS` if agents die of more than age and energy."""

RESERVED = frozenset().union(
    RUN_KEYS, SEVERAL_KEYS, HUNT_KEYS, WORLD_KEYS, WORLD_SEVERAL_KEYS, CAUSE_KEYS, ("condition", "digest", "repetition")
)
"""Names that a measure of a config cannot have, since they are already keys or columns."""
