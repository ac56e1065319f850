"""A batch whose process is lost again and again is given up, unless it makes progress."""

import io
import zipfile

import pytest
from sweep_case import planned, sweep_file

from hedon.ensemble.batch import STATE, BatchJob, batch_job
from hedon.ensemble.cluster import TRIES, RetryLimit
from hedon.ensemble.store import Store


def write_checkpoint(store: Store, task: BatchJob, step: int) -> None:
    """Writes the checkpoint of a batch: a file in its folder, or an archive at a URL."""
    name = f"checkpoints/step-{step:010d}.npz"
    if store.folder is not None:
        (task.folder / "checkpoints").mkdir(parents=True, exist_ok=True)
        (task.folder / name).write_bytes(b"")
        return
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        archive.writestr(name, b"")
    store.write(f"{STATE}/{task.batch.name}.zip", buffer.getvalue())


@pytest.mark.parametrize("kind", ["folder", "url"])
def test_a_batch_is_given_up_if_it_makes_no_progress(tmp_path, kind):
    plan, store = planned(sweep_file(tmp_path), str(tmp_path / "place") if kind == "folder" else f"file://{tmp_path}/x")
    one, other = (batch_job(store.location, plan, batch, tmp_path / batch.name, 1.0) for batch in plan.batches())
    retries = RetryLimit()
    assert [retries.may_go_on(one) for _ in range(TRIES)] == [True] * (TRIES - 1) + [False]
    for step in (0, 1024):
        write_checkpoint(store, other, step)
        assert [retries.may_go_on(other) for _ in range(TRIES - 1)] == [True] * (TRIES - 1)
    assert not retries.may_go_on(other)


def test_the_reason_names_the_worlds_and_what_to_do(tmp_path):
    plan, store = planned(sweep_file(tmp_path), str(tmp_path / "place"))
    batch = next(plan.batches())
    cost = plan.conditions[batch.condition].settings["energy.basic_cost"]
    reason = RetryLimit().reason(
        batch_job(store.location, plan, batch, tmp_path, 1.0), RuntimeError("Out of memory.\nMore.")
    )
    assert f"lost {TRIES} times in a row without a new checkpoint, the last time with: Out of memory. Its" in reason
    assert f"worlds: basic_cost={cost}, seeds 1-2." in reason
    assert "nodes with more" in reason
    assert "More." not in reason
