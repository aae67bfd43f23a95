"""Room for hosts: the CPUs of this machine, and whether there is a Ray cluster at an address."""

from __future__ import annotations

import contextlib
import math
import os
import secrets
import socket
import subprocess
import sys
from pathlib import Path
from typing import Final

from genome.errors import InputError
from islands.host import THREAD_VARIABLES
from orchestrator.backends.protocol import RunFailedError

HOSTS_PER_CPU: Final = 4
CONNECT_S: Final = 5.0
PROBE_S: Final = 20.0
PROBE: Final = """
import logging, sys, ray
try:
    ray.init(address=sys.argv[1], log_to_driver=False, logging_level=logging.ERROR)
except Exception as error:
    sys.exit(str(error).strip().splitlines()[0] if str(error).strip() else type(error).__name__)
"""


def machine_cpus() -> int:
    """Give the CPUs that this process may use: the affinity mask, cut down by a control group's quota."""
    cpus = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else (os.cpu_count() or 1)
    with contextlib.suppress(OSError, ValueError):
        quota, period = Path("/sys/fs/cgroup/cpu.max").read_text(encoding="ascii").split()
        if quota != "max":
            cpus = min(cpus, max(1, math.ceil(int(quota) / int(period))))
    return max(1, cpus)


def hosts_for(asked: int | str, islands: int, cpus: int) -> int:
    """Give how many hosts there will be.

    Parameters
    ----------
    asked
        A number, or ``auto`` for as many as CPUs.
    islands
        A host without an island is not made.
    cpus
        CPUs at hand.

    Raises
    ------
    InputError
        When more than four hosts for each CPU are asked for.
    """
    if isinstance(asked, str):
        return min(cpus, islands)
    if asked > HOSTS_PER_CPU * cpus:
        expected = f"at most {HOSTS_PER_CPU * cpus} hosts on {cpus} CPU{'s' if cpus > 1 else ''}"
        raise InputError("hosts", expected, str(asked), "set hosts: auto, or run on a larger machine")
    return min(asked, islands)


def settle_environment(*, local: bool) -> None:
    """Set what Ray reads when it is imported and started, except where the user has set it.

    A local Ray gets a token of its own through the environment: without one it would be open to other users of the
    machine, or leave a token file in the home folder.
    """
    settings = {
        "RAY_USAGE_STATS_ENABLED": "0",
        "RAY_ACCEL_ENV_VAR_OVERRIDE_ON_ZERO": "0",
        # A host that is asked to stop fails its call on purpose; the boxes of that call are never fetched.
        "RAY_IGNORE_UNHANDLED_ERRORS": "1",
    }
    if local:
        settings |= dict.fromkeys(THREAD_VARIABLES, "1")
        # Hosts are the run's work, not something behind it.
        settings["RAY_worker_niceness"] = "0"
        # Nobody looks at the tables of tasks and metrics of a Ray that goes with the run.
        settings |= {"RAY_task_events_report_interval_ms": "0", "RAY_enable_metrics_collection": "0"}
        # "No cluster here": all processes of this Ray then listen on loopback only, on Linux too.
        settings["RAY_ENABLE_WINDOWS_OR_OSX_CLUSTER"] = "0"
        if not any(name in os.environ for name in ("RAY_AUTH_MODE", "RAY_AUTH_TOKEN", "RAY_AUTH_TOKEN_PATH")):
            settings |= {"RAY_AUTH_MODE": "token", "RAY_AUTH_TOKEN": secrets.token_hex(32)}
    for name, value in settings.items():
        os.environ.setdefault(name, value)


def send_home_helpers() -> None:
    """End those processes of a local Ray that serve a cluster or a person at its dashboard.

    The autoscaler's monitor, the dashboard and the reader of log files cost seconds of CPU as they start, just when the
    hosts begin, and some of it for as long as they run. Ray has no setting for them. A Ray that lacks these methods
    keeps its helpers.
    """
    import ray

    node = getattr(ray._private.worker, "_global_node", None)
    for name in ("kill_monitor", "kill_dashboard", "kill_log_monitor"):
        with contextlib.suppress(Exception):
            getattr(node, name)(check_alive=False)


def hush() -> None:
    """Keep Ray's notices of processes that died from the terminal: of a host that did, Atoll tells in its own words.

    They come on the driver's stdout, ten lines for each, whether or not logs are to go there; Ray has no setting for
    them. A Ray that prints them in another way is left to do so.
    """
    import ray

    if hasattr(ray._private.worker, "print_to_stdstream"):
        ray._private.worker.print_to_stdstream = _say_nothing


def _say_nothing(data: object, ignore_prefix: object = None) -> None:
    del data, ignore_prefix


def check_address(address: str) -> None:
    """Refuse what is no address of a cluster that a driver can join.

    Raises
    ------
    InputError
        Unless it is ``auto`` or ``host:port``.
    """
    host, _, port = address.rpartition(":")
    if "://" in address:
        remedy = "run atoll on a machine of the cluster (Ray Client, ray://, is not part of Atoll)"
    elif address == "auto" or (host and port.isdecimal()):
        return
    else:
        remedy = ""
    raise InputError("--address", "host:port or auto", f"'{address}'", remedy)


def reach(address: str) -> None:
    """Try the address before the driver does: Ray has no deadline of its own for connecting.

    A socket finds out at once when nothing listens; another process, which can be given up, finds out whether what
    listens there is a cluster that takes us.

    Raises
    ------
    InputError
        When the address has no form that Ray takes.
    RunFailedError
        When no cluster answers there.
    """
    check_address(address)
    if address != "auto":
        _knock(address)
    try:
        probe = subprocess.run(  # noqa: S603 - this interpreter, with an address as its argument
            [sys.executable, "-c", PROBE, address],
            capture_output=True,
            text=True,
            timeout=PROBE_S,
            check=False,
        )
    except subprocess.TimeoutExpired:
        text = f"what listens there did not answer as one within {PROBE_S:g} s; check the address"
        raise RunFailedError(f"no Ray cluster at {address}: {text}") from None
    if probe.returncode != 0:
        lines = [line for line in probe.stderr.splitlines() if line.strip()]
        raise RunFailedError(f"no Ray cluster at {address}: {lines[-1] if lines else 'it refused to connect'}")


def _knock(address: str) -> None:
    """See whether anything listens at ``host:port``."""
    host, _, port = address.rpartition(":")
    try:
        socket.create_connection((host, int(port)), timeout=CONNECT_S).close()
    except (OSError, OverflowError) as error:
        raise RunFailedError(f"no Ray cluster at {address}: {error}; check the address, or start it") from None
