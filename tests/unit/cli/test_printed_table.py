"""Tables on terminals of any width: nothing is cut, no line is too long, numbers are whole."""

import io

import pytest
from rich.console import Console

from hedon.cli.console import make_console
from hedon.cli.display.run import RunDisplay
from hedon.cli.display.table import PrintedTable
from hedon.experiment.plan import Moment
from hedon.record.schema import Columns

HEADERS = ("item", "what it is", "steps of a world", "95 % interval", "needs")
ROWS = [
    (
        "weights-baseline",
        "Weights that evolve in the baseline",
        "10,240,000",
        "-0.04 … 0.08",
        "1 setting, 5 worlds",
    ),
    ("walk", "The random walk of mutations", "64", "0.00 … 0.00", "settings [alone]"),
]


def printed(width: int, table: PrintedTable) -> list[str]:
    console = Console(width=width, file=io.StringIO(), color_system=None, force_terminal=True)
    console.print(table)
    assert isinstance(console.file, io.StringIO)
    return console.file.getvalue().splitlines()


def words(lines: list[str]) -> str:
    return " ".join(" ".join(lines).split())


@pytest.mark.parametrize("width", [40, 60, 80, 120, 200])
def test_no_line_is_longer_than_the_terminal_and_nothing_is_lost(width: int) -> None:
    lines = printed(width, PrintedTable(HEADERS, ROWS, title="What there is", text=(0, 1, 4)))
    assert max(map(len, lines)) <= width
    text = words(lines)
    for row in ROWS:
        assert all(word in text for cell in row for word in cell.split())
    assert all(row[i] in text for row in ROWS for i in (2, 3))  # numbers are whole


def test_a_terminal_narrower_than_a_word_breaks_it() -> None:
    assert max(map(len, printed(20, PrintedTable(HEADERS, ROWS, text=(0, 1, 4))))) <= 20


def test_settings_that_are_numbers_tell_rows_apart_in_every_part() -> None:
    settings = [["0.1", "1"], ["0.1", "2"], ["0.2", "1"], ["0.2", "2"]]
    rows = [[*pair, *[f"{i}{j:07}" for j in range(9)]] for i, pair in enumerate(settings)]
    lines = printed(60, PrintedTable(["energy.basic_cost", "seeds", *(f"c{j}" for j in range(9))], rows))
    heads = [line.split()[:2] for line in lines if "seeds" in line]
    assert len(heads) > 1
    assert heads == [["energy.basic_cost", "seeds"]] * len(heads)
    for pair in settings:
        assert len([line for line in lines if line.split()[:2] == pair]) == len(heads)


@pytest.mark.parametrize("last", ["x", "y"], ids=["not told apart", "told apart"])
def test_texts_are_repeated_however_many_there_are(last: str) -> None:
    rows = [["a", "b", "x", "1" * 30, "2" * 30], ["a", "b", last, "3" * 30, "4" * 30]]
    lines = printed(50, PrintedTable(["one", "two", "three", "c", "d"], rows, text=(0, 1, 2)))
    heads = [line.split()[:3] for line in lines if "two" in line]
    assert heads == [["one", "two", "three"]] * 2


def test_columns_that_do_not_fit_are_continued_with_the_first_one() -> None:
    numbers = [[str(seed), *[f"{seed}{i:07}" for i in range(12)]] for seed in (1, 2)]
    lines = printed(60, PrintedTable(["seed", *(f"c{i}" for i in range(12))], numbers))
    heads = [line.split() for line in lines if "seed" in line]
    assert len(heads) > 1
    assert all(head[0] == "seed" for head in heads)
    assert [name for head in heads for name in head[1:]] == [f"c{i}" for i in range(12)]
    assert len([line for line in lines if line.split()[:1] == ["2"]]) == len(heads)


def test_the_columns_that_tell_rows_apart_are_repeated() -> None:
    rows = [[kind, weight, "x" * 20, "1" * 20] for kind in ("children", "lifespan") for weight in ("w_a", "w_b")]
    lines = printed(40, PrintedTable(["fitness", "weight", "remark", "value"], rows, text=(0, 1, 2)))
    assert len([line for line in lines if line.split()[:2] == ["children", "w_b"]]) == 2


def test_a_table_that_fits_is_whole_and_as_narrow_as_possible() -> None:
    lines = printed(120, PrintedTable(("a", "b"), [("x", "1"), ("together",)], total=True))
    assert [line.rstrip() for line in lines if line.strip(" ─")] == [" a          b", " x          1", " together"]
    assert len([line for line in lines if "─" in line or not line.strip()]) == 4  # top, below the head, total, bottom


def test_a_table_without_rows_has_its_head() -> None:
    assert "seed" in words(printed(60, PrintedTable(("seed", "alive"), [])))


def test_the_display_of_a_run_fits_and_names_extinct_worlds() -> None:
    row = dict.fromkeys(("alive", "births", "deaths"), 12) | {"energy_mean": 1.5, "generation_mean": 2.0}
    row |= {"eaten_normal": 3} | dict.fromkeys(("w_normal_mean", "w_action_mean", "neutral_1_mean"), 0.25)
    console = Console(width=60, file=io.StringIO(), force_terminal=True, color_system=None)
    display = RunDisplay(console, Columns(("normal",), 1), (1, 2))
    moment = Moment(first=0, step=2048, steps=4096, seconds=1.0, rows=(row, row), extinct=(None, 1500), window=1024)
    with display:
        display.update(moment)
    assert isinstance(console.file, io.StringIO)
    text = console.file.getvalue()
    assert "+0.250" in text
    assert "generation" in text
    assert "Seed 2 died out at step 1,500." in text


def test_in_a_file_each_row_is_one_line(capsys: pytest.CaptureFixture[str]) -> None:
    label = "baseline (corrected): energy.basic_cost 0.002, food.normal.growth_rate 3"
    headers = ("condition", "gene", *(f"measure of column {i}" for i in range(12)))
    rows = [(label, gene, *(f"{i / 7:.6f}" for i in range(12))) for gene in ("w_normal", "w_action")]
    make_console().print(PrintedTable(headers, rows, text=(0, 1)))
    head, _, *lines = [line for line in capsys.readouterr().out.splitlines() if line.strip()]
    assert [name.strip() for name in head.split("   ") if name.strip()] == list(headers)
    assert [line.split() for line in lines] == [" ".join(row).split() for row in rows]


def test_a_terminal_shows_a_long_label_once() -> None:
    long = "predator (corrected): prey"
    rows = [(long, "w_normal", "1"), (long, "w_action", "2"), ("short", "w_normal", "3"), ("short", "w_action", "4")]
    lines = printed(80, PrintedTable(("condition", "gene", "mean"), rows, text=(0, 1)))
    assert sum(long in line for line in lines) == 1
    assert sum("short" in line for line in lines) == 2
