from collections import Counter
from pathlib import Path

import numpy as np
import pytest

from hedon.config import load_config
from hedon.record.founder import FounderError, Founders, join, make_founders, unknown_gene
from hedon.record.founder_source import parse_point, read_founders
from hedon.record.founder_table import load_founders, read_table

CONFIG = load_config("poison")


def table(text: str, folder: Path) -> Founders:
    path = folder / "table.csv"
    path.write_text(text)
    return read_table(path, CONFIG)


def pair(shares: dict[str, float] | None = None) -> Founders:
    values = np.arange(12, dtype=np.float32).reshape(6, 2) / 2
    return make_founders(("w_normal", "w_action"), values, ["a"] * 4 + ["b"] * 2, shares)


def test_a_table_is_the_same_after_writing_and_reading(tmp_path: Path) -> None:
    odd = np.array([[np.float32(0.1), np.nan], [np.float32(1 / 3), -10]], np.float32)
    founders = make_founders(("w_action", "neutral_1"), odd, ["x", "y, z"], {"x": 1, "y, z": 2})
    (tmp_path / "t.csv").write_bytes(founders.content)
    again = read_table(tmp_path / "t.csv", CONFIG)
    np.testing.assert_array_equal(again.values, founders.values)
    assert (again.genes, again.group, again.digest) == (founders.genes, founders.group, founders.digest)


def test_short_names_and_empty_cells(tmp_path: Path) -> None:
    founders = table("food,w_poison,action\n1,,2\n3,4,5\n", tmp_path)
    assert founders.genes == ("w_normal", "w_poison", "w_action")
    assert np.isnan(founders.values[0, 1])
    assert founders.group == ("table", "table")


def test_each_group_gets_its_share() -> None:
    for seed in range(20):
        assert Counter(pair().groups(seed, 51)) == {"a": 34, "b": 17}
        assert Counter(pair({"a": 1, "b": 1}).groups(seed, 50)) == {"a": 25, "b": 25}
        assert Counter(pair({"a": 0.9, "b": 0.1}).groups(seed, 7)) == {"a": 6, "b": 1}


def test_the_draw_depends_on_the_seed_alone_and_uses_all_rows() -> None:
    draws = [tuple(pair().draw(seed, 6).tolist()) for seed in range(50)]
    assert draws == [tuple(pair().draw(seed, 6).tolist()) for seed in range(50)]
    assert all(sorted(draw) == list(range(6)) for draw in draws), "as many founders as rows: each row once"
    assert len(set(draws)) > 40
    first = Counter(draw[0] for draw in draws)
    assert set(first) == set(range(6)), "any row may come first"
    # Identical in every version: this draw is part of what a run's seed means.
    assert draws[1] == (5, 0, 4, 2, 3, 1)


def test_joined_tables_are_groups_with_the_genes_of_both() -> None:
    point = make_founders(("w_poison",), np.array([[7.0]]), ["p"])
    both = join([pair(), point], ["a", "p"], [3, 1])
    assert both.genes == ("w_normal", "w_action", "w_poison")
    assert both.share == {"a": 0.75, "p": 0.25}
    genomes = both.genomes(1, 8, ("w_normal", "w_poison", "w_action", "neutral_1"))
    assert np.isnan(genomes[:, 3]).all()
    assert (genomes[:, 1] == 7).sum() == 2
    assert np.isnan(genomes[genomes[:, 1] == 7][:, [0, 2]]).all()


def test_sources_and_mixtures() -> None:
    assert parse_point("food=5, action=-2", CONFIG) == {"w_normal": 5.0, "w_action": -2.0}
    both = read_founders("food=5,action=1:0.25,food=0,action=0:0.75", CONFIG)
    assert both.share == {"food=5,action=1": 0.25, "food=0,action=0": 0.75}
    np.testing.assert_array_equal(both.values, [[5, 1], [0, 0]])


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "line 1: must name at least one gene"),
        ("group\na\n", "line 1: must name at least one gene"),
        (
            "fod\n1\n",
            "there is no gene 'fod' (there are normal, poison, action, neutral_1 to neutral_16); did you mean food",
        ),
        ("acton\n1\n", "did you mean action?"),
        ("neutral_17\n1\n", "there is no gene 'neutral_17'"),
        ("food,normal\n1,1\n", "the gene 'normal' appears twice"),
        ("food\n", "must have from 1 to 100,000 rows"),
        ("food\n1\n\nx\n", "line 4, food = 'x': must be a number from -10 to 10"),
        ("food\nnan\n", "line 2, food = 'nan': must be a number from -10 to 10"),
        ("food\n10.5\n", "line 2, food = '10.5': must be a number from -10 to 10"),
        ("food,action\n1\n", "line 2: has 1 cells, but there are 2 columns"),
        ("food,share\n1,0\n", "line 2, share = 0: must be above 0, and the same in all rows of a group"),
        ("food,share\n1,1\n1,2\n", "line 3, share = 2: must be above 0, and the same"),
        ('food\n"1\n', "it is not CSV"),
    ],
)
def test_a_bad_table_is_refused_and_the_place_is_named(text: str, message: str, tmp_path: Path) -> None:
    with pytest.raises(FounderError) as caught:
        table(text, tmp_path)
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("nowhere.csv", "cannot be read: No such file"),
        ("nowhere@7", "there is no such file or folder"),
        ("runs@x", "'x' is not a step"),
        ("food=11", "food = 11: must be one number from -10 to 10"),
        ("food=1,food=2", "food = 2: must be one number"),
        ("foo=1", "there is no gene 'foo'"),
        ("food=1:0", "is no source with a share above 0"),
        ("food=1:0.5,a.csv", "give every source a share"),
        (",", "is no source"),
    ],
)
def test_a_bad_source_is_refused(text: str, message: str) -> None:
    with pytest.raises(FounderError) as caught:
        read_founders(text, CONFIG)
    assert message in str(caught.value)


def test_a_gene_of_another_species_is_not_suggested() -> None:
    two = load_config("predator")
    for given, own in (("normal", "predator"), ("predator.normal", None)):
        said = unknown_gene(two, given, own)
        assert "(predator has prey, action, see_prey, see_predator, neutral_1 to" in said
        assert "did you mean" not in said
    assert unknown_gene(two, "prey.acton").endswith("; did you mean prey.action?")
    assert "(there are normal, action, see_prey, see_predator, prey, neutral_1" in unknown_gene(two, "sight")


def test_a_changed_table_is_refused(tmp_path: Path) -> None:
    founders = pair()
    config = load_config("poison", overrides=[f'world.founders="{founders.digest}"'])
    (tmp_path / "founders.csv").write_bytes(founders.content)
    found = load_founders(tmp_path, config)
    assert found is not None
    assert found.digest == founders.digest
    (tmp_path / "founders.csv").write_bytes(founders.content.replace(b"0.5", b"0.6"))
    with pytest.raises(FounderError, match="was changed"):
        load_founders(tmp_path, config)
    assert load_founders(tmp_path, CONFIG) is None
