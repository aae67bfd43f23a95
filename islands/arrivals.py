"""What came to an island when, as the log of an ``async`` run tells it, and as a replay reads it again."""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from typing import Any, Final, cast

from genome.errors import InputError
from genome.settings import describe
from islands.migration.channel import Edge, Packet
from islands.spec import IslandSpec
from islands.store import Anywhere, Store

SIZED: Final = ("channel", "source", "epoch", "number of travellers")
"""What the event tells of each packet."""

Record = dict[tuple[int, int], list[tuple[int, int, int]]]
"""For an island's number and an epoch, the packets that it took in: channel, source, epoch sent."""

Sizes = dict[tuple[int, int], list[tuple[int, int, int, int]]]
"""The same with how many each packet held: which of the travellers of one epoch came in which packet."""


def arrivals_detail(packets: Sequence[Packet], edges: Iterable[Edge], before: int) -> dict[str, Any]:
    """Give the detail of an ``arrivals`` event.

    Parameters
    ----------
    packets
        What the island takes in.
    edges
        Those on which something could have come.
    before
        The last epoch that the island has finished.

    Returns
    -------
    Under ``packets`` channel, source, epoch and number of travellers of each; under ``without`` the names of the
    channels that carried at the end of the epoch before, and of which nothing came.
    """
    came = {packet.channel for packet in packets}
    silent = {edge.channel.name: None for edge in edges if edge.channel.number not in came}
    carried = {edge.channel.name for edge in edges if edge.channel.carries(before)}
    return {
        "packets": [(one.channel, one.source, one.epoch, len(one.migrants)) for one in packets],
        "without": [name for name in silent if name in carried],
    }


def recorded_arrivals(log: Anywhere, islands: Iterable[IslandSpec]) -> Record:
    """Read from a run's ``log`` folder what some islands took in."""
    return {place: [mark[:3] for mark in marks] for place, marks in recorded_sizes(log, islands).items()}


def recorded_sizes(log: Anywhere, islands: Iterable[IslandSpec]) -> Sizes:
    """Read the ``arrivals`` events of some islands from a run's ``log`` folder; of other schedules there are none."""
    import pyarrow as pa
    import pyarrow.parquet as pq

    store = Store.open(log)
    numbers = {spec.name: spec.number for spec in islands}
    record: Sizes = {}
    for name in [f"events/{name}" for name in store.names("events") if name.endswith(".parquet")]:
        source = pa.BufferReader(store.read(name))
        table = pq.read_table(
            source, columns=["island", "epoch", "kind", "detail"], filters=[("kind", "=", "arrivals")]
        )
        for row in table.to_pylist():
            if row["island"] in numbers:
                record[numbers[row["island"]], row["epoch"]] = _marks(row["detail"], row["epoch"], name)
    return record


def _marks(detail: str, epoch: int, name: str) -> list[tuple[int, int, int, int]]:
    """Read one event; what cannot have happened would let a replay wait for ever."""
    try:
        marks = [(*map(int, mark),) for mark in json.loads(detail)["packets"]]
        if all(len(mark) == len(SIZED) and 0 <= mark[2] < epoch for mark in marks):
            return cast("list[tuple[int, int, int, int]]", marks)
    except (ValueError, KeyError, TypeError):
        pass
    expected = f"packets taken in at the start of epoch {epoch}, each [{', '.join(SIZED)}] with an earlier epoch"
    raise InputError(name, expected, describe(detail), "the log was changed, or is not whole")
