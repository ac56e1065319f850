"""Worlds whose agents have individual numbers that genes set."""

from reference_case.case import Case, each

from hedon.config.expression import gene_column

WATER = "store.water={capacity=2, initial=1, basic_cost=0.01, action_cost=1e-5, decay=0.01, child_share=0.3}"
COSTS = ("basic_cost", "action_cost", "capacity", "child_share", "hazard_weight")
LIVES = ("hazard.kappa", "hazard.alpha_energy", "hazard.beta_energy", "hazard.alpha_age", "hazard.beta_age")
BIRTHS = ("birth.kappa", "birth.beta", "birth.logit_offset", "birth.distance_sd", "birth.mating_range")


def genes(*paths: str, limit: float = 0.3) -> tuple[str, ...]:
    """A gene for each number, with founders that differ."""
    laws = (f"genome.set.{path}.initial_sd=0.15" for path in paths)
    return (*laws, *(f"genome.mutation.{gene_column(path)}.limit={limit}" for path in paths))


GENES = {
    "own senses and costs": Case(
        "genes that set what agents sense, weigh, pay and hold",
        (
            *("birth.kappa=0.2", WATER, "food.normal.gives.water=0.4", "energy.decay=1e-3"),
            *('sensor.smells=["*"]', "sensor.noses=2", "sensor.mouth_spread=80", "energy.motor_threshold=0.5"),
            *genes(*(f"energy.{name}" for name in (*COSTS, "decay", "motor_threshold"))),
            *genes(
                *(f"store.water.{name}" for name in ("basic_cost", "action_cost", "capacity", "decay", "child_share"))
            ),
            *genes("sensor.ray_length", "sensor.ray_spread", "sensor.mouth_spread"),
            *genes("sensor.smell_decay", "sensor.nose_angle", "motor.force_scale", "motor.angle"),
            'birth.network="learned"',
            *genes("birth.network_noise"),
            "genome.set.motor.angle.initial_mean=0.05",
        ),
        {"births": 20, "eaten": 20, "smelled": 100},
    ),
    "own lives": Case(
        "genes that set chances of death and birth, of pairs, and bodies of other sizes that need room",
        (
            *("birth.kappa=0.3", "birth.logit_offset=0.3", "population.capacity=24"),
            *each("pairs", 'birth.mating="pairs"', "birth.mating_range=40", "birth.distance_sd=35"),
            *each("pairs", *genes(*LIVES, *BIRTHS, "body.radius", "body.density", limit=0.2)),
            *each("pairs", "population.initial_count=20", "genome.mutation.g_body_radius.law=normal"),
            *each("plain", "body.radius=7", "population.initial_count=8"),
        ),
        {"births": 20, "mated": 10, "births_failed_space": 3},
    ),
    "own numbers, late": Case(
        "genes that set numbers where newborns inherit when the window ends: until then they have those of their slots",
        (
            "birth.kappa=0.2",
            *genes(
                "energy.basic_cost", "energy.child_share", "sensor.mouth_spread", "hazard.kappa", "motor.force_scale"
            ),
        ),
        {"births": 20},
        fidelity="released",
        steps=104,
    ),
}
