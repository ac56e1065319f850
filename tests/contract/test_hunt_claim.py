"""Which agent eats which if any agent may eat any other: crowds with random headings, compared with plain Python."""

import numpy as np
import pytest
from reference.draw import philox
from worlds import CHILDLESS, DEATHLESS, QUICK, STILL, make_simulation

from hedon.experiment.simulation import Simulation

RADIUS, HALF_MOUTH = 10.0, 26.0
MARGIN = 3.0
"""Least angle between a mouth's edge and a contact, since bodies move a bit first; a mouth holds one body [degree]."""
SHARES = np.array([[0.6, 0.25, 0.9], [0.5, 0.1, 0.3], [0.8, 0.4, 0.7]])
"""The share of energy that each species (row) gains by eating each species (column)."""
HUNT = 16
"""The purpose number of the draws between eaters."""


def make(sharing: str, seed: int) -> Simulation:
    names = ("a", "b", "c")
    eats = (
        f"species.{name}.diet.eats={[[other, float(share)] for other, share in zip(names, row, strict=True)]}".replace(
            "'", '"'
        )
        for name, row in zip(names, SHARES, strict=True)
    )
    return make_simulation(
        *QUICK,
        *STILL,
        *DEATHLESS,
        *CHILDLESS,
        f"sensor.mouth_spread={HALF_MOUTH}",
        "food.normal.growth_rate=0",
        "food.normal.initial_count=0",
        "energy.basic_cost=0",
        "energy.action_cost=0",
        "energy.capacity=150",
        f'world.prey_sharing="{sharing}"',
        "population.capacity=40",
        "population.initial_count=1",
        *eats,
        seeds=(seed,),
    )


def crowd(rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Places of touching bodies in a honeycomb with holes, headings whose mouths end between bodies, and energies."""
    side = 2 * RADIUS - 0.05
    cells = [(column, row) for row in range(6) for column in range(6)]
    kept = [cells[i] for i in rng.permutation(len(cells))[: rng.integers(10, 34)]]
    places = np.array([(150 + side * (c + r % 2 / 2), 100 + side * r * np.sqrt(3) / 2) for c, r in kept])
    headings = rng.uniform(-np.pi, np.pi, len(places))
    for i in range(len(places)):
        while any(abs(abs(angle) - HALF_MOUTH) < MARGIN for angle in ahead(places, headings, i).values()):
            headings[i] = rng.uniform(-np.pi, np.pi)
    return places, headings, rng.uniform(1, 100, len(places))


def ahead(places: np.ndarray, headings: np.ndarray, i: int) -> dict[int, float]:
    """The bodies that touch body `i`, with the angle at which it sees each: 0 is straight ahead [degree]."""
    apart = places - places[i]
    near = [j for j in np.flatnonzero(np.hypot(*apart.T) < 2 * RADIUS) if j != i]
    angles = {j: np.degrees(np.arctan2(-apart[j, 0], apart[j, 1]) - headings[i]) for j in near}  # heading 0 is +y
    return {int(j): float((angle + 180) % 360 - 180) for j, angle in angles.items()}


def claims(places: np.ndarray, headings: np.ndarray, after: np.ndarray) -> dict[int, int]:
    """The prey each would eat: the nearest in its mouth, given where bodies are after the physics of the step."""
    found = {}
    for i in range(len(places)):
        inside = [j for j, angle in ahead(places, headings, i).items() if abs(angle) <= HALF_MOUTH]
        if inside:
            found[i] = min(inside, key=lambda j: np.float32(((after[j] - after[i]) ** 2).sum()))
    return found


def settle(wanted: dict[int, int], sharing: str, draw: list[int]) -> list[tuple[int, int]]:
    """The claims that succeed, as (eater, prey)."""
    if sharing == "each":
        return list(wanted.items())
    held, open_claims = [], dict(wanted)
    while open_claims:
        free = [i for i in open_claims if i not in open_claims.values()]
        eater = min(free or open_claims, key=lambda i: draw[i])
        prey = open_claims[eater]
        held.append((eater, prey))
        open_claims = {i: j for i, j in open_claims.items() if j not in (prey, eater) and i != prey}
    return held


def step(sharing: str, seed: int, scene: tuple[np.ndarray, ...]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The place after the physics, the energy, and whether it was eaten, for each body of a scene."""
    places, headings, energies, species = scene
    simulation = make(sharing, seed)
    x, y = (np.ascontiguousarray(column, np.float32) for column in places.T)
    none = np.zeros(0, np.float32)
    simulation.engine.set_scene(
        0, x, y, headings.astype(np.float32), energies.astype(np.float32), species, none, none, np.zeros(0, np.int32)
    )
    world = simulation.worlds[0]
    slots = world.living.copy()
    simulation.run(1)
    after = np.column_stack([world.view("physics.bodies.x")[slots], world.view("physics.bodies.y")[slots]])
    left = np.full(len(places), np.nan)
    lives, dead = world.agents(), world.deaths()
    first = min([*lives["agent_id"], *dead["agent_id"]])
    for rows in (lives, dead):
        left[rows["agent_id"] - first] = rows["energy"]
    eaten = np.zeros(len(places), bool)
    eaten[dead["agent_id"] - first] = True
    return after, left, eaten


@pytest.mark.parametrize("sharing", ["one", "each"])
def test_crowds_are_settled_as_in_plain_python(sharing):
    chains = rivals = mutual = 0
    for seed in range(40):
        rng = np.random.default_rng(seed)
        places, headings, energies = crowd(rng)
        species = rng.integers(0, 3, len(places)).astype(np.int32)
        after, left, eaten = step(sharing, seed, (places, headings, energies, species))
        wanted = claims(places, headings, after)
        draw = [philox((0, HUNT, i, 0), (seed, 0))[0] for i in range(len(places))]
        held = settle(wanted, sharing, draw)
        known = energies.astype(np.float32).astype(np.float64)
        gained = known.copy()
        for eater, prey in held:
            share = np.float64(np.float32(SHARES[species[eater], species[prey]]))
            gained[eater] = min(gained[eater] + share * known[prey], 150.0)
        assert np.flatnonzero(eaten).tolist() == sorted({prey for _, prey in held})
        np.testing.assert_allclose(left, gained, rtol=1e-12)
        chains += sum(prey in wanted for prey in wanted.values())
        rivals += len(wanted) - len(set(wanted.values()))
        mutual += sum(wanted.get(prey) == eater for eater, prey in wanted.items())
    assert min(chains, rivals, mutual) > 50


def test_if_each_eater_gains_the_order_of_ids_decides_nothing():
    """The same bodies, created in another order, have the same fates, whatever they claim."""
    for seed in range(20):
        rng = np.random.default_rng(100 + seed)
        places, headings, energies = crowd(rng)
        species = rng.integers(0, 3, len(places)).astype(np.int32)
        _, left, eaten = step("each", seed, (places, headings, energies, species))
        order = rng.permutation(len(places))
        again = step("each", seed, (places[order], headings[order], energies[order], species[order]))
        np.testing.assert_array_equal(again[2], eaten[order])
        np.testing.assert_allclose(again[1], left[order], rtol=1e-12)
