"""What the keys of `summary.json` mean: the single source of its documentation."""

RUN_KEYS: dict[str, str] = {
    "name": "what the config is called: the preset, or its file without the ending; or null",
    "preset": "name of the preset, or null",
    "fidelity": "corrected, released or text, or null",
    "modified": "whether any setting differs from the preset with the fidelity; null where the manifest does not say",
    "hedon_version": "version that made the run",
    "kernel": "instruction set that the engine used",
    "status": "running, finished, interrupted or failed",
    "config_digest": "digest of the resolved config",
    "food_kinds": "names, in the order of the config",
    "seeds": "one per world",
    "steps_asked": "steps that each world was to make",
    "steps": "steps made by all worlds together",
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
    "surviving": "the same means and intervals without the extinct worlds, which the paper replaced",
    "paper": "of this preset: mean_lifetime, food_per_step, population, generation, claim; null unless `modified` is "
    "false",
    "damaged_parts": "files that could not be read and are missing in all numbers",
    "worlds": "list, one entry per world, see below",
}

INTERVAL_KEYS: dict[str, str] = {
    "mean": "over the worlds that have a value, or null",
    "low": "bound of the 95 % interval, Student's t over worlds; null with fewer than two worlds",
    "high": "upper bound",
    "worlds": "number of worlds that have a value",
}

WORLD_KEYS: dict[str, str] = {
    "seed": "of the world",
    "steps": "steps made",
    "steps_per_second": "steps of this world per second, all worlds sharing the machine; or null",
    "alive": "agents alive at the end",
    "alive_mean": "agents alive, mean over the last tenth of the steps made",
    "extinct": "true if nobody is left",
    "extinct_step": "step at which nobody was left, or null",
    "births": "children born",
    "deaths": "agents that died",
    "births_failed_full": "births that failed at capacity",
    "births_failed_space": "births that failed for want of a free place",
    "mean_lifetime": "mean lifetime of the dead [step]; too small where many still live, see `alive`",
    "mean_lifetime_born": "the same without the founders [step]",
    "mean_lifetime_last": "the same over the 5000 that died last [step]",
    "food_per_step": "mean over the dead of foods eaten / lifetime [1/step]: the paper's rule",
    "food_per_agent_step": "foods eaten by all / steps lived by all [1/step]",
    "eaten": "by food kind: foods eaten",
    "mean_energy": "energy of the living, mean over the last tenth of the steps made",
    "generation": "mean generation of the living at the end, or when somebody lived last",
    "weights": "by genome column: mean and sd over the 5000 agents born last, dead or alive",
    "ledger": "sums of energy: initial, eaten, forgiven, basic, action, capped, lost, shared, final; and "
    "residual, the largest gap in an interval, only rounding where the ledger closes",
}
