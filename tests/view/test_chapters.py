"""The marks of the timeline are listed as chapters, each of which leads to its moment; sparse records play fast."""

from typing import Any

import pytest
from view_page import demo_server, live_server, run_server, serving, sized

pytest_plugins = ("view_fixture",)

LIST = "document.querySelector('#chapters')"


def link_of(server: Any) -> str:
    return f"http://127.0.0.1:{server.server_port}"


@pytest.mark.parametrize("width", [pytest.param(1400, marks=pytest.mark.long), 390])
def test_a_chapter_leads_to_its_moment(width, watch):
    with serving(demo_server()) as server:
        watched = watch(link_of(server), **sized(width))
        watched.get("hedon.play(false)")
        # Marks change until all records are read: the peak moves with the series, and drift needs the lives.
        watched.until("hedon.source.loaded && hedon.source.series.step.at(-1) === hedon.source.index.steps[0]")
        drawn = watched.get("(hedon.seek(0), hedon.pictures)")
        watched.until(f"hedon.pictures > {drawn} + 2")
        assert watched.get(f"hedon.marks.length > 1 && {LIST}.options.length === hedon.marks.length + 1")
        marks = watched.get("hedon.marks")
        steps = sorted(mark["step"] for mark in marks)
        told = watched.get(f"[...{LIST}.options].map((each) => each.text)")
        assert told[0] == f"{watched.get('hedon.source.first'):,}: the beginning"
        assert sorted(told[1:]) == sorted(f"{mark['step']:,}: {mark['text']}" for mark in marks)
        chapters = watched.page.get_by_role("combobox", name="Chapters")
        assert chapters.bounding_box()["width"] > 100
        chapters.select_option(index=2)
        watched.until(f"hedon.now === {steps[1]} && hedon.frame && hedon.frame.step <= {steps[1]}")
        chapters.evaluate("(list) => list.blur()")
        watched.get(f"hedon.seek({steps[-1] + 1})")
        watched.until(f"{LIST}.selectedIndex === {len(steps)}")
        first = watched.get("(hedon.seek(0), hedon.now)")
        watched.until(f"{LIST}.selectedIndex === {sum(step <= first for step in steps)}")


def test_a_live_world_has_no_chapters(watch):
    with serving(live_server("baseline")) as server:
        watched = watch(server.link)
        assert watched.get(f"{LIST}.hidden")


def test_sparse_records_play_several_moments_a_second(run_folder, watch):
    with serving(run_server(run_folder)) as dense, serving(demo_server()) as sparse:
        assert watch(dense.link).get("[hedon.speed, hedon.source.spacing]") == [4, 64]
        speed, spacing = watch(link_of(sparse)).get("[hedon.speed, hedon.source.spacing]")
        assert spacing >= 1024
        assert 12 <= spacing / speed <= 32, "pictures per recorded moment, at sixty pictures a second"
