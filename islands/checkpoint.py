"""One host's part of a checkpoint: a Parquet file with a row for each of its islands.

A row holds the island's deme in typed columns, and two texts of JSON: the rest of its state, and the packets that were
on their way to it. Random streams are named by island, purpose and epoch, so none of them is kept. Any host can read
its islands out of any hosts' parts. ``docs/formats/checkpoint.md`` has the columns.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final, NamedTuple

from genome.errors import InputError
from genome.mishaps import let_pass, told
from islands.codec import MEMBER, deme_columns, read_deme, read_state, state_text
from islands.island import Island
from islands.migration.channel import Packet
from islands.state import State
from islands.store import Store
from islands.tally import Champion
from islands.wire import Bundle, bundled, opened, written

if TYPE_CHECKING:
    import pyarrow as pa

FOLDER: Final = "checkpoints"
VERSION: Final = "2"
"""Of the part files and of the file that makes a checkpoint whole."""

READABLE: Final = ("1", VERSION)
"""Version 1 has no outcomes of pairings and no watched channels, which no island had then."""


@dataclass(frozen=True, slots=True)
class Part:
    """A part file that was written.

    Attributes
    ----------
    file
        Its name in the run's folder.
    bytes, sha256
        Its size, and its hash in hexadecimal.
    islands
        Whose state it holds: their numbers, ascending.
    """

    file: str
    bytes: int
    sha256: str
    islands: tuple[int, ...]


class Kept(NamedTuple):
    """What is kept of an island at an epoch's end.

    Attributes
    ----------
    island
        Names itself, and writes its genotypes.
    state
        At the end of that epoch.
    pending
        Packets to it that were sent at the end of that epoch or before, and that it has not taken in by then.
    champion
        The best individual that it had bred by then.
    """

    island: Island[Any]
    state: State[Any]
    pending: Sequence[Packet]
    champion: Champion | None


class Restored(NamedTuple):
    """What an island goes on from; see :class:`Kept`. Packets are in order of channel, source, epoch."""

    state: State[Any]
    pending: tuple[Packet, ...]
    champion: Champion | None


def stem(epoch: int) -> str:
    """Give a checkpoint's name in the run's folder: of its folder, and without suffix of the file beside it."""
    return f"{FOLDER}/e{epoch:06d}"


def write_part(store: Store, epoch: int, host: int, islands: Iterable[Kept]) -> Part:
    """Write a host's part of the checkpoint of an epoch.

    Parameters
    ----------
    store
        The run's folder.
    epoch
        The epoch; the states are those of its end.
    host
        The host's number.
    islands
        At least one.

    Raises
    ------
    ValueError
        When a state is of another epoch, or a packet is not for its island or of a later epoch.
    """
    import pyarrow as pa
    import pyarrow.parquet as pq

    kept = sorted(islands, key=lambda one: one.island.spec.number)
    table = _table(epoch, kept)
    sink = pa.BufferOutputStream()
    pq.write_table(
        table, sink, compression="zstd", use_dictionary=_REPEATED, use_byte_stream_split=_FLOATS, write_statistics=False
    )
    content = sink.getvalue().to_pybytes()
    file = f"{stem(epoch)}/host-{host:05d}.parquet"
    store.write(file, content)
    return Part(file, len(content), _hash(content), tuple(one.island.spec.number for one in kept))


def check_part(store: Store, part: Part) -> bytes:
    """Give a part's content.

    Raises
    ------
    InputError
        When the file is not there, or is not what was written.
    """
    expected = f"a part of a checkpoint, {part.bytes} bytes"
    try:
        content = store.read(part.file)
    except FileNotFoundError:
        raise InputError(part.file, expected, "no file") from None
    if len(content) != part.bytes:
        raise InputError(part.file, expected, f"{len(content)} bytes")
    if _hash(content) != part.sha256:
        raise InputError(part.file, f"the sha256 {part.sha256[:12]}...", f"{_hash(content)[:12]}...")
    return content


def read_parts(store: Store, parts: Iterable[Part], islands: Iterable[Island[Any]]) -> dict[int, Restored]:
    """Read what some islands go on from, out of the parts of whichever hosts held them.

    Parameters
    ----------
    store
        The run's folder.
    parts
        Of one checkpoint; those that hold none of the islands are not read.
    islands
        The wanted ones; they read their genotypes.

    Returns
    -------
    By the islands' numbers, in their order.

    Raises
    ------
    InputError
        When a part is damaged, an island is in none, or is another than when it was written.
    """
    wanted = {island.spec.number: island for island in islands}
    found: dict[int, Restored] = {}
    for part in parts:
        here = {number: wanted[number] for number in part.islands if number in wanted}
        if here:
            found.update(_read(part.file, check_part(store, part), here))
    for number, island in wanted.items():
        if number not in found:
            raise InputError(FOLDER, f"a part that holds the island {island.spec.name}", "none")
    return {number: found[number] for number in wanted}


# -- writing ---------------------------------------------------------------------------------------------------------

_REPEATED: Final = [
    "scores.list.element.key_value.key", "errors.list.element", "since.list.element",
    "outcomes.list.element.key_value.key",
]  # fmt: skip
_FLOATS: Final = [
    "fitness.list.element",
    "scores.list.element.key_value.value",
    "outcomes.list.element.key_value.value",
]


def _schema() -> pa.Schema:
    import pyarrow as pa

    scores = pa.map_(pa.string(), pa.float64())
    types = (pa.int64(), pa.string(), pa.float64(), scores, pa.string(), pa.int64(), scores)
    deme = [(name, pa.list_(kind)) for name, kind in zip(MEMBER, types, strict=True)]
    columns = [("island", pa.int64()), ("name", pa.string()), *deme, ("state", pa.string()), ("pending", pa.string())]
    return pa.schema(columns, metadata={"atoll.checkpoint": VERSION})


def _table(epoch: int, kept: Sequence[Kept]) -> pa.Table:
    import pyarrow as pa

    for one in kept:
        spec = one.island.spec
        if one.state.epoch != epoch:
            raise ValueError(f"{spec.name} is at epoch {one.state.epoch}, the checkpoint stands for {epoch}")
        for packet in one.pending:
            if packet.target != spec.number or packet.epoch > epoch:
                text = f"for island {packet.target}, sent at the end of epoch {packet.epoch}"
                raise ValueError(f"a packet {text}, among those on their way to {spec.name} at epoch {epoch}")
    letters = _letters(kept)
    rows = [
        {
            "island": one.island.spec.number,
            "name": one.island.spec.name,
            **deme_columns(one.island.biology, one.state.deme),
            "state": state_text(one.state, one.champion),
            "pending": letters.get(one.island.spec.number, "[]"),
        }
        for one in kept
    ]
    form = _schema()
    arrays = [pa.array([row[field.name] for row in rows], field.type) for field in form]
    return pa.Table.from_arrays(arrays, schema=form)


def _letters(kept: Sequence[Kept]) -> dict[int, str]:
    """Write the packets: those of one broadcast once, with the first of their targets."""
    packets = sorted(
        (packet for one in kept for packet in one.pending),
        key=lambda packet: (packet.channel, packet.source, packet.epoch, packet.target),
    )
    letters: dict[int, list[Bundle]] = {}
    for bundle in bundled(packets):
        letters.setdefault(bundle[2][0], []).append(bundle)
    return {target: written(bundles).decode("ascii") for target, bundles in letters.items()}


def _hash(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()


# -- reading ---------------------------------------------------------------------------------------------------------


def _read(file: str, content: bytes, islands: Mapping[int, Island[Any]]) -> dict[int, Restored]:
    import pyarrow as pa
    import pyarrow.compute as pc
    import pyarrow.parquet as pq

    table = pq.read_table(pa.BufferReader(content))
    version = (table.schema.metadata or {}).get(b"atoll.checkpoint", b"none").decode()
    if version not in READABLE:
        raise InputError(file, f"a part of a checkpoint, version {VERSION}", f"version {version}")
    pending: dict[int, list[Packet]] = {number: [] for number in islands}
    for letter in table.column("pending").to_pylist():
        for packet in opened(letter.encode("ascii")):
            if packet.target in pending:
                pending[packet.target].append(packet)
    numbers = pa.array(list(islands), pa.int64())
    rows = table.drop_columns(["pending"]).filter(pc.is_in(table.column("island"), numbers)).to_pylist()
    return {row["island"]: _restored(file, row, islands[row["island"]], pending[row["island"]]) for row in rows}


def _restored(file: str, row: Mapping[str, Any], island: Island[Any], pending: Iterable[Packet]) -> Restored:
    name = island.spec.name
    if row["name"] != name:
        got = f"'{row['name']}' under its number {row['island']}"
        raise InputError(file, f"the state of the island {name}", got, "the experiment was changed")
    try:
        deme = read_deme(island.biology, row)
    except BaseException as error:  # noqa: BLE001 - whatever a plug-in raises that cannot read its own
        let_pass(error)
        remedy = "the kind was changed since"
        raise InputError(file, f"genotypes of the island {name} that its kind reads", told(error), remedy) from None
    state, champion = read_state(row["state"], deme)
    in_order = sorted(pending, key=lambda packet: (packet.channel, packet.source, packet.epoch))
    return Restored(state, tuple(in_order), champion)
