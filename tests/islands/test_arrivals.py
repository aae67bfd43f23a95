"""What a replay reads of an async run's log: as written, or refused with the file's name."""

from __future__ import annotations

from datetime import datetime
from pathlib import Path

import pytest
from archipelagos import spec

from genome.errors import InputError
from islands.arrivals import arrivals_detail, recorded_arrivals
from islands.log import Event, events_table, write
from islands.migration.channel import Packet


def logged(folder: Path, detail: dict) -> Path:
    event = Event("isle-0", datetime(2026, 1, 1), 3, "arrivals", detail)  # noqa: DTZ001 - the log's times are naive
    write(folder, "events", "x", events_table("run", [event]))
    return folder


def test_what_was_told_is_read_again(tmp_path) -> None:
    packets = [Packet(0, 1, 0, 2, "s"), Packet(1, 2, 0, 0, "s")]
    log = logged(tmp_path, arrivals_detail(packets, (), 2))
    assert recorded_arrivals(log, [spec()]) == {(0, 3): [(0, 1, 2), (1, 2, 0)]}


@pytest.mark.parametrize(
    "packets", [[[0, 1, 3, 1]], [[0, 1, 99, 1]], [[0, 1, -1, 1]], [[0, 1]], [["a", 1, 2, 1]], "no", None, [7]]
)
def test_what_cannot_have_happened_is_refused(tmp_path, packets) -> None:
    with pytest.raises(InputError, match=r"events/x\.parquet: expected packets taken in at the start of epoch 3"):
        recorded_arrivals(logged(tmp_path, {"packets": packets}), [spec()])
    with pytest.raises(InputError, match="the log was changed"):
        recorded_arrivals(logged(tmp_path, {}), [spec()])
