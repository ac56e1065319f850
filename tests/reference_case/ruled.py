"""Worlds whose rules are functions in Python."""

from pathlib import Path

from reference_case.case import Case, each

RULES = Path(__file__).parents[1] / "rule_example.py"

RULED = {
    "rules": Case(
        "functions in Python that pay, kill and let breed",
        (
            *(f'reward.rule="{RULES}:curious"', f'hazard.rule="{RULES}:swamp"', f'birth.rule="{RULES}:crowded"'),
            *("reward.memory=2", "hazard.kappa=0.05", "population.capacity=34", "birth.kappa=0.1"),
        ),
        {"births": 5, "deaths": 5},
    ),
    "rules and neighbors": Case(
        "functions in Python that ask who is near, and read genes of their own; kin by two parents",
        (
            *("birth.kappa=0.2", "hazard.kappa=0.1", "birth.distance_sd=30"),
            *each("social", f'reward.rule="{RULES}:kind"', f'hazard.rule="{RULES}:lonely"', 'birth.mating="pairs"'),
            *each("social", "genome.extra.kindness.initial_mean=0.5", "genome.extra.patience.initial_sd=1"),
            *each("social", "genome.mutation.extra_patience.law=normal", "birth.mating_range=60"),
            *each("social", 'neighbor.near.of=["social"]', "neighbor.near.range=60"),
            *each("social", 'neighbor.guard.of=["guard"]', "neighbor.guard.range=40", "population.capacity=30"),
            *each("guard", f'birth.rule="{RULES}:apart"', "neighbor.all.range=35", "population.initial_count=10"),
            *each("guard", "body.radius=12", "birth.beta=0.2"),
        ),
        {"mated": 5, "kin": 100},
    ),
}
