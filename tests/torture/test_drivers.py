"""The driver is killed at a moment, and ``atoll resume`` goes on: in one process with its host, and so quick."""

from __future__ import annotations

import signal

import pytest
from ordeal import Ordeal, slowed, tortured
from traps import Trap

CHECKPOINT = "*/checkpoints/e00000[3-8]"
AT = {
    "as the run's folder is filled": Trap("write", "*/.bits.*/manifest.json"),
    "as the islands are made": Trap("build", "south", nth=2),
    "in epoch 0": Trap("evaluate", "north-*", nth=5),
    "before the first checkpoint": Trap("evaluate", "south", nth=30),
    "in an epoch after a checkpoint": Trap("evaluate", "north-*", nth=550),
    "before a log move": Trap("write", "*/log/individuals/e00000[1-6]-*", "draft"),
    "in the middle of a log file": Trap("write", "*/log/individuals/e00000[1-6]-*", "half"),
    "between two tables of the log": Trap("write", "*/log/evaluations/e00000[1-6]-*"),
    "between the log and the part": Trap("write", f"{CHECKPOINT}/host-*"),
    "in the middle of a part": Trap("write", f"{CHECKPOINT}/host-*", "half"),
    "between the parts and the JSON": Trap("write", f"{CHECKPOINT}.json"),
    "in the middle of the JSON": Trap("write", f"{CHECKPOINT}.json", "half"),
    "just after the JSON": Trap("write", f"{CHECKPOINT}.json", "after"),
    "as an old checkpoint is pruned": Trap("remove", "*/checkpoints/e*.json", "after"),
    "in the last epoch": Trap("evaluate", "south", nth=190),
    "as the rest of the log is written": Trap("write", "*/log/individuals/e*-000012-*"),
    "as forms are written": Trap("form", "north-*", nth=4),
    "before the manifest's last word": Trap("write", "*/manifest.json", nth=2),
    "just after its last word": Trap("write", "*/manifest.json", "after", nth=2),
}
SAMPLE = ("in the middle of a part", "between the parts and the JSON")


@pytest.mark.parametrize("moment", [pytest.param(at, marks=pytest.mark.ray) if at in SAMPLE else at for at in AT])
def test_a_driver_that_is_killed(place, note, moment: str) -> None:
    ordeal = Ordeal(place, tortured(), AT[moment])
    ordeal.ended(ordeal.run(), -signal.SIGKILL)
    assert len(ordeal.marks()) == 1
    if moment == "as the run's folder is filled":
        assert list(ordeal.path.parent.glob("bits")) == []
        ordeal.ended(ordeal.run(), 0)
    elif moment == "just after its last word":
        assert ordeal.manifest()["status"] == "finished"
    else:
        before = ordeal.checkpoints()
        ended = ordeal.ended(ordeal.resume(), 0)
        epoch = max(before, default=-1)
        assert (f"going on after epoch {epoch}" if before else "no checkpoint: beginning anew") in ended.err
        assert ordeal.events("resume")[0][1]["epoch"] == epoch
    assert ordeal.manifest()["status"] == "finished"
    assert ordeal.same()
    back = ordeal.marks("back")
    note("driver killed", moment, ordeal.recovered_s(ordeal.started) if back else None)


AT_RESUME = {
    "as the first log file is cut off": Trap("remove", "*/log/*.parquet"),
    "as the log is half cut off": Trap("remove", "*/log/*.parquet", "after", nth=3),
    "as its new settings are written": Trap("write", "*/experiment.yaml", "draft"),
    "before it says that it runs": Trap("write", "*/manifest.json"),
    "in the middle of its first event": Trap("write", "*/log/events/run-*", "half"),
}


@pytest.mark.parametrize("moment", AT_RESUME)
def test_a_driver_that_is_killed_while_it_resumes(place, note, moment: str) -> None:
    ordeal = Ordeal(place, slowed(), Trap("evaluate", "south", nth=170))
    ordeal.ended(ordeal.run(), -signal.SIGKILL)
    before, last = ordeal.checkpoints()[-2:]
    # Its parts stay, and the log up to it: there is something to cut off.
    (ordeal.path / f"checkpoints/e{last:06d}.json").unlink()
    # The first place is that of the trap that struck.
    ordeal.lay(Trap("build", "none"), AT_RESUME[moment])
    ordeal.ended(ordeal.resume(), -signal.SIGKILL)
    assert len(ordeal.marks()) == 2
    ended = ordeal.ended(ordeal.resume(), 0)
    assert f"going on after epoch {before}\n" in ended.err
    assert not list(ordeal.path.glob("checkpoints/.*"))
    assert ordeal.same()
    note("driver killed during resume", moment, ordeal.recovered_s(ordeal.started))
