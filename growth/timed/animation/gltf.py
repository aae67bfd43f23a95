"""Building a GLB file: accessors over one buffer, and the container (Khronos glTF 2.0).

trimesh, which writes the other GLB files, writes no animations, and knows no nodes that share a mesh and move.
"""

from __future__ import annotations

import json
import struct
from collections.abc import Mapping
from typing import Any, Final, final

import numpy as np
from numpy.typing import NDArray

VERTICES: Final = 34962
ELEMENTS: Final = 34963
"""What a buffer's view is for."""

COMPONENTS: Final[Mapping[str, int]] = {"<f4": 5126, "<u4": 5125, "<u2": 5123}
KINDS: Final[Mapping[int, str]] = {1: "SCALAR", 3: "VEC3", 4: "VEC4"}

JSON_CHUNK: Final = 0x4E4F534A
BINARY_CHUNK: Final = 0x004E4942
MAGIC: Final = 0x46546C67


@final
class Buffer:
    """The binary part of a file, and the accessors that read it; equal data are kept once."""

    def __init__(self) -> None:
        self._parts: Final[list[bytes]] = []
        self._size = 0
        self._known: Final[dict[tuple[bytes, str, int, int | None, bool], int]] = {}
        self.views: Final[list[dict[str, Any]]] = []
        self.accessors: Final[list[dict[str, Any]]] = []

    def floats(self, values: NDArray[Any], target: int | None = None, *, bounded: bool = False) -> int:
        """Keep floats, (n,), (n, 3) or (n, 4), as float32; give the accessor's number.

        ``bounded`` writes the lowest and highest into the accessor, which positions and times want.
        """
        return self._keep(np.ascontiguousarray(values, dtype="<f4"), target, bounded=bounded)

    def indices(self, triangles: NDArray[Any]) -> int:
        """Keep triangles' corners as 16 bits where that is enough."""
        large = int(triangles.max(initial=0)) >= 2**16 - 1
        return self._keep(np.ascontiguousarray(triangles.reshape(-1), dtype="<u4" if large else "<u2"), ELEMENTS)

    def _keep(self, values: NDArray[Any], target: int | None, *, bounded: bool = False) -> int:
        data = values.tobytes()
        width = values.shape[1] if values.ndim == 2 else 1
        key = (data, values.dtype.str, width, target, bounded)
        if key in self._known:
            return self._known[key]
        view: dict[str, Any] = {"buffer": 0, "byteOffset": self._size, "byteLength": len(data)}
        self.views.append(view if target is None else {**view, "target": target})
        accessor: dict[str, Any] = {
            "bufferView": len(self.views) - 1,
            "componentType": COMPONENTS[values.dtype.str],
            "count": len(values),
            "type": KINDS[width],
        }
        if bounded:
            rows = values.reshape(len(values), -1)
            accessor |= {"min": rows.min(axis=0).tolist(), "max": rows.max(axis=0).tolist()}
        self.accessors.append(accessor)
        padded = data + b"\0" * (-len(data) % 4)
        self._parts.append(padded)
        self._size += len(padded)
        self._known[key] = len(self.accessors) - 1
        return self._known[key]

    @property
    def data(self) -> bytes:
        """All of it."""
        return b"".join(self._parts)


def container(content: Mapping[str, Any], binary: bytes) -> bytes:
    """Put the JSON and the binary part into one GLB file."""
    text = json.dumps(content, separators=(",", ":"), allow_nan=False).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<II", len(text), JSON_CHUNK) + text + struct.pack("<II", len(binary), BINARY_CHUNK) + binary
    return struct.pack("<III", MAGIC, 2, 12 + len(chunks)) + chunks
