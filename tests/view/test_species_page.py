"""In a world of several species, the values shown for a gene come from the agents that have it."""

import io

import pytest
from matplotlib.image import imread
from split_run import record_species
from view_page import live_server, run_live, run_server, serving

from hedon import load_config
from hedon.config.layout import layouts

pytest_plugins = ("view_fixture",)


@pytest.fixture(scope="module")
def species_run(tmp_path_factory):
    return record_species(tmp_path_factory.mktemp("species") / "run", steps=640, seeds=(1,))


@pytest.fixture(params=["live", "run"])
def watched(request, species_run, watch):
    """A live world and a replay of prey and predators."""
    with serving(live_server("predator") if request.param == "live" else run_server(species_run)) as server:
        page = watch(server.link)
        if request.param == "live":
            run_live(page, 20)
            page.get("hedon.seek(hedon.source.last)")
        else:
            page.until("hedon.source.lives.size > 0")
            page.rest_at(512)
        page.until("hedon.frame")
        yield page


def test_each_gene_of_the_species_has_a_bar(watched):
    made = layouts(load_config("predator"))
    for s, species in enumerate(("prey", "predator")):
        chosen = watched.get(f"hedon.frame.id[hedon.frame.species.indexOf({s})]")
        watched.get(f"hedon.choose({chosen})")
        watched.until(f"document.querySelector('#agent h2')?.textContent === 'Agent {chosen}'")
        watched.get("document.querySelector('#agent .neutral').open = true")
        bars = watched.get("[...document.querySelectorAll('#agent .gene')].map((bar) => bar.title)")
        assert [bar.split(" = ")[0] for bar in bars] == list(made[species].gene_names)
        assert all(float(bar.split(" = ")[1]) == float(bar.split(" = ")[1]) for bar in bars)  # none is NaN
        widths = watched.get("[...document.querySelectorAll('#agent .gene i')].map((bar) => bar.offsetWidth)")
        assert max(widths) > 10


def test_the_scatter_shows_the_genes_of_either_species(watched):
    """The color of the species covers enough pixels for a dot per living agent, allowing for overlaps."""
    watched.get("hedon.tab('plots')")
    for s, color in enumerate(watched.get("hedon.source.layout.species.map((each) => each.color)")):
        watched.page.get_by_label("Species", exact=True).select_option(str(s))
        alive = watched.get(f"hedon.frame.species.filter((each) => each === {s}).length")
        watched.until(f"document.querySelector('#scatter').ariaLabel === 'Two genes of {alive} agents'")
        image = imread(io.BytesIO(watched.page.locator("#scatter").screenshot()))[:, :, :3]
        wanted = [int(color[i : i + 2], 16) / 255 for i in (1, 3, 5)]
        dots = (abs(image - wanted).max(axis=2) < 0.02).sum()
        assert dots > min(8 * alive, 400)  # a dot has 16 pixels, and some dots overlap
