"""The engine's probes of the processor: the speed of reading and of computing."""

import threading
import time
from itertools import pairwise

import pytest
from learning_case import KERNELS

from hedon import _engine


@pytest.mark.parametrize("kernel", KERNELS)
def test_rates_are_positive_and_bad_sizes_are_refused(kernel):
    assert _engine.kernel.read_rate(kernel, 1 << 16, 4) > 0
    assert _engine.kernel.calibrate(kernel, 1000) > 0
    with pytest.raises(ValueError, match="bytes: at least 256; rounds: at least 1"):
        _engine.kernel.read_rate(kernel, 255, 1)
    with pytest.raises(ValueError, match="rounds: at least 1"):
        _engine.kernel.calibrate(kernel, 0)


@pytest.mark.parametrize(
    ("probe", "arguments"), [("calibrate", ("portable", 60_000_000)), ("read_rate", ("portable", 1 << 20, 12_000))]
)
def test_other_threads_keep_running_while_a_rate_is_measured(probe, arguments):
    worker = threading.Thread(target=getattr(_engine.kernel, probe), args=arguments)
    worker.start()
    seen = [time.perf_counter()]
    while worker.is_alive():
        seen.append(time.perf_counter())
    worker.join()
    assert seen[-1] - seen[0] > 0.05
    assert max(after - before for before, after in pairwise(seen)) < 0.5 * (seen[-1] - seen[0])
