"""What the keys of `summary.json` mean: the single source of its documentation."""

_BEGIN: dict[str, str] = {
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
    "steps": "steps made by all worlds together",
}

MEAN_KEYS: dict[str, str] = {
    "agents": "agents in the record, dead and alive",
    "extinct_worlds": "number of worlds in which nobody is left",
    "mean_lifetime": "worlds' `mean_lifetime` as mean and interval [step]",
    "food_per_step": "worlds' `food_per_step` as mean and interval [1/step]",
    "food_per_agent_step": "worlds' `food_per_agent_step` as mean and interval [1/step]",
    "alive": "worlds' `alive_mean` as mean and interval",
    "mean_energy": "worlds' `mean_energy` as mean and interval",
    "generation": "worlds' `generation` as mean and interval",
    "weights": "by genome column: worlds' mean weight as mean and interval; neutral markers show drift alone",
    "pooled": "over the dead of all worlds, each agent alike: agents, mean_lifetime, food_per_step",
    "surviving": "the same means and intervals without the extinct worlds, which papers tend to replace",
}
"""The numbers of one species over all worlds."""

_END: dict[str, str] = {
    "reported": "by study, what its source reports of this preset: numbers or bounds under keys of this file, `steps` "
    "of its worlds, a `claim`, `ends`; empty unless `modified` is false",
    "damaged_parts": "files that could not be read and are missing in all numbers",
    "worlds": "list, one entry per world, see below",
}

RUN_KEYS: dict[str, str] = _BEGIN | MEAN_KEYS | _END
"""Keys of a run with one species."""

SEVERAL_KEYS: dict[str, str] = {
    **_BEGIN,
    "extinct_worlds": "number of worlds in which nobody is left, of no species",
    "total": "over all species: `agents` in the record, dead and alive, and `alive`, worlds' total `alive_mean` as "
    "mean and interval",
    "species": "by name: " + ", ".join(f"`{name}`" for name in MEAN_KEYS) + ", each of this species alone",
    **_END,
}
"""Keys of a run with several species."""

HUNT_KEYS: dict[str, str] = {
    "prey_per_step": "worlds' `prey_per_step` as mean and interval [1/step]",
    "prey_per_agent_step": "worlds' `prey_per_agent_step` as mean and interval [1/step]",
}
"""Beside `MEAN_KEYS` where agents eat agents."""

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
    "alive": "agents alive at the end",
    "alive_mean": "agents alive, mean over the last tenth of the steps; after its last agent, a world counts as empty",
    "extinct": "true if nobody is left",
    "extinct_step": "step at which nobody was left, or null",
    "births": "children born",
    "deaths": "agents that died",
    "births_failed_full": "births that failed at capacity",
    "births_failed_space": "births that failed for want of a free place",
    "mean_lifetime": "mean lifetime of the dead [step]; too small where many still live, see `alive`",
    "mean_lifetime_born": "the same without the founders [step]",
    "mean_lifetime_last": "the same over the 5000 that died last [step]",
    "food_per_step": "mean over the dead of foods eaten / lifetime [1/step]; null for who eats no food",
    "food_per_agent_step": "foods eaten by all / steps lived by all [1/step]; likewise",
    "eaten": "by food kind: foods eaten; and by species: agents eaten",
    "mean_energy": "energy of the living, mean over the last tenth of the steps; none in a world that died out",
    "generation": "mean generation of the living at the end, or when somebody lived last",
    "weights": "by genome column: mean and sd over the living at the end, or when somebody lived last",
    "ledger": "sums of energy: initial, eaten, forgiven, basic, action, capped, lost, shared, final; and "
    "residual, the largest gap in an interval, only rounding where the ledger closes; where agents eat agents also "
    "hunted, gained by that, and with obstacles damage, charged for touching them",
}
"""How one species fares in a world."""

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
    "deaths_starved": "agents that starved",
    "deaths_eaten": "agents that were eaten; where agents eat agents, as all below",
    "prey_per_step": "mean over the dead of agents eaten / lifetime [1/step]; null for a species that eats no agents",
    "prey_per_agent_step": "agents eaten by all / steps lived by all [1/step]; likewise",
}
"""Beside `FARE_KEYS` where agents die of more than age and energy."""
