"""A motion as a `.glb` file: a node for each joint, a skin, and an animation of rotations [GLTF21].

The nodes stand at rest: no joint is turned, and the lowest is on the ground. The turns of joints that carry
little are stored as shares of 32767 in 16 bits, as glTF allows: that moves no joint by more than 0.1 mm. The
file is a JSON text and a block of numbers [GLTF21, 4.4].
"""

from __future__ import annotations

import json
import struct
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mocap.body import rotations
from mocap.body.motion import Motion, turning
from mocap.body.skeleton import Skeleton
from mocap.errors import MocapError, shortened
from mocap.files.gltf_capsules import body, reaches

Record = dict[str, Any]

CARRIED = 0.25  # metres: the turns of a joint that carries less are rounded to 16 bits
MOST = 2**32 - 1  # bytes: the header counts in 32 bits
KINDS = {1: "SCALAR", 3: "VEC3", 4: "VEC4", 16: "MAT4"}  # by how many numbers an element has
NUMBERS = {"int16": 5122, "uint8": 5121, "uint16": 5123, "uint32": 5125, "float32": 5126}
VERTICES, CORNERS = 34962, 34963  # what an array is for
CLAY = {"baseColorFactor": [0.45, 0.55, 0.65, 1.0], "metallicFactor": 0.0, "roughnessFactor": 0.8}


def glb(motion: Motion) -> bytes:
    """Build the bytes of the file.

    Parameters
    ----------
    motion : F frames. Joints keep their names; labels and contacts are left out.

    Raises
    ------
    MocapError : for more bytes than the format can count, and frames too short for its clock.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> len(glb(sample("walk_straight"))) < 500_000
    True
    """
    skeleton, block = motion.skeleton, Block()
    joints = len(skeleton)
    back = np.tile(np.eye(4, dtype=np.float32), (joints, 1, 1))  # each moves a joint at rest to the origin
    back[:, 3, :3] = -skeleton.rest  # by columns
    bind = block.add(back.reshape(-1, 16))
    document = {
        "asset": {"version": "2.0", "generator": "mocap"},
        "scene": 0,
        "scenes": [{"name": motion.name, "nodes": [0, joints]}],
        "nodes": [*_nodes(skeleton), {"name": "body", "mesh": 0, "skin": 0}],
        "skins": [{"inverseBindMatrices": bind, "joints": list(range(joints)), "skeleton": 0}],
        "materials": [{"name": "clay", "pbrMetallicRoughness": CLAY}],
        "meshes": [_mesh(skeleton, block)],
        "animations": [_animation(motion, block)],
        "accessors": block.accessors,
        "bufferViews": block.views,
        "buffers": [{"byteLength": len(block.data)}],
    }
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    size = 28 + len(text) + len(block.data)
    if size > MOST:
        raise MocapError(f"A .glb file holds {MOST / 1e9:.1f} GB at most, not {size / 1e9:.1f}: write .bvh.")
    heads = struct.pack("<4sIII4s", b"glTF", 2, size, len(text), b"JSON"), (len(block.data), b"BIN\0")
    return heads[0] + text + struct.pack("<I4s", *heads[1]) + block.data


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

    accessors: list[Record] = field(default_factory=list)
    views: list[Record] = field(default_factory=list)
    data: bytearray = field(default_factory=bytearray)

    def add(self, values: NDArray[Any], *, bounds: bool = False, target: int | None = None) -> int:
        """Add an array, shape (N,) or (N, numbers), and give the index of its accessor.

        Whole numbers with a sign stand for shares of their largest, and so do bytes ("normalised").

        Parameters
        ----------
        values : of a type in `NUMBERS`.
        bounds : whether to say the least and the largest, as glTF wants for places and times.
        target : `VERTICES` for what belongs to vertices, `CORNERS` for the corners of triangles.
        """
        flat = values.reshape(len(values), -1)
        accessor = {
            "bufferView": len(self.views),
            "componentType": NUMBERS[values.dtype.name],
            "count": len(flat),
            "type": KINDS[flat.shape[1]],
        }
        accessor |= {"normalized": True} if values.dtype in (np.int16, np.uint8) else {}
        accessor |= {"min": flat.min(0).tolist(), "max": flat.max(0).tolist()} if bounds else {}
        self.accessors.append(accessor)
        place = {"buffer": 0, "byteOffset": len(self.data), "byteLength": values.nbytes}
        self.views.append(place | ({"target": target} if target else {}))
        self.data += values.tobytes() + b"\0" * (-values.nbytes % 4)
        return len(self.views) - 1


def _nodes(skeleton: Skeleton) -> list[Record]:
    places = skeleton.offsets.copy()
    places[0] = [0.0, -skeleton.rest[:, 1].min(), 0.0]
    nodes: list[Record] = []
    for joint, name in enumerate(skeleton.names):
        node: Record = {"name": name, "translation": (places[joint] + 0.0).tolist()}
        nodes.append(node | ({"children": below} if (below := skeleton.children(joint)) else {}))
    return nodes


def _mesh(skeleton: Skeleton, block: Block) -> Record:
    places, normals, joints, corners = body(skeleton)
    counted = np.uint16 if len(places) < 2**16 - 1 else np.uint32  # the largest number is kept free
    carried = np.zeros((len(places), 4), np.uint16)
    carried[:, 0] = joints
    weights = np.zeros((len(places), 4), np.uint8)
    weights[:, 0] = 255  # the whole of it
    attributes = {
        "POSITION": block.add(places.astype(np.float32), bounds=True, target=VERTICES),
        "NORMAL": block.add(normals.astype(np.float32), target=VERTICES),
        "JOINTS_0": block.add(carried, target=VERTICES),
        "WEIGHTS_0": block.add(weights, target=VERTICES),
    }
    indices = block.add(corners.ravel().astype(counted), target=CORNERS)
    return {"name": "body", "primitives": [{"attributes": attributes, "indices": indices, "material": 0}]}


def _animation(motion: Motion, block: Block) -> Record:
    times = (np.arange(len(motion)) / motion.fps).astype(np.float32)
    if np.any(np.diff(times) <= 0):
        name = shortened(motion.name)
        raise MocapError(f"'{name}' at {motion.fps:g} Hz is too fast for a .glb: resample it.")
    clock = block.add(times, bounds=True)
    samplers = [{"input": clock, "output": block.add(motion.root_positions.astype(np.float32))}]
    channels = [{"sampler": 0, "target": {"node": 0, "path": "translation"}}]
    turns = rotations.continuous(motion.rotations)[..., [1, 2, 3, 0]]
    carries = reaches(motion.skeleton)
    for joint in np.flatnonzero(turning(motion)).tolist():
        exact = turns[:, joint].astype(np.float32)
        short = np.round(32767 * exact).astype(np.int16)
        channels.append({"sampler": len(samplers), "target": {"node": joint, "path": "rotation"}})
        samplers.append({"input": clock, "output": block.add(exact if carries[joint] > CARRIED else short)})
    return {"name": motion.name, "samplers": samplers, "channels": channels}
