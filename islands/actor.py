"""The only door from the islands to Ray: the actor that a host becomes."""

from __future__ import annotations

import gc
import os
import sys
from collections.abc import Mapping
from typing import Any, Final, NamedTuple, final

from islands.host import Host
from islands.interventions.intervention import Intervention
from islands.mail import CAN_LISTEN, Letterbox
from islands.orders import Advanced, Box, Finished, HostPlan, Saved, Step
from islands.wire import opened, sealed

CONTROL: Final = "control"
"""The concurrency group of ``stop`` and ``step``, which must be heard while ``advance`` runs."""

MAIL: Final = "mail"
"""The concurrency group of ``deliver``: letters come while ``advance`` runs."""

UNANSWERED: Final = 4
"""Letters to one host that may be on their way under ``async``, where nobody waits for them."""


SWITCH_S: Final = 0.1
"""Python's switch interval in hosts: how long the thread that computes is left alone by others that want the
interpreter's lock. One of Ray's asks for it a hundred times a second, and each time that it gets it the other loses a
moment to the change. Who waits for it in earnest, a wish to stop, can wait so long."""


COLLECT: Final = (20_000, 20, 20)
"""The collector's thresholds in hosts: demes and records are made by the thousand, and hardly ever in circles."""


class Address(NamedTuple):
    """Where a host can be reached: its machine, the path of its letterbox (empty where it has none), its process."""

    machine: str
    letterbox: str
    process: int = 0


@final
class HostActor:
    """A host as an actor: letters go through sockets on one machine, and as calls of actors from one to another.

    Parameters
    ----------
    plan
        What the host is to do.
    mail
        The folder in which its letterbox is to stand; empty for one of its own.
    """

    def __init__(self, plan: HostPlan, mail: str = "") -> None:
        self._machine = _machine()
        self._take(plan, mail)

    def _take(self, plan: HostPlan, mail: str) -> None:
        self._plan = plan
        folder = mail and f"{mail}/{plan.round}-{plan.host}"
        self._letterbox = Letterbox(folder) if CAN_LISTEN and plan.hosts > 1 else None
        self._host = Host(plan, post=self._post, porch=self._letterbox)
        self._peers: dict[int, Any] = {}
        self._limited = plan.schedule == "async" and not plan.replay
        self._unanswered: dict[int, list[Any]] = {}

    def ready(self) -> Address:
        """Make the islands; see :meth:`Host.ready`. Gives the host's address."""
        sys.setswitchinterval(SWITCH_S)
        self._host.ready()
        # What stands now stands for good: the collector need not look at half a million objects of libraries again.
        gc.collect()
        gc.freeze()
        gc.set_threshold(*COLLECT)
        return Address(self._machine, "" if self._letterbox is None else self._letterbox.address, os.getpid())

    def restart(self, plan: HostPlan, mail: str) -> Address:
        """Begin anew with another plan, in this process, where all that is imported and compiled is at hand."""
        gc.unfreeze()
        self._host.close()
        if self._letterbox is not None:
            self._letterbox.close()
        self._take(plan, mail)
        return self.ready()

    def connect(self, peers: Mapping[int, tuple[Any, Address]]) -> None:
        """Take the other hosts' actors and addresses."""
        near: dict[int, str] = {}
        for number, (actor, address) in peers.items():
            if self._letterbox and address.letterbox and address.machine == self._machine:
                near[number] = address.letterbox
            else:
                self._peers[number] = actor.deliver
        if self._letterbox is not None:
            self._letterbox.connect(near, self._plan.patience)

    def advance(self, through: int, horizon: int, settled: int) -> Advanced:
        """Step islands; see :meth:`Host.advance`."""
        return self._host.advance(through, horizon, settled)

    def checkpoint(self, epoch: int) -> Saved:
        """Write a part of a checkpoint; see :meth:`Host.checkpoint`."""
        return self._host.checkpoint(epoch)

    def steer(self, epoch: int, intervention: Intervention) -> None:
        """Take an intervention; see :meth:`Host.steer`."""
        self._host.steer(epoch, intervention)

    def finish(self, forms: bool, settled: int, through: int) -> Finished:
        """Write the rest; see :meth:`Host.finish`."""
        return self._host.finish(forms, settled, through)

    def stop(self, turn: int, lost: bool = False) -> None:
        """Ask for the epoch in hand to be abandoned, unless the host has begun anew since; see :meth:`Host.stop`."""
        if turn == self._plan.round:
            self._host.stop(lost)

    def step(self) -> Step:
        """Give what the host is at."""
        return self._host.step()

    def deliver(self, letter: bytes, turn: int) -> None:
        """Take a letter from another host, unless it was sent before all began anew."""
        if turn == self._plan.round:
            self._host.deliver(opened(letter))

    def _post(self, host: int, packets: Box) -> bool:
        letter = sealed(packets)
        if self._letterbox is not None and self._letterbox.reaches(host):
            self._letterbox.send(host, letter)
            return True
        if not self._limited:
            self._peers[host].options(num_returns=0, concurrency_group=MAIL).remote(letter, self._plan.round)
            return True
        return self._post_limited(host, letter)

    def _post_limited(self, host: int, letter: bytes) -> bool:
        """Post where nobody waits for letters, unless too many are on their way."""
        import ray

        waiting = self._unanswered.get(host, [])
        if len(waiting) >= UNANSWERED:
            _, waiting = ray.wait(waiting, num_returns=len(waiting), timeout=0)
        if len(waiting) >= UNANSWERED:
            self._unanswered[host] = waiting
            return False
        answer = self._peers[host].options(concurrency_group=MAIL).remote(letter, self._plan.round)
        self._unanswered[host] = [*waiting, answer]
        return True


def _machine() -> str:
    import ray

    return str(ray.get_runtime_context().get_node_id())


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
