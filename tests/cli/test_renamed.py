"""Names of earlier versions: commands and options are refused with their new names, records are read."""

import json
import shutil
from pathlib import Path

import pytest
from command import hedon
from resumed_run import small_run

from hedon.record.earlier import with_names
from hedon.record.manifest import load_manifest


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


@pytest.mark.parametrize("content", [b"[]", b'"kernel"', b'{"kernel": 1, "sessions": 3}', b'{"sessions": ["kernel"]}'])
def test_what_is_no_manifest_is_left_to_its_reader(content):
    assert isinstance(json.loads(with_names(content)), type(json.loads(content)))


def test_a_manifest_of_an_earlier_version_says_what_computed(tmp_path: Path):
    manifest = small_run(tmp_path / "run", 32, overrides=("world.rollout_steps=32", "learning.minibatch_size=16"))
    old = json.loads((tmp_path / "run" / "manifest.json").read_text())
    for each in (old, *old["sessions"]):
        each["kernel"] = each.pop("backend")
    shutil.copytree(tmp_path / "run", tmp_path / "old")
    (tmp_path / "old" / "manifest.json").write_text(json.dumps(old))
    assert load_manifest(tmp_path / "old") == manifest
