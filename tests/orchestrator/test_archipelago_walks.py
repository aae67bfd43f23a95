"""The state machine among hosts that answer in any order, fail, or die: random walks, with what must hold on each."""

from __future__ import annotations

import random

import pytest

from orchestrator.archipelago import (
    CALL_S,
    CALLS,
    Archipelago,
    decide,
    ungranted,
)
from orchestrator.messages import (
    Advance,
    AskStop,
    Begun,
    Conclude,
    EpochAbandoned,
    EpochDone,
    Finish,
    HostFailed,
    HostFinished,
    HostReady,
    PartSaved,
    Pause,
    PauseAsked,
    Report,
    RestructureAsked,
    ResumeAsked,
    Rewind,
    Rewound,
    Save,
    SaveAsked,
    Seal,
    Spawn,
    StopAsked,
)


class World:
    """Hosts that do what they are told in order, or fail, or die; whatever is ordered is looked at."""

    def __init__(self, seed: int, schedule: str) -> None:
        self.rng = random.Random(seed)
        hosts, self.epochs = self.rng.randint(1, 4), self.rng.randint(0, 40)
        spacing = self.rng.choice([0.0, 2 * CALL_S])
        self.state = Archipelago(hosts, self.epochs, schedule, every=self.rng.randint(1, 6), spacing=spacing)
        self.troubles = self.rng.choice([(0.0, 0.0, 0.0), (0.0, 0.01, 0.05), (0.01, 0.01, 0.05), (0.1, 0.1, 0.1)])
        self.queues: dict[int, list] = {}
        self.stood: dict[int, int] = {}
        self.parts: dict[int, set[int]] = {}
        self.dead: set[int] = set()
        self.asked: set[int] = set()
        self.broken: set[int] = set()
        self.raised: set[int] = set()
        self.sealed, self.base = [-1], -1
        self.changes: list[int] = []
        self.reports: list[int] = []
        self.rewinding = False
        self.conclusion = None

    # -- orders ------------------------------------------------------------------------------------------------------

    def feed(self, event) -> None:
        assert self.conclusion is None
        self.state, instructions = decide(self.state, event)
        for instruction in instructions:
            assert self.conclusion is None
            self.ordered(instruction)

    def ordered(self, what) -> None:
        match what:
            case Report(epoch):
                assert epoch <= min(self.stood.values())
                self.reports.append(epoch)
            case Seal(epoch):
                assert self.parts.pop(epoch) == set(range(self.state.hosts))
                self.sealed.append(epoch)
            case Rewind(lost):
                assert set(lost) == self.dead
                assert not self.rewinding
                assert self.idle
                self.rewinding = True
            case Pause(epoch):
                assert self.idle
                assert epoch == self.sealed[-1]
            case Conclude():
                self.concluded(what)
            case Spawn(host):
                self.queues[host], self.stood[host] = [what], self.base
            case AskStop(host):
                assert host not in self.dead
                assert self.queues[host]
                self.asked.add(host)
            case _:
                assert what.host not in self.dead
                self.told(what)

    def told(self, what) -> None:
        queue = self.queues[what.host]
        match what:
            case Advance(host, through, horizon, settled):
                calls = [one for one in queue if isinstance(one, Advance)]
                assert len(calls) < (1 if self.state.in_step else CALLS)
                assert max([self.stood[host], *(call.through for call in calls)]) < through <= horizon <= self.last
                assert settled <= min(self.stood.values())
            case Save(_, epoch):
                assert self.sealed[-1] < epoch <= min(self.stood.values())
                assert epoch >= max([one.settled for one in queue if isinstance(one, Advance)], default=-1)
                assert not any(isinstance(one, Save) for one in queue)
                self.parts.setdefault(epoch, set())
            case Finish(_, forms, _, through):
                assert not queue
                assert through <= min(self.stood.values())
                assert not forms or self.dead or through == self.sealed[-1]
        queue.append(what)

    def concluded(self, end) -> None:
        assert self.idle or self.state.calls == ((),) * self.state.hosts
        assert end.torn == bool(self.dead)
        if end.status == "finished":
            assert (self.sealed[-1], self.reports[-1], self.dead) == (self.epochs, self.epochs, set())
            assert not any(self.base < change - 1 for change in self.changes)
        self.conclusion = end

    @property
    def idle(self) -> bool:
        return not any(self.queues.values())

    @property
    def last(self) -> int:
        """The last epoch that hosts may begin."""
        return min([self.epochs, *(change - 1 for change in self.changes if change > self.base + 1)])

    # -- events ------------------------------------------------------------------------------------------------------

    def answer(self) -> None:
        """Let a host answer the oldest of its orders."""
        host = self.rng.choice([host for host, queue in self.queues.items() if queue])
        what, (failing, dying, _) = self.queues[host].pop(0), self.troubles
        if self.rng.random() < dying:
            self.dead.add(host)
            self.queues[host] = []
            self.feed(HostFailed(host, "died", alive=False))
        elif isinstance(what, Advance) and self.breaks(host, failing):
            self.broken.add(host)
            self.feed(EpochAbandoned(host, self.stood[host]))
        elif host in self.raised or self.rng.random() < failing / 4:
            part = isinstance(what, Save)
            if isinstance(what, Advance):
                self.raised.add(host)
            self.feed(HostFailed(host, "raised", alive=True, epoch=-1 if part else self.stood[host], part=part))
        else:
            self.feed(self.done(what))

    def breaks(self, host: int, failing: float) -> bool:
        """Tell whether a host abandons a call: it was asked to, or heard of a wish to stop; then it steps no more."""
        if host in self.raised:
            return False
        chance = failing / 4 if host not in self.asked else 0.7
        return host in self.broken or self.rng.random() < chance

    def done(self, what):
        match what:
            case Spawn(host):
                return HostReady(host)
            case Advance(host, through):
                self.stood[host] = through
                return EpochDone(host, through, self.rng.random() * 2 * CALL_S)
            case Save(host, epoch):
                self.parts[epoch].add(host)
                return PartSaved(host, epoch)
            case Finish(host):
                return HostFinished(host)

    def rewound(self) -> None:
        """Begin anew from the newest checkpoint, or now and then from one before: the newest is damaged."""
        if self.rng.random() < self.troubles[0]:
            self.sealed.pop() if len(self.sealed) > 1 else None
        self.base, hosts = self.sealed[-1], max(1, self.state.hosts - self.rng.randint(0, len(self.dead)))
        self.dead, self.queues, self.stood, self.parts, self.rewinding = set(), {}, {}, {}, False
        self.asked, self.broken, self.raised = set(), set(), set()
        self.reports = [epoch for epoch in self.reports if epoch <= self.base]
        later = [change - 1 for change in self.changes if change > self.base + 1]
        self.feed(Rewound(self.base, hosts, min(later, default=None)))

    def wish(self) -> None:
        """Somebody wants something."""
        wishes = [PauseAsked(), ResumeAsked(), SaveAsked()]
        if self.state.phase == "running":
            change = ungranted(self.state) + self.rng.randint(0, 3)
            if 0 < change <= self.epochs:
                wishes.append(RestructureAsked(change))
        if self.rng.random() < 0.1:
            wishes = [StopAsked()]
        wish = self.rng.choice(wishes)
        if isinstance(wish, RestructureAsked):
            self.changes.append(wish.epoch)
        self.feed(wish)

    def go_on(self) -> None:
        if self.rng.random() < self.troubles[2]:
            self.wish()
        elif self.rewinding:
            self.rewound()
        elif self.idle:
            assert self.state.paused, "the machine waits for nobody"
            self.feed(ResumeAsked())
        else:
            self.answer()


@pytest.mark.parametrize("schedule", ["barrier", "dataflow", "async"])
@pytest.mark.parametrize("seed", range(300))
def test_whatever_happens_it_concludes_exactly_once_and_never_hangs(seed, schedule) -> None:
    """Hosts that answer in any order, fail, or die, and people who want this and that, at any moment."""
    world = World(seed, schedule)
    world.feed(Begun())
    for _ in range(20_000):
        if world.conclusion is not None:
            break
        world.go_on()
    assert world.conclusion is not None
    assert world.reports == sorted(set(world.reports))
    if world.troubles[1] == 0:
        assert world.conclusion.status == "finished"
    state = world.state
    assert decide(state, HostFailed(0, "late", alive=False)) == (state, ())
