"""Faults that strike a process of a run from within, at a moment that no signal from outside could hit.

The island kind ``traps:TrappedKind`` is :mod:`bits`' own; importing it, which the driver and every host do, lays what
the folder named by ``ATOLL_TRAPS`` holds in ``traps.json``: a list of :class:`Trap`. One that strikes leaves
``struck-PLACE.json`` there before it does; an island's first evaluation in a process leaves ``back-PID.json``.
"""

from __future__ import annotations

import fnmatch
import json
import os
import signal
import time
from collections import Counter
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, ClassVar

from bits import BitsBiology, BitsGenome, BitsGrowth, BitsKind

from growth.protocol import Clock
from islands.spec import IslandSpec

PLACE = "ATOLL_TRAPS"
IS_HOST = "RAY_RAYLET_PID" in os.environ


@dataclass(frozen=True)
class Trap:
    """One fault.

    ``at``: build, evaluate, fit, post, wait, form, write, remove. What is named is an island (build, evaluate, form),
    how many ones a genotype has (fit), a file's path (write, remove), or nothing. ``like``: a pattern for it.
    ``moment``, of write: before; half (of the draft is on the disk); draft (all of it, not in its place yet); after.
    ``nth``: the time, of those in one process, that it strikes. ``who``: host, driver, or any process. ``does``: the
    signal, or "crash" for an exit without a word. ``always``: each time, in whichever process.
    """

    at: str
    like: str = "*"
    moment: str = "before"
    nth: int = 1
    who: str = "any"
    does: str = "KILL"
    always: bool = False


class Traps:
    """Those that are laid in this process."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        path = folder / "traps.json"
        told = json.loads(path.read_text(encoding="utf-8")) if path.exists() else []
        self.laid = [Trap(**one) for one in told]
        self.seen: Counter[int] = Counter()

    def meet(self, at: str, name: str, moment: str = "before") -> bool:
        """Tell whether a trap strikes here; it has left its mark then."""
        met = [self._meets(place, trap, at, name, moment) for place, trap in enumerate(self.laid)]
        return any(met)

    def _meets(self, place: int, trap: Trap, at: str, name: str, moment: str) -> bool:
        if (trap.at, trap.moment) != (at, moment) or not fnmatch.fnmatch(name, trap.like):
            return False
        if trap.who != "any" and (trap.who == "host") != IS_HOST:
            return False
        self.seen[place] += 1
        if self.seen[place] < trap.nth:
            return False
        told = {**asdict(trap), "name": name, "pid": os.getpid(), "time": time.time(), "host": IS_HOST}
        mark = self.folder / f"struck-{place}.json"
        try:
            with mark.open("x", encoding="utf-8") as file:
                json.dump(told, file)
        except FileExistsError:
            return trap.always
        return True

    def strike(self, at: str, name: str, moment: str = "before") -> None:
        if self.meet(at, name, moment):
            does = next(trap.does for trap in self.laid if (trap.at, trap.moment) == (at, moment))
            if does == "crash":
                os._exit(77)
            os.kill(os.getpid(), getattr(signal, f"SIG{does}"))

    def back(self, made: float) -> None:
        """Note that this process evaluates on islands made since the last trap struck, for the first time."""
        struck = list(self.folder.glob("struck-*.json"))
        mark = self.folder / f"back-{len(struck)}-{os.getpid()}.json"
        if struck and made > max(path.stat().st_mtime for path in struck) and not mark.exists():
            mark.write_text(json.dumps({"time": time.time()}), encoding="utf-8")


TRAPS = Traps(Path(os.environ.get(PLACE, "/nonexistent")))


def _on_writes() -> None:
    from islands.stores.disk import DiskStore

    write, remove, fsync = DiskStore.write, DiskStore.remove, os.fsync

    def trapped_write(self: DiskStore, name: str, content: bytes, staging: str = "") -> None:
        path = f"{self.place}/{name}"
        TRAPS.strike("write", path)

        def on_disk(number: int) -> None:
            fsync(number)
            if TRAPS.meet("write", path, "half"):
                os.ftruncate(number, len(content) // 2)
                fsync(number)
                os.kill(os.getpid(), signal.SIGKILL)
            TRAPS.strike("write", path, "draft")

        os.fsync = on_disk
        try:
            write(self, name, content, staging)
        finally:
            os.fsync = fsync
        TRAPS.strike("write", path, "after")

    def trapped_remove(self: DiskStore, name: str) -> None:
        path = f"{self.place}/{name}"
        TRAPS.strike("remove", path)
        remove(self, name)
        TRAPS.strike("remove", path, "after")

    DiskStore.write, DiskStore.remove = trapped_write, trapped_remove  # type: ignore[method-assign]


def _before(owner: Any, method: str, at: str) -> None:
    found: Callable[..., Any] = getattr(owner, method)

    def trapped(self: Any, *arguments: Any, **named: Any) -> Any:
        TRAPS.strike(at, "")
        return found(self, *arguments, **named)

    setattr(owner, method, trapped)


if TRAPS.laid:
    from islands.host import Host
    from islands.mail import Letterbox

    _on_writes()
    _before(Host, "_wait", "wait")
    _before(Letterbox, "send", "post")


class TrappedBiology(BitsBiology):
    def __init__(self, spec: IslandSpec, clock: Clock) -> None:
        super().__init__(spec, clock)
        self.island, self.made = spec.name, time.time()
        TRAPS.strike("build", spec.name)

    def evaluate(self, genotype: Any) -> Any:
        TRAPS.strike("evaluate", self.island)
        TRAPS.strike("fit", f"{sum(genotype):02d}")
        TRAPS.back(self.made)
        return super().evaluate(genotype)

    def write_forms(self, genotype: Any, *arguments: Any) -> Any:
        TRAPS.strike("form", self.island)
        return super().write_forms(genotype, *arguments)


class TrappedKind:
    name: ClassVar[str] = "trapped"
    genome, growth = BitsGenome, BitsGrowth

    def build(self, spec: IslandSpec, clock: Clock) -> TrappedBiology:
        return TrappedBiology(spec, clock)

    keep_files = BitsKind.keep_files
