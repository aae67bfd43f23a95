"""One driver a run: who drives it keeps others from doing so at the same time.

On a local disk a lock on a file, which the system lets go when the process ends, however it ends. In a bucket, where
nothing can be locked, a file that is written anew every few seconds: one that has become old is of a driver that is
gone.
"""

from __future__ import annotations

import json
import os
import platform
import secrets
import time
from typing import Any, Final, final

from genome.errors import InputError
from islands.store import Store

LOCK: Final = ".lock"
FILE: Final = "lease.json"
RENEWED_S: Final = 10.0
STALE_S: Final = 45.0
LOOKS: Final = 3
LOOK_S: Final = 0.1
"""The lock is tried so often, with so many seconds in between: who only looks whether a run is driven has it, too."""


@final
class Lease:
    """Held from its making until it is let go.

    Parameters
    ----------
    store
        The run's folder.

    Raises
    ------
    InputError
        When another process drives the run.
    """

    def __init__(self, store: Store) -> None:
        self._store: Final = store
        self._token: Final = secrets.token_hex(8)
        self._renewed = 0.0
        self._file: Any = None
        if store.local is not None:
            self._file = _locked(store)
        else:
            _refuse_fresh(store)
            self.renew()

    def renew(self) -> None:
        """Keep it from growing old; to be called often, does something seldom."""
        now = time.monotonic()
        if self._store.local is not None or now - self._renewed < RENEWED_S:
            return
        self._renewed = now
        told = {"token": self._token, "time": time.time(), "machine": platform.node(), "process": os.getpid()}
        self._store.write(FILE, json.dumps(told).encode())

    def release(self) -> None:
        """Let it go; more than once does nothing."""
        if self._file is not None:
            self._file.close()
            self._file = None
        elif self._store.local is None:
            self._store.remove(FILE)


def is_driven(store: Store) -> bool:
    """Tell whether a process drives the run in this folder, without touching it."""
    if store.local is None:
        try:
            _refuse_fresh(store)
        except InputError:
            return True
        return False
    import fcntl

    try:
        with (store.local / LOCK).open("rb") as file:
            fcntl.flock(file, fcntl.LOCK_SH | fcntl.LOCK_NB)
    except BlockingIOError:
        return True
    except OSError:
        return False
    return False


def _locked(store: Store) -> Any:  # noqa: ANN401 - a file
    import fcntl

    assert store.local is not None
    try:
        file = (store.local / LOCK).open("w")
    except OSError as error:
        got = (error.strerror or str(error)).lower()
        raise InputError(str(store), "a run's folder that can be written to", got) from None
    for _ in range(LOOKS):
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            time.sleep(LOOK_S)
        else:
            return file
    file.close()
    raise _taken(store, "another process drives it")


def _refuse_fresh(store: Store) -> None:
    try:
        told = json.loads(store.read(FILE))
        age = time.time() - float(told["time"])
        who = f"process {told['process']} on {told['machine']} drives it"
        gone = told.get("machine") == platform.node() and not _is_there(told["process"])
    except (FileNotFoundError, ValueError, KeyError, TypeError):
        return
    if age < STALE_S and not gone:
        raise _taken(store, f"{who}, heard of {max(age, 0):.0f} s ago")


def _is_there(process: int) -> bool:
    """Tell whether a process of this machine lives; one of somebody else's does."""
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except OSError:
        return True
    return True


def _taken(store: Store, got: str) -> InputError:
    return InputError(str(store), "a run that nobody drives", got, "wait for it, or steer it: atoll steer --help")
