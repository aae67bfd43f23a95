"""Keeping signals that are meant for a driver from the processes that it starts."""

from __future__ import annotations

import contextlib
import os
import sys
from collections.abc import Iterator
from typing import final


@final
class _Apart:
    """Whether children get a session of their own; Python keeps what is registered at a fork for good."""

    def __init__(self) -> None:
        self.on = False
        self.registered = False

    def leave(self) -> None:
        """Run in a child between fork and exec."""
        if self.on:
            os.setsid()


_apart = _Apart()


@contextlib.contextmanager
def sessions_of_their_own() -> Iterator[None]:
    """Give each process that Ray starts meanwhile, and so its children, a session of its own.

    A SIGTERM or SIGHUP to the driver's process group (a closed terminal, ``timeout``, a supervisor) then reaches the
    driver alone, and the hosts live to write their log. They still die with the driver: on Linux, the kernel sees to
    it. Elsewhere Ray kills them by their group, so that they stay in it.
    """
    if not sys.platform.startswith("linux"):
        yield
        return
    if not _apart.registered:
        # It is called where a process is started with a ``preexec_fn``, as all of Ray's are.
        os.register_at_fork(after_in_child=_apart.leave)
        _apart.registered = True
    _apart.on = True
    try:
        yield
    finally:
        _apart.on = False
