"""The only door from the islands to Ray: the actor that a host becomes."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from typing import Any, Final, final

from islands.host import Advanced, Box, Finished, Host, HostPlan
from islands.wire import opened, sealed

CONTROL: Final = "control"
"""The concurrency group of ``stop``, which must be heard while ``advance`` runs."""

MAIL: Final = "mail"
"""The concurrency group of ``deliver``: letters come while ``advance`` runs."""

SWITCH_S: Final = 0.0005
"""How long a thread of a host may keep the others waiting; Python's own 5 ms are longer than a short epoch."""

UNANSWERED: Final = 4
"""Letters to one host that may be on their way under ``async``, where nobody waits for them."""


@final
class HostActor:
    """A host as an actor: its letters travel as calls from actor to actor.

    Parameters
    ----------
    plan
        What the host is to do.
    """

    def __init__(self, plan: HostPlan) -> None:
        sys.setswitchinterval(SWITCH_S)
        self._host = Host(plan, post=self._post)
        self._peers: dict[int, Any] = {}
        self._limited = plan.schedule == "async" and not plan.replay
        self._unanswered: dict[int, list[Any]] = {}

    def ready(self) -> int:
        """Make the islands; see :meth:`Host.ready`."""
        return self._host.ready()

    def connect(self, peers: Mapping[int, Any]) -> None:
        """Take the other hosts' actors."""
        method = "deliver"
        self._peers = {number: getattr(actor, method) for number, actor in peers.items()}

    def advance(self, through: int, horizon: int, settled: int) -> Advanced:
        """Step islands; see :meth:`Host.advance`."""
        return self._host.advance(through, horizon, settled)

    def finish(self, forms: bool, settled: int, through: int) -> Finished:
        """Write the rest; see :meth:`Host.finish`."""
        return self._host.finish(forms, settled, through)

    def stop(self) -> None:
        """Ask for the epoch in hand to be abandoned."""
        self._host.stop()

    def deliver(self, letter: bytes) -> None:
        """Take a letter from another host."""
        self._host.deliver(opened(letter))

    def _post(self, host: int, packets: Box) -> bool:
        if not self._limited:
            self._peers[host].options(num_returns=0, concurrency_group=MAIL).remote(sealed(packets))
            return True
        import ray

        waiting = self._unanswered.get(host, [])
        if len(waiting) >= UNANSWERED:
            _, waiting = ray.wait(waiting, num_returns=len(waiting), timeout=0)
        if len(waiting) >= UNANSWERED:
            self._unanswered[host] = waiting
            return False
        answer = self._peers[host].options(concurrency_group=MAIL).remote(sealed(packets))
        self._unanswered[host] = [*waiting, answer]
        return True


def host_actor(cpus: float) -> Any:  # noqa: ANN401 - Ray's actor classes have no useful type
    """Give the Ray actor class of :class:`HostActor`.

    All calls but those in groups of their own run one after the other on one thread. Ray is told not to restart the
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
        "concurrency_groups": {CONTROL: 1, MAIL: 1},
    }
    make: Any = ray.remote(**options)
    return make(HostActor)
