"""Confidence intervals of means and of shares, and what a comparison of two of them decides."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from statistics import NormalDist, fmean, stdev
from typing import Final

CONFIDENCE: Final = 0.95
"""Of all comparisons of a validation together."""


@dataclass(frozen=True, slots=True)
class Interval:
    """An estimate with the bounds that it keeps to at the level asked for."""

    estimate: float
    low: float
    high: float


def quantile(comparisons: int) -> float:
    """Give the two-sided normal quantile at which so many comparisons together keep to ``CONFIDENCE`` (Bonferroni)."""
    return NormalDist().inv_cdf(1 - (1 - CONFIDENCE) / (2 * comparisons))


def mean_interval(values: Sequence[float], comparisons: int, published_runs: int = 0) -> Interval:
    """Give the mean of independent runs with the interval in which a figure published for it should lie.

    Parameters
    ----------
    values
        One figure a run, at least two.
    comparisons
        How many comparisons are made in all.
    published_runs
        Runs behind the published mean, which errs too, by the same spread; 0 for an exact one.
    """
    share = 1 / len(values) + (1 / published_runs if published_runs else 0)
    margin = quantile(comparisons) * stdev(values) * math.sqrt(share)
    mean = fmean(values)
    return Interval(mean, mean - margin, mean + margin)


def share_interval(successes: int, runs: int, comparisons: int) -> Interval:
    """Give a share of successes with its interval (Wilson 1927)."""
    z = quantile(comparisons)
    share = successes / runs
    centre = (share + z * z / (2 * runs)) / (1 + z * z / runs)
    margin = z / (1 + z * z / runs) * math.sqrt(share * (1 - share) / runs + z * z / (4 * runs * runs))
    return Interval(share, centre - margin, centre + margin)


def difference(one: Interval, other: Interval) -> Interval:
    """Give the difference of two shares of independent runs, from the interval of each (Newcombe 1998, method 10)."""
    apart = one.estimate - other.estimate
    low = apart - math.hypot(one.estimate - one.low, other.high - other.estimate)
    high = apart + math.hypot(one.high - one.estimate, other.estimate - other.low)
    return Interval(apart, low, high)
