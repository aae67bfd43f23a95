"""A real cluster of three nodes on this machine, one of which is removed with the host that it has."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
from buckets import environment, reaching, serving
from ordeal import ROOT, Ordeal, is_host, slowed, undisturbed
from traps import PLACE

HOSTS = ("--set", "backend=ray", "--set", "hosts=3")
TOKEN = {"RAY_AUTH_MODE": "token", "RAY_AUTH_TOKEN": "0123456789abcdef" * 4}


@contextmanager
def three_nodes(place: Path, more: dict[str, str]) -> Iterator[tuple[Any, str, dict[str, str]]]:
    """Start a cluster of three nodes of one CPU; give it, its address, and the variables of whoever joins it."""
    paths = os.pathsep.join([str(ROOT), str(ROOT / "tests" / "support")])
    told = {
        **TOKEN, **more, "PYTHONPATH": paths, "ATOLL_TEST": str(place), PLACE: str(place),
        "RAY_USAGE_STATS_ENABLED": "0", "RAY_ENABLE_WINDOWS_OR_OSX_CLUSTER": "1", "OMP_NUM_THREADS": "1",
        "RAY_health_check_period_ms": "500", "RAY_health_check_failure_threshold": "4",
    }  # fmt: skip
    before = {name: os.environ.get(name) for name in told}
    os.environ.update(told)
    cluster = None
    try:
        from ray.cluster_utils import Cluster

        node = {"num_cpus": 1, "object_store_memory": 100 * 2**20, "include_dashboard": False}
        cluster = Cluster(initialize_head=True, head_node_args=node)
        for _ in range(2):
            cluster.add_node(num_cpus=1, object_store_memory=100 * 2**20)
        cluster.wait_for_nodes()
        yield cluster, cluster.address, told
    finally:
        if cluster is not None:
            cluster.shutdown()
        for name, value in before.items():
            os.environ.pop(name, None) if value is None else os.environ.update({name: value})


@contextmanager
def store_of_runs(far: bool) -> Iterator[tuple[str, dict[str, str]]]:
    """Give where runs are to stand, on a disk or in a bucket, and what processes must know to reach it."""
    if not far:
        yield "runs", {}
        return
    with serving() as server, reaching(server):
        yield "s3://bucket/runs", environment(server)


@pytest.mark.filterwarnings("ignore::ResourceWarning", "ignore::pytest.PytestUnraisableExceptionWarning")
@pytest.mark.parametrize("far", [False, True], ids=["disk", "s3"])
def test_a_node_that_is_removed(place, note, far: bool) -> None:
    with store_of_runs(far) as (runs, more), three_nodes(place, more) as (cluster, address, told):
        ordeal = Ordeal(place, slowed(20), runs=runs, environment=told)
        process = ordeal.run(*HOSTS, "--address", address)
        ordeal.until(lambda: [name for name in ordeal.store.names("checkpoints") if name.endswith(".json")], process)
        node = min(cluster.worker_nodes, key=lambda one: str(one.node_id))
        here = [child for child in _below(node) if is_host(child)]
        assert len(here) == 1
        ordeal.strike()
        cluster.remove_node(node, allow_graceful=False)
        ended = ordeal.ended(process, 0)
        assert ended.told["status"] == "finished"
        ((_, detail),) = ordeal.events("recovery")
        assert (detail["hosts"], len(detail["lost"])) == (2, 1)
        assert not here[0].is_running()
        assert ordeal.digest() == undisturbed(ordeal.data)
        where = "with its host, of three" + (", runs on S3" if "://" in runs else "")
        note("node removed", where, ordeal.recovered_s())


def _below(node: Any) -> list[Any]:
    import psutil

    (raylet,) = node.all_processes["raylet"]
    return psutil.Process(raylet.process.pid).children(recursive=True)
