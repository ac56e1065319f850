"""Compares one step of a simulation with the rules in plain Python."""

import math

import numpy as np
import ppo_reference
import pytest
from acting_weights import AFTER_W2, HIDDEN, as_read
from observed_touch import assert_touches, touch_bits
from observed_world import food_slots, read_deeds, read_world, rollout_rows
from reference.channel import is_paid_by_place
from reference.draw import normals
from reference.heredity import first_log_sd, inherited_network
from reference.meal import can_digest
from reference.model import Model
from reference.neighbor import neighbors
from reference.reward import inputs
from reference.sense import body_sense, smells
from reference.setting import Rules
from reference.state import Agent, Deed, Outcome, Turn, World
from same_world import FORCE, PLACE, REWARD, WEIGHT, assert_close, assert_same_world

from hedon.experiment.simulation import Simulation
from hedon.record.schema import CAUSES

OUTPUT = 2e-5
"""Sums of a hundred products, up to 40 for energy, added in a different order, and tanh accurate to 1e-6."""
LARGE_OUTPUT = 5e-6
"""The same for networks with large weights, as a share of the summed products, which may cancel out."""
SENSE = 3e-6
"""Sums of a hundred smells, each rounded by 6e-8."""


class Judge:
    """Compares a simulation with its model step by step, and counts events."""

    def __init__(self, simulation: Simulation, seed: int) -> None:
        self.simulation, self.model = simulation, Model(simulation.config, seed)
        species = self.model.rules.species
        # Genes can multiply forces and costs by at most this factor.
        genes = [(gene, own.limit) for each in species for gene, own in zip(each.genes, each.mutations, strict=True)]
        set_by = {"g_" + path.replace(".", "_") for each in species for path in each.genome.set}
        stretch = 10 ** max((limit for gene, limit in genes if gene in set_by), default=0.0)
        self.force = FORCE * math.sqrt(2) * stretch * max(each.max_force for each in species)
        costs = [sum(store.action_cost for store in each.stores.values()) for each in species]
        self.costs = 2e-12 + self.force * stretch * max(costs)
        self.happened: dict[str, float] = {}
        self.born_with: dict[int, np.ndarray] = {}
        """The network that each agent had when it was first seen."""

    def count(self, **what: float) -> None:
        for name, number in what.items():
            self.happened[name] = self.happened.get(name, 0) + number

    def begin(self) -> None:
        """Asserts that the initial world follows the rules."""
        self.assert_same(self.model.found(), 0.0)
        found = [np.reshape(each, (-1, 2)) for each in self.model.rules.arena.obstacles]
        assert_close(np.reshape(self.simulation.worlds[0].obstacles, (-1, 2)), np.reshape(found, (-1, 2)), PLACE)

    def step(self) -> None:
        """Advances by one step and asserts that it followed the rules."""
        simulation, world = self.simulation, self.simulation.worlds[0]
        before, slots, foods = read_world(simulation), world.living.tolist(), food_slots(simulation)
        observations = self.observations(before)
        seen = [self.sight(agent, row) for agent, row in zip(before.agents, observations, strict=True)]
        if before.step % 5 == 0:
            self.assert_observations(before, slots, observations)
        params, command = world.view("params"), world.view("external_action").reshape(len(world.view("alive")), -1)
        params = params[slots] if len(params) else np.zeros((len(slots), 0), np.float32)
        told = command[slots].tolist() if command.size else [(0.0, 0.0)] * len(slots)
        for agent, network in zip(before.agents, params, strict=True):
            self.born_with.setdefault(agent.agent_id, network)
        simulation.run(1)

        deeds = read_deeds(simulation, before, slots, foods, seen)
        for i, (agent, deed) in enumerate(zip(before.agents, deeds, strict=True)):
            policy = self.model.rules.of(agent).learning.policy
            if policy == "idle":
                continue
            if policy not in ("ppo", "fixed"):
                assert_close(deed.action, self.model.action(before, agent, told[i]), 1e-6)
        if before.step % 5 == 0:
            self.assert_networks_act(before, slots, observations, params)
        self.count(**assert_touches(simulation, self.model.rules, before, slots, deeds))

        expected = self.model.advance(before, deeds)
        # If a newborn took an agent's slot, the agent's final place is unknown, and so are rewards that depend on it.
        replaced = any(deed.replaced for deed in deeds)
        unsure = [replaced and is_paid_by_place(self.model.rules.of(agent), others=True) for agent in before.agents]
        ids = frozenset(agent.agent_id for agent, each in zip(before.agents, unsure, strict=True) if each)
        self.assert_same(expected.world, self.costs, ids)
        rewards = np.array([expected.rewards[agent.agent_id] for agent in before.agents])
        scale = REWARD * max(1.0, np.abs(rewards).max())
        unknown = [
            each or (deed.replaced and is_paid_by_place(self.model.rules.of(agent), others=False))
            for each, agent, deed in zip(unsure, before.agents, deeds, strict=True)
        ]
        paid = rollout_rows(simulation, before, slots, "reward")
        assert_close(paid[np.logical_not(unknown)], rewards[np.logical_not(unknown)], scale, 1e-6)
        self.assert_deaths(expected)
        if self.model.rules.births_first and not self.model.rules.inherits_late:
            self.assert_newborn_networks(before, params)
        self.note(before, expected)

    def assert_same(self, expected: World, costs: float, unsure: frozenset[int] = frozenset()) -> None:
        actual = read_world(self.simulation)
        assert_same_world(actual, expected, costs, self.force, self.model.rules.inherits_late, unsure)

    def note(self, before: World, expected: Outcome) -> None:
        """Counts events, so that a case can assert that the events it tests occurred."""
        rules, turns = self.model.rules, expected.turns
        met = [food for turn in turns for food in turn.deed.mouthfuls]
        hungry = [turn for turn in turns if turn.start.digestion == 0 and turn.deed.prey and not turn.starved]
        nearest = [turn.deed.prey[0] for turn in hungry]
        born = [agent for agent in expected.world.agents if agent.birth_step == expected.world.step]
        self.count(
            rivals=len(met) - len(set(met)),
            contested=len(nearest) - len(set(nearest)),
            spared=sum(turn.caught for turn in hungry),
            feasts=sum(sum(turn.meal[len(rules.kinds) :]) > 1 for turn in turns),
            digesting=sum(bool(turn.deed.prey) for turn in turns if turn.start.digestion > 0),
            cannibal=sum(turn.meal[len(rules.kinds) + turn.agent.species] for turn in turns if rules.hunting),
            mated=sum(child.mate_id >= 0 for child in born),
            alone=sum(child.mate_id < 0 for child in born),
            waiting=sum(agent.ready_until >= expected.world.step for agent in expected.world.agents),
            **_held(rules, before),
            refused=sum(not can_digest(rules, turn, kind) for turn in turns for kind, _ in turn.deed.mouthfuls),
            eaten_foods=len(expected.world.eaten_foods),
            switched=sum(a.center != b.center for a, b in zip(before.stocks, expected.world.stocks, strict=True)),
            told=sum(rules.of(turn.agent).learning.policy == "external" and any(turn.deed.action) for turn in turns),
            passed=_overlaps(rules, before),
            kin=_kin(rules, expected.world),
        )
        for turn in turns:
            self.count(**{f"paid_{name}": value != 0 for name, value in inputs(rules, before, turn).items()})

    def observations(self, before: World) -> list[np.ndarray]:
        """What each agent observes now, in order of id."""
        rows = [iter(self.simulation.worlds[0].observations(s)) for s in range(len(self.model.rules.species))]
        found = [next(rows[agent.species]) for agent in before.agents]
        assert all(next(rest, None) is None for rest in rows)
        return found

    def sight(self, agent: Agent, observation: np.ndarray) -> np.ndarray:
        """Ray readings of an agent, (rays, types that it sees)."""
        species = self.model.rules.of(agent)
        rays, sees = species.sensor.ray_count, len(species.sees)
        return observation[: rays * sees].reshape(sees, rays).T.astype(float)

    def assert_observations(self, before: World, slots: list[int], observations: list[np.ndarray]) -> None:
        """Checks observations except rays: touch must match the state, the rest must follow from the rules."""
        world, rules = self.simulation.worlds[0], self.model.rules
        touch = touch_bits(world, slots)
        names = ("velocity_x", "velocity_y", "angular_velocity")
        motion = np.stack([world.view(f"physics.bodies.{name}")[slots] for name in names], axis=1).tolist()
        for i, (agent, row) in enumerate(zip(before.agents, observations, strict=True)):
            species, smelled = rules.of(agent), smells(rules, before, agent)
            here = (agent.x, agent.y, agent.angle)
            deed = Deed((0.0, 0.0), *here, [], [], [], self.sight(agent, row), tuple(motion[i]), touch[i])
            turn = Turn(agent, agent, deed, [], (0.0, 0.0), smelled, before, [])
            rays, bits = (
                species.sensor.ray_count * len(species.sees),
                len(species.touches) * species.sensor.touch_sectors,
            )
            assert row[rays : rays + bits].tolist() == [touch[i] >> bit & 1 for bit in range(bits)]
            assert_close(row[rays + bits :], body_sense(rules, before, turn), SENSE, 1e-6)
            self.count(smelled=bool(np.any(smelled > 0.1)))

    def assert_networks_act(self, before: World, slots: list[int], observations: list, params: np.ndarray) -> None:
        """Checks that actions, log-probabilities and values follow from the observations and the networks."""
        rows = (
            rollout_rows(self.simulation, before, slots, name, width)
            for name, width in (("action", 2), ("log_prob", 1), ("value", 1))
        )
        for agent, observation, weights, action, log_prob, value in zip(
            before.agents, observations, params, *rows, strict=True
        ):
            learning = self.model.rules.of(agent).learning
            if learning.policy not in ("ppo", "fixed"):
                continue
            weights = weights[: network_size(len(observation))]
            weights = as_read(weights) if learning.acting_weights == "bfloat16" else weights
            layers = ppo_reference.split(weights.astype(float), len(observation))
            _, hidden, output = ppo_reference.forward(weights.astype(float), observation[None, :].astype(float))
            output, products = output[0], np.abs(hidden[0]) @ np.abs(layers["w3"]).T + np.abs(layers["b3"])
            rounding = np.maximum(OUTPUT, LARGE_OUTPUT * products)
            noise = np.array(normals(*self.model.rules.draw("action", agent.agent_id, before.step)[:2]))
            assert_close(action, output[:2] + np.exp(layers["log_sd"]) * noise, rounding[:2], LARGE_OUTPUT)
            expected = (-0.5 * noise**2 - layers["log_sd"] - 0.5 * np.log(2 * np.pi)).sum()
            assert log_prob == pytest.approx(expected, abs=5e-6)
            assert_close(value, output[2], rounding[2])
            self.count(**{f"acts_{learning.policy}_{learning.acting_weights}": 1})

    def assert_newborn_networks(self, before: World, params: np.ndarray) -> None:
        """Checks that newborns have a noisy copy of the parent's network or a new one; genes may set the spread."""
        world = self.simulation.worlds[0]
        old = {agent.agent_id: i for i, agent in enumerate(before.agents)}
        for slot, child in zip(world.living.tolist(), read_world(self.simulation).agents, strict=True):
            species = self.model.rules.of(child)
            if child.agent_id in old or species.learning.policy not in ("ppo", "fixed"):
                continue
            size = network_size(world.observations(child.species).shape[1])
            network, parent = world.view("params")[slot][:size].astype(float), old[child.parent_id]
            log_sd = slice(size - 13, size - 11)
            if species.birth.network == "none":
                assert_close(network[log_sd], first_log_sd(species, child.genome), WEIGHT)
                assert np.abs(np.corrcoef(network[: size - 13], params[parent][: size - 13])[0, 1]) < 0.2
                continue
            now, first = params[parent][:size], self.born_with[child.parent_id][:size]
            source = first if species.birth.network == "initial" else now
            giver = self.model.rules.of(before.agents[parent])
            wanted = inherited_network(self.model.rules, giver, source.astype(float), child.agent_id)
            if "action_sd" in species.genome.learning:
                wanted[log_sd] = first_log_sd(species, child.genome)
            assert_close(network, wanted, WEIGHT)
            learned = bool(np.abs(now - first).max() > 1e-3)
            self.count(**{f"network_{species.birth.network}": 1, "network_of_learned": learned})

    def assert_deaths(self, expected) -> None:
        dead = self.simulation.engine.take_rows(0)
        assert dead["agent_id"].tolist() == [agent.agent_id for agent in expected.dead]
        if "cause" in dead:
            assert [CAUSES[cause] for cause in dead["cause"].tolist()] == expected.causes
            self.count(starved=expected.causes.count("starved"))
        assert_close(dead["energy"], [agent.energy for agent in expected.dead], self.costs)
        assert np.all(dead["death_step"] == expected.world.step)


def command(simulation: Simulation) -> None:
    """From time to time, gives externally controlled agents new actions."""
    step = simulation.worlds[0].step
    for s, species in enumerate(simulation.config.species.values()):
        if species.learning.policy == "external" and step % 7 == 0:
            actions = np.random.default_rng(step).normal(size=(1, species.population.capacity, 2))
            simulation.engine.set_actions(s, actions.astype(np.float32))


def _held(rules: Rules, world: World) -> dict[str, float]:
    """Counts stores above 1 that weaken the motors, and stores other than energy that are full or empty."""
    held = [(agent.store[name], each) for agent in world.agents for name, each in rules.of(agent).store.items()]
    return {
        "poisoned": sum(amount > 1 for amount, store in held if store.motor_threshold),
        "sated": sum(amount == store.capacity for amount, store in held),
        "empty": sum(amount == 0 for amount, store in held if not store.motor_threshold),
    }


def _kin(rules: Rules, world: World) -> int:
    """How many kin the neighbor queries find."""
    asked = ((agent, query) for agent in world.agents for query in rules.of(agent).neighbor.values())
    return sum(int(neighbors(rules, world, agent, query)["kin"]) for agent, query in asked)


def _overlaps(rules: Rules, world: World) -> int:
    """Number of pairs of agents that overlap."""
    count = 0
    for i, one in enumerate(world.agents):
        for other in world.agents[:i]:
            reach = rules.of(one).body.radius + rules.of(other).body.radius
            count += math.hypot(one.x - other.x, one.y - other.y) < 0.8 * reach
    return count


def network_size(inputs: int) -> int:
    """Number of parameters of a network."""
    return HIDDEN * (inputs + 1) + HIDDEN * HIDDEN + AFTER_W2
