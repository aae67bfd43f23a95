"""What was on its way at an epoch's end, however far the islands have gone on since."""

from __future__ import annotations

import random

import pytest
from stepping import Stepping
from traders import judging, trading

from experiments import write
from islands.agenda import Agenda, Complete
from islands.migration.routes import Routes
from islands.transit import Transit, lacking
from orchestrator.loading import load_experiment

AT = 2


@pytest.mark.parametrize("seed", range(1, 4))
@pytest.mark.parametrize("name", ["trading", "redrawn"])
def test_islands_that_are_ahead_have_been_sent_what_they_would_have_in_step(name, seed, tmp_path) -> None:
    data = trading(epochs=6)
    if name == "redrawn":
        data = judging({"pairing": "best"})
        data["channels"].append({"topology": {"name": "random", "degree": 2}, "among": ["model", "odd"]})
    loaded = load_experiment(write(tmp_path, data))
    expected = Stepping.of(loaded).on(AT + 1).pending
    there = Stepping.of(loaded)
    numbers = [island.spec.number for island in there.islands]
    routes = Routes(there.plan.edges, there.plan.redrawn, loaded.experiment.seed)
    # Ranks let islands be some epochs apart; those that are last settle the epochs.
    order = random.Random(seed)
    agenda = Agenda(numbers, Complete(routes), {number: order.randint(0, 4) for number in numbers})
    transit, whole = Transit(), Transit()
    states, present, ahead = {}, [], 0
    while agenda.floor < AT:
        number, epoch = agenda.next(6)
        taken = agenda.take(number)
        transit.take(epoch, taken)
        whole.take(epoch, taken)
        present = [packet for packet in present if packet not in taken]
        island = there.islands[number]
        step = island.advance(states[number], there.generations, taken) if epoch else island.begin()
        states[number] = step.state
        agenda.done(number)
        for packet in step.departures:
            assert agenda.put(packet)
            present.append(packet)
        ahead = max(ahead, epoch)
        transit.forget(agenda.floor)
    assert ahead > AT
    found = transit.pending(AT, numbers, present)
    assert whole.pending(AT, numbers, present) == found
    assert {number: list(packets) for number, packets in found.items()} == {
        number: sorted((p for p in expected if p.target == number), key=lambda p: (p.channel, p.source, p.epoch))
        for number in numbers
    }
    assert lacking(routes, AT, found) == ()
    some = next(packet for packet in expected if packet.epoch == AT)
    without = {number: [packet for packet in packets if packet != some] for number, packets in found.items()}
    assert lacking(routes, AT, without) == ((some.channel, some.source, some.target),)
