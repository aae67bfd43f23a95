"""Evaluators that take their host with them: once, or each time."""

from __future__ import annotations

import pytest
from ordeal import RAY, Ordeal, noise, slowed
from traps import Trap


def test_one_that_crashes_its_process_once(place, note) -> None:
    ordeal = Ordeal(place, slowed(), Trap("evaluate", "south", who="host", nth=90, does="crash"))
    ended = ordeal.ended(ordeal.run(*RAY), 0)
    ((_, detail),) = ordeal.events("recovery")
    assert "south" in detail["reason"]
    assert noise(ended.err) == []
    assert ordeal.same()
    note("evaluator crashes its process", "once", ordeal.recovered_s())


@pytest.mark.ray
def test_one_that_crashes_its_process_each_time(place, note) -> None:
    """The run fails in a line, after a few losses; it goes on when the plug-in is mended."""
    ordeal = Ordeal(place, slowed(1), Trap("fit", "27", who="host", does="SEGV", always=True))
    ended = ordeal.ended(ordeal.run(*RAY), 1)
    # Both hosts crash at about the same moment: one of them may be found dead only as it is to start again.
    assert "died and could not " in ended.complaint
    assert "; it held " in ended.complaint
    assert "it is the 4th loss in a row without an epoch in between; go on with: " in ended.complaint
    assert len(ordeal.events("recovery")) >= 3
    assert ordeal.manifest()["status"] == "failed"
    ordeal.lay()
    resumed = ordeal.ended(ordeal.resume(), 0)
    assert resumed.told["status"] == "finished"
    assert ordeal.same()
    note("evaluator crashes its process", "each time; mended, then resumed", ordeal.recovered_s(ordeal.started))
