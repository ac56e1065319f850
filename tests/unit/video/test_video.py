"""Videos, read back: they have the right number of pictures, the right size, and agents where the frames have them."""

import subprocess
from dataclasses import replace

import numpy as np
import polars as pl
import pytest
from typer.testing import CliRunner
from view_page import record

from hedon.cli.main import app
from hedon.figure.film import Film
from hedon.record.reader import open_run
from hedon.video.encoder import Encoder
from hedon.video.error import VideoError
from hedon.video.make import choose_range
from hedon.video.moment import blend, open_footage

imageio_ffmpeg = pytest.importorskip("imageio_ffmpeg", reason="needs ffmpeg: uv sync --extra video")


def pixel(film: Film, x: float, y: float) -> tuple[int, int]:
    """The column and row of a point in the world [u], in the last picture drawn."""
    column, above = film._axes.transData.transform((x, y))
    return int(column), film.height - 1 - int(above)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return record(tmp_path_factory.mktemp("video") / "run", 256)


def command(*arguments):
    return CliRunner().invoke(app, ["export", "video", *map(str, arguments)])


def read_back(path):
    """The pictures of a video, shape (pictures, rows, columns, 3)."""
    frames = imageio_ffmpeg.read_frames(str(path))
    width, height = next(frames)["size"]
    return np.array([np.frombuffer(frame, np.uint8).reshape(height, width, 3) for frame in frames])


def interrupt(out):
    with Encoder(out, 64, 64, 25) as encoder:
        encoder.add(memoryview(bytes(64 * 64 * 4)))
        raise ValueError("interrupted")


@pytest.mark.parametrize(("ending", "bound"), [("mp4", 12), ("gif", 24)])
def test_a_video_has_the_pictures_and_agents_of_the_frames(folder, tmp_path, ending, bound):
    done = command(folder, tmp_path / f"all.{ending}", "--speed", 32, "--width", 641, "--to", 192)
    assert done.exit_code == 0, done.output
    assert "5 pictures" in done.output
    pictures = read_back(tmp_path / f"all.{ending}")
    footage = open_footage(folder)
    moments = list(footage.moments(64, 192, 32))
    film = Film(moments[0], {"normal": "#3d8f4d", "poison": "#8e44ad"}, 641, footage.usual_energy())
    assert pictures.shape == (5, film.height, 640, 3)
    for picture, moment in zip(pictures, moments, strict=True):
        drawn = np.asarray(film.draw(moment))[:, :, :3].astype(int)
        for x, y in zip(moment.x, moment.y, strict=True):
            column, row = pixel(film, x, y)
            # Well inside the body; codecs change colors slightly.
            near = np.s_[row - 3 : row + 4, column - 3 : column + 4]
            assert np.abs(picture[near].astype(int) - drawn[near]).mean() < bound
            assert picture[near].mean(axis=(0, 1))[0] < 235  # the floor has 251


def test_a_moment_between_two_frames_is_interpolated(folder):
    rows = open_run(folder).frames().collect()
    at = {step: rows.filter((pl.col("step") == step) & pl.col("id").is_not_null()).sort("id") for step in (64, 128)}
    (moment,) = open_footage(folder).moments(80, 80, 1)
    both = at[64].join(at[128], on="id", suffix="_later")
    index = np.searchsorted(moment.agent_id, both["id"])
    for name in ("x", "y"):
        even = 0.75 * both[name].to_numpy() + 0.25 * both[f"{name}_later"].to_numpy()
        np.testing.assert_allclose(getattr(moment, name)[index], even, rtol=1e-5)


def test_an_agent_turns_the_shorter_way_and_frames_far_apart_are_not_mixed(folder):
    (before,) = open_footage(folder).moments(64, 64, 1)
    turned = replace(before, step=128, angle=before.angle + np.float32(2 * np.pi - 0.2))
    np.testing.assert_allclose(blend(before, turned, 96).angle, before.angle - 0.1, atol=1e-4)
    assert blend(before, replace(turned, step=500), 96).angle is before.angle


def test_a_followed_agent_stays_ringed_and_in_sight(folder):
    footage = open_footage(folder)
    (moment,) = footage.moments(128, 128, 1)
    agent = int(moment.agent_id[5])
    film = Film(moment, {"normal": "#3d8f4d", "poison": "#8e44ad"}, 480, 60.0, agent)
    picture = np.asarray(film.draw(moment)).astype(int)
    column, row = pixel(film, float(moment.x[5]), float(moment.y[5]))
    assert 0 <= column < film.width
    assert 0 <= row < film.height
    edge, _ = pixel(film, float(moment.x[5]) + float(moment.radius[0]) + 1.5, float(moment.y[5]))
    assert picture[row, edge - 1 : edge + 2, :3].sum(axis=1).min() < 250  # the ring is dark
    shown = choose_range(footage, None, None, 8, agent)
    assert (shown.first, shown.last) == footage.lifetime(agent)


def test_a_video_must_be_of_recorded_frames(folder):
    footage = open_footage(folder)
    with pytest.raises(VideoError, match="--from 32: the frames reach from step 64 to 256"):
        choose_range(footage, 32, None, 8)
    with pytest.raises(VideoError, match="--to 257"):
        choose_range(footage, None, 257, 8)
    with pytest.raises(VideoError, match="--from 200 is later than --to 100"):
        choose_range(footage, 200, 100, 8)
    with pytest.raises(VideoError, match="no frame has this agent"):
        choose_range(footage, None, None, 8, 10**6)
    with pytest.raises(VideoError, match="the run has seeds 1"):
        open_footage(folder, 2)


def test_a_file_is_not_replaced_and_a_failed_video_leaves_nothing(folder, tmp_path, monkeypatch):
    (tmp_path / "there.mp4").write_text("mine")
    for name, words in (("there.mp4", "is there already"), ("a.avi", ".mp4 or .gif"), ("no/a.mp4", "no folder")):
        error = command(folder, tmp_path / name).exception
        assert words in str(error)
    with pytest.raises(ValueError, match="interrupted"):
        interrupt(tmp_path / "broken.mp4")
    with pytest.raises(VideoError, match="ffmpeg says"), Encoder(tmp_path / "odd.mp4", 63, 64, 25) as encoder:
        encoder.add(memoryview(bytes(63 * 64 * 4)))
    monkeypatch.setitem(__import__("sys").modules, "imageio_ffmpeg", None)
    assert 'pip install "hedon[video]"' in str(command(folder, tmp_path / "new.mp4").exception)
    assert [path.name for path in tmp_path.iterdir()] == ["there.mp4"]


def test_ffmpeg_exits_with_its_video(tmp_path):
    with Encoder(tmp_path / "a.gif", 32, 32, 25) as encoder:
        encoder.add(memoryview(bytes(32 * 32 * 4)))
        program = encoder._program
    assert isinstance(program, subprocess.Popen)
    assert program.returncode == 0
