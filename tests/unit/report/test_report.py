import io
import re
from collections import Counter
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest
from synthetic_run import write_run

from hedon.error import ArgumentError
from hedon.record.error import RecordError
from hedon.record.reader import open_run
from hedon.report.run import write_report

FIGURES = ["history", "world", "weights", "population", "regime", "survival", "selection", "lineage", "demography"]
SVG = "{http://www.w3.org/2000/svg}"
NAMES = ["summary.json", "report.html", "report.md", "analysis.json", *(f"{name}.svg" for name in FIGURES)]


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize(
    "options",
    [
        pytest.param({"intervals": 30, "worlds": 3}, id="usual", marks=pytest.mark.long),
        pytest.param({"intervals": 12, "worlds": 1, "extinct": 0}, id="all extinct", marks=pytest.mark.long),
        pytest.param({"intervals": 1, "worlds": 1}, id="one window", marks=pytest.mark.long),
        pytest.param({"intervals": 0, "worlds": 1}, id="no window"),
        pytest.param(
            {"intervals": 5, "worlds": 3, "extinct": 0, "food_kinds": ("normal", "poor", "poison"), "neutral_count": 3},
            id="three kinds, one extinct",
        ),
        pytest.param({"intervals": 2, "worlds": 12, "neutral_count": 0}, id="many, 0 neutral", marks=pytest.mark.long),
    ],
)
def test_every_run_has_a_report(tmp_path: Path, options: dict) -> None:
    files = write_report(open_run(write_run(tmp_path / "run", **options)))
    assert [file.name for file in files] == NAMES
    for file in files[4:]:
        drawing = ElementTree.parse(file).getroot()
        assert float(drawing.attrib["height"].removesuffix("pt")) > 100
        marks = sum(1 for kind in ("path", "use") for _ in drawing.iter(f"{SVG}{kind}"))
        assert marks >= 20, "lines and letters"
        assert len(set(re.findall(r"#[0-9a-f]{6}", file.read_text()))) >= 1, "colors"


def test_without_figures_a_report_has_all_numbers(tmp_path: Path) -> None:
    folder = write_run(tmp_path / "run", intervals=3, worlds=2)
    with_figures = write_report(open_run(folder))
    numbers = [(folder / "analysis" / "analysis.json").read_bytes(), (folder / "summary.json").read_bytes()]
    files = write_report(open_run(folder), folder=tmp_path / "lean", figures="none")
    assert [file.name for file in files] == NAMES[:4]
    assert [(tmp_path / "lean" / "analysis" / "analysis.json").read_bytes(), files[0].read_bytes()] == numbers
    assert "<figure>" in with_figures[1].read_text()
    assert "<figure>" not in files[1].read_text()


def test_a_report_can_be_rewritten(tmp_path: Path) -> None:
    folder = write_run(tmp_path / "run", intervals=0, worlds=1, snapshot=False)
    assert [file.name for file in write_report(open_run(folder))] == [name for name in NAMES if name != "world.svg"]
    before = (folder / "summary.json").read_text()
    write_report(open_run(folder))
    assert (folder / "summary.json").read_text() == before


def test_a_report_that_cannot_be_written_says_so(tmp_path: Path) -> None:
    folder = write_run(tmp_path / "run", intervals=1, worlds=1)
    (folder / "figures").touch()
    with pytest.raises(RecordError, match="cannot write the report"):
        write_report(open_run(folder))


@pytest.mark.smoke
def test_a_report_reads_each_file_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = write_run(tmp_path / "run", intervals=2, worlds=3)
    read: Counter[str] = Counter()
    original = io.open

    def count(file: Any, *options: Any, **named: Any) -> Any:
        if not isinstance(file, int) and Path(file).is_relative_to(folder):
            read[Path(file).relative_to(folder).as_posix()] += 1
        return original(file, *options, **named)

    monkeypatch.setattr("io.open", count)
    monkeypatch.setattr("builtins.open", count)
    write_report(open_run(folder))
    records = {name: times for name, times in read.items() if name.endswith((".parquet", ".toml"))}
    parts = {f"{table}/part-000000.parquet": 1 for table in ("agents", "population")}
    assert records == {**parts, "agents/living.parquet": 1, "config.toml": 1}


def test_figures_can_be_written_in_another_format_too(tmp_path: Path) -> None:
    files = write_report(open_run(write_run(tmp_path / "run", intervals=5, worlds=1)), figures="pdf")
    drawn = [path for path in files if path.parent.name == "figures"]
    stems = [{path.stem for path in drawn if path.suffix == suffix} for suffix in (".svg", ".pdf")]
    assert len(stems[0]) > 5
    assert stems[0] == stems[1]
    assert all(path.stat().st_size > 1000 for path in drawn)
    with pytest.raises(ArgumentError, match="figures = 'jpg': must be one of svg, pdf, png, none"):
        write_report(open_run(tmp_path / "run"), figures="jpg")
