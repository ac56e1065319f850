"""Studies from other packages: the one in the guide, installed in a separate folder, and ones that cannot be used."""

import json
import re
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from command import hedon as command

from hedon.study.catalogue import StudyError, choose, installed
from hedon.study.verdict import verdict

GUIDE = Path(__file__).parents[3] / "docs/guide/study.md"
Install = Callable[[str, str, str], None]


@pytest.fixture
def install(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Install]:
    """Installs a package with a module and an entry point, as pip does, where Python looks for packages."""
    place = tmp_path / "site"
    place.mkdir()
    monkeypatch.syspath_prepend(str(place))

    def installing(name: str, code: str, target: str) -> None:
        (place / f"{name}.py").write_text(code, encoding="utf-8")
        info = place / f"{name}-1.0.dist-info"
        info.mkdir()
        (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: 1.0\n", encoding="utf-8")
        (info / "entry_points.txt").write_text(f"[hedon.studies]\n{name} = {target}\n", encoding="utf-8")
        installed.cache_clear()

    yield installing
    installed.cache_clear()


def code_of_the_guide() -> str:
    blocks = re.findall(r"```python\n(.*?)```", GUIDE.read_text(encoding="utf-8"), re.DOTALL)
    return next(block for block in blocks if "STUDY = Study(" in block)


@pytest.mark.more
def test_the_study_of_the_guide_is_listed_run_and_reported(tmp_path: Path, install: Install) -> None:
    install("waste", code_of_the_guide(), "waste:STUDY")
    assert "waste: Do fewer agents live" in command("study", "list", cwd=tmp_path).stdout
    answer = command("study", "run", "waste", "--seeds", "1-3", "--steps", "1024", cwd=tmp_path)
    assert answer.returncode == 0, answer.stderr
    found = json.loads((tmp_path / "studies" / "waste" / "study.json").read_text(encoding="utf-8"))
    rows = found["tables"]["waste"]["rows"]
    assert [(row["condition"], row["seed"]) for row in rows] == [(c, s) for c in ("cheap", "dear") for s in (1, 2, 3)]
    (judged,) = (row for row in found["tables"]["verdict"]["rows"] if row["claim"] == "fewer")
    assert (judged["worlds"], judged["verdict"]) == (6, "undecided")
    assert "reach 1,024 of 512,000 steps" in judged["reason"]


def test_a_study_that_cannot_be_used_is_named_and_affects_no_other(tmp_path: Path, install: Install) -> None:
    install("broken", "import no_such_module", "broken:STUDY")
    install("other", "STUDY = 1", "other:STUDY")
    answer = command("study", "list", cwd=tmp_path)
    assert answer.returncode == 0
    assert "the study 'broken' of broken (broken:STUDY) cannot be loaded: ModuleNotFoundError: " in answer.stderr
    assert "the study 'other' of other (other:STUDY) is no hedon.study.Study of this name" in answer.stderr
    assert "fear: " in answer.stdout
    with pytest.raises(StudyError, match="cannot be loaded"):
        choose(["broken"])
    assert verdict({})[0].rows.is_empty()


def test_a_name_that_is_taken_is_left_out(install: Install) -> None:
    own = installed()[0]["fear"]
    install("fear", "from hedon.study import Study\nSTUDY = Study('fear', '', '', ())", "fear:STUDY")
    studies, faults = installed()
    assert studies["fear"] == own
    assert list(faults) == ["fear:fear"]


def test_an_item_that_two_studies_share_is_named_with_its_study(install: Install) -> None:
    code = "from hedon.study import Item, Study\nSTUDY = Study('mine', '', '', (Item('hazard', '', '', lambda i: []),))"
    install("mine", code, "mine:STUDY")
    with pytest.raises(
        StudyError, match="several studies have an item 'hazard': say kanagawa-doya-2024/hazard or mine/hazard"
    ):
        choose(["hazard"])
    assert [study.name for study in choose(["mine/hazard"])] == ["mine"]


FAILING = """
from hedon.analysis.result import make_table
from hedon.study import Claim, Condition, Item, Scale, Study

SMALL = Condition("small", overrides=("population.initial_count=4", "population.capacity=8"))


def fail(inputs):
    yield make_table("before", "Made before it fails", [{"answer": 42}])
    raise ValueError("no such bin")


def make(inputs):
    return [make_table("after", "Made all the same", [{"answer": 43}])]


def divide(world):
    return 1 / len(world.prey)


CLAIM = Claim("prey", SMALL, "They eat.", divide, "mean", "none")
ITEMS = (Item("failing", "Fails", "", fail), Item("working", "Works", "", make, (SMALL,), Scale((1,), 64)))
STUDY = Study("halves", "", "", ITEMS, claims=(CLAIM,))
"""


def test_items_and_claims_that_fail_are_shown_with_their_errors_and_the_others_are_written(
    tmp_path: Path, install: Install
) -> None:
    install("halves", FAILING, "halves:STUDY")
    answer = command("study", "run", "halves", cwd=tmp_path)
    page = tmp_path / "studies" / "halves" / "study.html"
    assert answer.returncode == 2
    assert re.search(r"failing: ValueError: no such bin \(line 10 of .*halves\.py\)", answer.stderr), answer.stderr
    failed = r"prey: its measure failed: ZeroDivisionError: division by zero \(line 18 of .*halves\.py\)"
    assert re.search(failed, answer.stderr), answer.stderr
    assert f"everything else is in {Path('studies/halves/study.html')}" in answer.stderr
    assert "Traceback" not in answer.stderr
    results = json.loads(page.with_suffix(".json").read_text(encoding="utf-8"))
    assert [bool(item["failure"]) for item in results["items"]] == [True, False]
    assert [results["tables"][name]["rows"] for name in ("before", "after")] == [[{"answer": 42}], [{"answer": 43}]]
    assert [row["verdict"] for row in results["tables"]["verdict"]["rows"]] == ["undecided"]
    assert "Failed: ValueError: no such bin" in page.read_text(encoding="utf-8")
