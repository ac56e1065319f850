"""What is planned for a request, given the runs that are already in the folder."""

import shutil
from dataclasses import replace
from pathlib import Path

import pytest
from resumed_run import SMALL, small_run

from hedon.config import diff, load_config
from hedon.ensemble.demand import part_of, setting_name
from hedon.ensemble.ensemble import find_ensemble
from hedon.ensemble.run_job import RunJob, folder_name, run_jobs
from hedon.experiment.plan import RunPlan
from hedon.experiment.resume import resume
from hedon.experiment.run import run
from hedon.record.folder import MANIFEST
from hedon.record.manifest import load_manifest, save_manifest
from hedon.study.catalogue import StudyError, choose
from hedon.study.gather import gather
from hedon.study.item import Condition, Item, Scale
from hedon.study.request import Request, needs

BASE = Condition("base", overrides=SMALL)
FAST = Condition("fast", overrides=(*SMALL, "food.normal.growth_rate=1.0"))


def an_item(
    name: str, *conditions: Condition, seeds: tuple[int, ...] = (1, 2), steps: int = 256, pictures: bool = False
) -> Item:
    return Item(name, name, "", lambda inputs: [], conditions, Scale(seeds, steps), pictures)


def planned(request: Request, folder: Path) -> list[RunJob]:
    return run_jobs(find_ensemble(needs(request), folder))


def test_items_share_the_worlds_of_equal_settings_and_the_most_demanding_decides() -> None:
    same = Condition("the same by other words", overrides=(*SMALL, "food.normal.growth_rate=0.2"))
    items = (an_item("a", BASE, FAST), an_item("b", same, seeds=(2, 3), steps=512))
    base, fast = needs(Request(items, "corrected"))
    assert base.steps == {1: 256, 2: 512, 3: 512}
    assert fast.steps == {1: 256, 2: 256}


def test_parts_hold_every_world_once() -> None:
    request = Request((an_item("a", BASE, seeds=(1, 2, 3)), an_item("b", FAST, seeds=(1, 5))), "corrected")
    parts = [part_of(needs(request), (number, 3)) for number in (1, 2, 3)]
    worlds = [sorted((need.digest, *world) for need in part for world in need.steps.items()) for part in parts]
    assert sorted(map(len, worlds)) == [1, 2, 2]
    whole = [(need.digest, *world) for need in needs(request) for world in need.steps.items()]
    assert sorted(world for part in worlds for world in part) == sorted(whole)
    assert part_of(needs(request), (7, 7)) == []


def test_a_request_overrules_the_scale_of_all_but_pictures() -> None:
    items = (an_item("a", BASE), an_item("picture", FAST, seeds=(7,), steps=64, pictures=True))
    base, fast = needs(Request(items, "corrected", (4, 5), 1024))
    assert base.steps == {4: 1024, 5: 1024}
    assert fast.steps == {7: 64}


def test_an_arm_has_its_own_fidelity_or_that_of_the_request() -> None:
    items = (an_item("a", Condition("asked"), Condition("own", fidelity="as_printed")),)
    asked, own = needs(Request(items, "released"))
    assert asked.config.food["normal"].growth_rate == 1.0
    assert own.config.fidelity == "as_printed"


def begun(job: RunJob) -> bool:
    """Whether the job continues an existing run."""
    return (job.folder / MANIFEST).is_file()


def test_the_longest_job_comes_first_and_no_two_share_a_folder(tmp_path: Path) -> None:
    items = (an_item("a", BASE, FAST, seeds=(1, 5)), an_item("b", FAST, seeds=(2, 7), steps=512))
    jobs = planned(Request(items, "corrected"), tmp_path)
    assert [job.world_steps for job in jobs] == [1024, 512, 512]
    assert len({job.folder for job in jobs}) == 3
    assert not any(begun(job) for job in jobs)


def test_existing_runs_are_used_and_those_that_are_too_short_are_continued(tmp_path: Path) -> None:
    small_run(tmp_path / "mine", 256, seeds=(1, 2))
    item = an_item("a", BASE)
    assert planned(Request((item,), "corrected"), tmp_path) == []
    assert planned(Request((item,), "corrected", steps=128), tmp_path) == []
    (further,) = planned(Request((item,), "corrected", steps=384), tmp_path)
    assert (further.folder, begun(further), further.plan.steps) == (tmp_path / "mine", True, 384)
    assert further.world_steps == 2 * 128
    (more,) = planned(Request((item,), "corrected", seeds=(1, 2, 3, 4)), tmp_path)
    assert (more.plan.seeds, begun(more)) == ((3, 4), False)


def test_a_run_that_was_killed_is_as_long_as_its_records(tmp_path: Path) -> None:
    small_run(tmp_path / "mine", 256)
    manifest = load_manifest(tmp_path / "mine")
    save_manifest(tmp_path / "mine", replace(manifest, status="running", steps_done=(0, 0)))
    assert planned(Request((an_item("a", BASE),), "corrected"), tmp_path) == []
    (job,) = planned(Request((an_item("a", BASE, steps=512),), "corrected"), tmp_path)
    assert (begun(job), job.world_steps) == (True, 512)


def test_worlds_that_died_out_are_not_simulated_again(tmp_path: Path) -> None:
    deadly = Condition("deadly", overrides=(*SMALL, "hazard.kappa=1.0", "hazard.alpha_energy=100.0", "birth.kappa=0.0"))
    small_run(tmp_path / "mine", 512, overrides=deadly.overrides[len(SMALL) :])
    assert None not in load_manifest(tmp_path / "mine").extinct_steps
    request = Request((an_item("a", deadly, steps=100_000),), "corrected")
    assert planned(request, tmp_path) == []
    inputs = gather(request, tmp_path).inputs(request.items[0])
    assert [world.extinct_step is not None for world in inputs.worlds["deadly"]] == [True, True]


def test_branches_and_other_settings_are_left_alone_and_damage_is_named(tmp_path: Path) -> None:
    small_run(tmp_path / "other", 256, overrides=("food.normal.growth_rate=1.0",))
    (tmp_path / "damaged").mkdir()
    (tmp_path / "damaged" / "manifest.json").write_text("{")
    request = Request((an_item("a", BASE),), "corrected")
    ensemble = find_ensemble(needs(request), tmp_path)
    assert ensemble.runs == []
    assert len(ensemble.faults) == 1
    assert "damaged" in ensemble.faults[0]
    assert len(planned(request, tmp_path)) == 1


def test_a_run_whose_config_lacks_a_setting_of_this_version_is_named(tmp_path: Path) -> None:
    small_run(tmp_path / "earlier", 256)
    config = tmp_path / "earlier" / "config.toml"
    kept = [line for line in config.read_text().splitlines(keepends=True) if not line.startswith("reward_scaling")]
    config.write_text("".join(kept))
    manifest = load_manifest(tmp_path / "earlier")
    save_manifest(tmp_path / "earlier", replace(manifest, config_digest="0" * 64))
    request = Request((an_item("a", BASE),), "corrected")
    for faults in (find_ensemble(needs(request), tmp_path).faults, gather(request, tmp_path).faults):
        (fault,) = faults
        assert "earlier" in fault
        assert "learning.reward_scaling: is missing" in fault
    assert len(planned(request, tmp_path)) == 1


def test_a_longer_world_is_read_as_if_it_had_ended_at_the_requested_step(tmp_path: Path) -> None:
    """The same seed gives the same bits, so a cut run must equal the shorter run, but for what the living did later."""
    small_run(tmp_path / "long" / "run", 512)
    small_run(tmp_path / "short" / "run", 256)
    request = Request((an_item("a", BASE),), "corrected")
    cut, whole = (
        gather(request, tmp_path / name).inputs(request.items[0]).worlds["base"] for name in ("long", "short")
    )
    for a, b in zip(cut, whole, strict=True):
        assert a.population.equals(b.population)
        assert a.last_step == b.last_step == 256
        dead = b.agents.filter(b.agents["death_step"].is_not_null())
        assert dead.height > 5
        assert a.agents.filter(a.agents["death_step"].is_not_null()).equals(dead)
        always = ["agent_id", "parent_id", "generation", "birth_step", "birth_energy", *a.weight_names]
        assert a.agents.select(always).equals(b.agents.select(always))
        living = a.agents.filter(a.agents["death_step"].is_null())
        assert living["children"].null_count() == living.height > 0


def test_a_gathered_world_is_as_long_as_its_extended_run(tmp_path: Path) -> None:
    small_run(tmp_path / "mine", 256)
    resume(tmp_path / "mine", 512, 1)
    request = Request((an_item("a", BASE, steps=512),), "corrected")
    assert [world.last_step for world in gather(request, tmp_path).inputs(request.items[0]).worlds["base"]] == [512] * 2


def test_names_of_runs_tell_settings_apart() -> None:
    assert folder_name(Condition("x").config("corrected")) == "baseline-corrected"
    changed = Condition("x", "small", ("energy.basic_cost=0.002", "world.mutation_noise=tabulated"))
    assert (
        folder_name(changed.config("as_printed"))
        == "small-as_printed-world.mutation_noise-tabulated-energy.basic_cost-0.002"
    )
    long = [folder_name(condition.config("corrected")) for condition in (BASE, FAST)]
    assert max(map(len, long)) < 100
    assert long[0] != long[1]
    kinds = [
        Condition("x", "poor", (f"food.{kind}.growth_rate=0.7",)).config("corrected") for kind in ("normal", "poor")
    ]
    assert setting_name(kinds[0]) != setting_name(kinds[1])


def test_equal_settings_written_in_two_ways_are_one_condition(tmp_path: Path) -> None:
    changes = diff(load_config("baseline"), load_config("baseline", "released"))
    faults = tuple(f"{path}={value}" for path, _, value in changes)
    small_run(tmp_path / "a", 64, seeds=(1,), overrides=faults)
    config = load_config("baseline", "released", SMALL)
    run(RunPlan(config, (2,), 64, tmp_path / "b", 1))
    item = an_item("a", Condition("released", overrides=SMALL, fidelity="released"), steps=64)
    worlds = gather(Request((item,), "corrected"), tmp_path).demanded()
    assert [world.seed for world in worlds] == [1, 2]
    assert len({world.condition for world in worlds}) == 1


def test_a_damaged_part_is_named_and_an_intact_run_of_the_same_worlds_is_used(tmp_path: Path) -> None:
    small_run(tmp_path / "a", 256)
    small_run(tmp_path / "b", 256)
    part = sorted((tmp_path / "a" / "agents").glob("part-*.parquet"))[0]
    part.write_bytes(b"damaged")
    request = Request((an_item("a", BASE),), "corrected")
    found = gather(request, tmp_path)
    assert [str(part) in fault for fault in found.faults] == [True]
    assert {world.run for world in found.worlds.values()} == {"b"}


def test_a_world_ends_at_the_step_at_which_its_living_were_last_written(tmp_path: Path) -> None:
    """A run in progress writes the living only now and then; agents born since are not in the records."""
    small_run(tmp_path / "short" / "run", 256)
    small_run(tmp_path / "run", 512)
    shutil.copy(tmp_path / "short" / "run" / "agents" / "living.parquet", tmp_path / "run" / "agents")
    save_manifest(tmp_path / "run", replace(load_manifest(tmp_path / "run"), status="running", steps_done=(0, 0)))
    request = Request((an_item("a", BASE, steps=512),), "corrected")
    worlds = gather(request, tmp_path).inputs(request.items[0]).worlds["base"]
    assert all(256 <= world.last_step < 512 for world in worlds)
    for world in worlds:
        assert world.agents["death_step"].null_count() == world.population["alive"][-1]
    (job,) = planned(request, tmp_path)
    assert begun(job)


def test_an_unknown_name_is_reported_with_the_nearest_one() -> None:
    with pytest.raises(StudyError, match=r"no study or item 'hazrd'; did you mean hazard\?"):
        choose(["hazrd"])


def test_studies_and_items_are_chosen_by_name_and_in_their_own_order() -> None:
    names = [item.name for study in choose(["all"]) for item in study.items]
    assert len(names) == len(set(names)) > 30
    (paper,) = choose(["birth", "kanagawa-doya-2024/hazard", "birth"])
    assert (paper.name, [item.name for item in paper.items]) == ("kanagawa-doya-2024", ["hazard", "birth"])
    (whole,) = choose(["fear", "sequel-fear"])
    assert len(whole.items) == 12
