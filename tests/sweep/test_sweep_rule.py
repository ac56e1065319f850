"""A sweep over rules in Python, which are named relative to its file and stored with the sweep."""

import shutil

import pytest
from sweep_case import assert_same_table, planned, sweep_file, table_of

from hedon.config.problem import ConfigError
from hedon.ensemble.batch import batch_job
from hedon.ensemble.error import EnsembleError
from hedon.ensemble.plan import load_config_of, load_rules
from hedon.sweep.read import read_sweep

pytest.importorskip("numba", reason='needs the optional package: pip install "hedon[rules]"')

RULES = """
def once(agent):
    return agent.linear

def twice(agent):
    return 2.0 * agent.linear
"""
FACTORS = """
[factor]
"reward.rule" = ["rules/my.py:once", "rules/my.py:twice"]
"""


def test_a_sweep_keeps_the_rules_that_its_file_names(tmp_path, monkeypatch):
    home = tmp_path / "home"
    (home / "rules").mkdir(parents=True)
    (home / "rules" / "my.py").write_text(RULES)
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    monkeypatch.chdir(elsewhere)
    file = sweep_file(home, 96, rest=FACTORS)
    tables = []
    for name in ("first", "second"):
        plan, store = planned(file, str(tmp_path / name))
        own = plan.conditions[0]
        first = load_config_of(store, own.digest, own.base, plan.changes(own))
        assert first.species["agent"].reward.rule == f"my.py:once@{load_rules(store, first)[0].digest}"
        if name == "second":  # the plan no longer needs the files
            shutil.rmtree(home)
        for batch in plan.batches():
            task = batch_job(store.location, plan, batch, tmp_path / name / "work" / batch.name, 1e9)
            assert task.make(1, None) == "finished"
        tables.append(table_of(store.location))
    assert_same_table(*tables)
    assert tables[0]["digest"].n_unique() == 4  # two rules, two seeds
    shutil.rmtree(tmp_path / "second" / "rules")
    with pytest.raises(EnsembleError, match=r"has no text of the rule my\.py:once@"):
        load_rules(store, first)


def test_a_missing_rule_is_named(tmp_path):
    with pytest.raises(ConfigError, match=rf"cannot read {tmp_path}/rules/my\.py: No such file"):
        read_sweep(sweep_file(tmp_path, 96, rest=FACTORS))
