"""The only door from the islands to Ray: the actor that a host becomes."""

from __future__ import annotations

from typing import Any, Final

from islands.host import Host

CONTROL: Final = "control"
"""The concurrency group of ``stop``, which must be heard while ``advance`` runs."""


def host_actor(cpus: float) -> Any:  # noqa: ANN401 - Ray's actor classes have no useful type
    """Give the Ray actor class of :class:`islands.host.Host`.

    All calls but those in the group ``control`` run one after the other on one thread. Ray is told not to restart the
    actor nor its calls: an actor that Ray restarts has silently lost its state.

    Parameters
    ----------
    cpus
        How much of a CPU each actor asks for.
    """
    import ray

    options: dict[str, Any] = {
        "num_cpus": cpus,
        "max_restarts": 0,
        "max_task_retries": 0,
        "concurrency_groups": {CONTROL: 1},
    }
    make: Any = ray.remote(**options)
    return make(Host)
