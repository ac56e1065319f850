"""Every recorded step is whole: no part of a table ends within a step, and readers join the split steps of old runs."""

from collections import Counter
from functools import partial

import polars as pl
import pytest
from split_run import FRAMES, record_species, split_parts

from hedon.record.folder import part_paths
from hedon.record.reader import open_run
from hedon.record.writer import Writer
from hedon.video.moment import open_footage

STEPS = range(FRAMES, 257, FRAMES)


@pytest.fixture(scope="module")
def species_run(tmp_path_factory):
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("hedon.experiment.run.Writer", partial(Writer, part_rows=3))
        return record_species(tmp_path_factory.mktemp("whole") / "run")


@pytest.mark.parametrize("table", ["frames", "population"])
def test_a_part_never_ends_within_a_step(species_run, table):
    parts = [set(pl.read_parquet(path)["step"]) for path in part_paths(species_run, table)]
    assert len(parts) >= (len(STEPS) if table == "frames" else 4)
    assert sum(map(len, parts)) == len(set().union(*parts))


def shown(folder, world):
    """What a video shows at each recorded step: the number of each kind, and the ids."""
    footage = open_footage(folder, open_run(folder).manifest.seeds[world])
    found = {}
    for step in STEPS:
        (moment,) = footage.moments(step, step, 1)
        kinds = [moment.species_names[each] for each in moment.species]
        kinds += [moment.food_kinds[each] for each in moment.food_kind]
        found[moment.step] = Counter(kinds), moment.agent_id.tolist()
    return found


@pytest.mark.parametrize("world", [0, 1])
def test_a_moment_has_every_agent_wherever_parts_end(species_run, world):
    rows = open_run(species_run).frames().filter(pl.col("world") == world).collect()
    recorded = {
        step: (Counter(mine["kind"]), sorted(mine["id"].drop_nulls()))
        for (step,), mine in rows.group_by("step", maintain_order=True)
    }
    assert sorted(recorded) == list(STEPS)
    assert shown(species_run, world) == recorded
    for size in (700, 150):
        assert split_parts(species_run, "frames", size) > 5
        assert shown(species_run, world) == recorded
