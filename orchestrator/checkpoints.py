"""The whole of a checkpoint: one small file that is written last, and which of them is the newest that stands.

A checkpoint stands for one settled epoch. Its file names the hosts' parts and the log's files that belong to it, so
that a run can go on from it as if nothing had come after. :mod:`orchestrator.cutting` removes what did come after.
"""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Any, Final
from zlib import crc32

from pydantic import Field, JsonValue

from genome.errors import InputError
from genome.settings import Settings, validated
from islands.checkpoint import FOLDER, READABLE, VERSION, Part, check_part, stem
from islands.log import LogFile
from islands.store import Store, StoreError

NAME: Final = re.compile(r"e(\d{6,})\.json")
MAGIC: Final = b"PAR1"
MOST_READ: Final = 256 * 2**20
"""Bytes of the log, the newest first, that are read to see whether they are whole before a run goes on."""

LEAST: Final = 12
"""Bytes of a Parquet file at least: its magic number twice, and the length of its footer."""


@dataclass(frozen=True, slots=True)
class Checkpoint:
    """A checkpoint, whole.

    Attributes
    ----------
    run, seed
        The run's name and seed.
    epoch
        The settled epoch that it stands for.
    parts
        Of all hosts; each island is in one.
    log
        The hosts' log files that end at that epoch or before, by name.
    events
        How many files of events of the whole run belong to it: ``run-0000`` and so on.
    commands
        How many of the run's commands had been applied.
    facts
        Whatever else the driver goes on from; plain JSON values.
    """

    run: str
    seed: int
    epoch: int
    parts: tuple[Part, ...]
    log: tuple[LogFile, ...]
    events: int = 0
    commands: int = 0
    facts: Mapping[str, Any] = field(default_factory=dict)


class ForeignError(InputError):
    """A checkpoint that is whole, for all that is known, and not for this run or this version of Atoll."""


class _Part(Settings):
    file: str
    bytes: int
    sha256: str
    islands: list[int]


class _Shape(Settings):
    """The file, as JSON; ``sha256`` is of all other keys."""

    version: str
    run: str
    seed: int
    epoch: int
    parts: list[_Part]
    log: dict[str, Annotated[list[int], Field(min_length=2, max_length=2)]]
    events: int
    commands: int
    facts: dict[str, JsonValue]
    sha256: str


def log_of(before: Checkpoint | None, told: Iterable[Iterable[LogFile]]) -> tuple[LogFile, ...]:
    """Give the log files of a checkpoint: those of the one that the run went on from, and those that hosts wrote since.

    Parameters
    ----------
    before
        The checkpoint that the hosts began with; ``None`` for the start.
    told
        For each host the files that its log writer has written.

    Raises
    ------
    ValueError
        When two files have one name.
    """
    files = [*(() if before is None else before.log), *(file for files in told for file in files)]
    found = {file.name: file for file in files}
    if len(found) < len(files):
        names = [file.name for file in files]
        twice = next(name for name in names if names.count(name) > 1)
        raise ValueError(f"two log files have the name {twice}")
    return tuple(found[name] for name in sorted(found))


def complete(store: Store, checkpoint: Checkpoint) -> None:
    """Make a checkpoint whole whose parts are written.

    Raises
    ------
    ValueError
        When it has no parts, or two with one island.
    """
    islands = [number for part in checkpoint.parts for number in part.islands]
    if not islands or len(set(islands)) < len(islands):
        raise ValueError(f"the checkpoint of epoch {checkpoint.epoch} needs each island in one part, got {islands}")
    content = {
        "version": VERSION,
        "run": checkpoint.run,
        "seed": checkpoint.seed,
        "epoch": checkpoint.epoch,
        "parts": [
            {"file": part.file, "bytes": part.bytes, "sha256": part.sha256, "islands": part.islands}
            for part in checkpoint.parts
        ],
        "log": {file.name: [file.bytes, file.crc] for file in checkpoint.log},
        "events": checkpoint.events,
        "commands": checkpoint.commands,
        "facts": dict(checkpoint.facts),
    }
    text = json.dumps({**content, "sha256": _hash(content)}, separators=(",", ":"), allow_nan=False)
    store.write(f"{stem(checkpoint.epoch)}.json", f"{text}\n".encode("ascii"))


def newest(store: Store, run: str, seed: int) -> tuple[Checkpoint | None, tuple[str, ...]]:
    """Find the newest checkpoint that stands.

    Parameters
    ----------
    store
        The run's folder.
    run, seed
        The run's name and seed.

    Returns
    -------
    The checkpoint, ``None`` when there is none; and for each newer one why it does not stand.

    Raises
    ------
    ForeignError
        When one is of another run, or of another version of Atoll: going back behind it would throw work away.
    StoreError
        When the store gives no answer, which says nothing about a checkpoint.
    """
    reasons: list[str] = []
    for epoch in epochs_of(store):
        try:
            found = read(store, epoch)
            if (found.run, found.seed) == (run, seed):
                check(store, found)
                return found, tuple(reasons)
        except (StoreError, ForeignError):
            raise
        except InputError as error:
            reasons.append(str(error))
            continue
        expected, got = f"a checkpoint of the run {run}, seed {seed}", f"one of {found.run}, seed {found.seed}"
        raise ForeignError(f"{stem(epoch)}.json", expected, got, "it was put there by hand: take it away")
    return None, tuple(reasons)


def epochs_of(store: Store) -> list[int]:
    """Give the epochs of which there is a file that makes a checkpoint whole, the newest first."""
    found = (NAME.fullmatch(name) for name in store.names(FOLDER))
    return sorted((int(match[1]) for match in found if match), reverse=True)


def read(store: Store, epoch: int) -> Checkpoint:
    """Read the file of one checkpoint; its parts and the log may be damaged all the same.

    Raises
    ------
    InputError
        When it is not what was written; a :class:`ForeignError` when another version of Atoll wrote it.
    """
    where = f"{stem(epoch)}.json"
    try:
        data = json.loads(store.read(where))
    except StoreError:
        raise
    except (FileNotFoundError, ValueError) as error:
        raise InputError(where, "a checkpoint's JSON", f"what is none ({error})") from None
    version = data.get("version") if isinstance(data, dict) else None
    if isinstance(version, str) and version not in READABLE:
        expected, got = f"a checkpoint of version {VERSION}", f"one of version {version}"
        raise ForeignError(where, expected, got, "go on with the Atoll that wrote it")
    shape = validated(_Shape, data, where)
    content = {key: value for key, value in data.items() if key != "sha256"}
    if _hash(content) != shape.sha256:
        raise InputError(where, f"content of the sha256 {shape.sha256[:12]}...", f"{_hash(content)[:12]}...")
    if shape.epoch != epoch:
        raise InputError(where, f"the checkpoint of epoch {epoch}", f"that of epoch {shape.epoch}")
    return Checkpoint(
        run=shape.run,
        seed=shape.seed,
        epoch=epoch,
        parts=tuple(Part(one.file, one.bytes, one.sha256, tuple(one.islands)) for one in shape.parts),
        log=tuple(LogFile(name, *told) for name, told in shape.log.items()),
        events=shape.events,
        commands=shape.commands,
        facts=shape.facts,
    )


def check(store: Store, checkpoint: Checkpoint) -> None:
    """Check that all parts and log files of a checkpoint are there, and whole.

    Parts are read and hashed. Of log files sizes are compared; on a local disk both ends are looked at, and the newest
    are read, up to ``MOST_READ`` bytes, and their checksums compared.

    Raises
    ------
    InputError
        For the first thing that is wrong.
    """
    for part in checkpoint.parts:
        check_part(store, part)
    log = store.at("log")
    sizes: dict[str, int] = {}
    listed = {file.name: file.bytes for file in checkpoint.log}
    for table in sorted({name.partition("/")[0] for name in listed} | {"events"}):
        sizes.update((f"{table}/{name}", size) for name, size in log.sizes(table).items())
    told = {run_events(number): sizes.get(run_events(number), LEAST) for number in range(checkpoint.events)}
    for name, size in {**listed, **told}.items():
        expected = f"a file of {size} bytes" if name not in told else "a file"
        if name not in sizes:
            raise InputError(f"log/{name}", f"{expected} of the checkpoint of epoch {checkpoint.epoch}", "none")
        if sizes[name] != size:
            raise InputError(f"log/{name}", expected, f"{sizes[name]} bytes")
        if log.local is not None and not _has_both_ends(log.local / name, size):
            raise InputError(f"log/{name}", "a whole Parquet file", "one that lacks its beginning or its end")
    if log.local is not None:
        _read_newest(log.local, sorted(checkpoint.log, key=_last_epoch, reverse=True))


def _last_epoch(file: LogFile) -> tuple[str, str]:
    """Sort the log's files by the last epoch in them."""
    return (file.name.rpartition("/")[2][8:14], file.name)


def _read_newest(log: Path, files: Iterable[LogFile]) -> None:
    """Read log files whole, as far as a bound allows, and compare their checksums."""
    budget = MOST_READ
    for file in files:
        budget -= file.bytes
        if budget < 0:
            return
        found = crc32((log / file.name).read_bytes())
        if found != file.crc:
            raise InputError(f"log/{file.name}", f"content of the CRC-32 {file.crc:08x}", f"{found:08x}")


def run_events(number: int) -> str:
    """Give the name in the log of a file of events of the whole run."""
    return f"events/run-{number:04d}.parquet"


def _has_both_ends(path: Path, size: int) -> bool:
    if size < LEAST:
        return False
    with path.open("rb") as file:
        head = file.read(len(MAGIC))
        file.seek(-len(MAGIC) - 4, 2)
        footer, tail = int.from_bytes(file.read(4), "little"), file.read()
    return head == tail == MAGIC and footer <= size - LEAST


def _hash(content: Mapping[str, Any]) -> str:
    return hashlib.sha256(json.dumps(content, sort_keys=True, separators=(",", ":")).encode("ascii")).hexdigest()
