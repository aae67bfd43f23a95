"""The fault suite: what every test of it has, and the table at its end."""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from pathlib import Path

import psutil
import pytest
from ordeal import belongs

HERE = Path(__file__).parent
Note = Callable[[str, str, "float | None"], None]


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Mark all but the sample (the marker ``ray``) as ``torture``, which is not part of the default run."""
    for item in items:
        if item.path.is_relative_to(HERE) and item.get_closest_marker("ray") is None:
            item.add_marker(pytest.mark.torture)


@pytest.fixture
def place(tmp_path):
    """A folder for one ordeal; none of its processes outlives it by more than a moment."""
    yield tmp_path
    ends = time.monotonic() + 20
    while left := [process for process in psutil.process_iter() if belongs(process, tmp_path)]:
        if time.monotonic() > ends:
            for process in left:
                process.kill()
            raise AssertionError(left)
        time.sleep(0.1)


@pytest.fixture
def note(record_property) -> Note:
    """Tell the table: the fault, where it struck, and the seconds until all were back at work."""

    def told(fault: str, where: str, seconds: float | None) -> None:
        record_property("fault", (fault, where, "" if seconds is None else f"{seconds:.1f}"))

    return told


def pytest_terminal_summary(terminalreporter) -> None:
    rows = []
    for outcome in ("passed", "failed"):
        for report in terminalreporter.stats.get(outcome, ()):
            for name, value in getattr(report, "user_properties", ()):
                if name == "fault" and report.when == "call":
                    rows.append((*value, "equal" if outcome == "passed" else "NOT EQUAL"))
    if not rows:
        return
    rows = [("fault", "struck", "back at work (s)", "digest"), *sorted(rows, key=str)]
    widths = [max(len(row[column]) for row in rows) for column in range(4)]
    terminalreporter.section("faults")
    for row in [rows[0], tuple("-" * width for width in widths), *rows[1:]]:
        terminalreporter.line(
            "| " + " | ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)) + " |"
        )


# In the default run a sample of hosts and drivers alone; `make torture` takes all.
collect_ignore = (
    []
    if os.environ.get("ATOLL_TORTURE")
    else ["test_cluster.py", "test_disks.py", "test_evaluators.py", "test_steering.py", "test_stores.py"]
)
