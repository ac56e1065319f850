"""Commands, options and variables of earlier versions are refused with a message that gives the new name."""

import pytest
from command import hedon


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("demography", "baseline"), "there is no command 'demography': it is `hedon forecast` now"),
        (("assay", "start", "baseline"), "there is no command 'assay start': it is `hedon assay stability` now"),
        (("run", "baseline", "--device", "cuda"), "there is no option --device: it is --backend now"),
        (("run", "baseline", "--device=cuda"), "there is no option --device: it is --backend now"),
    ],
)
def test_a_name_of_an_earlier_version_is_refused_with_the_new_one(words, said):
    answer = hedon(*words)
    assert (answer.returncode, answer.stderr) == (2, f"hedon: {said}\n")


def test_a_variable_of_an_earlier_version_is_refused_with_the_new_one(monkeypatch, tmp_path):
    monkeypatch.setenv("HEDON_KERNEL", "portable")
    answer = hedon("run", "baseline", "--steps", "1", "--out", str(tmp_path / "run"))
    assert (answer.returncode, answer.stderr) == (2, "hedon: HEDON_KERNEL: this variable is HEDON_BACKEND now\n")
