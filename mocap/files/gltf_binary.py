"""The container of a `.glb` file: a JSON text and a block of numbers [GLTF21, 4.4]."""

from __future__ import annotations

import json
import struct
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mocap.errors import MocapError

KINDS = {1: "SCALAR", 3: "VEC3", 4: "VEC4", 16: "MAT4"}  # by how many numbers an element has
NUMBERS = {"int16": 5122, "uint8": 5121, "uint16": 5123, "uint32": 5125, "float32": 5126}
MOST = 2**32 - 1  # bytes: the header counts in 32 bits


@dataclass
class Block:
    """The numbers of a file: each array that is added gets a view of the bytes, and an accessor.

    Examples
    --------
    >>> block = Block()
    >>> block.add(np.zeros((5, 3), np.float32)), block.add(np.arange(3, dtype=np.uint16))
    (0, 1)
    >>> block.accessors[1]
    {'bufferView': 1, 'componentType': 5123, 'count': 3, 'type': 'SCALAR'}
    """

    accessors: list[dict[str, Any]] = field(default_factory=list)
    views: list[dict[str, Any]] = field(default_factory=list)
    pieces: list[bytes] = field(default_factory=list)
    size: int = 0

    def add(self, values: NDArray[Any], *, bounds: bool = False, target: int | None = None) -> int:
        """Add an array, shape (N,) or (N, numbers), and give the index of its accessor.

        Whole numbers with a sign stand for shares of their largest, and so do bytes ("normalised").

        Parameters
        ----------
        values : of a type in `NUMBERS`.
        bounds : whether to say the least and the largest, as glTF wants for places and times.
        target : 34962 for what belongs to vertices, 34963 for the corners of triangles.
        """
        flat = values.reshape(len(values), -1)
        data = np.ascontiguousarray(flat).tobytes()
        view = {"buffer": 0, "byteOffset": self.size, "byteLength": len(data)}
        self.views.append(view | ({"target": target} if target else {}))
        padded = data + b"\0" * (-len(data) % 4)
        self.pieces.append(padded)
        self.size += len(padded)
        accessor = {
            "bufferView": len(self.views) - 1,
            "componentType": NUMBERS[values.dtype.name],
            "count": len(flat),
            "type": KINDS[flat.shape[1]],
        }
        if values.dtype in (np.int16, np.uint8):
            accessor["normalized"] = True
        if bounds:
            accessor |= {"min": flat.min(0).tolist(), "max": flat.max(0).tolist()}
        self.accessors.append(accessor)
        return len(self.accessors) - 1


def to_glb(document: dict[str, Any], block: Block) -> bytes:
    """Put a document and its numbers together.

    Raises
    ------
    MocapError : for more bytes than the header can count.

    Examples
    --------
    >>> to_glb({"asset": {"version": "2.0"}}, Block())[:4]
    b'glTF'
    """
    whole = document | {"accessors": block.accessors, "bufferViews": block.views}
    whole = {key: value for key, value in whole.items() if value != []}
    if block.size:
        whole["buffers"] = [{"byteLength": block.size}]
    text = json.dumps(whole, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    chunks = [(b"JSON", text)] + ([(b"BIN\0", b"".join(block.pieces))] if block.size else [])
    size = 12 + sum(8 + len(data) for _, data in chunks)
    if size > MOST:
        raise MocapError(f"A .glb file holds {MOST / 1e9:.1f} GB at most, not {size / 1e9:.1f}: write .bvh.")
    parts = [struct.pack("<4sII", b"glTF", 2, size)]
    parts += [struct.pack("<I4s", len(data), kind) + data for kind, data in chunks]
    return b"".join(parts)
