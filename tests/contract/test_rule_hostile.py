"""Faulty Python rules: each is refused in one line or stops its world."""

import os

import pytest
from worlds import CHILDLESS, DEATHLESS, QUICK, make_simulation

from hedon import EngineError, Simulation, load_config
from hedon.experiment.rule import RuleError

numba = pytest.importorskip("numba", reason='needs the optional package: pip install "hedon[rules]"')

QUIET = (
    *QUICK,
    *DEATHLESS,
    *CHILDLESS,
    "population.capacity=10",
    "population.initial_count=5",
    "genome.neutral_count=0",
)


def make(path, text, name="rule"):
    path.write_text(text)
    return make_simulation(*QUIET, f'reward.rule="{path}:{name}"')


REFUSED = {
    "syntax": ("def rule(agent:\n    return 1\n", r"its file fails at line 1: SyntaxError: '\(' was never closed"),
    "name": (
        "def rule(agent):\n    return 1 + oops\n",
        "Numba cannot compile it: NameError: name 'oops' is not defined",
    ),
    "at once": ("1 / 0\n", "its file fails at line 1: ZeroDivisionError"),
    "no exception": ("class Odd(BaseException):\n    pass\nraise Odd('x')\n", r"its file fails at line 3: Odd\('x'\)"),
    "compiled": (
        "def rule(agent):\n    if agent.age > 1.0:\n        raise SystemExit\n    return 1.0\n",
        "Numba cannot compile line 3: Encountered unsupported constant type used for exception",
    ),
    "end of a generator": ("raise GeneratorExit\n", "its file fails at line 1: GeneratorExit"),
    "exit": ("import sys\nsys.exit(0)\n", "its file fails at line 2: SystemExit"),
    "import": (
        "import no_such_module\ndef rule(agent):\n    return 1.0\n",
        "its file fails at line 1: ModuleNotFoundError",
    ),
    "number": ("rule = 3.0\n", "rule is 3.0: a rule is a function"),
    "class": ("class rule:\n    pass\n", "rule is <class .*>: a rule is a function"),
    "builtin": ("from math import sin as rule\n", "rule is <built-in function sin>: a rule is a function"),
    "empty": ("", "has no function rule"),
    "two": ("def rule(agent, world):\n    return 1.0\n", r"a rule takes one agent, but this is rule\(agent, world\)"),
    "none": ("def rule():\n    return 1.0\n", r"a rule takes one agent, but this is rule\(\)"),
    "nothing": ("def rule(agent):\n    pass\n", "it returns none: a rule returns one number"),
    "complex": ("def rule(agent):\n    return agent.energy + 1j\n", "it returns complex128: a rule returns one number"),
    "generator": ("def rule(agent):\n    yield 1.0\n", "it returns float64 generator.*: a rule returns one number"),
    "coroutine": ("async def rule(agent):\n    return 1.0\n", "rule must be a plain function"),
    "counter": (
        "n = 0\ndef rule(agent):\n    global n\n    n += 1\n    return n\n",
        r"Numba cannot compile line 4: Use of unsupported opcode \(STORE_GLOBAL\)",
    ),
    "file": (
        "def rule(agent):\n    return float(len(open('/etc/hosts').read()))\n",
        "line 2: it reads a file, which no run keeps",
    ),
    "a text": (
        "def rule(agent):\n    x = 1\n    return agent.energy + 'a'\n",
        r"Numba cannot compile line 3: No implementation of .* add\(float64, Literal\[str\]\(a\)\)",
    ),
    "energy": (
        "def rule(agent):\n    agent.energy = 1\n    return 1.0\n",
        r"line 2: it writes agent\.energy.*agent\.memory_1",
    ),
    "energy added": ("def rule(a):\n    a.energy += 1\n    return 1.0\n", r"line 2: it writes agent\.energy"),
    "energy elsewhere": (
        "import numba\n@numba.njit\ndef eat(a):\n    a.energy = 1\ndef rule(agent):\n    eat(agent)\n    return 1.0\n",
        r"line 4: it writes agent\.energy",
    ),
    "numpy's chance": (
        "import numpy as np\ndef rule(agent):\n    return np.random.rand()\n",
        r"line 3: numpy\.random.* is chance.* returns a probability",
    ),
    "chance": (
        "from random import gauss as g\ndef rule(agent):\n    return g(0, 1)\n",
        r"line 3: random\.gauss is chance",
    ),
    "chance elsewhere": (
        "import random\nimport numba\n@numba.njit\ndef draw():\n    return random.random()\n"
        "def rule(agent):\n    return draw()\n",
        r"line 5: random.* is chance",
    ),
    "energy by its name": (
        "def rule(agent):\n    agent['energy'] = 1\n    return 1.0\n",
        r"line 2: it writes agent\.energy",
    ),
    "energy by another name": (
        "import numba\n@numba.njit\ndef eat(share, a):\n    b = a\n    b.energy = share\n"
        "def rule(agent):\n    eat(1.0, agent)\n    return 1.0\n",
        r"line 5: it writes agent\.energy",
    ),
    "table without a seed": (
        "import numpy as np\nTABLE = np.random.default_rng().normal(size=3)\ndef rule(agent):\n    return TABLE[0]\n",
        r"line 2: numpy\.random.* is chance",
    ),
    "time": ("import time\ndef rule(agent):\n    return time.time()\n", r"line 3: time\.time is the time.*agent\.step"),
    "null": ("def rule(agent):\n    return 1.0\n\0", "its file fails"),
}


@pytest.mark.parametrize(("text", "says"), REFUSED.values(), ids=REFUSED)
def test_an_invalid_rule_is_refused_in_one_line(tmp_path, text, says):
    with pytest.raises(RuleError, match=says) as caught:
        make(tmp_path / "r.py", text)
    assert "\n" not in str(caught.value)
    assert len(str(caught.value)) < 400


def test_an_unusable_file_is_refused(tmp_path):
    for path, says in (
        (tmp_path / "gone.py", "cannot read .*gone.py: No such file"),
        (tmp_path / "folder.py", "it is no plain file"),
        (tmp_path / "pipe.py", "it is no plain file"),
        (tmp_path / "bytes.py", "cannot read .*bytes.py: 'utf-8'"),
        (tmp_path / "big.py", "too large for a rule"),
    ):
        (tmp_path / "folder.py").mkdir(exist_ok=True)
        (tmp_path / "bytes.py").write_bytes(b"\xff\xfe")
        (tmp_path / "big.py").write_bytes(b"#" * 1_000_001)
        if not (tmp_path / "pipe.py").exists():
            os.mkfifo(tmp_path / "pipe.py")
        with pytest.raises(RuleError, match=says):
            make_simulation(*QUIET, f'reward.rule="{path}:rule"')


def test_the_error_for_a_missing_relative_file_names_the_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(RuleError, match=rf"cannot read {tmp_path}/my\.py: No such file"):
        make_simulation(*QUIET, 'reward.rule="my.py:rule"')
    config = load_config("baseline", overrides=QUIET)
    with pytest.raises(RuleError, match=rf"cannot read my\.py in {tmp_path}: No such file"):
        Simulation(config.with_("reward.rule", "my.py:rule"), [1])


STOPS = {
    "outside": "import numpy as np\ndef rule(agent):\n    return np.zeros(3)[int(agent.age) + 1]\n",
    "helper": (
        "import numba\nimport numpy as np\n@numba.njit\ndef at(i):\n    return np.zeros(3)[i]\n"
        "def rule(agent):\n    return at(int(agent.age) + 1)\n"
    ),
    "raise": "def rule(agent):\n    if agent.age > 1.0:\n        raise ValueError('old')\n    return 1.0\n",
    "infinite": "def rule(agent):\n    return 1.0 / (agent.age - 2.0)\n",
}


@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
@pytest.mark.parametrize("text", STOPS.values(), ids=STOPS)
def test_a_rule_that_fails_stops_the_world_in_that_step(tmp_path, text):
    simulation = make(tmp_path / "r.py", text)
    with pytest.raises(EngineError, match=r"rule_not_finite: .* step 1, "):
        simulation.run(5)


def test_indices_of_other_programs_are_checked_as_before(tmp_path):
    before = numba.core.config.BOUNDSCHECK
    make(tmp_path / "r.py", STOPS["outside"])
    assert before == numba.core.config.BOUNDSCHECK


WORKS = {
    "allocates": "import numpy as np\ndef rule(agent):\n    return np.full(1000, agent.age).sum() / 1000.0\n",
    "global": "scale = 1.0\ndef rule(agent):\n    return scale * agent.age\nscale = 1.0\n",
    "closure": "def make(k):\n    def own(agent):\n        return k * agent.age\n    return own\nrule = make(1.0)\n",
    "lambda": "rule = lambda agent: agent.age\n",
    "compiled": "import numba\n@numba.njit\ndef rule(agent):\n    return agent.age\n",
    "default": "def rule(agent, k=1.0):\n    return k * agent.age\n",
    "chance of another rule": (
        "import random\ndef rule(agent):\n    return agent.age\ndef other(agent):\n    return random.random()\n"
    ),
    "chance of another rule with an equal local": (
        "import random\ndef rule(agent):\n    x = agent.age\n    return x\n"
        "def other(agent):\n    x = random.random()\n    return x\n"
    ),
    "table from a seed": (
        "import numpy as np\nTABLE = np.random.default_rng(3).normal(size=3)\n"
        "def rule(agent):\n    return 0.0 * TABLE[0] + agent.age\n"
    ),
    "whole": "def rule(agent):\n    return int(agent.age)\n",
}


@pytest.mark.parametrize("text", WORKS.values(), ids=WORKS)
def test_rules_that_numba_can_compile_pay(tmp_path, text):
    """Each pays an agent its age."""
    simulation = make(tmp_path / "r.py", text)
    simulation.run(4)
    assert set(simulation.worlds[0].agents()["reward"]) == {1.0 + 2.0 + 3.0 + 4.0}


def test_a_rule_that_allocates_frees_its_memory(tmp_path):
    import resource

    simulation = make(tmp_path / "r.py", WORKS["allocates"].replace("1000", "100000"))
    simulation.run(20)
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    simulation.run(200)
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 50_000  # of 800 MB allocated in total [KiB]
