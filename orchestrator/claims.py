"""Claiming a run's name in a store that can neither move a folder nor write a file only where there is none.

Who wants a name writes a claim of its own and then looks: one who sees nobody else's has the name, since any later
claim finds this one there. Two who see each other both withdraw and try again after unequal times.
"""

from __future__ import annotations

import contextlib
import secrets
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Final

from genome.errors import InputError
from islands.store import Store, StoreError

CLAIMS: Final = ".claims"
"""The folder beside the runs' in which claims stand; its name is hidden, so that it is no run's."""

ATTEMPTS: Final = 30
LEAST_PAUSE_S: Final = 0.05
MOST_PAUSE_MS: Final = 600


@contextmanager
def claimed(runs: Store, choose: Callable[[], str], mark: str) -> Iterator[str]:
    """Claim a name, for as long as its folder is being made.

    Parameters
    ----------
    runs
        Where run folders stand.
    choose
        Gives a name that seems free; is asked again after each attempt that failed.
    mark
        The file that the folder of one who had the name holds.

    Raises
    ------
    InputError
        When all attempts met others: somebody was killed while making a folder.
    """
    for _ in range(ATTEMPTS):
        name = choose()
        claims, own = runs.at(CLAIMS, name), secrets.token_hex(8)
        claims.write(own, b"")
        try:
            if claims.names() == [own] and not runs.at(name).exists(mark):
                yield name
                return
        finally:
            with contextlib.suppress(StoreError):
                claims.remove(own)
        time.sleep(LEAST_PAUSE_S + secrets.randbelow(MOST_PAUSE_MS) / 1000)
    got = f"'{name}', which others claim in {claims}"
    raise InputError("--name", "a name that nobody else is about to take", got, "remove the claims of runs that died")
