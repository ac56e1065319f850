"""Configs of 0.4: complete ones are read, short ones are refused with the new names and rewritten."""

import random
import re
import shutil
import tomllib
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
import tomlkit
from command import hedon
from project_files import ROOT

from hedon.check.run import check_run
from hedon.config import ConfigError, diff, digest, dump_toml, load_config
from hedon.config.dump import flatten
from hedon.config.field import sections, settings, value_at
from hedon.config.load import migrated_file, parse_config
from hedon.config.migrate import MOVED, STORES, VALUES, migrate_text, renamed
from hedon.config.schema.evolution import GeneConfig, PayConfig
from hedon.config.schema.species import SpeciesConfig
from hedon.config.schema.store import StoreConfig
from hedon.config.schema.world import WorldConfig
from hedon.experiment.resume import resume
from hedon.record.error import RecordError
from hedon.record.reader import open_run
from hedon.report.summary import summarize

EARLIER = ROOT / "tests" / "data" / "earlier"
"""Run folders that hedon 0.4 wrote, of one and of two species, and the file of the latter."""

Write = Callable[[str], Path]


def test_the_config_of_an_earlier_run_means_what_its_file_means(tmp_path: Path) -> None:
    file = tmp_path / "two.toml"
    file.write_text(migrated_file(EARLIER / "two.toml")[0])
    made, read = load_config(file), load_config(EARLIER / "two" / "config.toml")
    assert (diff(made, read), digest(made)) == ([], digest(read))
    assert (read.world.food_radius, read.world.eaten_food, read.world.rollout_steps) == (5.0, "seen", 128)
    assert read == parse_config((EARLIER / "two" / "config.toml").read_text(), "here")
    one = load_config(EARLIER / "one" / "config.toml")
    changed = {path for path, _, _ in diff(load_config("poison", "released"), one)}
    assert {"world.rollout_steps", "birth.logit_offset", "learning.policy"} <= changed
    assert not any(path.startswith("world.") for path in changed - {"world.rollout_steps"}), "as released"


def test_a_file_keeps_its_comments_and_its_order(tmp_path: Path) -> None:
    before = (EARLIER / "two.toml").read_text().replace("birth.delay", "birth.logit_offset")
    after = migrated_file(EARLIER / "two.toml")[0]
    moved = ["food_radius = 5.0", 'eaten_food = "seen"', "rollout_steps = 128"]
    assert "\n".join(["[world]", *moved, ""]) in after
    stores = ["[nutrient]", "initial = 30.0", "hazard_share = 0.3", "[toxin]", "threshold = 4.0"]
    gone = (*moved, "[body]", *stores, "nutrient.observed = false")
    kept = [line for line in before.splitlines() if line and line not in gone]
    named = ["[food.normal.gives]", "[species.predator.store]", "nutrient = false", "toxin = false"]
    assert [line for line in after[: after.index("[world]")].splitlines() if line and line not in named] == kept
    assert "nutrient = 1.0 # a second store" in after
    file = tmp_path / "again.toml"
    file.write_text(after)
    assert migrated_file(file)[0] == after


LINES = (
    "food.normal.energy = 1.5",
    "food.normal.toxin = 1.0",
    "food.normal.nutrient = 2.0",
    "food.normal.capacity = 80",
    "nutrient.capacity = 300.0",
    "toxin.threshold = 4.0",
    "species.prey.birth.delay = 3.0",
    "species.prey.nutrient.initial = 30.0",
    "species.prey.population.capacity = 90",
    "learning.rollout_steps = 512",
    "birth.kappa = 0.002",
)


@pytest.mark.parametrize("number", range(12))
def test_dotted_keys_in_any_order_mean_the_same(number: int) -> None:
    """With a header for the food, or none."""
    draw = random.Random(number)
    lines = draw.sample(LINES, draw.randrange(1, len(LINES) + 1))
    text = "\n".join(lines)
    if number % 2:
        food = [line.removeprefix("food.normal.") for line in lines if line.startswith("food.")]
        text = "\n".join([*(line for line in lines if not line.startswith("food.")), "[food.normal]", *food])
    given = tomllib.loads(text)
    found = tomllib.loads(migrate_text(text, {}))
    assert found == tomllib.loads(migrate_text(tomlkit.dumps(given), {}))
    assert not list(renamed(found))
    assert sum(1 for _ in leaves_of(found)) >= len(lines)


def leaves_of(table: dict[str, Any]) -> Iterator[Any]:
    for value in table.values():
        yield from leaves_of(value) if isinstance(value, dict) else [value]


def test_the_command_rewrites_short_and_complete_files(tmp_path: Path) -> None:
    short, whole = tmp_path / "short.toml", tmp_path / "whole.toml"
    short.write_bytes(b"body.food_radius = 5.0  # large\nspecies.agent.birth.parents = 'old_slots'\n")
    shutil.copy(EARLIER / "one" / "config.toml", whole)
    shown = hedon("config", "migrate", str(short), "--stdout")
    assert (shown.returncode, short.read_text()[:16]) == (0, "body.food_radius")
    for file in (short, whole):
        answer = hedon("config", "migrate", str(file))
        assert (answer.returncode, answer.stderr) == (0, "")
    assert "food_radius = 5.0  # large" in short.read_text()
    assert short.read_text().splitlines() == shown.stdout.splitlines()
    assert (load_config(short).world.food_radius, load_config(short).world.parents) == (5.0, "resident_slots")
    assert whole.read_text() == dump_toml(load_config(EARLIER / "one" / "config.toml"))


@pytest.mark.parametrize(
    ("text", "path", "value"),
    [
        ("[food]\nbad = {energy = 0.5, toxin = 2.0}", "food.bad.gives.toxin", 2.0),
        ("food.bad = {energy = 0.5}", "food.bad.gives.energy", 0.5),
        ('fidelity = "text"', "fidelity", "as_printed"),
        ("reward = {see = {agent = {coef = 0.5}}}", "species.agent.reward.pay.see_agent.coef", 0.5),
        ("species.a = {birth = {delay = 2.0}}\nspecies.b = {}", "species.a.birth.logit_offset", 2.0),
        (
            '[species.a.birth]\norder = "after_deaths" # why\n[species.b.birth]\norder = "after_deaths"',
            "species.b",
            None,
        ),
    ],
)
def test_tables_of_one_line_and_empty_ones_are_rewritten(write: Write, text: str, path: str, value: Any) -> None:
    file = write(text)
    migrated, config = migrated_file(file)
    file.write_text(migrated)
    assert load_config(file) == config
    found = value_at(config, path)
    assert value is None or found == value
    assert ("# why" in migrated) == ("# why" in text)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        (
            "[birth]\ndelay = 1.0\nlogit_offset = 2.0",
            r"birth\.delay = 1\.0: is called birth\.logit_offset now, which is 2",
        ),
        (
            '[birth]\norder = "after_deaths"\n[species.a.birth]\norder = "before_deaths"\n[species.b]',
            r'species\.a\.birth\.order = "before_deaths": is called world\.birth_order now, which is "after_deaths"',
        ),
        (
            "[food.normal]\nenergy = 2.0\ngives.energy = 3.0",
            r"food\.normal\.energy = 2\.0: is called food\.normal\.gives\.energy",
        ),
        (
            "[reward]\nsee.agent.coef = 0.3\npay.see_agent.coef = 0.5",
            r"reward\.see\.agent = .*: is called reward\.pay\.see_agent now",
        ),
        ('[reward]\nfamily = "by_age"\ngate = "energy"', r'reward\.family = "by_age": means reward\.gate = "age"'),
        ("hello = 3", "hello: unknown name"),
        ('[factor]\n"birth.delay" = [1.0]', "factor: unknown name"),
    ],
)
def test_a_file_that_cannot_be_rewritten_stays_as_it_is(write: Write, text: str, says: str) -> None:
    file = write(text)
    done = hedon("config", "migrate", str(file))
    assert done.returncode == 2
    assert re.search(says, done.stderr)
    assert file.read_text() == text


def test_lines_keep_their_ends(tmp_path: Path) -> None:
    """Those of Windows are two signs."""
    file = tmp_path / "windows.toml"
    file.write_bytes(b"body.food_radius = 5.0\r\n# more\r\nbirth.delay = 3\r\n")
    assert hedon("config", "migrate", file).returncode == 0
    lines = file.read_bytes().split(b"\n")
    assert len(lines) > 3
    assert b"\r\r" not in b"".join(lines)
    assert load_config(file).world.food_radius == 5.0


def test_a_comment_that_goes_with_its_line_is_shown(tmp_path: Path) -> None:
    file = tmp_path / "short.toml"
    dotted = "reward.see.predator = { coef = 0.5 }  # fear\nreward.see.prey.coef = 0.2  # company\n"
    file.write_text(f"# mine\npreset = 'predator'\n[species.prey]\n{dotted}birth.kappa = 0.1  # often\n")
    answer = hedon("config", "migrate", str(file))
    assert answer.returncode == 0
    assert [line.rpartition(": ")[2] for line in answer.stderr.splitlines()] == ["# fear", "# company"]
    kept = file.read_text()
    assert all(comment in kept for comment in ("# mine", "# often"))
    assert load_config(file).species["prey"].reward.pay["see_predator"].coef == 0.5


@pytest.mark.parametrize("old", MOVED)
def test_a_setting_that_moved_is_refused_with_its_new_name(write: Write, old: str) -> None:
    new = MOVED[old]
    known = {f"{place}.{name}" for place, each in sections(SpeciesConfig).items() for name in settings(each.type)}
    known |= {f"store.{store}.{name}" for store in STORES for name in (*settings(StoreConfig), *sections(StoreConfig))}
    known |= {"energy.set_point"}
    assert old not in known
    assert new in known | {f"world.{name}" for name in settings(WorldConfig)}
    said = f"{old}: is called {new} now"
    with pytest.raises(ConfigError, match=re.escape(said)):
        load_config("baseline", overrides=[f"{old}=1"])
    with pytest.raises(ConfigError, match=re.escape(said)):
        load_config(write(f"{old} = 1\n"))
    with pytest.raises(ConfigError, match=rf"species\.prey\.{re.escape(old)}: is called .*{re.escape(new)} now"):
        load_config(write(f"species.prey.{old} = 1\n"))
    with pytest.raises(ConfigError, match=re.escape(said)):
        load_config("baseline").with_(old, 1)


@pytest.mark.parametrize("path", VALUES)
def test_a_choice_with_another_name_is_refused_with_it(path: str) -> None:
    for old, new in VALUES[path].items():
        said = f'{path} = "{old}": is called "{new}" now'
        with pytest.raises(ConfigError, match=re.escape(said)):
            load_config("baseline", overrides=[f"{path}={old}"])
        rest = ["birth.network=initial"] if new == "fixed" else []
        assert flatten(load_config("baseline", overrides=[f"{path}={new}", *rest]))[path] == new


@pytest.mark.parametrize("given", ['reward.family = "by_age"', '[species.agent.reward]\nfamily = "by_age"'])
def test_weights_by_age_get_age_as_their_gate(write: Write, given: str) -> None:
    file = write(f"{given}  # the old like action\n")
    file.write_text(migrated_file(file)[0])
    assert "# the old like action" in file.read_text()
    reward = load_config(file).species["agent"].reward
    assert (reward.family, reward.gate) == ("between", "age")
    whole = (EARLIER / "one" / "config.toml").read_text().replace('family = "linear"', 'family = "by_age"')
    own = parse_config(whole, "here").species["agent"].reward
    assert (own.family, own.gate) == ("between", "age")
    assert parse_config(whole.replace("by_age", "hungry"), "here").species["agent"].reward.gate == "energy"


@pytest.mark.parametrize(
    ("text", "term", "pay"),
    [
        ("[reward.see.normal]\ncoef = 0.5\nover_rays = 'max'", "see_normal", PayConfig("see_normal_max", 0.5)),
        ("reward.see.wall = { reads = 'normal' }", "see_wall", PayConfig("see_normal", 0.1)),
        ("sensor.smells = ['normal']\nreward.smell.normal.gene.initial_sd = 0.2", "smell_normal", PayConfig("", 0.1)),
        ("preset = 'pitfall'\nreward.see.obstacle.reads = 'normal'", "see_obstacle", PayConfig("see_normal_max", 0.1)),
        ("preset = 'pitfall'\n[reward.see.agent]\nover_rays = 'mean'", "see_agent", PayConfig("see_agent", 0.1)),
        ("preset = 'predator'\nspecies.prey.reward.see.prey.coef = 0.3", "see_prey", PayConfig("", 0.3)),
    ],
)
def test_rewards_for_sights_and_smells_are_terms_like_others(
    write: Write, text: str, term: str, pay: PayConfig
) -> None:
    file = write(f"{text}  # said\n")
    with pytest.raises(ConfigError, match=f"is called .*reward.pay.{term} now"):
        load_config(file)
    file.write_text(migrated_file(file)[0])
    assert "# said" in file.read_text()
    found = next(iter(load_config(file).species.values())).reward.pay[term]
    assert (found.channel, found.coef) == (pay.channel, pay.coef)


def test_paths_of_sights_are_refused_with_their_new_names() -> None:
    with pytest.raises(ConfigError, match=r"reward\.see\.normal: is called reward\.pay\.see_normal now"):
        load_config("baseline", overrides=["reward.see.normal.over_rays=max"])
    with pytest.raises(ConfigError, match=r"is called reward\.pay\.see_normal\.channel now"):
        load_config("baseline").with_("reward.see.normal.reads", "wall")


def test_founders_of_the_first_versions_are_read(tmp_path: Path) -> None:
    text = (EARLIER / "one" / "config.toml").read_text()
    genes = r"\n\n\[(genome\.action|genome\.neutral|food\.\w+\.gene)\]\ninitial_mean.*\ninitial_sd.*"
    text, count = re.subn(genes, "", text)
    assert count == 4
    old = "neutral_count = 2\ninitial_mean_food = 0.5\ninitial_mean_action = 2.0\ninitial_sd = 0.1"
    text = re.sub(r"\nacting_weights.*", "", text.replace("neutral_count = 2", old))
    file = tmp_path / "config.toml"
    file.write_text(text)
    config = load_config(file)
    own = config.species["agent"]
    assert (own.genome.action, own.genome.neutral) == (GeneConfig(2.0, 0.1), GeneConfig(0.0, 0.1))
    assert {food.gene for food in config.food.values()} == {GeneConfig(0.5, 0.1)}
    assert own.learning.acting_weights == "float32", "what these versions did"


def test_another_schema_is_refused(write: Write) -> None:
    text = dump_toml(load_config("baseline"))
    for other in ('"2"', "1"):
        with pytest.raises(ConfigError, match=f'schema = {other}: must be "1"'):
            load_config(write(text.replace('schema = "1"', f"schema = {other}")))


@pytest.mark.parametrize("name", ["one", "two"])
def test_an_earlier_run_is_read_and_checked_but_not_continued(tmp_path: Path, name: str) -> None:
    folder = tmp_path / name
    shutil.copytree(EARLIER / name, folder)
    assert check_run(folder).findings == ()
    run = open_run(folder)
    assert run.manifest.config_digest == digest(load_config(folder / "config.toml"))
    assert summarize(run)["steps"] == 256
    if name == "one":
        with pytest.raises(RecordError, match=r"was made by a version of hedon before 1\.0"):
            resume(folder, 512)
