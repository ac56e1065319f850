"""Worlds with obstacles that do harm, depending on a schedule and on the body, and that rays misread."""

from reference_case.case import Case, each

OBSTACLES = {
    "pitfalls": Case(
        "obstacles that do harm, by schedule only some of them; a reward for seeing them, by the wrong rays",
        (
            *("obstacle.count=4", "obstacle.damage=0.3", "obstacle.min_side=15", "obstacle.max_side=35"),
            *("obstacle.schedule.harmful.points=[[0, 0.5], [40, 1.0], [70, 0.25]]",),
            *(
                "reward.pay.see_obstacle.coef=0.2",
                'reward.pay.see_obstacle.channel="see_normal"',
                'energy.at_zero="death"',
            ),
        ),
        {"harmed": 20, "harmless": 10, "starved": 3, "paid_see_obstacle": 100},
    ),
    "grid": Case(
        "obstacles in the cells of a grid, with corners to one side, which rays read wrongly",
        (
            *("obstacle.count=5", "obstacle.damage=0.3", "obstacle.cell=30", "obstacle.min_angle=1.5"),
            *("obstacle.max_angle=2.5", 'obstacle.sight="released"', "reward.pay.see_obstacle.coef=0.2"),
            *("obstacle.min_side=24", "obstacle.max_side=24"),
        ),
        {"harmed": 20, "paid_see_obstacle": 100},
    ),
    "blocks": Case(
        "squares, and two species of which one goes by another body",
        (
            *("obstacle.count=3", "obstacle.corners=4", "obstacle.damage=0.05", "obstacle.friction=0.1"),
            *("obstacle.restitution=0.2", "obstacle.schedule.harmful.points=[[5, 1], [20, 0]]"),
            *('obstacle.schedule.harmful.form="linear"', "obstacle.schedule.harmful.period=30"),
            *each("small", "body.radius=6", "population.capacity=20", "population.initial_count=14"),
            *each("large", "body.radius=13", "population.capacity=14", "population.initial_count=10"),
            *each("large", 'diet.eats=[["small", 0.5]]'),
        ),
        {"harmed": 20, "deaths_eaten": 5},
    ),
}
