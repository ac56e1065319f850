"""Shared by all tests: a fixture that writes a config file, and a test order that keeps all workers busy."""

import gc
import os
from collections.abc import Callable
from pathlib import Path

import pytest

from hedon.cli.start import OBJECTS_BEFORE_COLLECTION

# The threads of NumPy's BLAS spin while they wait for one another, on processors that other workers could use.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
# As in the command: libraries and tests make many objects that stay, which Python would search for garbage too often.
gc.set_threshold(OBJECTS_BEFORE_COLLECTION)

TESTS = Path(__file__).parent
LONGEST = (
    "test_combination.py",
    "test_assay.py",
    "test_reference_model.py",
    "test_browser.py",
    "test_replay_parts.py",
    "test_resume.py",
    "test_killed.py",
    "test_live.py",
    "test_report.py",
    "test_run.py",
    "test_notebooks.py",
    "test_ray.py",
    "test_ppo.py",
    "test_sweep_run.py",
    "test_module.py",
    "test_story_reader.py",
    "test_story_order.py",
    "test_picture.py",
    "test_docs.py",
    "test_cuda_run.py",
    "test_site.py",
    "test_classics.py",
    "test_learner_study.py",
    "test_store.py",
    "test_damaged_file.py",
    "test_cuda_window.py",
    "test_cuda_variant.py",
    "test_kernel_symbols.py",
    "test_cli_study.py",
    "test_contest.py",
    "test_lock.py",
    "test_page.py",
)
"""Files that take more than about ten seconds of processor time, longest first."""


MORE = (
    "cli/test_assay.py",
    "cli/test_bench.py",
    "cli/test_cli_study.py",
    "cli/test_input.py",
    "cli/test_output.py",
    "cli/test_run.py",
    "cli/test_signal.py",
    "contract/test_checkpoint.py",
    "contract/test_cuda_failure.py",
    "contract/test_cuda_run.py",
    "contract/test_cuda_value.py",
    "contract/test_cuda_variant.py",
    "contract/test_cuda_window.py",
    "contract/test_disk.py",
    "contract/test_folder.py",
    "contract/test_jobs.py",
    "contract/test_kernel_symbols.py",
    "contract/test_killed.py",
    "contract/test_mechanism_record.py",
    "contract/test_mechanism_report.py",
    "contract/test_resume.py",
    "contract/test_rule_neighbor.py",
    "contract/test_rule_place.py",
    "env/test_jax.py",
    "env/test_record.py",
    "env/test_value.py",
    "machine/",
    "property/test_combination.py",
    "property/test_damaged_file.py",
    "property/test_untrusted_checkpoint.py",
    "repository/test_device_text.py",
    "repository/test_docs.py",
    "repository/test_notebooks.py",
    "repository/test_site.py",
    "repository/test_typing.py",
    "sweep/test_lock.py",
    "sweep/test_store.py",
    "sweep/test_sweep_run.py",
    "unit/check/test_check_run.py",
    "unit/check/test_difference.py",
    "unit/demography/test_forecast.py",
    "unit/demography/test_unlearned.py",
    "unit/report/test_page.py",
    "unit/report/test_report.py",
    "unit/study/test_classics.py",
    "unit/study/test_study.py",
    "view/",
)
"""Files and folders that only `make test-more` runs, except for their tests marked `smoke`: browsers, emulated devices,
killed processes, complete reports and sites."""

SHARES = {"test_calibration.py": 4, "test_reference_model.py": 7}
"""Files in which `make test` runs one case out of this many; `make test-more` runs the others."""

THINNED = {
    "test_a_copy_goes_on_alone": 4,
    "test_a_copy_of_driven_worlds_goes_on_alone": 3,
    "test_a_copy_on_the_device_goes_on_alone": 3,
    "test_a_damaged_file_ends_no_command_in_a_traceback": 3,
    "test_a_reader_that_has_enough_is_no_fault": 2,
    "test_a_resumed_run_is_the_run_left_alone": 3,
    "test_a_signal_ends_after_the_window_and_keeps_everything": 3,
    "test_a_signal_ends_it_with_the_code_of_the_shell": 3,
    "test_a_window_has_the_bits_of_the_native_engine": 3,
    "test_an_item_is_made_from_no_world_one_and_several": 2,
    "test_damage_to_files_is_named": 2,
    "test_damage_to_rows_is_named_also_without_checkpoints": 2,
    "test_learners_that_scale_and_normalize_have_the_bits_of_the_native_engine": 2,
    "test_queries_of_two_species_have_the_bits_of_the_native_engine": 2,
    "test_threads_change_no_bit": 4,
    "test_unit_defines_only_its_table": 2,
    "test_values_that_no_run_has_end_no_command_in_a_traceback": 2,
}
"""Tests of which `make test-more` runs one case out of this many; `make test-long` runs the others."""


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Marks tests for `make test-more` and `make test-long`; sorts long files first so that workers finish together."""
    seen = dict.fromkeys((*SHARES, *THINNED), 0)
    for item in items:
        name = getattr(item, "originalname", item.name)
        if name in THINNED:
            if seen[name] % THINNED[name]:
                item.add_marker(pytest.mark.long)
            seen[name] += 1
        path = item.path.relative_to(TESTS).as_posix()
        if path.startswith(MORE) and item.get_closest_marker("smoke") is None:
            item.add_marker(pytest.mark.more)
        elif item.path.name in SHARES:
            if seen[item.path.name] % SHARES[item.path.name]:
                item.add_marker(pytest.mark.more)
            seen[item.path.name] += 1
    items.sort(key=lambda item: LONGEST.index(item.path.name) if item.path.name in LONGEST else len(LONGEST))


@pytest.fixture
def write(tmp_path: Path) -> Callable[[str], Path]:
    """Writes a config file and returns its path."""

    def write(text: str) -> Path:
        path = tmp_path / "my.toml"
        path.write_text(text, encoding="utf-8")
        return path

    return write
