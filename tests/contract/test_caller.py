"""How the calling process and a simulation affect each other: floating-point modes, forks, Ctrl-C."""

import ctypes
import hashlib
import multiprocessing
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np
import pytest
from worlds import QUICK, make_engine, make_simulation, set_scene

from hedon import _engine
from hedon.config.engine import engine_input
from hedon.config.load import load_config
from hedon.error import EngineError

LIVELY = (*QUICK, "birth.kappa=0.02", "hazard.kappa=0.2")
STEPS = 150  # two windows of 64 steps and a remainder
MXCSR = 28  # offset of the SSE control register in glibc's fenv_t on x86-64 [byte]
ROUNDING = {"down": 0x2000, "up": 0x4000, "to zero": 0x6000}
FLUSHING = {"flush to zero": 0x8000, "denormals are zero": 0x0040}
TRAPS = {"exceptions unmasked": 0x0E00}  # the bits that mask division by zero, overflow and underflow, inverted below

libm = ctypes.CDLL("libm.so.6")
needs_sse = pytest.mark.skipif(os.uname().machine != "x86_64", reason="the control register is that of x86-64")


def control_register() -> int:
    environment = ctypes.create_string_buffer(64)
    libm.fegetenv(environment)
    return int.from_bytes(environment.raw[MXCSR : MXCSR + 4], "little")


def set_control_register(bits: int) -> None:
    environment = ctypes.create_string_buffer(64)
    libm.fegetenv(environment)
    environment[MXCSR : MXCSR + 4] = bits.to_bytes(4, "little")
    libm.fesetenv(environment)


@contextmanager
def control(bits: int) -> Iterator[None]:
    before = control_register()
    set_control_register(before ^ bits)
    try:
        yield
        assert (control_register() ^ before ^ bits) & ~0x3F == 0, "the caller's mode changed by more than sticky flags"
    finally:
        set_control_register(before)


def life(threads: int) -> list[str]:
    """Digests after each operation on a simulation: creating, running, saving and restoring it, setting a scene."""
    simulation = make_simulation(*LIVELY, preset="relocation", threads=threads)
    world = simulation.worlds[0]
    digests = [world.digest()]
    simulation.run(STEPS)
    digests.append(world.digest())
    digests.append(hashlib.sha256(world.observations().tobytes()).hexdigest())
    saved = simulation.engine.save(0)
    other = make_simulation(*LIVELY, preset="relocation", threads=threads)
    other.engine.restore(0, saved)
    digests.append(other.worlds[0].digest())
    set_scene(other, [(100.125, 100.75, 0.25), (121.25, 100.25, 1.125)], [(140.75, 100.25)])
    other.run(10)
    return [*digests, other.worlds[0].digest()]


@needs_sse
@pytest.mark.parametrize("mode", [*ROUNDING, *FLUSHING, *TRAPS])
def test_the_callers_floating_point_mode_changes_no_bit_and_is_restored(mode):
    plain = life(1)
    bits = {**ROUNDING, **FLUSHING, **TRAPS}[mode]
    for threads in (1, 2):
        with control(bits):
            assert life(threads) == plain


@needs_sse
def test_the_test_above_would_detect_a_mode():
    """One third rounds to different float32 values in different modes, so a missing guard would show."""
    with control(ROUNDING["down"]):
        down = np.float32(1.0) / np.float32(3.0)
    assert down != np.float32(1.0) / np.float32(3.0)


def test_denormals_change_no_bit():
    """Adam's moments decay below the range of float32; with this many epochs, they do so within three windows."""
    settings = (
        "world.rollout_steps=64",
        "learning.minibatch_size=16",
        "learning.update_epochs=80",
        "population.capacity=6",
        "population.initial_count=6",
        "hazard.kappa=0",
        "hazard.alpha_age=0",
        "birth.kappa=0",
    )
    flushed, kept = (make_engine(*settings, flush_denormals=flush) for flush in (True, False))
    for engine in (flushed, kept):
        engine.run(4 * 64)
    moments = flushed.view(0, "first_moment")
    assert ((moments == 0) & (flushed.view(0, "second_moment") > 0)).any(), "no moment decayed to zero"
    for name in ("first_moment", "second_moment"):
        size = np.abs(kept.view(0, name))
        assert size[size > 0].min() > 1e-30
    assert flushed.digest(0) == kept.digest(0)


@pytest.mark.long
@pytest.mark.parametrize("preset", ["baseline", "small", "poison"])
@pytest.mark.parametrize("kernel", _engine.kernel.kernel_names())
def test_denormals_change_no_bit_over_twenty_windows(preset, kernel):
    """Long enough for moments to decay with the settings of the paper; AVX2 and AVX-512 also agree there."""
    given = engine_input(load_config(preset))
    digests = set()
    for flush, name in [(True, kernel), (False, kernel), (True, "avx2" if kernel == "avx512" else kernel)]:
        engine = _engine.Simulation(given.settings, given.walls, given.outer_walls, [1], 2, name, [], flush)
        engine.run(20 * 1024 + 100)
        digests.add(engine.digest(0))
    assert len(digests) == 1


def in_child(report, work) -> None:
    """Runs in a forked process: reports how `work` ended, then exits normally."""
    try:
        work()
        report.put("went through")
    except Exception as error:
        report.put(f"{type(error).__name__}: {error}")


@pytest.mark.parametrize("threads", [1, 2, 3])
@pytest.mark.filterwarnings("ignore:.*multi-threaded.*:DeprecationWarning")
def test_a_forked_child_gets_a_clear_error_and_exits(threads):
    context = multiprocessing.get_context("fork")
    simulation = make_simulation(*LIVELY, threads=threads)
    simulation.run(10)
    report = context.Queue()
    uses = [
        lambda: simulation.run(1),
        lambda: simulation.worlds[0].digest(),
        lambda: simulation.worlds[0].agents(),
        lambda: simulation.worlds[0].view("genome"),
        lambda: simulation.engine.restore(0, {}),
    ]
    for use in uses:
        child = context.Process(target=in_child, args=(report, use))
        child.start()
        said = report.get(timeout=20)
        child.join(timeout=20)
        assert not child.is_alive(), "the child hangs on exit"
        assert child.exitcode == 0
        assert said.startswith("EngineError: this process was forked")
    simulation.run(10)  # the parent's simulation is unaffected
    assert simulation.worlds[0].step == 20


FORK_AND_DELETE = """
import os, sys
sys.path.insert(0, "tests")
from worlds import make_simulation
simulation = make_simulation(threads=2)
simulation.run(5)
child = os.fork()
if child == 0:
    del simulation  # the last reference: its memory is given back here
    own = make_simulation(threads=2)  # and a new one works
    own.run(5)
    sys.exit(7)
print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))
"""


def test_a_forked_child_can_drop_the_simulation_and_make_its_own():
    done = subprocess.run(
        [sys.executable, "-c", FORK_AND_DELETE], capture_output=True, text=True, timeout=60, check=True
    )
    assert done.stdout.strip() == "7"


@pytest.fixture
def ctrl_c() -> Iterator[None]:
    """Python's default Ctrl-C handler, even if the tests run in the background, where Ctrl-C is ignored."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.mark.usefixtures("ctrl_c")
def test_ctrl_c_interrupts_a_simulation_and_its_state_is_kept():
    simulation = make_simulation("learning.update_epochs=0", threads=1)
    simulation.run(300)
    pressed = threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT))
    begun = time.monotonic()
    pressed.start()
    with pytest.raises(KeyboardInterrupt):
        simulation.run(10_000_000)
    heard = time.monotonic() - begun - 0.5
    step = simulation.worlds[0].step
    assert 300 < step < 10_000_000
    assert heard < 2.0, "it takes 0.3 s on an idle machine"
    simulation.run(77)
    assert simulation.worlds[0].step == step + 77
    other = make_simulation("learning.update_epochs=0", threads=1)
    other.run(step + 77)
    assert other.worlds[0].digest() == simulation.worlds[0].digest()


def test_a_callers_signal_handler_is_called_during_a_run():
    simulation = make_simulation("learning.update_epochs=0", threads=1)
    heard = []
    before = signal.signal(signal.SIGUSR1, lambda *_: heard.append(time.monotonic()))
    try:
        threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGUSR1)).start()
        simulation.run(15_000)
        assert heard
        assert time.monotonic() - heard[0] > 0.2, "the handler was not called until the end of the run"
    finally:
        signal.signal(signal.SIGUSR1, before)


def test_negative_steps_are_refused():
    with pytest.raises(EngineError, match="steps = -1"):
        make_engine().run(-1)
