"""How the interpreter and the system affect a simulation's threads: exits, sub-interpreters, thread limits."""

import importlib.util
import subprocess
import sys

import pytest

DAEMON = """
import sys, threading, time
sys.path.insert(0, "tests")
from worlds import make_simulation

simulation = make_simulation("learning.update_epochs=0", threads={threads})

class Slow:  # goes with the modules: the thread asks for the interpreter meanwhile
    sleep = staticmethod(time.sleep)
    def __del__(self):
        self.sleep(0.5)

def work():
    while True:
        simulation.run({steps})

threading.Thread(target=work, daemon=True).start()
time.sleep(0.2)
sys.modules["slow"] = Slow()
print("left")
"""


@pytest.mark.parametrize("steps", [1, 10**9])
@pytest.mark.parametrize("threads", [1, 2])
def test_a_program_exits_while_a_daemon_thread_runs(threads, steps):
    code = DAEMON.format(threads=threads, steps=steps)
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60)
    assert (done.returncode, done.stdout.strip(), done.stderr) == (0, "left", "")


INTERPRETER = """
import {module} as interpreters
made = interpreters.create()
try:
    told = interpreters.{run}(made, "import hedon; hedon.Simulation(hedon.load_config('baseline'), [1]).run(1)")
    print(told)
except Exception as error:
    print(error)
"""


def test_a_sub_interpreter_is_refused():
    names = {"_xxsubinterpreters": "run_string", "_interpreters": "run_string"}
    module = next((name for name in names if importlib.util.find_spec(name)), None)
    if module is None:
        pytest.skip("this Python has no module for sub-interpreters")
    code = INTERPRETER.format(module=module, run=names[module])
    done = subprocess.run([sys.executable, "-W", "ignore", "-c", code], capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr
    assert "hedon's engine cannot be used in a sub-interpreter of Python" in done.stdout


LIMITED = """
import gc, os, resource, sys
sys.path.insert(0, "tests")
from worlds import make_simulation
from hedon import EngineError

make_simulation(threads=1).run(1)
def addresses():
    return int(open("/proc/self/statm").read().split()[0]) * resource.getpagesize()

def threads():
    return len(os.listdir("/proc/self/task"))

before = threads()
limit = addresses() + 2_000_000_000
resource.setrlimit(resource.RLIMIT_AS, (limit, resource.RLIM_INFINITY))
for _ in range(5):
    try:
        make_simulation(threads=1000)
    except EngineError as error:
        print(error)
    gc.collect()
    assert threads() == before, "threads that began are joined"
resource.setrlimit(resource.RLIMIT_AS, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))
assert addresses() < limit - 1_500_000_000, "what was reserved is given back"
simulation = make_simulation(threads=2)
simulation.run(10)
print(simulation.worlds[0].step)
"""


def test_running_out_of_threads_gives_one_error_and_leaves_nothing_behind():
    done = subprocess.run([sys.executable, "-c", LIMITED], capture_output=True, text=True, timeout=60)
    assert (done.returncode, done.stderr) == (0, "")
    *said, last = done.stdout.splitlines()
    advice = "use fewer, or check the limits `ulimit -u` and `ulimit -v`"
    assert said == [f"the system gives no 1000 threads: {advice}"] * 5
    assert last == "10"
