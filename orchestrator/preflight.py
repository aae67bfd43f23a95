"""Before a run on a cluster begins: whether each machine can write where the run stands, and make its islands.

A machine that cannot would be found out by the first host placed there, minutes later perhaps, after a death. Each is
asked by a task of its own: it reads what the driver wrote, writes what the driver then finds, and builds the kinds of
islands, which imports every plug-in and opens every file that the experiment names.
"""

from __future__ import annotations

import secrets
from collections.abc import Sequence
from typing import Any, Final

from genome.errors import InputError
from islands.orders import HostPlan
from islands.store import Store, StoreError
from orchestrator.backends.protocol import RunFailedError

FOLDER: Final = ".preflight"
DEADLINE_S: Final = 90.0


def preflight(plans: Sequence[HostPlan], seconds: float = DEADLINE_S) -> int:
    """Ask every machine of the cluster that has a CPU; give how many there are.

    Parameters
    ----------
    plans
        Of all hosts: where the run stands, and its islands.
    seconds
        How long a machine may take to answer.

    Raises
    ------
    RunFailedError
        Names the machine, and says what it lacks.
    """
    import ray
    from ray.util.scheduling_strategies import NodeAffinitySchedulingStrategy

    place, token = plans[0].folder, secrets.token_hex(8)
    listed: Any = ray.nodes
    nodes = [node for node in listed() if node["Alive"] and node["Resources"].get("CPU", 0) > 0]
    store = Store.open(place)
    store.write(f"{FOLDER}/{token}", token.encode())
    groups = {spec.group: spec for plan in plans for spec in plan.islands}
    plan = _asking_for(plans[0], tuple(groups.values()))
    ask: Any = ray.remote(num_cpus=0, max_retries=0)(_answer)
    asked = {
        ask.options(scheduling_strategy=NodeAffinitySchedulingStrategy(node["NodeID"], soft=False)).remote(
            plan, token, node["NodeID"]
        ): node
        for node in sorted(nodes, key=lambda node: str(node["NodeID"]))
    }
    try:
        for reference, node in asked.items():
            name = str(node["NodeManagerHostname"] or node["NodeManagerAddress"])
            complaint = _heard(reference, seconds)
            if not complaint and not store.exists(f"{FOLDER}/{token}-{node['NodeID']}"):
                complaint = (
                    f"what it writes to {place} is not there for the others; use a place that all machines share"
                )
            if complaint:
                raise RunFailedError(f"the machine {name} cannot take part: {complaint}")
    finally:
        store.remove_tree(FOLDER)
    return len(nodes)


def _heard(reference: Any, seconds: float) -> str:  # noqa: ANN401 - Ray's references
    import ray

    try:
        return str(ray.get(reference, timeout=seconds))
    except ray.exceptions.GetTimeoutError:
        return f"it did not answer within {seconds:g} s"
    except ray.exceptions.RayError as error:
        lines = [line.strip() for line in str(error).splitlines() if line.strip()]
        return lines[-1] if lines else type(error).__name__


def _asking_for(plan: HostPlan, islands: tuple[Any, ...]) -> HostPlan:
    from dataclasses import replace

    return replace(plan, islands=islands, edges=(), redrawn=(), foreign=())


def _answer(plan: HostPlan, token: str, node: str) -> str:
    """Run on each machine: give what it lacks, or nothing."""
    import time

    from islands.inputs import inputs_here
    from islands.kinds.registry import resolve_kind

    try:
        store = Store.open(plan.folder)
        if store.read(f"{FOLDER}/{token}") != token.encode():
            return f"what the driver wrote to {plan.folder} reads otherwise there"
        store.write(f"{FOLDER}/{token}-{node}", token.encode())
        with inputs_here(plan) as here:
            for spec in here.islands:
                resolve_kind(spec.kind, spec.where("kind")).build(spec, time.perf_counter)
    except FileNotFoundError:
        return f"it does not see the run's folder {plan.folder}; use a place that all machines share, such as a bucket"
    except StoreError as error:
        return str(error)
    except (InputError, ImportError) as error:
        return str(error)
    except Exception as error:  # noqa: BLE001 - whatever a plug-in raises there
        return f"{type(error).__name__}: {error}"
    return ""
