"""A user's program, checked by mypy and pyright with the types of the installed package (`py.typed`)."""

import subprocess
import sys
from pathlib import Path

import pytest

PROGRAM = """
import hedon
import hedon.callback
import hedon.env
from hedon.analysis import WorldRecord, read_worlds
from hedon.figure import save_figure

config = hedon.load_config("baseline", overrides=["population.capacity=40"])
simulation = hedon.Simulation(config, seeds=[1])
alive: int = simulation.worlds[0].alive


def tell(moment: hedon.Moment) -> None:
    print(moment.step)


plan = hedon.RunPlan(config, seeds=(1,), steps=10, out="runs/mine")
manifest = hedon.run(plan, callbacks=[tell, hedon.callback.TensorBoard("runs/mine")])
seeds: tuple[int, ...] = manifest.seeds
worlds: list[WorldRecord] = read_worlds([hedon.open_run("runs/mine")])
envs = hedon.env.SlotVectorEnv(hedon.make("baseline", worlds=2))
observations, infos = envs.reset(seed=1)
print(observations.shape, alive, seeds, worlds[0].seed, save_figure)
"""
WRONG = "steps: str = plan.steps\n"


@pytest.mark.parametrize("checker", [("mypy", "--strict"), ("pyright",)], ids=lambda words: words[0])
def test_types_of_a_program_are_known(checker: tuple[str, ...], tmp_path: Path) -> None:
    pytest.importorskip(checker[0])
    for name, text in {"right.py": PROGRAM, "wrong.py": PROGRAM + WRONG}.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    done = {
        name: subprocess.run(
            [sys.executable, "-m", *checker, name], cwd=tmp_path, capture_output=True, text=True, check=False
        )
        for name in ("right.py", "wrong.py")
    }
    assert done["right.py"].returncode == 0, done["right.py"].stdout
    assert done["wrong.py"].returncode == 1
    assert "wrong.py" in done["wrong.py"].stdout
