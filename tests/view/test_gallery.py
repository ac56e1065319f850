"""The gallery: places in the article, each with a picture and a sentence. `HEDON_PICTURES=1` writes them."""

import csv
import os
import re
from dataclasses import dataclass, field
from urllib.parse import parse_qsl

import numpy as np
import pytest
from project_files import ROOT
from view_page import serving, story_server

from hedon import Simulation, _engine, load_config
from hedon.view.story import PAGE, SCENES

pytest_plugins = ("view_fixture",)

TEACHING = ROOT / "docs" / "teaching"
GALLERY = ROOT / "docs" / "gallery"
STORY = ROOT / "web" / "src" / "story"
PICTURES = os.environ.get("HEDON_PICTURES")
LARGEST = 300_000  # bytes of one picture
HEAD = """# Gallery

This page shows worlds from the article `hedon view --story`. To open one, add the line below its picture to the end of
the article's address. You get the same world, bit for bit. A test writes this page and its pictures
(`HEDON_PICTURES=1 uv run pytest tests/view/test_gallery.py`).
"""


@dataclass(frozen=True)
class Place:
    """A place: its scene, config file and step, the settings that differ, and what you see there."""

    scene: str
    file: str
    step: int
    title: str
    sentence: str
    changes: dict[str, str] = field(default_factory=dict)
    notes: dict[str, str] = field(default_factory=dict)

    def digest(self) -> str:
        config = load_config(SCENES / f"{self.file}.toml", overrides=[f"{k}={v}" for k, v in self.changes.items()])
        simulation = Simulation(config, seeds=[1])
        simulation.run(self.step)
        return simulation.worlds[0].digest()[:8]

    def address(self, digest: str) -> str:
        given = {"scene": self.scene, "seed": "1", "step": str(self.step), **self.notes, **self.changes}
        return "#" + "&".join(f"{name}={value}" for name, value in {**given, "digest": digest}.items())


PLACES = {
    "learned": Place(
        "learning",
        "learning",
        81920,
        "It has learned",
        "The gray line is its path before learning, the pink line its path after 80 rounds of learning.",
    ),
    "dislikes-moving": Place(
        "learning",
        "learning",
        20480,
        "Moving hurts",
        "Moving hurts this creature, and meals mean nothing to it. It moves far less than the one that likes meals.",
        {"food.normal.gene.initial_mean": "0", "genome.action.initial_mean": "-10"},
    ),
    "family": Place(
        "family",
        "family",
        2000,
        "One family",
        "A founder, with a pink ring, and its four descendants, with violet rings, among the others after 2,000 steps.",
        notes={"agent": "13"},
    ),
    "predators": Place(
        "sandbox",
        "predators",
        300,
        "Predators and prey",
        "Six predators, with dark rings, have begun to eat. Amber creatures are full of energy; blue ones have little.",
        notes={"world": "predators"},
    ),
    "pitfalls": Place(
        "sandbox",
        "pitfalls",
        300,
        "Pitfalls",
        "Triangles hurt every creature that touches them.",
        notes={"world": "pitfalls"},
    ),
}


def addresses() -> dict[str, str]:
    """The address of each place in the gallery, by name."""
    lines = (GALLERY / "README.md").read_text().split("\n")
    return dict(zip(PLACES, [line.strip("`") for line in lines if line.startswith("`#")], strict=True))


@pytest.mark.skipif(
    not {"avx2", "avx512"} & set(_engine.kernel.kernel_names()), reason="this processor does not fuse multiply-adds"
)
@pytest.mark.long
def test_the_gallery_matches_the_engine_bit_for_bit():
    def section(name: str, place: Place) -> str:
        shown = f"![{place.title}]({name}.png)\n\n{place.sentence}"
        return f"\n## {place.title}\n\n{shown}\n\n`{place.address(place.digest())}`\n"

    made = HEAD + "".join(section(*each) for each in PLACES.items())
    if PICTURES:
        (GALLERY / "README.md").write_text(made)
    assert (GALLERY / "README.md").read_text() == made, "a world has changed: take the pictures again"


@pytest.fixture(scope="module")
def server():
    with serving(story_server()) as running:
        yield running


@pytest.mark.parametrize("name", PLACES)
def test_each_place_of_the_gallery_has_its_picture(name, server, watch):
    path = GALLERY / f"{name}.png"
    if PICTURES:
        watched = watch(f"{server.link}{PAGE}{addresses()[name]}")
        watched.until("hedon.opened !== ''", 400)
        watched.until(f"document.querySelector('#{PLACES[name].scene} .digest').textContent.includes('as in the link')")
        drawn = watched.get("hedon.pictures")
        watched.until(f"hedon.pictures > {drawn} + 3")
        path.write_bytes(watched.page.locator(f"#{PLACES[name].scene} .view").screenshot())
    assert 5_000 < path.stat().st_size < LARGEST


def test_the_exercises_have_places_that_exist_and_a_data_sheet():
    text = (TEACHING / "README.md").read_text()
    places = [dict(parse_qsl(address)) for address in re.findall(r"`#(scene=[^`]+)`", text)]
    assert {place["scene"] for place in places} >= {"creature", "family", "contest", "evolve"}
    for place in places:
        settings = [f"{path}={value}" for path, value in place.items() if "." in path]
        load_config(SCENES / f"{place['scene']}.toml", overrides=settings)
        assert set(place) - {"scene", "seed", "step"} == {setting.partition("=")[0] for setting in settings}
    for part in ("**Misconception**", "**Before**", "**Task**", "**After**", "**For the teacher**"):
        assert text.count(part) == 3
    with (TEACHING / "data-sheet.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert [row["exercise"] for row in rows] == ["1", "2", "3"]
    assert {"pair", "seed", "step", "reward", "energy", "you", "evolution", "vote_before"} <= set(rows[0])
    assert {"meals_first_rounds", "meals_last_rounds", "pace_first", "pace_last", "parent_meal_feels"} <= set(rows[0])


def test_the_exercises_name_only_controls_that_the_article_has():
    """Sliders and buttons are in italics; each pair of students must be able to find them."""
    scenes = [STORY / f"{name}.html" for name in ("creature", "learning", "family", "evolve", "contest")]
    page = "".join(path.read_text() for path in (*scenes, STORY.parent.parent / "story.html"))
    buttons = set(re.findall(r"<button[^>]*>([^<]+)", page))
    buttons |= set(
        re.findall(r'run.textContent = .*\? "([^"]+)" : "Let it learn"', (STORY / "learning.ts").read_text())
    )
    sliders = {name.strip() for name in re.findall(r"<label[^>]*>([^<]+)<(?:input|span)", page)}
    text = " ".join((TEACHING / "README.md").read_text().split())
    stressed = {"link", "learned", "before"}
    named = set(re.findall(r"(?<!\*)\*([^*]+)\*(?!\*)", text)) - stressed - {"Reset"}
    assert named <= buttons | sliders
    assert len(named) > 5
    assert f"in 1 of {2**5} tries (the page says {100 / 2**5:.0f} of 100)" in text


def test_the_second_exercise_shows_what_a_child_inherits():
    """Children inherit their parents' feelings; a new network starts without anything another one has learned."""
    world = Simulation(load_config(SCENES / "family.toml"), seeds=[1])
    lives, living = {}, []  # parent and feeling of every agent, including the dead
    for _ in range(2000):
        world.run(1)
        agents = world.worlds[0].agents()
        columns = (agents["agent_id"], agents["parent_id"], agents["genome"][:, 0])
        lives |= {own: rest for own, *rest in zip(*(each.tolist() for each in columns), strict=True)}
        living = agents["agent_id"].tolist()
    alive = [lives[own] for own in living if lives[own][0] >= 0]
    assert len(alive) > 20, "enough for a class"
    feeling = np.corrcoef([(own, lives[parent][1]) for parent, own in alive], rowvar=False)[0, 1]
    text = " ".join((TEACHING / "README.md").read_text().split())
    assert f"Over the {len(alive)} children" in text
    assert f"correlate by {feeling:.2f}." in text
    first, last = meals_of_rounds(1)
    second, _ = meals_of_rounds(2, rounds=5)
    assert f"eats {first} meals in its first five rounds and {last} in its last five" in text
    assert f"the second one {second} in its first five" in text
    assert last > 5 * max(first, second)


def meals_of_rounds(seed: int, rounds: int = 80) -> tuple[int, int]:
    """Meals that the learner in scene 2 eats in its first five rounds and in its last five."""
    world = Simulation(load_config(SCENES / "learning.toml"), seeds=[seed])
    eaten = [0]
    for _ in range(rounds):
        world.run(1024)
        eaten.append(int(world.worlds[0].agents()["eaten"].sum()))
    return eaten[5], eaten[-1] - eaten[-6]
