"""What the user sees during a run."""

import io

from rich.console import Console

from hedon.cli.display.run import RunDisplay
from hedon.experiment.plan import Moment
from hedon.record.schema import Columns

WINDOW = 1000
ROW = {"step": WINDOW, "alive": 3, "births": 0, "deaths": 0, "energy_mean": 1.0}
ROW |= {"w_normal_mean": 0.0, "w_action_mean": 0.0}


def shown(moments: list[tuple[float, int]]) -> list[str]:
    """The lines for moments (seconds, step) of a run of 100 windows."""
    stream = io.StringIO()
    display = RunDisplay(Console(file=stream), Columns(("normal",), 0), (1,))
    for seconds, step in moments:
        row = ROW | {"step": step // WINDOW * WINDOW}
        display.update(Moment(0, step, 100 * WINDOW, seconds, (row,), (None,), WINDOW))
    return stream.getvalue().splitlines()


def test_the_speed_is_averaged_over_a_whole_window_however_long_its_learning_takes():
    """The steps of a window take 5 s; its learning takes 60 s, during which no step is made."""
    moments = []
    for window in range(4):
        begun = window * 65.0
        moments += [(begun + 5.0 * i / 10, window * WINDOW + i * 100) for i in range(1, 10)]
        moments.append((begun + 65.0, (window + 1) * WINDOW))
    lines = shown(moments)
    assert "the speed is known after a window of 1,000 steps" in lines[0]
    later = [line for line in lines if "steps/s" in line]
    assert later
    speeds = [float(line.split(" steps/s")[0].split()[-1]) for line in later]
    assert all(10 <= speed <= 30 for speed in speeds), "1000 steps in 65 s are 15 steps/s"
    assert not any("0 steps/s" in line.split()[4] for line in later)


def test_the_speed_follows_the_last_seconds_if_windows_are_short():
    moments = [(float(i), i * WINDOW) for i in range(1, 30)] + [(29 + i / 10, (29 + i) * WINDOW) for i in range(1, 72)]
    speed = float(shown(moments)[-1].split(" steps/s")[0].split()[-1].replace(",", ""))
    assert speed > 3000


def test_a_line_within_a_window_gives_the_step_of_its_numbers():
    within, end = shown([(2.0, 1792), (14.0, 2000)])
    assert "step 1,792 of 100,000" in within
    assert "seed 1 at step 1,000: 3 alive" in within
    assert "step 2,000 of 100,000" in end
    assert "seed 1: 3 alive" in end


def test_several_worlds_share_a_line_of_progress():
    stream = io.StringIO()
    display = RunDisplay(Console(file=stream), Columns(("normal",), 0), (1, 2))
    display.update(Moment(0, WINDOW, 100 * WINDOW, 5.0, (ROW, ROW), (None, 700), WINDOW))
    head, first, second = stream.getvalue().splitlines()
    assert head == "step 1,000 of 100,000  200 steps/s  8 min 15 s left"
    assert first.startswith("  seed 1: 3 alive, 0 births, 0 deaths, energy 1.00")
    assert second == "  seed 2: extinct at step 700"


def test_a_world_without_a_new_window_is_not_printed_again():
    stream = io.StringIO()
    display = RunDisplay(Console(file=stream), Columns(("normal",), 0), (1, 2))
    other = ROW | {"step": 2 * WINDOW, "alive": 4}
    for seconds, step, rows in ((5.0, 1500, (ROW, ROW)), (15.0, 1900, (ROW, ROW)), (25.0, 2000, (other, other))):
        display.update(Moment(0, step, 100 * WINDOW, seconds, rows, (None, 700), WINDOW))
    lines = stream.getvalue().splitlines()
    heads = [line for line in lines if line.startswith("step ")]
    assert [line.partition(" of")[0] for line in heads] == ["step 1,500", "step 1,900", "step 2,000"]
    worlds = [line.partition(",")[0] for line in lines if line.startswith("  seed")]
    assert worlds == ["  seed 1 at step 1", "  seed 2: extinct at step 700", "  seed 1: 4 alive"]


def test_an_extinct_species_has_no_energy():
    """The world continues: its other species has its own line."""
    nan = float("nan")
    gone = ROW | {"alive": 0, "energy_mean": nan, "generation_mean": nan, "w_normal_mean": nan, "w_action_mean": nan}
    here = ROW | {"generation_mean": 1.5}
    columns = Columns(("normal",), 0, species=("prey", "hunter"))
    moment = Moment(0, WINDOW, WINDOW, 60.0, (here, gone), (None, None), WINDOW)
    stream, file = io.StringIO(), io.StringIO()
    RunDisplay(Console(file=stream), columns, (1,)).update(moment)
    lines = stream.getvalue().splitlines()
    assert "seed 1 prey: 3 alive" in lines[1]
    assert lines[2].endswith("seed 1 hunter: 0 alive, 0 births, 0 deaths")
    console = Console(file=file, width=140)
    console.print(RunDisplay(console, columns, (1,))._draw(moment, None))
    assert "nan" not in file.getvalue()
    assert "1 hunter" in file.getvalue()
