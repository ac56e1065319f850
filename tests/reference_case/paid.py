"""Worlds that cover what agents are paid for and how, and what they observe of themselves."""

from reference_case.case import Case, each


def pay(name: str, coef: float, channel: str = "", mean: float = 0.5) -> tuple[str, ...]:
    """A term for a channel."""
    term = f"reward.pay.{name}"
    named = (f"{term}.channel={channel}",) if channel else ()
    return (*named, f"{term}.coef={coef}", f"{term}.gene.initial_mean={mean}", f"{term}.gene.initial_sd=0.3")


FAMILIES = {
    "families": Case(
        "families of rewards: sinh, scaled, hungry and fed, two with genes of their thresholds",
        (
            *("population.capacity=12", "population.initial_count=10", "reward.action_coef=0.5"),
            *each(
                "curved",
                'reward.family="sinh"',
                "reward.pay.see_normal.coef=0.1",
                "reward.pay.see_normal.gene.initial_sd=1",
            ),
            *each("power", 'reward.family="scaled"', "genome.second.initial_sd=0.5", "genome.second.initial_mean=0.2"),
            *each("hungry", 'reward.family="below"', "reward.threshold=2", "reward.threshold_width=1"),
            *each("hungry", "genome.family.threshold.initial_sd=0.3", "genome.family.threshold_width.initial_mean=0.2"),
            *each("fed", 'reward.family="above"', "reward.threshold=3", "genome.family.threshold_width.initial_sd=0.4"),
            *each("fed", "reward.threshold_width=0.5", "genome.family.threshold.initial_mean=-0.2"),
        ),
        {"births": 12, "eaten": 10},
    ),
    "by age": Case(
        "weights that change with age; gains by meals count double",
        (
            *(
                'reward.family="between"',
                'reward.gate="age"',
                "reward.threshold=20",
                "reward.threshold_width=5",
                "reward.meal_coef=2",
            ),
            *("genome.second.initial_sd=1", "genome.action.initial_sd=1", "reward.action_coef=0.4"),
        ),
        {"births": 20, "eaten": 10},
    ),
}

CHANNELS = {
    "paid channels": Case(
        "terms for what happens to an agent, for what it senses, and for what it is",
        (
            *("obstacle.count=4", "obstacle.damage=0.3", "obstacle.min_side=15", "obstacle.max_side=35"),
            *(*pay("moved", 0.2), *pay("gain", 0.5, "energy_change"), *pay("harm", -1, "damage"), *pay("one", 0.1)),
            *(*pay("touched", 0.1), *pay("wall", -0.2, "contacts_wall"), *pay("child", 2, "births"), *pay("x", 1e-3)),
            *(*pay("age", 1e-3), *pay("alive", 1e-2), *pay("force", 1e-4), *pay("near", 0.3, "see_normal_max")),
            *(
                *pay("spin", 0.5, "angular_velocity"),
                *pay("east", 0.1, "velocity_x"),
                *pay("to", 0.1, "heading_cosine"),
            ),
        ),
        {"paid_moved": 500, "paid_harm": 20, "paid_wall": 50, "paid_touched": 100, "paid_child": 10, "paid_near": 100},
    ),
    "reward gates": Case(
        "weights that change with what an agent touches, with its children, and while it waits for a mate",
        (
            *("population.capacity=20", "population.initial_count=14", "birth.kappa=0.2", "reward.action_coef=0.4"),
            *("genome.second.initial_sd=1", "genome.action.initial_sd=1", "reward.threshold_width=0.3"),
            *each("feeling", 'reward.family="below"', 'reward.gate="touched"', "reward.threshold=0.5"),
            *each("parent", 'reward.family="between"', 'reward.gate="births"', "reward.threshold=0.5"),
            *each("mate", 'reward.family="above"', 'reward.gate="waits"', "reward.threshold=0.5"),
            *each(
                "mate", 'birth.mating="pairs"', "birth.mating_window=25", "birth.mating_range=60", *pay("waits", 0.3)
            ),
            *each("mate", "birth.kappa=0.4", *pay("births", 1)),
            *each("social", 'reward.family="around"', 'reward.gate="own_count"', "reward.threshold=2"),
            *each("social", 'neighbor.own.of=["social"]', "neighbor.own.range=60", *pay("shared", 0.5, "own_meals")),
            *each("social", 'neighbor.any.of=["normal", "*"]', "neighbor.any.range=30", *pay("any_count", 0.1)),
            *each("social", "sensor.observes.any_bearing=2", "sensor.observes.any_distance=20", *pay("own_kin", 0.1)),
            *each("social", "sensor.observes.own_meals=1"),
        ),
        {
            "births": 20,
            "mated": 5,
            "paid_waits": 20,
            "paid_births": 5,
            "paid_shared": 10,
            "paid_any_count": 300,
            "paid_own_kin": 10,
        },
    ),
    "observers": Case(
        "agents that know their age, the season, and what the step before brought them",
        (
            *("birth.kappa=0.1", "population.capacity=20", "population.initial_count=14"),
            *("food.normal.schedule.capacity.points=[[0, 1], [10, 0.5]]", "food.normal.schedule.capacity.period=25"),
            *each("wise", "sensor.observes.age=50", "sensor.observes.season_sine=1", "sensor.observes.season_cosine=2"),
            *each("wise", "sensor.observes.moved=0.5", "sensor.observes.energy_change=0.3", "sensor.observes.births=1"),
            *each("wise", "sensor.observes.eaten_normal=1", "sensor.observes.see_wall=0.5", "sensor.observes.alive=10"),
            *each("other", 'sensor.scaling="unit"', "sensor.velocity_scale=4", "sensor.angular_velocity_scale=0.5"),
            *each("other", "sensor.observes.season_sine=1", "sensor.season_period=17", "sensor.observes.effort=0.5"),
        ),
        {"births": 20, "eaten": 10},
    ),
}

REWARDS = FAMILIES | CHANNELS
