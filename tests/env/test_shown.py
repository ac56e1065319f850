"""A window shows what a program does to a world, at the frame rate of a film, and may be closed."""

import copy
import sys
import time

import numpy as np
import pytest

import hedon
from hedon.env.window import PICTURES_PER_SECOND

pygame = pytest.importorskip("pygame", reason='needs the optional package: pip install "hedon[window]"')
CONFIG = hedon.load_config("baseline", overrides=["population.capacity=20", "population.initial_count=12"])


@pytest.fixture(autouse=True)
def no_screen(monkeypatch):
    """Lets pygame draw into memory, so that no screen is needed."""
    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")
    yield
    pygame.display.quit()


def shown() -> np.ndarray:
    return pygame.surfarray.array3d(pygame.display.get_surface()).swapaxes(0, 1)


def test_each_step_and_each_reset_is_shown():
    with hedon.make(CONFIG, 2, render_mode="human") as worlds, hedon.make(CONFIG, 2, render_mode="rgb_array") as same:
        for each in (worlds, same):
            each.reset(seed=5)
        pictures = []
        for _ in range(3):
            np.testing.assert_array_equal(shown(), same.render())
            pictures.append(shown())
            for each in (worlds, same):
                each.step(np.ones_like(each.actions))
        assert all((one != pictures[0]).any() for one in pictures[1:])
        assert worlds.render() is None
        assert worlds.simulation.worlds[0].digest() == same.simulation.worlds[0].digest()
    assert pygame.display.get_surface() is None


def test_it_is_as_slow_as_a_film():
    with hedon.make(CONFIG, render_mode="human") as worlds:
        worlds.reset()
        begun = time.perf_counter()
        for _ in range(10):
            worlds.step(worlds.actions)
        assert time.perf_counter() - begun > 9 / PICTURES_PER_SECOND * 0.9


def test_a_closed_window_stays_closed_and_the_steps_continue():
    with hedon.make(CONFIG, render_mode="human") as worlds:
        worlds.reset()
        pygame.event.post(pygame.event.Event(pygame.QUIT))
        for _ in range(3):
            worlds.step(worlds.actions)
        assert pygame.display.get_surface() is None
        assert worlds.simulation.worlds[0].step == 3


def test_copies_do_not_share_a_window():
    with hedon.make(CONFIG, render_mode="human") as worlds:
        worlds.reset()
        other = copy.deepcopy(worlds)
        other.step(other.actions)
        assert other._eye is not worlds._eye


def test_one_agent_is_shown_too():
    env = hedon.env.AgentEnv(CONFIG, "agent", render_mode="human")
    env.reset(seed=1)
    assert env.render() is None
    assert len(np.unique(shown())) > 10
    env.close()


def test_without_pygame_it_says_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "pygame", None)
    worlds = hedon.make(CONFIG, render_mode="human")
    with pytest.raises(hedon.ArgumentError, match=r'needs pygame: pip install "hedon\[window\]"'):
        worlds.reset()
