"""One hash of what happened in a run, the same for every way of getting there.

Each row of individuals, evaluations, generations and migrations is written as one line of JSON, without the run's
name and the clock's columns; the lines' hashes are sorted and hashed. Floats are written so that they read back to
the same bits.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator
from typing import Final

from genome.errors import InputError
from islands.schemas import CLOCKED, columns
from islands.store import Anywhere, Store

SPOILT: Final = "the file was damaged after it was written: take a copy of it, or replay the run"
DIGESTED: Final = ("individuals", "evaluations", "generations", "migrations")


def digest(log: Anywhere) -> tuple[str, int]:
    """Digest a log.

    Parameters
    ----------
    log
        The run's ``log`` folder, in any store.

    Returns
    -------
    The digest in hexadecimal, and how many rows it covers.
    """
    store = Store.open(log)
    hashes: list[bytes] = []
    for table in DIGESTED:
        hashes.extend(hashlib.sha256(line).digest() for line in _lines(store, table))
    whole = hashlib.sha256()
    for part in sorted(hashes):
        whole.update(part)
    return whole.hexdigest(), len(hashes)


def _lines(log: Store, table: str) -> Iterator[bytes]:
    import pyarrow as pa
    import pyarrow.parquet as pq

    kept = [name for name in columns(table) if name != "run" and name not in CLOCKED]
    for name in log.names(table):
        if not name.endswith(".parquet"):
            continue
        content = pa.BufferReader(log.read(f"{table}/{name}"))
        try:
            read = pq.read_table(content, columns=kept, use_threads=False)
        except (pa.ArrowException, OSError) as error:
            got = str(error).strip().partition("\n")[0]
            raise InputError(f"log/{table}/{name}", "a Parquet file that can be read", got, SPOILT) from None
        for batch in read.to_batches():
            lists = [batch.column(name).to_pylist() for name in kept]
            for row in zip(*lists, strict=True):
                text = json.dumps([table, *row], separators=(",", ":"), allow_nan=False)
                yield text.encode()
