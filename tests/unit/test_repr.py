"""How objects are shown in one line and in a notebook, where users' text is escaped."""

import hedon
from hedon.shown import table_html

BRIEF = ["world.rollout_steps=64", "learning.minibatch_size=32"]


def test_objects_describe_themselves_in_one_line():
    config = hedon.load_config("poison", overrides=[*BRIEF, "energy.basic_cost=0.01"])
    simulation = hedon.Simulation(config, [3, 4])
    simulation.run(10)
    alive = [world.alive for world in simulation.worlds]
    worlds = hedon.make("predator", 2, seed=1, species="prey")
    for thing, line in (
        (config, "<Config poison (corrected), 3 settings changed>"),
        (hedon.load_config("baseline"), "<Config baseline (corrected), 0 settings changed>"),
        (simulation, f"<Simulation poison (corrected): 2 worlds at step 10, {sum(alive)} alive>"),
        (simulation.worlds[1], f"<World of seed 4 at step 10, {alive[1]} alive>"),
        (worlds.groups["prey"], "<Group of 320 agents in 2 worlds of 450 slots>"),
    ):
        assert repr(thing) == str(thing) == line
    assert repr(worlds).startswith("<VectorEnv driving prey in <Simulation predator (corrected): 2 worlds at step 0, ")


def test_notebooks_show_changed_settings_and_each_world():
    config = hedon.load_config("baseline", overrides=["energy.basic_cost=0.01"])
    assert "<td>energy.basic_cost</td><td>0.001</td><td>0.01</td>" in config._repr_html_()
    simulation = hedon.Simulation(config, [7])
    assert "<td>7</td><td>0</td><td>50</td>" in simulation._repr_html_()
    many = table_html("<b>", ["<i>"], [["<script>"]] * 20)
    assert many.count("&lt;script&gt;") == 12
    assert "<script>" not in many
    assert "… and 8 more" in many
    assert "<table>" not in table_html("empty", ["a"], [])
