"""A world for each mechanism beyond the first paper, and some that combine mechanisms."""

from reference_case.case import Case, each, kind
from reference_case.first_paper import FIRST_PAPER
from reference_case.gene import GENES
from reference_case.obstacle import OBSTACLES
from reference_case.paid import REWARDS
from reference_case.ruled import RULED
from two_stores import STORES

SPECIES = {
    "hunters": Case(
        "a species that eats another; digestion; sights in the reward; starvation",
        (
            'energy.at_zero="death"',
            *(
                "reward.pay.see_prey.coef=0.3",
                "reward.pay.see_hunter.coef=0.2",
                'reward.pay.see_hunter.channel="see_hunter_max"',
            ),
            *each("prey", "population.capacity=26", "population.initial_count=22", "birth.kappa=0.15"),
            *each("hunter", "population.capacity=14", "population.initial_count=12", "body.radius=14"),
            *each("hunter", 'diet.eats=[["prey", 0.6], ["normal", 0.5]]', "diet.digestion_steps=6"),
            *each("hunter", "sensor.mouth_spread=100", "energy.initial=5"),
            *each("hunter", "sensor.ray_count=16", "sensor.touch_sectors=18", "motor.force_scale=1.9"),
            *each(
                "hunter",
                "reward.pay.see_wall.coef=0.4",
                'reward.pay.see_wall.channel="see_prey"',
                "genome.prey.initial_mean=2",
            ),
            *each("hunter", "genome.prey.initial_sd=0.5", "reward.pay.see_prey.gene.initial_mean=0.5"),
        ),
        {"deaths_eaten": 20, "starved": 5, "digesting": 5, "paid_see_prey": 300, "paid_prey": 20, "energy_hunted": 15},
    ),
    "food chain": Case(
        "three species of a chain, of which the middle ones eat one another too; who is eaten eats nothing",
        (
            *("birth.kappa=0.1", "hazard.kappa=0.1"),
            *each("grass", "population.capacity=30", "population.initial_count=20", "body.radius=8"),
            *each("middle", "population.capacity=20", "population.initial_count=16", "sensor.mouth_spread=90"),
            *each("middle", 'diet.eats=[["grass", 0.7], ["middle", 0.4]]', "diet.digestion_steps=2"),
            *each("top", "population.capacity=12", "population.initial_count=8", "sensor.mouth_spread=120"),
            *each("top", 'diet.eats=[["middle", 0.9], ["normal", 1.0]]', "energy.capacity=6"),
        ),
        {"deaths_eaten": 30, "spared": 1, "cannibal": 3, "energy_capped": 0.5},
    ),
    "cannibals": Case(
        "one species that eats its own kind",
        (
            *each("shark", 'diet.eats=[["shark", 0.6]]', "diet.digestion_steps=3", "sensor.mouth_spread=90"),
            *each("shark", "birth.kappa=0.2", "birth.distance_sd=30"),
        ),
        {"deaths_eaten": 10, "cannibal": 10, "births": 20},
    ),
    "shared prey": Case(
        "all who claim an agent gain",
        (
            'world.prey_sharing="each"',
            *each("prey", "population.capacity=30", "population.initial_count=26", "birth.kappa=0.2"),
            *each("hunter", "population.capacity=20", "population.initial_count=18", 'diet.eats=[["prey", 0.6]]'),
            *each("hunter", "sensor.mouth_spread=120", "energy.basic_cost=0.1"),
        ),
        {"deaths_eaten": 20},
    ),
    "feast": Case(
        "all agents at a mouth are eaten, for what they had before the step; a mouth to one side",
        (
            *('world.prey_at_mouth="all"', 'world.prey_energy="before_step"', "hazard.kappa=0.1"),
            *each("prey", "population.capacity=50", "population.initial_count=40", "birth.kappa=0.2"),
            *each("hunter", "population.capacity=10", "population.initial_count=8", 'diet.eats=[["prey", 0.6]]'),
            *each("hunter", "sensor.mouth_spread=120", "sensor.mouth_center=60", "energy.basic_cost=0.1"),
            *each("hunter", "body.radius=16", "motor.force_scale=3", "birth.kappa=0.1"),
            "species.prey.body.radius=6",
        ),
        {"deaths_eaten": 20, "feasts": 2},
    ),
    "passing": Case(
        "species that pass through one another and through food, of other sizes and densities",
        (
            *each("ghost", 'body.collides=["ghost"]', 'sensor.sees=["ghost"]', "diet.eats=[]", "body.radius=12"),
            *each("ghost", "population.capacity=12", "population.initial_count=8", "hazard.kappa=0.1"),
            *each("solid", 'body.collides=["solid", "normal"]', "body.radius=7", "body.density=0.2"),
            *each("solid", "population.heading_range=1", "reward.action_coef=0.2", 'reward.action_norm="none"'),
            "world.food_radius=3",
        ),
        {"passed": 20, "births": 10},
    ),
    "smell": Case(
        "smell, by one nose and by two, as an observation and in the reward",
        (
            "sensor.smell_decay=0.05",
            *each("one", 'sensor.smells=["*"]', "reward.pay.smell_two.coef=0.5", "reward.pay.smell_normal.coef=0.3"),
            *each("one", "reward.pay.smell_two.gene.initial_mean=1", "reward.pay.smell_two.gene.initial_sd=0.5"),
            *each("two", 'sensor.smells=["normal", "one"]', "sensor.noses=2", "sensor.nose_angle=70"),
            *each("one", "sensor.smell_decay=0.15"),
            *each("two", 'sensor.scaling="unit"', "reward.pay.smell_normal.coef=0.3"),
            *("population.capacity=20", "population.initial_count=12", 'world.eaten_food="seen"'),
        ),
        {"smelled": 100, "paid_smell_two": 500, "paid_smell_normal": 500, "eaten_foods": 3},
    ),
    "wide": Case(
        "observations with more touch than one word has bits, and three stores",
        (
            *STORES,
            *("sensor.touch_sectors=20", "food.normal.gives.nutrient=0.5", "food.normal.gives.toxin=0.4"),
            *each("one", "population.capacity=14", "population.initial_count=12"),
            *each("two", "population.capacity=14", "population.initial_count=12", 'sensor.smells=["*"]'),
        ),
        {"eaten": 10},
    ),
}

INNER = {
    "stores": Case(
        "a nutrient and a toxin: costs, hazard, weak motors, births; not observed by one species",
        (
            *STORES,
            *(
                "food.fruit.gives.energy=0.2",
                "food.fruit.gives.nutrient=1.5",
                "food.fruit.growth_rate=1",
                "food.fruit.capacity=15",
            ),
            *(
                "food.fungus.gives.energy=1.5",
                "food.fungus.gives.toxin=4",
                "food.fungus.growth_rate=1",
                "food.fungus.capacity=15",
            ),
            *(
                "store.nutrient.initial=1",
                "store.nutrient.capacity=2",
                "store.nutrient.basic_cost=0.02",
                "store.nutrient.action_cost=1e-4",
            ),
            *(
                "store.nutrient.hazard_weight=0.5",
                "store.toxin.basic_cost=0.05",
                "store.toxin.motor_threshold=3",
                "energy.child_share=0.3",
            ),
            *each("open", "population.capacity=20", "population.initial_count=16", 'sensor.scaling="unit"'),
            *each("blind", "population.capacity=20", "population.initial_count=16"),
            *each(
                "blind",
                "store.nutrient.observed=false",
                "store.toxin.observed=false",
                'diet.eats=[["*", 1.0], ["fruit", 0.5]]',
            ),
            *each("pure", "population.capacity=8", "population.initial_count=6", 'diet.eats=[["normal", 2.0]]'),
        ),
        {"poisoned": 20, "sated": 1, "empty": 20},
    ),
    "gates": Case(
        "a store that food needs, one that decays and one whose end kills; energy that decays and makes slow",
        (
            "store.water={capacity=5.0, initial=2.5, basic_cost=0.05, child_share=0.5}",
            *("store.water.scale=2", "store.water.hazard_weight=0.3", "store.water.birth_weight=0.4"),
            "store.venom={capacity=9.0, initial=1.0, decay=0.05, motor_threshold=2.0, action_cost=1e-4}",
            *("food.normal.gives.water=1", "food.grain.gives={energy=2.0, water=-0.2, venom=1.5}"),
            *("food.grain.needs={water=2.0, energy=0.5}", "food.grain.growth_rate=1", "food.grain.capacity=20"),
            *("energy.decay=0.01", "energy.motor_threshold=6", "energy.hazard_weight=0.7", "energy.scale=20"),
            "energy.birth_weight=0.6",
            *each("land", "population.capacity=20", "population.initial_count=14", 'sensor.scaling="unit"'),
            *each("sea", "population.capacity=20", "population.initial_count=14", "energy.observed=false"),
            *each("sea", "store.air={capacity=6.0, initial=4.0, basic_cost=0.1, child_share=0.5}"),
            *each("sea", 'store.air.at_zero="death"', 'body.collides=["sea", "land", "normal", "grain"]'),
            "food.normal.gives.air=3",
        ),
        {"eaten": 10, "starved": 3, "refused": 5, "poisoned": 20},
    ),
    "forms": Case(
        "chances of death by age alone, or always the same; births from a threshold of energy on",
        (
            *each("aging", 'hazard.form="gompertz"', "hazard.alpha_age=5e-3", "hazard.beta_age=0.03"),
            *each("ageless", 'hazard.form="constant"', "hazard.kappa=0.02"),
            *each("patient", 'birth.form="threshold"', "birth.beta=1", "birth.logit_offset=2.5"),
            *("population.capacity=16", "population.initial_count=12", "birth.kappa=0.1"),
        ),
        {"births": 20, "deaths": 20},
    ),
    "homeostasis": Case(
        "relief alone pays: energy, nutrient and toxin come closer to set points, which are genes",
        (
            *STORES,
            *(
                "food.normal.gives.nutrient=1",
                "store.nutrient.initial=1",
                "store.nutrient.capacity=3",
                "store.nutrient.basic_cost=0.01",
            ),
            *("food.normal.gives.toxin=1", "store.toxin.basic_cost=0.1", "energy.capacity=6"),
            *("reward.drive_reduction_coef=2", "reward.meal_coef=0", "reward.action_coef=0"),
            "energy.set_point.initial_sd=0.3",
            *("store.nutrient.set_point.initial_mean=0.8", "store.toxin.set_point.initial_sd=0.2"),
            *("energy.set_point.initial_mean=0.7", "store.nutrient.set_point.initial_sd=0.3"),
            *("store.toxin.set_point.initial_mean=0.3", "genome.mutation.set_point.scale=0.1"),
        ),
        {"paid_drive_reduction": 1000, "eaten": 10},
    ),
    "exponents of the drive": Case(
        "a drive with exponents of its own, one of them a gene",
        (
            *STORES,
            *("food.normal.gives.nutrient=1", "store.nutrient.initial=1", "store.nutrient.capacity=3"),
            *("energy.capacity=6", "reward.drive_reduction_coef=2", "reward.drive_exponent=4", "reward.drive_root=3"),
            *("energy.set_point.initial_sd=0.3", "genome.set.reward.drive_exponent={initial_sd=0.2}"),
        ),
        {"paid_drive_reduction": 1000, "eaten": 10},
    ),
    "relief by energy": Case(
        "relief with energy alone, beside the other terms",
        ("reward.drive_reduction_coef=1.5", "energy.capacity=8", 'diet.eats=[["normal", 0.7]]'),
        {"paid_drive_reduction": 1000},
    ),
}

HEREDITY = {
    "pairs": Case(
        "two parents, in two of three species; who gives energy dies more easily",
        (
            *("birth.kappa=0.3", "birth.beta=2", "hazard.alpha_energy=50", "hazard.beta_energy=3"),
            *("genome.neutral_count=5", "genome.neutral.initial_sd=1", "genome.neutral.initial_mean=0.5"),
            *each("pairs", 'birth.mating="pairs"', "birth.mating_window=6", "birth.mating_range=50"),
            *each("pairs", "population.capacity=20", "population.initial_count=16", "hazard.kappa=0.2"),
            *each("couples", 'birth.mating="pairs"', "population.capacity=16", "population.initial_count=12"),
            *STORES[:3],
            *("food.normal.gives.nutrient=1", "store.nutrient.initial=2"),
            *each("alone", "birth.logit_offset=3", "population.capacity=14", "population.initial_count=8"),
        ),
        {"mated": 10, "alone": 3, "waiting": 50},
    ),
    "instinct": Case(
        "children have the network that their parent was born with",
        ('birth.network="initial"', "birth.network_noise=0.02", "learning.learning_rate=0.01"),
        {"network_initial": 20, "network_of_learned": 3},
    ),
    "lamarck": Case(
        "children have what their parent has learned; genes of a father, networks of a mother",
        (
            *('birth.network="learned"', "learning.learning_rate=0.01", 'birth.mating="pairs"', "birth.kappa=0.3"),
            *("birth.mating_range=60", "genome.learning.action_sd.initial_sd=0.3", "birth.distance_sd=60"),
        ),
        {"network_learned": 20, "network_of_learned": 3, "mated": 20},
    ),
    "laws": Case(
        "laws of mutation, of all genes and of one",
        (
            *("birth.kappa=0.2", "population.capacity=14", "population.initial_count=12", "genome.mutation_scale=0.8"),
            *each("student", 'genome.mutation_law="student_t"', "genome.mutation_df=3", "genome.weight_limit=2"),
            *each("student", 'genome.mutation.w_action.law="uniform"', 'genome.mutation.w_normal.law="normal"'),
            *each("normal_law", 'genome.mutation_law="normal"', "genome.mutation_probability=0.4"),
            *each("normal_law", 'genome.mutation.w_action.law="cauchy"', "genome.mutation.w_action.limit=1.5"),
            *each("flat", 'genome.mutation_law="uniform"', 'genome.mutation.neutral_2.law="student_t"'),
            *each("flat", "genome.mutation.neutral_2.df=1.5", "genome.mutation.neutral_2.scale=0.1"),
            *each("flat", "genome.mutation.neutral_2.probability=0.7", "genome.action.initial_mean=1"),
        ),
        {"births": 25},
    ),
    "genes of learning": Case(
        "genes that set learning, expressed at birth",
        (
            *(f"genome.learning.{name}.initial_sd=0.4" for name in ("learning_rate", "gamma", "entropy_coef")),
            *("genome.learning.action_sd.initial_mean=-0.3", "genome.learning.action_sd.initial_sd=0.3"),
        ),
        {"births": 20, "acts_ppo_bfloat16": 100},
    ),
}

POLICIES = {
    "policies": Case(
        "agents that act at random, not at all, as they are told, or by networks that never learn",
        (
            *("population.capacity=12", "population.initial_count=9", "birth.kappa=0.1"),
            *each("random", 'learning.policy="random"'),
            *each("idle", 'learning.policy="idle"'),
            *each("told", 'learning.policy="external"', "reward.action_coef=0.3"),
            *each("fixed", 'learning.policy="fixed"', 'birth.network="initial"', "birth.network_noise=0.1"),
        ),
        {"births": 20, "acts_fixed_bfloat16": 50, "network_initial": 5, "told": 200},
    ),
}

FOOD = {
    "places": Case(
        "food around several centers, in a rectangle, around one center that drifts, and apart",
        (
            *("food.normal.candidates=3", "food.normal.placement.spacing=25"),
            *kind("many", "mixture", "[[50, 50], [190, 150], [190, 50]]", "[12, 20]"),
            *kind("box", "rectangle", "[[120, 100]]", "[60, 20]", "drift=[1.5, -0.7]", "spacing=9"),
            *kind("one", "gaussian", "[[60, 140]]", "[20, 20]", "drift=[0.5, 0]"),
            *kind("turns", "switching", "[[60, 140], [150, 60]]", "[30, 20]", "drift=[-0.5, 0.2]", "switch_after=2"),
        ),
        {"eaten": 30, "switched": 2},
    ),
    "seasons": Case(
        "growth, capacity and hazard that follow time",
        (
            "food.normal.schedule.growth_rate.points=[[5, 1], [20, 2], [30, 0]]",
            *("food.normal.schedule.growth_rate.form=linear", "food.normal.schedule.growth_rate.period=40"),
            *("food.normal.schedule.capacity.points=[[10, 0.2], [50, 0.9]]", "food.normal.initial_count=25"),
            *("hazard.schedule.scale.points=[[15, 0], [45, 3]]", "hazard.schedule.scale.period=50"),
            *("hazard.alpha_energy=0.1", "hazard.beta_energy=0.5"),
        ),
        {"births": 10, "eaten": 10},
    ),
}

COMBINED = {
    "everything": Case(
        "several mechanisms at once, in species that differ in them",
        (
            *("obstacle.count=3", "obstacle.damage=0.2", "obstacle.max_side=30", "obstacle.min_side=20"),
            *("obstacle.schedule.harmful.points=[[0, 1], [50, 0.4]]", 'world.birth_order="after_deaths"'),
            *STORES,
            *(
                "food.fruit.gives.energy=0.3",
                "food.fruit.gives.nutrient=1",
                "food.fruit.growth_rate=1",
                "food.fruit.capacity=12",
            ),
            *(
                "food.fungus.gives.energy=1",
                "food.fungus.gives.toxin=3",
                "food.fungus.growth_rate=1",
                "food.fungus.capacity=12",
            ),
            *(
                "store.nutrient.initial=1",
                "store.nutrient.basic_cost=0.02",
                "store.toxin.basic_cost=0.1",
                "birth.kappa=0.15",
            ),
            *each("grazer", "reward.drive_reduction_coef=1", "reward.pay.see_hunter.coef=0.3", 'birth.mating="pairs"'),
            *each("grazer", "birth.mating_window=8", "birth.mating_range=40", "population.capacity=24"),
            *each(
                "grazer",
                'hazard.schedule.scale.form="linear"',
                "hazard.schedule.scale.points=[[10, 0.5], [60, 2]]",
                'birth.network="learned"',
            ),
            *each("hunter", 'diet.eats=[["grazer", 0.7], ["hunter", 0.3], ["fruit", 0.5]]', "body.radius=13"),
            *each("hunter", "diet.digestion_steps=3", 'sensor.smells=["grazer", "fruit"]', "sensor.noses=2"),
            *each("hunter", "reward.pay.smell_grazer.coef=0.4", 'reward.family="below"', "reward.threshold=3"),
            *each("hunter", "population.capacity=14", "population.initial_count=9", 'energy.at_zero="death"'),
            *each("drifter", 'learning.policy="random"', 'body.collides=["grazer", "hunter"]', "diet.eats=[]"),
            *each("drifter", "population.capacity=8", "population.initial_count=5", 'genome.mutation_law="normal"'),
        ),
        {
            "deaths_eaten": 6,
            "harmed": 10,
            "mated": 3,
            "paid_smell_grazer": 100,
            "paid_drive_reduction": 300,
            "starved": 1,
        },
    ),
    "released hunters": Case(
        "late inheritance in several species, all of whose mouths are fed",
        (
            *each("prey", "population.capacity=26", "population.initial_count=22", "birth.kappa=0.2"),
            *each("hunter", "population.capacity=14", "population.initial_count=12", 'diet.eats=[["prey", 0.6]]'),
            *each(
                "hunter", "reward.pay.see_prey.coef=0.2", 'genome.mutation_law="student_t"', "genome.neutral_count=0"
            ),
        ),
        {"deaths_eaten": 10, "births": 20},
        fidelity="released",
        steps=104,
    ),
}

CASES = FIRST_PAPER | SPECIES | INNER | OBSTACLES | HEREDITY | GENES | REWARDS | RULED | POLICIES | FOOD | COMBINED
