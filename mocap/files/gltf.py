"""Motions as a `.glb` file: a node for each joint, a skin, and animations of rotations [GLTF21].

The nodes are in the rest pose, which stands with its lowest joint on the ground (`gltf_rest`), and the skin
is bound to this pose. The y axis of each joint runs along its bone (`gltf_bones`). Rotations of joints with a
short limb below are stored as normalised 16-bit integers, which changes joint positions by at most 0.1 mm.
The file consists of a JSON text and a block of binary data [GLTF21, 4.4].
"""

from __future__ import annotations

import json
import struct
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mocap._shared.arrays import Array, Mask
from mocap.body import rotations
from mocap.body.concatenation import require_compatible
from mocap.body.motion import Motion, rotating_joints
from mocap.body.planar import PlanarTransform, heading
from mocap.body.skeleton import Skeleton, reaches
from mocap.errors import MocapError, shortened
from mocap.files.gltf_bones import bone_axes
from mocap.files.gltf_capsules import body
from mocap.files.gltf_rest import with_standing_rest
from mocap.files.plain_names import plain_name
from mocap.files.tuned import TUNED

Record = dict[str, Any]

LARGEST_INT16 = 32767  # represents 1
MOST = 2**32 - 1  # bytes: the size in the header has 32 bits
VERSION = 2  # of glTF
HEADER = struct.Struct("<4sII")  # "glTF", the version, the bytes of the file
CHUNK_HEADER = struct.Struct("<I4s")  # the bytes of a chunk, its kind

KINDS = {1: "SCALAR", 3: "VEC3", 4: "VEC4", 16: "MAT4"}  # by the number of components of an element
NUMBERS = {"int16": 5122, "uint8": 5121, "uint16": 5123, "uint32": 5125, "float32": 5126}
VERTICES = 34962  # the target of an array: data of vertices
CORNERS = 34963  # the target of an array: corners of triangles
TRANSLATION = 3  # column of a 4 × 4 matrix
XYZW = [1, 2, 3, 0]  # indices that reorder (w, x, y, z) to the order of glTF
LEAST_ROTATION = 1e-12  # sine of half the angle: below this, a node is not rotated
INFLUENCES = 4  # joints that influence a vertex: glTF requires four, of which only the first is used here

ASSET = {"version": "2.0", "generator": "mocap"}
BODY_NAME = "body"
BODY: Record = {"name": BODY_NAME, "mesh": 0, "skin": 0}
CLAY = {"baseColorFactor": [0.45, 0.55, 0.65, 1.0], "metallicFactor": 0.0, "roughnessFactor": 0.8}


def glb(motions: Motion | Sequence[Motion], *, root: bool = False) -> bytes:
    """Convert a motion, or several motions of one body, to the bytes of a `.glb` file.

    Parameters
    ----------
    motions : a motion, or motions with different names, each of which becomes an animation. Their frame rates
        may differ. Joints keep their names. Labels and contacts are omitted. If the rest pose of the body
        does not stand, the file gets one that does, for all animations.
    root : whether to add a joint on the floor below the hips, with their heading, as the parent of the
        skeleton's root. Engines move a character by such a joint (root motion).

    Raises
    ------
    SkeletonMismatch : for different skeletons.
    MocapError : for equal names, an empty list, files larger than the format allows, and frame times below
        the precision of its clock.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> glb(sample("walk_straight"))[:4]
    b'glTF'
    """
    block = Block()
    clips = [motions] if isinstance(motions, Motion) else _of_one_body(motions)
    text = json.dumps(_document(clips, root, block), separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    size = HEADER.size + CHUNK_HEADER.size + len(text) + CHUNK_HEADER.size + len(block.data)
    if size > MOST:
        raise MocapError(f"A .glb file holds {MOST / 1e9:.1f} GB at most, not {size / 1e9:.1f}: write .bvh.")
    json_chunk = CHUNK_HEADER.pack(len(text), b"JSON") + text
    binary_chunk = CHUNK_HEADER.pack(len(block.data), b"BIN\0") + block.data
    return HEADER.pack(b"glTF", VERSION, size) + json_chunk + binary_chunk


@dataclass
class Block:
    """The binary data of a file: each array that is added gets a buffer view and an accessor.

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
        """Add an array, shape (N,) or (N, components), and return the index of its accessor.

        Signed 16-bit integers and bytes are normalised: fractions of their largest value.

        Parameters
        ----------
        values : of a type in `NUMBERS`.
        bounds : whether to store the minimum and maximum, which glTF requires for positions and times.
        target : `VERTICES` for vertex data, `CORNERS` for the vertex indices of triangles.
        """
        table = values.reshape(len(values), -1)
        accessor: Record = {"bufferView": len(self.views), "componentType": NUMBERS[values.dtype.name]}
        accessor["count"] = len(table)
        accessor["type"] = KINDS[table.shape[1]]
        if values.dtype in (np.int16, np.uint8):
            accessor["normalized"] = True
        if bounds:
            accessor["min"] = table.min(0).tolist()
            accessor["max"] = table.max(0).tolist()
        view: Record = {"buffer": 0, "byteOffset": len(self.data), "byteLength": values.nbytes}
        if target:
            view["target"] = target
        self.accessors.append(accessor)
        self.views.append(view)
        padding = b"\0" * (-values.nbytes % 4)
        self.data += values.tobytes() + padding
        return len(self.accessors) - 1


def _of_one_body(motions: Sequence[Motion]) -> list[Motion]:
    """Return motions on one skeleton at their own frame rates; raise for equal names."""
    names = [motion.name for motion in motions]
    for name in names:
        if names.count(name) > 1:
            raise MocapError(f"Two motions have the name '{shortened(name)}': an animation needs its own.")
    at_one_rate = require_compatible([replace(motion, fps=motions[0].fps) for motion in motions])
    return [replace(clip, fps=motion.fps) for clip, motion in zip(at_one_rate, motions, strict=True)]


def _document(motions: Sequence[Motion], root: bool, block: Block) -> Record:
    """Build the JSON part of the file, and add its arrays to the block."""
    motions = with_standing_rest(motions)
    skeleton = motions[0].skeleton
    axes = bone_axes(skeleton)
    body_node = len(skeleton)  # after all joints
    nodes = [*_nodes(skeleton, axes), BODY | {"name": _free_name(BODY_NAME, "drawn", skeleton)}]
    skin = _skin(skeleton, axes, root, block)
    if root:
        nodes.append({"name": _free_name("root", "floor", skeleton), "children": [0]})
    document: Record = {"asset": ASSET, "scene": 0}
    scene_name = _free_name(motions[0].name, "clip", skeleton)
    document["scenes"] = [{"name": scene_name, "nodes": [skin["skeleton"], body_node]}]
    document["nodes"] = nodes
    document["skins"] = [skin]
    document["materials"] = [{"name": "clay", "pbrMetallicRoughness": CLAY}]
    document["meshes"] = [_mesh(skeleton, block)]
    travels = [_travel(motion) if root else None for motion in motions]
    motions = [_without(travel, motion) for travel, motion in zip(travels, motions, strict=True)]
    rotates = np.any([rotating_joints(motion) for motion in motions], axis=0)
    document["animations"] = [
        _animation(motion, axes, rotates, travel, block)
        for travel, motion in zip(travels, motions, strict=True)
    ]
    document["accessors"] = block.accessors
    document["bufferViews"] = block.views
    document["buffers"] = [{"byteLength": len(block.data)}]
    return document


def _nodes(skeleton: Skeleton, axes: Array) -> list[Record]:
    """Build a node for each joint: its position and orientation at rest, relative to its parent."""
    above = _axes_of_parents(skeleton, axes)
    positions = rotations.rotate(rotations.inverse(above), skeleton.offsets)
    positions[0] = _floor_to_root(skeleton)
    quaternions = _relative_to_bones(skeleton, axes, rotations.IDENTITY)[:, XYZW]
    nodes: list[Record] = []
    for joint, name in enumerate(skeleton.names):
        node: Record = {"name": name, "translation": (positions[joint] + 0.0).tolist()}
        if np.abs(quaternions[joint, :3]).max() > LEAST_ROTATION:
            node["rotation"] = np.clip(quaternions[joint], -1, 1).tolist()
        children = skeleton.children(joint)
        if children:
            node["children"] = children
        nodes.append(node)
    return nodes


def _floor_to_root(skeleton: Skeleton) -> Array:
    """Return the position of the root at rest, (3,), metres: the lowest joint is at y = 0."""
    return np.array([0.0, -skeleton.rest[:, 1].min(), 0.0])


def _axes_of_parents(skeleton: Skeleton, axes: Array) -> Array:
    """Return the orientation of each joint's parent at rest, (J, 4); the identity for the root."""
    above = axes[skeleton.parents]
    above[0] = rotations.IDENTITY
    return above


def _relative_to_bones(skeleton: Skeleton, axes: Array, local: Array) -> Array:
    """Convert local rotations R, (..., J, 4), to those of nodes with axes A along the bones: A_p⁻¹ R A."""
    rotated = rotations.multiply(local, axes)
    return rotations.multiply(rotations.inverse(_axes_of_parents(skeleton, axes)), rotated)


def _floor_node(skeleton: Skeleton) -> int:
    """Return the node of a joint on the floor: the last one, after the joints and the body."""
    return len(skeleton) + 1


def _free_name(name: str, prefix: str, skeleton: Skeleton) -> str:
    """Return a name that no joint has, with prefixes if necessary.

    Programs that need unique names would rename the joint. Names that differ only in characters that three.js
    drops are the same.
    """
    names_of_joints = {plain_name(joint) for joint in skeleton.names}
    while plain_name(name) in names_of_joints:
        name = f"{prefix}_{name}"
    return name


def _travel(motion: Motion) -> PlanarTransform:
    """Return the heading of the root and its position over the ground, each of shape (F,)."""
    x, _, z = motion.root_positions.T
    return PlanarTransform(heading(motion.rotations[:, 0]), x, z)


def _without(travel: PlanarTransform | None, motion: Motion) -> Motion:
    """Return a motion relative to its travel, or as it is without one."""
    if travel is None:
        return motion
    root_positions, local = travel.inverse().apply_frames(motion.root_positions, motion.rotations)
    return replace(motion, root_positions=root_positions, rotations=local)


def _skin(skeleton: Skeleton, axes: Array, root: bool, block: Block) -> Record:
    """Build the skin: for each joint the inverse of its world matrix at rest, [A | p]⁻¹ = [A⁻¹ | -A⁻¹ p]."""
    nodes = list(range(len(skeleton)))
    rest = skeleton.rest + _floor_to_root(skeleton)
    if root:
        nodes.append(_floor_node(skeleton))
        rest = np.vstack([rest, np.zeros(3)])
        axes = np.vstack([axes, rotations.IDENTITY])
    matrices = np.tile(np.eye(4, dtype=np.float32), (len(nodes), 1, 1))  # stored by columns: transposed
    matrices[:, :3, :3] = rotations.to_matrix(axes)
    matrices[:, TRANSLATION, :3] = -rotations.rotate(rotations.inverse(axes), rest)
    accessor = block.add(matrices.reshape(len(nodes), -1))
    return {"inverseBindMatrices": accessor, "joints": nodes, "skeleton": nodes[-1] if root else 0}


def _mesh(skeleton: Skeleton, block: Block) -> Record:
    """Build the surface of the body at rest. Each vertex is influenced by one joint."""
    positions, normals, joints, corners = body(skeleton)
    positions = positions + _floor_to_root(skeleton)
    index_type = np.uint16 if len(positions) < 2**16 - 1 else np.uint32  # the largest index is reserved
    carriers = np.zeros((len(positions), INFLUENCES), np.uint16)
    carriers[:, 0] = joints
    weights = np.zeros((len(positions), INFLUENCES), np.uint8)
    weights[:, 0] = 255  # represents 1
    attributes = {"POSITION": block.add(positions.astype(np.float32), bounds=True, target=VERTICES)}
    attributes["NORMAL"] = block.add(normals.astype(np.float32), target=VERTICES)
    attributes["JOINTS_0"] = block.add(carriers, target=VERTICES)
    attributes["WEIGHTS_0"] = block.add(weights, target=VERTICES)
    indices = block.add(corners.ravel().astype(index_type), target=CORNERS)
    name = _free_name(BODY_NAME, "drawn", skeleton)
    return {"name": name, "primitives": [{"attributes": attributes, "indices": indices, "material": 0}]}


def _animation(
    motion: Motion, axes: Array, rotates: Mask, travel: PlanarTransform | None, block: Block
) -> Record:
    """Build an animation: the translation of the root, and the rotations of joints that rotate in any.

    The travel, if there is one, is that of the joint on the floor.

    A joint without a rotation in one animation would keep that of the animation played before.
    """
    times = (np.arange(len(motion)) / motion.fps).astype(np.float32)
    if np.any(np.diff(times) <= 0):
        name = shortened(motion.name)
        raise MocapError(f"'{name}' at {motion.fps:g} Hz is too fast for a .glb: resample it.")
    clock = block.add(times, bounds=True)
    samplers = [{"input": clock, "output": block.add(motion.root_positions.astype(np.float32))}]
    channels: list[Record] = [{"sampler": 0, "target": {"node": 0, "path": "translation"}}]
    local = _relative_to_bones(motion.skeleton, axes, motion.rotations)
    quaternions = rotations.continuous(local)[..., XYZW]
    limbs = reaches(motion.skeleton)
    for joint in np.flatnonzero(rotates).tolist():
        values: NDArray[Any] = quaternions[:, joint].astype(np.float32)
        if limbs[joint] <= TUNED.carried:
            values = np.round(LARGEST_INT16 * values).astype(np.int16)
        channels.append({"sampler": len(samplers), "target": {"node": joint, "path": "rotation"}})
        samplers.append({"input": clock, "output": block.add(values)})
    if travel is not None:
        positions = travel.apply_points(np.zeros(3)).astype(np.float32)
        headings = rotations.continuous(rotations.about_y(travel.angle))[..., XYZW].astype(np.float32)
        for path, values in {"translation": positions, "rotation": headings}.items():
            target = {"node": _floor_node(motion.skeleton), "path": path}
            channels.append({"sampler": len(samplers), "target": target})
            samplers.append({"input": clock, "output": block.add(values)})
    return {"name": motion.name, "samplers": samplers, "channels": channels}
