"""Genes that set numbers of a species: an agent with a gene is like one whose species has the number itself."""

import math
from dataclasses import replace

import numpy as np
import pytest
from resumed_run import SMALL, small_run
from worlds import QUICK, make_simulation

from hedon import EngineError, load_config
from hedon.config import ConfigError
from hedon.config.expression import expressed, gene_column, settable
from hedon.config.layout import layouts
from hedon.demography.forecast import forecast, setting_warnings
from hedon.experiment.simulation import Simulation
from hedon.record.founder import make_founders
from hedon.record.reader import open_run
from hedon.record.snapshot import load_snapshot
from hedon.view.layout import describe

WORLD = (
    *QUICK,
    *("world.rollout_steps=32", "arena.width=260", "arena.height=240", "food.normal.growth_rate=2"),
    *(
        "food.normal.capacity=40",
        "food.normal.initial_count=25",
        "food.normal.gives.water=0.5",
        "food.normal.gives.energy=3",
    ),
    *("population.capacity=24", "population.initial_count=12", "motor.max_force=300"),
    *(
        "energy.initial=3",
        "energy.capacity=3",
        "energy.basic_cost=0.02",
        "energy.action_cost=1e-4",
        "energy.decay=1e-3",
    ),
    *(
        "energy.motor_threshold=0.5",
        "hazard.kappa=0.08",
        "hazard.alpha_age=3e-3",
        "hazard.beta_age=0.02",
        "hazard.alpha_energy=0.5",
        "hazard.beta_energy=0.6",
    ),
    *("birth.kappa=0.3", "birth.beta=0.3", "birth.logit_offset=0.5", 'birth.mating="pairs"', "birth.mating_range=40"),
    *(
        "birth.distance_sd=40",
        'birth.network="learned"',
        "sensor.noses=2",
        'sensor.smells=["*"]',
        "sensor.nose_angle=40",
    ),
    *(
        "sensor.mouth_spread=80",
        "sensor.mouth_center=20",
        "sensor.observes={moved=3}",
        "sensor.ray_length=70",
        "genome.mutation_scale=0",
        "genome.neutral_count=0",
    ),
    *("store.water={capacity=1, initial=1, basic_cost=0.01, action_cost=1e-5, decay=0.01}",),
    *("store.water.child_share=0.3", "store.water.hazard_weight=0.5", "store.water.motor_threshold=0.3"),
    *("store.water.birth_weight=3", "reward.drive_reduction_coef=3"),
    *("species.plain.body.radius=9", "species.own.body.radius=8"),
)
PATHS = [
    path.replace("<kind>", "water") if name == "water" else path.replace("store.<kind>", "energy")
    for path in settable()
    for name in (("energy", "water") if "<kind>" in path else ("",))
]
STEPS = 100


def with_gene(path: str, gene: float, *more: str) -> Simulation:
    """A world whose second species has a gene that all its agents share."""
    law = f"species.own.genome.set.{path}={{initial_mean={gene}, initial_sd=0}}"
    limit = f"species.own.genome.mutation.{gene_column(path)}.limit={max(abs(gene), 0.01)}"
    return make_simulation(*WORLD, *more, law, limit, seeds=(4,))


def motion(simulation: Simulation) -> list[np.ndarray]:
    """The past and present of the living agents, except their genomes."""
    world = simulation.worlds[0]
    agents = world.agents()
    names = ("agent_id", "x", "y", "angle", "energy", "water", "reward", "parent_id", "children", "distance")
    return [agents[name] for name in names if name in agents]


def alike(one: list[np.ndarray], other: list[np.ndarray]) -> bool:
    return all(np.array_equal(a, b) for a, b in zip(one, other, strict=True))


@pytest.fixture(scope="module")
def plain() -> list[np.ndarray]:
    simulation = make_simulation(*WORLD, seeds=(4,))
    simulation.run(STEPS)
    assert simulation.worlds[0].counters["births"] > 15
    assert simulation.worlds[0].counters["deaths"] > 15
    return motion(simulation)


@pytest.mark.parametrize("path", PATHS)
def test_a_gene_changes_a_number_as_the_setting_would(path, plain):
    gene = float(np.float32({"energy.motor_threshold": -0.15, "sensor.mouth_spread": -0.4}.get(path, 0.12)))
    first = with_gene(path, gene)
    value = expressed(load_config("baseline", overrides=WORLD).species["own"], path, gene)
    second = make_simulation(*WORLD, f"species.own.{path}={value!r}", seeds=(4,))
    for simulation in (first, second):
        simulation.run(STEPS)
    assert alike(motion(first), motion(second))
    assert not alike(motion(first), plain)


@pytest.mark.parametrize(("path", "limit"), [("sensor.mouth_spread", 180.0), ("energy.child_share", 1.0)])
def test_a_number_stays_within_the_limits_of_its_setting(path, limit):
    first = with_gene(path, 2.0)
    second = make_simulation(*WORLD, f"species.own.{path}={limit}", seeds=(4,))
    for simulation in (first, second):
        simulation.run(STEPS)
    assert alike(motion(first), motion(second))


EVERY = (
    *(f"genome.set.{path}.initial_sd=0.1" for path in PATHS if not path.startswith("body.")),
    *("genome.set.body.radius.initial_sd=0.05", "genome.set.body.density.initial_sd=0.1"),
)
MANY = (*WORLD, "genome.mutation_scale=0.1", "genome.weight_limit=0.5", *EVERY)


def test_threads_slots_and_checkpoints_change_nothing():
    once = make_simulation(*MANY, seeds=(4,))
    once.run(STEPS)
    first, second = (make_simulation(*MANY, seeds=(4,), threads=threads) for threads in (2, 1))
    first.run(STEPS)
    second.run(45)
    second.engine.restore(0, second.engine.save(0))
    second.run(STEPS - 45)
    assert once.worlds[0].counters["births"] > 15
    assert {first.worlds[0].digest(), second.worlds[0].digest()} == {once.worlds[0].digest()}


@pytest.mark.parametrize(
    "settings", [(), ('world.inheritance="at_window_end"', "birth.network=none", "birth.mating=none")]
)
def test_slots_that_were_used_before_change_nothing(settings):
    """A newborn keeps nothing of the previous agent in its slot, except what late inheritance leaves it."""
    from hedon import _engine
    from hedon.config.engine import engine_input

    some = [
        each
        for each in MANY
        if settings == () or not any(name in each for name in ("set.body", "mating_range", "noise"))
    ]
    digests = set()
    for order in ([], list(range(47, -1, -1))):
        given = engine_input(load_config("baseline", overrides=[*some, *settings]))
        engine = _engine.Simulation(given.settings, given.walls, given.outer_walls, [4], 1, "", order, True)
        engine.run(STEPS)
        digests.add(engine.digest(0))
    assert len(digests) == 1


def test_founders_of_a_table_have_room_for_their_bodies():
    law = ("species.own.genome.set.body.radius={}", "species.own.genome.mutation.g_body_radius.limit=0.5")
    config = load_config("baseline", overrides=[*WORLD, *law])
    simulation = Simulation(config, [4], 1)
    simulation.set_founders(make_founders(["g_body_radius"], np.array([[0.25]]), ["large"], {"large": 1.0}))
    agents = simulation.worlds[0].agents()
    radius = np.where(agents["species"] == 1, 8.0 * 10**0.25, 9.0)
    apart = np.hypot(*(np.subtract.outer(agents[axis], agents[axis]) for axis in "xy"))
    assert (apart + 1e9 * np.eye(len(radius)) >= np.add.outer(radius, radius) - 1e-3).all()
    simulation.run(STEPS)


def test_genes_beyond_the_limits_of_a_branch_count_as_the_limits():
    """A branch may lower a limit, so its world may start with genes beyond it."""
    wide = with_gene("body.radius", 0.3)
    wide.run(10)
    state = wide.engine.save(0)
    narrow = with_gene("body.radius", 0.1)
    narrow.engine.restore(0, state)
    narrow.run(STEPS)
    assert narrow.worlds[0].agents()["genome"].max() <= wide.worlds[0].agents()["genome"].max()


def test_a_checkpoint_with_invalid_genes_is_refused():
    simulation = with_gene("body.radius", 0.1)
    state = dict(simulation.engine.save(0))
    state["genome"] = np.full_like(state["genome"], np.nan)
    with pytest.raises((ValueError, EngineError), match="genome"):
        simulation.engine.restore(0, state)


def test_forecasts_assume_founders_with_mean_genes():
    gene = "genome.set.energy.basic_cost={initial_mean=0.5}"
    own = load_config("baseline", overrides=[gene])
    cost = load_config("baseline").species["agent"].energy.basic_cost
    same = load_config("baseline", overrides=[f"energy.basic_cost={cost * 10**0.5!r}"])
    told, plain = forecast(own), forecast(same)
    assert told.need == pytest.approx(plain.need, rel=1e-6)
    assert [level.r0 for level in told.levels] == pytest.approx([level.r0 for level in plain.levels])
    assert "Genes set energy.basic_cost" in told.warnings[0]
    assert setting_warnings(own) == told.warnings


def test_records_pictures_and_pages_show_what_genes_set(tmp_path):
    genes = ("genome.set.body.radius.initial_sd=0.1", "genome.mutation.g_body_radius.limit=0.3")
    settings = (*genes, "genome.set.sensor.ray_length.initial_sd=0.2")
    small_run(tmp_path / "run", 96, seeds=(1,), overrides=settings)
    run = open_run(tmp_path / "run")
    assert {"g_body_radius", "g_sensor_ray_length"} <= set(run.reward_names)
    snapshot = load_snapshot(tmp_path / "run")
    assert snapshot is not None
    living = run.agents().filter(run.agents()["death_step"].is_null()).sort("agent_id")
    factor = 10.0 ** living["g_body_radius"].to_numpy()
    np.testing.assert_allclose(snapshot.of_agents("radius"), 10.0 * factor, rtol=1e-5)
    assert snapshot.of_agents("mouth_spread").tolist() == [60.0] * len(living)
    config = load_config("baseline", overrides=[*SMALL, *settings])
    species, layout = describe(config)["species"][0], layouts(config)["agent"]
    assert species["sets"] == [
        {"place": "body.radius", "gene": 2, "low": 2.0**-126, "high": 1000.0},
        {"place": "sensor.ray_length", "gene": 3, "low": 2.0**-126, "high": 100_000.0},
    ]
    assert [gene.role for gene in layout.genes[:4]] == ["reward", "reward", "setting", "setting"]


@pytest.mark.parametrize(
    ("settings", "says"),
    [
        (
            ["genome.set.sensor.ray_len={}"],
            r"genome\.set\.sensor\.ray_len: no gene can set this: .*did you mean sensor\.ray",
        ),
        (["genome.set.sensor.ray_count={}"], r"no gene can set this: there are body\.radius, body\.density"),
        (["genome.set.learning.gamma={}"], r"genome\.set\.learning\.gamma: no gene can set this: genome\.learning has"),
        (["genome.set.energy.initial={}"], r"founders have it before they have genes"),
        (["genome.set.energy.decay={}"], r"a gene multiplies .*energy\.decay, so that must not be 0"),
        (
            ["genome.set.birth.mating_range={}"],
            r'would have no effect, since nobody mates: give birth\.mating = "pairs"',
        ),
        (["genome.set.sensor.smell_decay={}"], r"since it smells nothing: give sensor\.smells"),
        (["genome.set.sensor.ray_length=1"], r"genome\.set\.sensor\.ray_length = 1: must be a table"),
        (["genome.set.sensor.ray_length.initial_mea=1"], r"initial_mea: unknown name; did you mean initial_mean"),
        (["genome.set.sensor.ray_length.initial_mean=3"], r"initial_mean = 3\.0: must be within ± 2"),
        (
            ["genome.set.body.radius={}"],
            r"does not fit into the arena: give genome\.mutation\.g_body_radius a limit below 1\.26",
        ),
        (
            ["genome.set.body.density={}", 'world.inheritance="at_window_end"'],
            r"bodies cannot change in a window: needs world\.inheritance",
        ),
    ],
)
def test_a_wrong_setting_is_named(settings, says):
    with pytest.raises(ConfigError, match=says):
        load_config("baseline", overrides=settings)


def test_quotes_and_nested_tables_name_the_same_gene():
    nested = load_config("baseline", overrides=["genome.set.sensor.ray_length={initial_sd=0.3}"])
    quoted = load_config("baseline", overrides=['genome.set."sensor.ray_length".initial_sd=0.3'])
    assert nested == quoted
    assert nested.with_("genome.set.sensor.ray_length.initial_sd", 0.1) == replace(
        load_config("baseline", overrides=["genome.set.sensor.ray_length={}"]), name=nested.name
    )


def test_the_engine_refuses_bodies_that_do_not_fit():
    from hedon import _engine
    from hedon.config.engine import engine_input

    given = engine_input(load_config("baseline", overrides=["genome.set.body.radius={}", "genome.weight_limit=0.8"]))
    given.settings["layout"][0]["genes"][2]["mutation"]["limit"] = math.sqrt(2.0)
    with pytest.raises(EngineError, match="a radius that fits into the arena"):
        _engine.Simulation(given.settings, given.walls, given.outer_walls, [1], 1, "", [], True)
