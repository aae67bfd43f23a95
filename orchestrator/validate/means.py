"""Comparing mean times with published ones."""

from __future__ import annotations

from orchestrator.validate.case import Outcomes, Verdict
from orchestrator.validate.statistics import mean_interval


def compared(check: str, case: str, published: float, decimals: int, outcomes: Outcomes, comparisons: int) -> Verdict:
    """Compare the mean of a case with a published one, which is known to so many decimals and from as many runs."""
    done = [value for value in outcomes if value is not None]
    expected = f"{published:.{decimals}f}"
    if len(done) < len(outcomes):
        detail = "there are runs that did not come to their end"
        return Verdict(check, case, expected, None, None, None, len(outcomes), ok=False, detail=detail)
    found = mean_interval(done, comparisons, published_runs=len(done))
    rounding = 0.5 * 10.0**-decimals
    ok = found.low - rounding <= published <= found.high + rounding
    return Verdict(check, case, expected, found.estimate, found.low, found.high, len(done), ok)
