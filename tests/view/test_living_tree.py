"""The page's tree of living agents is the recorded pedigree at every moment, and shows who belongs to a branch."""

import polars as pl
import pytest
from split_run import record_species
from view_page import live_server, run_live, run_server, serving

from hedon.record.reader import open_run

pytest_plugins = ("view_fixture",)
TREE = "hedon.tree"
RINGED = "[...hedon.arena.marked].sort((a, b) => a - b)"
LINES = f"{TREE}.branches.map(({{ life, row, end, children }}) => [life.id, row, end, children.map((c) => c.life.id)])"


@pytest.fixture(scope="module")
def replay(run_folder):
    with serving(run_server(run_folder)) as server:
        yield server


def opened(watch, server, step: int):
    watched = watch(server.link)
    watched.until("hedon.source.lives.size > 0 && hedon.source.series.step.length > 0")
    watched.get("hedon.tab('tree')")
    watched.rest_at(step)
    watched.until(f"{TREE}.branches.length > 0")
    return watched


def pedigree(folder, step: int) -> tuple[dict[int, int], set[int]]:
    """The parents of all agents born up to a step, and the agents alive at it."""
    born = open_run(folder).agents().filter(pl.col("birth_step") <= step)
    living = born.filter(pl.col("death_step").is_null() | (pl.col("death_step") > step))
    parents = dict(zip(born["agent_id"], born["parent_id"].fill_null(-1), strict=True))
    return parents, set(living["agent_id"])


def below(parents: dict[int, int], living: set[int], branch: int) -> list[int]:
    """The living agents that descend from an agent, including the agent itself."""

    def descends(agent: int) -> bool:
        while agent >= 0 and agent != branch:
            agent = parents[agent]
        return agent == branch

    return sorted(agent for agent in living if descends(agent))


@pytest.mark.parametrize("step", [pytest.param(512, marks=pytest.mark.long), 2048])
def test_the_tree_is_the_pedigree_of_the_living_agents(step, watch, replay, run_folder):
    parents, living = pedigree(run_folder, step)
    watched = opened(watch, replay, step)
    watched.until(f"[...hedon.frame.id].length === {len(living)} && {TREE}.branches.some((b) => b.end === {step})")
    lines = {agent: (row, end, children) for agent, row, end, children in watched.get(LINES)}
    wanted = set()
    for agent in living:
        while agent >= 0:
            wanted.add(agent)
            agent = parents[agent]
    assert set(lines) == wanted
    assert sorted(lines[agent][0] for agent in living) == list(range(len(living))), "each has its own row"
    for agent, (_, end, children) in lines.items():
        assert (end == step) == (agent in living)
        assert sorted(children) == sorted(child for child in wanted if parents[child] == agent)


def test_a_click_on_a_branch_rings_its_living_agents(watch, replay, run_folder):
    parents, living = pedigree(run_folder, 2048)
    watched = opened(watch, replay, 2048)
    branch = max(parents, key=lambda agent: (parents[agent] < 0) * len(below(parents, living, agent)))
    family = below(parents, living, branch)
    assert len(family) > 1
    place = watched.get(
        f"((b) => [({TREE}.toX(b.life.birth) + {TREE}.toX(b.end)) / 2, {TREE}.toY(b.row)])"
        f"({TREE}.branches.find((b) => b.life.id === {branch}))"
    )
    watched.page.locator("canvas.tree").click(position={"x": place[0], "y": place[1]})
    assert watched.get(RINGED) == family
    assert watched.get("document.querySelector('#tree .said').innerText").startswith(
        f"{len(family)} agents of {len(living)}"
    )
    watched.until("document.getElementById('legend').innerText.includes('of the chosen branch')")
    watched.rest_at(1024)  # the branch stays chosen, and its agents are those alive at that step
    watched.until(f"{RINGED}.join() === '{','.join(map(str, below(*pedigree(run_folder, 1024), branch)))}'")
    watched.get("hedon.tab('plots')")  # also while the tree is hidden
    watched.rest_at(1536)
    watched.until(f"{RINGED}.join() === '{','.join(map(str, below(*pedigree(run_folder, 1536), branch)))}'")
    watched.get("hedon.tab('tree')")
    watched.page.get_by_role("button", name="No branch").click()
    assert watched.get(RINGED) == []


def test_the_branch_of_an_agent_is_chosen_by_keys(watch, replay, run_folder):
    parents, living = pedigree(run_folder, 2048)
    child = max(agent for agent in living if parents[agent] >= 0)
    watched = opened(watch, replay, 2048)
    watched.get(f"hedon.choose({child})")
    watched.get("hedon.tab('tree')")
    watched.until(f"{TREE}.branches.length > 0")
    watched.page.get_by_role("button", name="Branch of the agent").press("Enter")
    assert watched.get(RINGED) == below(parents, living, child)
    watched.page.get_by_role("button", name="One parent up").press("Enter")
    assert watched.get(RINGED) == below(parents, living, parents[child])


def test_a_live_world_and_several_species_have_trees(watch, tmp_path):
    with serving(live_server("predator")) as server:
        watched = watch(server.link)
        watched.get("hedon.tab('tree')")
        run_live(watched, 300)
        watched.get("hedon.seek(hedon.source.last)")
        watched.until(
            f"hedon.frame.step === 300 && {TREE}.branches.filter((b) => b.end === 300).length === hedon.frame.id.length"
        )
    run = open_run(record_species(tmp_path / "run", steps=640, seeds=(1,)))
    with serving(run_server(run.path)) as server:
        watched = opened(watch, server, 640)
        alive = run.population().filter(pl.col("step") == 640)["alive"].sum()
        watched.until(f"{TREE}.branches.filter((b) => b.end === 640).length === {alive}")
        assert len(watched.get("[...document.querySelectorAll('#tree option')].map((o) => o.innerText)")) > 3
