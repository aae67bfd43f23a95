"""A run in a bucket whose server is gone, and back; and whose driver is killed."""

from __future__ import annotations

import signal

from buckets import environment, reaching, serving
from ordeal import Ordeal, slowed, undisturbed
from proxy import Proxy

RUNS = "s3://bucket/runs"


def sealed(ordeal: Ordeal) -> list[str]:
    return [name for name in ordeal.store.names("checkpoints") if name.endswith(".json")]


def test_a_store_that_is_gone_and_back(place, note) -> None:
    with serving() as server, reaching(server):
        wire = Proxy(server)
        ordeal = Ordeal(place, slowed(8), runs=RUNS, environment=environment(wire.endpoint))
        process = ordeal.run()
        ordeal.until(lambda: sealed(ordeal), process)
        wire.cut()
        ended = ordeal.ended(process, 1)
        assert "go on then with: atoll resume s3://bucket/runs/bits" in ended.complaint
        wire.mend()
        told = ordeal.ended(ordeal.resume(), 0).told
        assert told["status"] == "finished"
        wire.cut()
        assert ordeal.digest() == undisturbed(ordeal.data)
    note("store not to be reached", "in mid-run, then back (S3)", None)


def test_a_driver_killed_in_a_bucket(place, note) -> None:
    """Its lease is fresh, and its process gone: on the same machine nobody has to wait for it to grow old."""
    with serving() as server, reaching(server):
        ordeal = Ordeal(place, slowed(8), runs=RUNS, environment=environment(server))
        process = ordeal.run()
        ordeal.until(lambda: sealed(ordeal), process)
        second = ordeal.ended(ordeal.resume(), 2)
        assert "a run that nobody drives" in second.complaint
        process.send_signal(signal.SIGKILL)
        ordeal.ended(process, -signal.SIGKILL)
        ordeal.ended(ordeal.resume(), 0)
        assert ordeal.digest() == undisturbed(ordeal.data)
    note("driver killed", "in mid-run (S3)", None)
