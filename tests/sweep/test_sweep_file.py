"""The file of a sweep: what it yields, and the messages for an invalid one."""

from pathlib import Path

import numpy as np
import pytest
from sweep_case import condition_configs

from hedon.config import ConfigError
from hedon.ensemble.plan import SweepFile
from hedon.sweep.read import read_sweep


def read(folder: Path, text: str) -> SweepFile:
    path = folder / "a.toml"
    path.write_text(text)
    return read_sweep(path)


def settings(folder: Path, text: str) -> list[dict]:
    return [condition.settings for condition in read(folder, "steps = 64\n" + text).plan.conditions]


def test_factors_are_crossed_and_reach_the_configs(tmp_path):
    found = read(
        tmp_path,
        'steps = 64\nseeds = 3\n[set]\n"birth.kappa" = 0.01\n'
        '[factor]\n"energy.initial" = [5.0, 7.0]\npreset = ["baseline", "poison"]\n',
    )
    assert [tuple(c.settings.values()) for c in found.plan.conditions] == [
        (5.0, "baseline"), (5.0, "poison"), (7.0, "baseline"), (7.0, "poison")
    ]  # fmt: skip
    assert [c.species["agent"].energy.initial for c in condition_configs(found)] == [5.0, 5.0, 7.0, 7.0]
    assert ["poison" in c.food for c in condition_configs(found)] == [False, True, False, True]
    assert {c.species["agent"].birth.kappa for c in condition_configs(found)} == {0.01}
    assert found.plan.seeds == (1, 2, 3)


def test_a_fidelity_can_be_a_factor(tmp_path):
    found = read(tmp_path, 'steps = 64\n[factor]\nfidelity = ["corrected", "released"]\n')
    assert [c.fidelity for c in condition_configs(found)] == ["corrected", "released"]


def test_zipped_factors_go_together_and_are_crossed_with_the_rest(tmp_path):
    found = settings(
        tmp_path,
        '[factor]\n"energy.initial" = [5.0, 7.0]\n"birth.kappa" = [0.1, 0.2, 0.3]\n'
        '"hazard.kappa" = [0.01, 0.02]\n[design]\nzip = [["hazard.kappa", "energy.initial"]]\n',
    )
    assert [tuple(each.values()) for each in found] == [
        (5.0, 0.1, 0.01), (5.0, 0.2, 0.01), (5.0, 0.3, 0.01), (7.0, 0.1, 0.02), (7.0, 0.2, 0.02), (7.0, 0.3, 0.02)
    ]  # fmt: skip


def test_ranges_are_evenly_spaced_also_on_a_log_scale(tmp_path):
    found = settings(
        tmp_path,
        '[factor]\n"energy.action_cost" = { log = [1e-6, 1e-4], count = 3 }\n'
        '"energy.initial" = { range = [0.0, 0.3], count = 4 }\n'
        '"population.capacity" = { range = [200, 240], count = 3 }\n',
    )
    assert sorted({each["energy.action_cost"] for each in found}) == pytest.approx([1e-6, 1e-5, 1e-4], rel=1e-11)
    assert sorted({each["energy.initial"] for each in found}) == [0.0, 0.1, 0.2, 0.3]
    assert sorted({each["population.capacity"] for each in found}) == [200, 220, 240]


@pytest.mark.parametrize("draw", ["latin", "sobol"])
def test_drawn_values_fill_their_ranges(draw, tmp_path):
    """Of 16 points, each sixteenth of each range has one; both designs guarantee it, Latin hypercubes by definition."""
    text = ('[factor]\n"energy.initial" = { range = [2.0, 6.0] }\n"energy.action_cost" = { log = [1e-6, 1e-4] }\n'
            f'"birth.kappa" = [0.1, 0.2]\n[design]\ndraw = "{draw}"\npoints = 16\n')  # fmt: skip
    found = settings(tmp_path, text)
    assert len(found) == 32
    assert found == settings(tmp_path, text)
    assert found != settings(tmp_path, text + "seed = 2\n")
    one = [each for each in found if each["birth.kappa"] == 0.1]
    shares = np.array(
        [[(e["energy.initial"] - 2) / 4, np.log(e["energy.action_cost"] / 1e-6) / np.log(100)] for e in one]
    )
    for column in shares.T:
        assert sorted(np.floor(16 * column)) == list(range(16))


def test_conditions_take_turns(tmp_path):
    text = 'steps = 64\nseeds = 5\nworlds = 2\n[factor]\n"energy.initial" = [1.0, 2.0, 3.0]\n'
    batches = list(read(tmp_path, text).plan.batches())
    for begin in (0, 3, 6):
        assert {batch.condition for batch in batches[begin : begin + 3]} == {0, 1, 2}
    assert {batch.seeds for batch in batches[:3]} == {(1, 2)}
    assert {batch.seeds for batch in batches[6:]} == {(5,)}
    assert len({batch.name for batch in batches}) == 9


WRONG = {
    "stepz = 5\nsteps = 64": "stepz: is not a part of a sweep (base, fidelity, steps, seeds, worlds, keep, set, "
    "factor, design); did you mean steps?",
    "": "steps: is missing: it must be a whole number from 1 to 2,147,483,647",
    "steps = 64\nseeds = [1, 1]": "seeds = [1, 1]: must be how many",
    'steps = 64\nkeep = ["agent"]': 'keep = "agent": must be a list of agents, population, run; did you mean agents?',
    'steps = 64\n[factor]\n"energy.initail" = [1.0]': "did you mean initial?",
    'steps = 64\nbase = "predator"\n[factor]\n"prey.energy.initial" = [1.0]': "did you mean species.prey?",
    'steps = 64\n[factor]\n"energy.initial" = [1.0, -3.0]': 'with energy.initial = -3.0: energy.initial = -3.0:',
    'steps = 64\n[factor]\npreset = ["basline"]': "did you mean baseline?",
    'steps = 64\nfidelity = "realeased"': "did you mean released?",
    'steps = 64\n[factor]\n"energy.initial" = { rang = [1, 2], count = 2 }': "energy.initial.rang: is not",
    'steps = 64\n[factor]\n"energy.initial" = { range = [2, 1], count = 2 }': "must be two finite numbers",
    'steps = 64\n[factor]\n"energy.initial" = { log = [0, 1], count = 2 }': "initial.log = [0, 1]: must be above 0",
    'steps = 64\n[factor]\n"energy.initial" = { range = [1, 2] }': "design.points: is missing",
    'steps = 64\n[design]\ndraw = "sobel"': 'design.draw = "sobel": must be one of latin, sobol; did you mean sobol?',
    'steps = 64\n[factor]\n"energy.initial" = [1.0]\n"birth.kappa" = [0.1, 0.2]\n'
    '[design]\nzip = [["energy.initial", "birth.kappa"]]': "needs equally many values",
    'steps = 64\n[factor]\n"birth.kappa" = [0.1]\n[design]\nzip = [["birth.kappa", "birth.kapa"]]': "did you mean",
    'steps = 64\n[set]\n"birth.kappa" = 0.1\n[factor]\n"birth.kappa" = [0.1]': "set.birth.kappa: is a factor too",
    'steps = 64\nbase = "poison"\n[factor]\npreset = ["baseline"]': "base: cannot be set beside the factor preset",
    'steps = 64\n[set]\n"learning.policy" = "external"': "takes actions from a program",
}  # fmt: skip


@pytest.mark.parametrize("text", WRONG, ids=range(len(WRONG)))
def test_a_wrong_file_is_refused_with_place_and_remedy(text, tmp_path):
    with pytest.raises(ConfigError) as error:
        read(tmp_path, text)
    assert WRONG[text] in str(error.value)
    assert "a.toml" in str(error.value)


def test_all_problems_are_reported_at_once(tmp_path):
    with pytest.raises(ConfigError) as error:
        read(tmp_path, 'steps = 0\nseeds = "x"\nworlds = -1\n')
    assert len(error.value.problems) == 3


def test_a_misspelled_factor_is_reported_once(tmp_path):
    with pytest.raises(ConfigError) as error:
        read(tmp_path, 'steps = 64\n[factor]\n"energy.basic_csot" = [0.1, 0.2, 0.3]\n')
    assert str(error.value).count("basic_csot") == 1
    assert "did you mean basic_cost?" in str(error.value)


def test_a_base_file_is_found_next_to_the_sweep(tmp_path):
    (tmp_path / "own.toml").write_text('preset = "small"\n[energy]\ninitial = 3.5\n')
    found = read(tmp_path, 'steps = 64\nbase = "own.toml"\n')
    assert condition_configs(found)[0].species["agent"].energy.initial == 3.5
