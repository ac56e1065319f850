"""Worlds of the first paper: one species that eats food, with the settings of each fidelity."""

from reference_case.case import Case

FIRST_PAPER = {
    "baseline": Case(
        "one species, one food", ("genome.weight_limit=3", "food.normal.gene.initial_sd=0.5"), {"births_failed_full": 5}
    ),
    "crowded": Case(
        "births fail for space, energy above the capacity",
        ("birth.distance_sd=30", "birth.attempts=2", "food.normal.growth_rate=9", "energy.capacity=3.5"),
        {"energy_capped": 0.1, "births_failed_space": 5},
    ),
    "costly births": Case(
        "who gives energy to a child dies more easily in the same step",
        ("energy.child_share=0.8", "hazard.alpha_energy=50", "hazard.beta_energy=3", "birth.kappa=0.15"),
        {"births": 20, "deaths": 20},
    ),
    "relocation": Case(
        "food in one place after another",
        (
            *("food.normal.placement.switch_after=3", "food.normal.placement.sd=[40, 40]"),
            "food.normal.placement.centers=[[60, 60], [180, 60], [180, 140]]",
        ),
        {"switched": 2},
        preset="relocation",
    ),
    "poor": Case(
        "two foods; starvation kills",
        ('energy.at_zero="death"', 'food."*".growth_rate=1.3', "arena.corner_radius=0"),
        {"energy_forgiven": 0.2, "starved": 5},
        preset="poor",
    ),
    "released": Case(
        "the fidelity released",
        ("food.poison.initial_count=20", "food.poison.capacity=30", "food.poison.growth_rate=0.9"),
        {"energy_forgiven": 5, "births": 20},
        preset="poison",
        fidelity="released",
        steps=104,
    ),
    "one by one": Case(
        "some settings of released alone",
        (
            *('world.mutation_noise="tabulated"', 'world.parents="resident_slots"', 'world.birth_order="after_deaths"'),
            *('world.mouths="all"', 'world.eaten_food="seen"', 'learning.acting_weights="float32"'),
        ),
        {"births_failed_full": 5, "acts_ppo_float32": 100, "eaten_foods": 5},
        steps=104,
    ),
    "text": Case(
        "the fidelity as_printed; mouths on all sides",
        ("genome.neutral_count=3", "sensor.mouth_spread=180", "birth.distance_sd=0.2"),
        {"eaten": 20},
        fidelity="as_printed",
    ),
    "inner walls": Case(
        "inner walls; observations scaled to about 1",
        (
            "arena.inner_walls=[[120, 40, 180, 160], [60, 50, 60, 120]]",
            'sensor.scaling="unit"',
            "arena.corner_chords=2",
        ),
    ),
}
