"""How much would a number change with other agents? A cluster bootstrap that resamples whole families."""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from hedon.statistic.interval import LEVEL

REPLICATES = 1000
"""Number of replicates, enough for the 2.5 % points of an interval: about 25 are beyond each."""

# Poisson numbers with mean 1 from one random byte each: 94 of 256 bytes give 0, 94 give 1, 47 give 2, and so on.
# The mean and the variance are 1.004; a draw takes a nanosecond.
_COUNTS = np.repeat(np.arange(6, dtype=np.float32), (94, 94, 47, 16, 4, 1))
_CHUNK = 4_000_000  # numbers held at a time, 16 MB


def resampled_sums(
    features: NDArray[np.float64],
    cluster: NDArray[np.int64],
    rng: np.random.Generator,
    replicates: int = REPLICATES,
) -> NDArray[np.float64]:
    """Sums of features over bootstrap samples of clusters.

    The number of times that a cluster is drawn is Poisson-distributed with mean 1, the limit of drawing with
    replacement for many clusters.

    Args:
        features: Features of each agent, shape (n, q). They should be of order 1, since sums are computed in float32.
        cluster: Index of each agent's cluster, shape (n,), n > 0; agents of a cluster are drawn together.
        rng: Source of random numbers.
        replicates: Number of bootstrap samples.

    Returns:
        The sums of each sample, shape (replicates, q).
    """
    order = np.argsort(cluster, kind="stable")
    starts = np.flatnonzero(np.diff(cluster[order], prepend=cluster[order[:1]] - 1))
    sums = np.add.reduceat(features[order], starts, axis=0).astype(np.float32)
    return np.concatenate([(draws @ sums).astype(np.float64) for draws in _draws(rng, replicates, len(sums))])


def percentile_interval(values: NDArray[np.float64], level: float = LEVEL) -> NDArray[np.float64]:
    """The percentile interval of bootstrap replicates; NaN if a replicate is not finite.

    Args:
        values: The replicates, shape (replicates, …).
        level: Confidence level.

    Returns:
        Lower and upper bound, shape (2, …).
    """
    tail = 0.5 * (1.0 - level)
    return np.quantile(values, (tail, 1.0 - tail), axis=0)


def _draws(rng: np.random.Generator, replicates: int, count: int) -> Iterator[NDArray[np.float32]]:
    """How often each cluster is drawn, in blocks of several replicates."""
    piece = max(_CHUNK // max(count, 1), 1)
    for start in range(0, replicates, piece):
        yield _COUNTS[rng.integers(0, 256, (min(piece, replicates - start), count), np.uint8)]
