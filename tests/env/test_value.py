"""Worlds as values: saved, restored, cloned, copied and pickled, they continue with the same bits."""

import pickle
import random
import subprocess
import sys
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from world_copy import LIVELY, PAIR, WAYS, digests
from worlds import QUICK, RELEASED, make_simulation

import hedon
from hedon import ArgumentError, Simulation, load_config, make
from hedon.env import VectorEnv


@pytest.mark.parametrize("way", WAYS.values(), ids=WAYS)
@pytest.mark.parametrize("steps", [0, 1, 63, 64, 150])
@pytest.mark.parametrize("settings", [LIVELY, (*LIVELY, *RELEASED), PAIR], ids=["one", "released", "pair"])
def test_a_copy_goes_on_alone(way, steps, settings):
    one = make_simulation(*settings, seeds=(3, 8), threads=2)
    one.run(steps)
    other = way(one)
    assert digests(other) == digests(one)
    assert (other.seeds, other.config) == (one.seeds, one.config)
    at = digests(one)
    one.run(90)
    assert digests(other) == at, "a copy has its own worlds"
    other.run(90)
    assert digests(other) == digests(one) != at
    for mine, theirs in zip(one.worlds, other.worlds, strict=True):
        assert mine.counters == theirs.counters
        for name, values in mine.agents().items():
            np.testing.assert_array_equal(values, theirs.agents()[name])


def test_restored_worlds_bring_their_seeds_along():
    one, other = make_simulation(*LIVELY, seeds=(3, 8)), make_simulation(*LIVELY, seeds=(1, 2), threads=2)
    one.run(70)
    kept = one.save()
    one.run(50)
    end = digests(one)
    other.run(5)
    for simulation in (one, other):
        simulation.restore(kept)
        assert simulation.seeds == (3, 8)
        assert [world.step for world in simulation.worlds] == [70, 70]
        simulation.run(50)
        assert digests(simulation) == end


@pytest.mark.parametrize("preset", ["baseline", "predator", "pitfall"])
def test_a_reset_is_a_new_simulation(preset):
    """Nothing remains of what lived there before."""
    used = make_simulation(*QUICK, preset=preset, seeds=(1, 2))
    used.run(100)
    used.reset([7, 9])
    fresh = make_simulation(*QUICK, preset=preset, seeds=(7, 9))
    for _ in range(3):
        assert digests(used) == digests(fresh)
        assert used.seeds == fresh.seeds == (7, 9)
        for simulation in (used, fresh):
            simulation.run(50)
    with pytest.raises(ArgumentError, match="there must be 2, one per world, not 1"):
        used.reset([1])


def test_another_process_continues_a_pickled_simulation(tmp_path):
    simulation = make_simulation(*LIVELY)
    simulation.run(100)
    file = tmp_path / "world.pickle"
    file.write_bytes(pickle.dumps(simulation))
    program = f"import pickle; s = pickle.load(open({str(file)!r}, 'rb')); s.run(60); print(s.worlds[0].digest())"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    simulation.run(60)
    assert done.stdout.strip() == simulation.worlds[0].digest()


@pytest.mark.parametrize("way", WAYS.values(), ids=WAYS)
def test_a_world_with_a_rule_continues_with_the_saved_text(way, tmp_path):
    """Even if the file is gone or has changed by then."""
    pytest.importorskip("numba", reason='needs the optional package: pip install "hedon[rules]"')
    file = tmp_path / "own.py"
    file.write_text("def pay(agent):\n    return agent.linear + 0.5 * agent.moved\n")
    one = make_simulation(*LIVELY, f'reward.rule="{file}:pay"')
    one.run(70)
    file.write_text("def pay(agent):\n    return 0.0\n")
    other = way(one)
    for simulation in (one, other):
        simulation.run(90)
    assert digests(other) == digests(one)
    file.unlink()
    again = way(other)
    for simulation in (one, again):
        simulation.run(30)
    assert digests(again) == digests(one)


def play(worlds: VectorEnv, steps: int, seed: int) -> list[Any]:
    """All arrays and digests of worlds after each of some steps."""
    rng, told = np.random.default_rng(seed), []
    for _ in range(steps):
        for group in worlds.groups.values():
            group.actions[...] = rng.uniform(-1, 1, group.actions.shape)
        worlds.step(worlds.actions)
        told.append(everything(worlds))
    return told


def everything(worlds: VectorEnv) -> list[bytes]:
    groups = worlds.groups.values()
    arrays = [array.tobytes() for group in groups for _, array in sorted(group._arrays().items())]
    return [*arrays, *(group.newborns.tobytes() for group in groups), repr(digests(worlds)).encode()]


@pytest.mark.parametrize("way", WAYS.values(), ids=WAYS)
@pytest.mark.parametrize(("species", "repeat"), [("led", 1), ("led", 5), (None, 5), ("wise", 70)])
def test_a_copy_of_driven_worlds_goes_on_alone(way, species, repeat):
    worlds = make(load_config("baseline", overrides=PAIR), 2, 3, species, repeat=repeat, max_steps=200, threads=2)
    play(worlds, 12, 0)
    other = way(worlds)
    assert everything(other) == everything(worlds)
    assert play(other, 10, 1) == play(worlds, 10, 1)
    for each in (worlds, other):
        each.reset()
    assert worlds.simulation.seeds == other.simulation.seeds
    assert not {3, 4} & set(worlds.simulation.seeds)
    assert play(other, 5, 2) == play(worlds, 5, 2)


@pytest.mark.parametrize("stop", [1, 3, 6])
def test_worlds_are_intact_when_ctrl_c_ends_a_repeat(stop, monkeypatch):
    """None of the completed steps is lost, and the worlds can be saved and continued."""
    config = load_config("baseline", overrides=LIVELY)
    single, held = (make(config, 2, seed=0, repeat=repeat, threads=1) for repeat in (1, 7))
    paid, first = np.zeros_like(single.rewards), single.groups["agent"].ids.copy()
    for _ in range(stop):
        before = single.groups["agent"].ids.copy()
        single.step(single.actions)
        paid += np.where(before == first, single.rewards, 0)
    count = 0

    class Interrupted:
        """The engine with a Ctrl-C in one of its steps."""

        def __init__(self, engine: Any) -> None:
            self._engine = engine

        def __getattr__(self, name: str) -> Any:
            return getattr(self._engine, name)

        def run(self, steps: int) -> None:
            nonlocal count
            self._engine.run(steps)
            count += 1
            if count == stop:
                raise KeyboardInterrupt

    monkeypatch.setattr(held.simulation, "engine", Interrupted(held.simulation.engine))
    with pytest.raises(KeyboardInterrupt):
        held.step(held.actions)
    monkeypatch.undo()
    assert digests(held) == digests(single)
    np.testing.assert_array_equal(held.observations, single.observations)
    np.testing.assert_array_equal(held.rewards, paid)
    other = make(config, 2, repeat=7, threads=2)
    other.restore(held.save())
    assert everything(other) == everything(held)
    assert play(other, 3, 1) == play(held, 3, 1)


def spoil(kept: bytes, at: int) -> bytes:
    return kept[:at] + bytes([kept[at] ^ 1]) + kept[at + 1 :]


WRONG: dict[str, tuple[Callable[[bytes], Any], str]] = {
    "nothing": (lambda kept: None, "saved = None: must be bytes, as `save` gives them"),
    "a text": (lambda kept: "worlds", "saved = 'worlds': must be bytes"),
    "no bytes": (lambda kept: b"", "these bytes are no worlds that were saved"),
    "other bytes": (lambda kept: b"PK\3\4" + kept, "these bytes are no worlds that were saved"),
    "the first part": (lambda kept: kept[:-8], "these bytes are damaged"),
    "the mark alone": (lambda kept: kept[:8], "these bytes are damaged"),
    "more": (lambda kept: kept + b"12345678", "these bytes are damaged"),
    "a bit in the middle": (lambda kept: spoil(kept, len(kept) // 2), "these bytes are damaged"),
    "a bit of the last": (lambda kept: spoil(kept, len(kept) - 1), "these bytes are damaged"),
    "a bit of the hash": (lambda kept: spoil(kept, 9), "these bytes are damaged"),
    "one world": (lambda kept: make_simulation(*LIVELY, seeds=(1,)).save(), "there are 1 worlds, here 2"),
    "other settings": (
        lambda kept: make_simulation(*LIVELY, "energy.initial=7", seeds=(1, 2)).save(),
        "these worlds were saved with another config",
    ),
}


@pytest.mark.parametrize(("wrong", "says"), WRONG.values(), ids=WRONG)
def test_what_is_not_a_saved_world_is_refused_in_one_sentence(wrong, says):
    simulation = make_simulation(*LIVELY, seeds=(1, 2))
    simulation.run(70)
    kept = simulation.save()
    simulation.run(3)
    before = digests(simulation)
    with pytest.raises(ArgumentError, match=says) as caught:
        simulation.restore(wrong(kept))
    assert "\n" not in str(caught.value)
    assert digests(simulation) == before
    assert simulation.seeds == (1, 2)


def test_another_version_is_refused_by_its_name(monkeypatch):
    simulation = make_simulation(*LIVELY)
    monkeypatch.setitem(simulation._mark, "hedon", "0.0.1")
    kept = simulation.save()
    with pytest.raises(ArgumentError, match=rf"by another version of hedon \(0\.0\.1, here {hedon.__version__}\)"):
        make_simulation(*LIVELY).restore(kept)


def forged(kept: bytes, draw: random.Random) -> bytes:
    """The bytes with some of them changed, and a hash that matches."""
    raw = bytearray(kept)
    for _ in range(draw.randint(1, 3)):
        at = draw.randrange(16, len(raw))
        raw[at] = draw.choice((0, 1, 127, 255, draw.randrange(256)))
    raw[8:16] = hash_of(bytes(raw[16:])).to_bytes(8, "little")
    return bytes(raw)


def hash_of(data: bytes) -> int:
    """The hash of the format, in plain Python."""
    ones = 2**64 - 1

    def mix(value: int, word: int) -> int:
        value = (value ^ word) * 0xD6E8FEB86659FD93 & ones
        return value ^ value >> 32

    start = 0x9E3779B97F4A7C15
    chains = [start] * 4
    whole = len(data) // 32 * 32
    words = np.frombuffer(data[:whole], np.uint64).tolist()
    for i, word in enumerate(words):
        chains[i % 4] = mix(chains[i % 4], word)
    rest = data[whole:]
    value = mix(start, len(rest))
    for at in range(0, len(rest), 8):
        value = mix(value, int.from_bytes(rest[at : at + 8], "little"))
    for chain in chains:
        value = mix(value, chain)
    return value


def test_forged_worlds_are_refused_or_do_no_harm():
    """With a matching hash, only the engine's checks are left: it checks all worlds before it changes any."""
    few = (*LIVELY, "population.capacity=4", "population.initial_count=3", 'learning.policy="random"')
    source, target = (make_simulation(*few, seeds=(1, 2)) for _ in range(2))
    source.run(70)
    kept = source.save()
    assert hash_of(kept[16:]).to_bytes(8, "little") == kept[8:16]
    draw, taken = random.Random(1), []
    for _ in range(150):
        before = digests(target)
        try:
            target.restore(forged(kept, draw))
            taken.append(True)
            target.run(3)
        except ArgumentError:
            taken.append(False)
            assert digests(target) == before
        except hedon.EngineError:
            target = make_simulation(*few, seeds=(1, 2))
    assert 10 < sum(taken) < len(taken) - 10


def test_a_wrong_second_world_leaves_the_first_as_it_is():
    one = make_simulation(*LIVELY, seeds=(1, 2))
    one.run(70)
    kept = bytearray(one.save())
    name = kept.rindex(b"life.energy\0")
    first = name + 16 + 8 * 4  # the name takes 16 bytes, then come kind, size, dimensions, length
    kept[first : first + 8] = np.float64(-1).tobytes()
    kept[8:16] = hash_of(bytes(kept[16:])).to_bytes(8, "little")
    other = make_simulation(*LIVELY, seeds=(1, 2))
    before = digests(other)
    with pytest.raises(ArgumentError, match=r"saved: world 1: life\.energy holds -1"):
        other.restore(bytes(kept))
    assert digests(other) == before


DRIVEN_WRONG: dict[str, tuple[Callable[[VectorEnv], bytes], str]] = {
    "worlds alone": (lambda w: w.simulation.save(), "hold worlds alone, without those who drive them"),
    "other actions": (lambda w: make(w.config, 2, species="led", actions="logit").save(), "driven in another way"),
    "other drivers": (lambda w: make(w.config, 2, species=["led", "wise"]).save(), "with another config"),
    "more worlds": (lambda w: make(w.config, 3, species="led").save(), "there are 3 worlds, here 2"),
}


@pytest.mark.parametrize(("wrong", "says"), DRIVEN_WRONG.values(), ids=DRIVEN_WRONG)
def test_driven_worlds_refuse_what_is_not_theirs(wrong, says):
    worlds = make(load_config("baseline", overrides=PAIR), 2, species="led")
    play(worlds, 5, 0)
    before = everything(worlds)
    with pytest.raises(ArgumentError, match=says):
        worlds.restore(wrong(worlds))
    assert everything(worlds) == before


def test_a_simulation_can_restore_the_bytes_of_driven_worlds():
    worlds = make(load_config("baseline", overrides=PAIR), 2, species="led")
    play(worlds, 5, 0)
    simulation = Simulation(worlds.config, worlds.simulation.seeds)
    simulation.restore(worlds.save())
    assert digests(simulation) == digests(worlds)


def test_a_missing_array_is_named():
    world = make_simulation(*QUICK, seeds=(1,)).worlds[0]
    with pytest.raises(
        ArgumentError, match=r"view: the state has no array 'life\.energgy'; did you mean life\.energy\?"
    ):
        world.view("life.energgy")
