"""Neighbor queries as rules read them, compared with a count over all pairs, and genes that only rules read."""

import math

import numpy as np
import pytest
from resumed_run import small_run
from worlds import CHILDLESS, DEATHLESS, QUICK, STILL, make_simulation, set_scene

from hedon import load_config
from hedon.config import ConfigError
from hedon.config.layout import layouts
from hedon.config.title import weight_title
from hedon.experiment.rule import RuleError
from hedon.record.reader import open_run
from hedon.report.analysis import analyze

pytest.importorskip("numba", reason='needs the optional package: pip install "hedon[rules]"')

NUMBERS = ("count", "kin", "distance", "bearing", "meals")
LIVELY = (*QUICK, "birth.kappa=0.05", "hazard.alpha_age=0.01", "population.capacity=60", "population.initial_count=40")
ARENA = ("arena.width=300", "arena.height=300")
PLENTY = ("food.normal.capacity=200", "food.normal.initial_count=200", "food.normal.growth_rate=1")


@pytest.fixture
def file(tmp_path):
    """Rules that read their queries; `copy` copies them into its memory."""
    copied = "".join(f"    agent.memory_{i} = agent.near_{name}\n" for i, name in enumerate(NUMBERS, 1))
    (tmp_path / "near.py").write_text(
        f"def copy(agent):\n{copied}    return agent.linear\n\n"
        "def kind(agent):\n    return agent.linear + agent.extra_kindness * agent.near_kin\n\n"
        "def crowd(agent):\n    return min(1.0, agent.chance * (1.0 + agent.near_count))\n\n"
        "def greed(agent):\n    return 1.0 if agent.normal + agent.near_meals > 0.0 else agent.chance\n\n"
        "def marked(agent):\n    return agent.neutral_1\n"
    )
    return tmp_path / "near.py"


def wrapped(angle):
    return (angle + math.pi) % (2 * math.pi) - math.pi


def distances(world, of=None):
    """Distances from every agent (row) to every other agent of some species, infinite for the rest."""
    agents = world.agents()
    x, y = (world.view(f"physics.bodies.{name}")[world.living].astype(float) for name in ("x", "y"))
    apart = np.hypot(x - x[:, None], y - y[:, None])
    np.fill_diagonal(apart, np.inf)
    if of is not None:
        apart[:, ~np.isin(agents["species"], of)] = np.inf
    return apart


def near(world, reach, of=None):
    return distances(world, of) <= reach


def found(world, reach, of=None):
    """The query results of every agent at the start of a step, from all pairs."""
    agents = world.agents()
    x, y, angle = (world.view(f"physics.bodies.{name}")[world.living].astype(float) for name in ("x", "y", "angle"))
    rows = []
    for i, apart in enumerate(distances(world, of)):
        close = apart <= reach
        parent = agents["parent_id"]
        kin = (
            (parent == agents["agent_id"][i])
            | (agents["agent_id"] == parent[i])
            | ((parent == parent[i]) & (parent >= 0))
        )
        j = int(np.argmin(apart))
        bearing = wrapped(math.atan2(y[j] - y[i], x[j] - x[i]) - math.pi / 2 - angle[i]) if close.any() else 0.0
        rows.append((close.sum(), (close & kin).sum(), apart[j] if close.any() else reach, bearing))
    return np.array(rows)


@pytest.mark.parametrize(("of", "reach"), [(["*"], 40.0), (["odd"], 120.0), (["plain"], 1e4)])
def test_a_query_finds_the_agents_nearby(file, of, reach):
    """Only steps without births and deaths are compared, so all meals are those of the agents present."""
    settings = (*LIVELY, *ARENA, *PLENTY, "species.plain.body.radius=8", f'species.odd.reward.rule="{file}:copy"')
    names = ", ".join(f'"{name}"' for name in of)
    settings += ("species.odd.reward.memory=5", f"species.odd.neighbor.near={{of=[{names}], range={reach}}}")
    simulation = make_simulation(*settings, seeds=(5,))
    world, compared, kin, meals = simulation.worlds[0], 0, 0, 0
    for _ in range(200):
        before, species = world.counters, None if of == ["*"] else [["plain", "odd"].index(name) for name in of]
        wanted, eaten = found(world, reach, species), world.agents()["eaten"].sum(axis=1)
        simulation.run(1)
        if (before["births"], before["deaths"]) != (world.counters["births"], world.counters["deaths"]):
            continue
        mine = world.agents()["species"] == 1
        wanted, got = wanted[mine], world.view("memory")[world.living][mine]
        fed = world.agents()["eaten"].sum(axis=1) - eaten
        np.testing.assert_array_equal(got[:, 4], (near(world, reach, species) @ fed)[mine])
        np.testing.assert_array_equal(got[:, :2], wanted[:, :2])
        np.testing.assert_allclose(got[:, 2], wanted[:, 2], rtol=1e-6)
        np.testing.assert_allclose(wrapped(got[:, 3] - wanted[:, 3]), 0.0, atol=1e-5)
        compared += len(got)
        kin += int(wanted[:, 1].sum())
        meals += int(got[:, 4].sum())
    assert compared > 500
    assert kin > 10 or of == ["plain"]
    assert meals > 10


def test_bearings_are_counter_clockwise_from_the_heading(file):
    settings = (*QUICK, *DEATHLESS, *CHILDLESS, *STILL, "reward.memory=5", "neighbor.near.range=60")
    simulation = make_simulation(*settings, f'reward.rule="{file}:copy"')
    quarter = math.pi / 2
    for angle, place, bearing in ((0, (100, 150), 0), (0, (50, 100), quarter), (quarter, (100, 150), -quarter)):
        set_scene(simulation, [(100, 100, angle), (*place, 0), (300, 300, 0)])
        simulation.run(1)
        memory = simulation.worlds[0].view("memory")[simulation.worlds[0].living]
        np.testing.assert_allclose(memory[0, :4], [1, 0, 50, bearing], atol=1e-4)
        np.testing.assert_allclose(memory[2, :4], [0, 0, 60, 0])


def test_threads_and_checkpoints_change_nothing(file):
    """Nor does continuing a world in another simulation, whose slots were never used."""
    settings = (*LIVELY, *ARENA, *PLENTY, f'reward.rule="{file}:kind"', f'hazard.rule="{file}:crowd"')
    settings += ("genome.extra.kindness.initial_sd=1", 'birth.mating="pairs"', "birth.mating_range=50")
    settings += ("neighbor.near.range=50", "birth.distance_sd=20", "birth.attempts=100")
    once = make_simulation(*settings, seeds=(3,))
    once.run(150)
    first, begun, second = (make_simulation(*settings, seeds=(3,), threads=threads) for threads in (2, 1, 1))
    first.run(150)
    begun.run(70)
    second.engine.restore(0, begun.engine.save(0))
    second.run(80)
    assert once.worlds[0].counters["births"] > 10
    assert {first.worlds[0].digest(), second.worlds[0].digest()} == {once.worlds[0].digest()}


def test_a_gene_for_rules_is_drawn_inherited_and_paid(file):
    settings = (*LIVELY, f'reward.rule="{file}:kind"', "neighbor.near.range=1e4", "genome.neutral_count=2")
    genes = ("genome.extra.kindness={initial_mean=0.5, initial_sd=0.2}", "genome.mutation.extra_kindness.limit=0.6")
    simulation = make_simulation(*settings, *genes, "genome.mutation_scale=0.3")
    made = layouts(simulation.config)["agent"]
    assert [(gene.name, gene.role) for gene in made.genes[-3:]] == [
        ("extra_kindness", "rule"),
        *((f"neutral_{i}", "neutral") for i in (1, 2)),
    ]
    world = simulation.worlds[0]
    first = world.agents()["genome"][:, 2]
    assert 0.4 < first.mean() < 0.6
    assert first.std() > 0.05
    simulation.run(200)
    agents = world.agents()
    born = agents["parent_id"] >= 0
    assert born.any()
    assert np.abs(agents["genome"][:, 2]).max() == np.float32(0.6)
    assert np.abs(agents["genome"][born][:, 3]).max() > 0.6


def test_a_neutral_gene_is_refused_with_an_alternative(file):
    with pytest.raises(RuleError, match=r"reads neutral_1.*genome\.extra\.NAME gives the species a gene extra_NAME"):
        make_simulation(f'reward.rule="{file}:marked"')


def test_a_newborn_does_not_count_the_meals_of_the_last_agent_in_its_slot(file):
    """A parent's hazard is computed again after the birth; in another simulation, the child's slot was never used."""
    settings = (*LIVELY, *ARENA, *PLENTY, f'hazard.rule="{file}:greed"', "neighbor.near.range=35")
    settings += ("birth.distance_sd=20", "birth.attempts=1000", "birth.kappa=0.2")
    once = make_simulation(*settings, seeds=(3,))
    moved = make_simulation(*settings, seeds=(3,))
    for _ in range(30):
        once.run(4)
        moved.run(2)
        fresh = make_simulation(*settings, seeds=(3,))
        fresh.engine.restore(0, moved.engine.save(0))
        moved = fresh
        moved.run(2)
        assert moved.worlds[0].digest() == once.worlds[0].digest()
    assert min(once.worlds[0].counters[name] for name in ("births", "deaths")) > 30


def test_a_query_of_all_species_can_be_removed_from_one_of_them():
    settings = ("neighbor.close={}", "species.a.reward.pay.close_kin={}", "species.b.neighbor.close=false")
    config = load_config("baseline", overrides=settings)
    assert [list(species.neighbor) for species in config.species.values()] == [["close"], []]


@pytest.mark.parametrize(
    ("settings", "says"),
    [
        (["genome.extra.kindness={}"], r"genome\.extra: only a rule in Python reads this: give reward\.rule or hazard"),
        (["neighbor.near={}"], r"neighbor\.near: nothing reads its channels, such as near_count: sensor\.observes"),
        (
            ['neighbor.grain.of=["normal"]', "reward.pay.grain_meals={}"],
            r"no channel 'grain_meals' here.*grain_bearing",
        ),
        (["neighbor.near={}", "reward.gate=near_count"], r"neighbor\.near: nothing reads its channels"),
        (
            ["neighbor.near.of=[]", "reward.pay.near_count={}"],
            r"neighbor\.near\.of = \[\]: must name a species or a kind",
        ),
        (["sensor.observes.near_prey=1"], r"no channel 'near_prey' here; \[neighbor\.NAME\] asks who is near"),
        (['reward.rule="a.py:b"', "genome.extra.Kind={}"], r"genome\.extra\.Kind: a name must have only a-z"),
        (['reward.rule="a.py:b"', 'neighbor."a b"={}'], r"neighbor\.a b: a name must have only a-z"),
        (['reward.rule="a.py:b"', 'neighbor.near.of=["agnt"]'], r"neighbor\.near\.of = \"agnt\".*did you mean agent"),
        (['reward.rule="a.py:b"', "neighbor.near.range=0"], r"neighbor\.near\.range = 0: must be a number > 0"),
        (['reward.rule="a.py:b"', *(f"neighbor.n{i}={{}}" for i in range(5))], r"neighbor: there must be at most 4"),
        (
            ['reward.rule="a.py:b"', "food.n_count.gives.energy=1", "neighbor.n={}"],
            r"called n_count: rename a food, a query or a term",
        ),
    ],
)
def test_a_wrong_setting_is_named(settings, says):
    with pytest.raises(ConfigError, match=says):
        load_config("baseline", overrides=settings)


def test_records_and_analyses_name_the_gene_and_its_role(file, tmp_path):
    settings = (f'reward.rule="{file}:kind"', "neighbor.near.range=60", "genome.extra.kindness.initial_sd=0.3")
    small_run(tmp_path / "run", 200, seeds=(1,), overrides=settings)
    found = open_run(tmp_path / "run")
    assert found.reward_names == ("w_normal", "w_action", "extra_kindness")
    assert np.std(found.agents()["extra_kindness"].to_numpy()) > 0.1
    assert weight_title("extra_kindness") == "kindness, read by a rule"
    tables = analyze([found], ["drift", "price"]).tables
    for name in ("drift", "price"):
        roles = {row["weight"]: row["role"] for row in tables[name].rows.to_dicts()}
        assert roles.items() >= {"extra_kindness": "rule", "w_action": "reward", "neutral_1": "neutral"}.items()
