"""A motion as a `.glb` file: a node for each joint, a skin, and an animation of rotations [GLTF21].

The nodes stand at rest: no joint is turned, and the lowest is on the ground. The turns of joints that carry
little are stored as shares of 32767 in 16 bits, as glTF allows: that moves no joint by more than 0.1 mm.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from mocap._shared.atomic import replacing
from mocap.body import rotations
from mocap.body.motion import Motion, turning
from mocap.body.skeleton import Skeleton
from mocap.errors import MocapError, shortened
from mocap.files.gltf_binary import Block, to_glb
from mocap.files.gltf_capsules import body, reaches, rest

CARRIED = 0.25  # metres: the turns of a joint that carries less are rounded to 16 bits
VERTICES, CORNERS = 34962, 34963
CLAY = {"baseColorFactor": [0.45, 0.55, 0.65, 1.0], "metallicFactor": 0.0, "roughnessFactor": 0.8}


def write(motion: Motion, path: str | Path) -> None:
    """Write a `.glb` file; one that exists is replaced when the new one is whole.

    Parameters
    ----------
    motion : F frames. Joints keep their names; labels and contacts are left out.
    path : the file.

    Raises
    ------
    MocapError : for more bytes than the format can count, frames too short for its clock, or a folder that
        cannot be written to.
    """
    data = glb(motion)
    with replacing(path) as beside:
        beside.write_bytes(data)


def glb(motion: Motion) -> bytes:
    """Build the bytes of the file.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> len(glb(sample("walk_straight"))) < 500_000
    True
    """
    skeleton, block = motion.skeleton, Block()
    joints = len(skeleton)
    document = {
        "asset": {"version": "2.0", "generator": "mocap"},
        "scene": 0,
        "scenes": [{"name": motion.name, "nodes": [0, joints]}],
        "nodes": [*_nodes(skeleton), {"name": "body", "mesh": 0, "skin": 0}],
        "skins": [_skin(skeleton, block)],
        "materials": [{"name": "clay", "pbrMetallicRoughness": CLAY}],
        "meshes": [_mesh(skeleton, block)],
        "animations": [_animation(motion, block)],
    }
    return to_glb(document, block)


def _nodes(skeleton: Skeleton) -> list[dict[str, Any]]:
    places = skeleton.offsets.copy()
    places[0] = [0.0, -rest(skeleton)[:, 1].min(), 0.0]
    nodes: list[dict[str, Any]] = []
    for joint, name in enumerate(skeleton.names):
        node: dict[str, Any] = {"name": name, "translation": (places[joint] + 0.0).tolist()}
        nodes.append(node | ({"children": below} if (below := skeleton.children(joint)) else {}))
    return nodes


def _skin(skeleton: Skeleton, block: Block) -> dict[str, Any]:
    """Bind the body where the joints are at rest: each matrix moves a joint back to the origin."""
    matrices = np.tile(np.eye(4, dtype=np.float32), (len(skeleton), 1, 1))
    matrices[:, 3, :3] = -rest(skeleton)  # by columns
    return {
        "inverseBindMatrices": block.add(matrices.reshape(-1, 16)),
        "joints": list(range(len(skeleton))),
        "skeleton": 0,
    }


def _mesh(skeleton: Skeleton, block: Block) -> dict[str, Any]:
    shape = body(skeleton)
    counted = np.uint16 if len(shape.places) < 2**16 - 1 else np.uint32  # the largest number is kept free
    carried = np.zeros((len(shape.places), 4), np.uint16)
    carried[:, 0] = shape.joints
    weights = np.zeros((len(shape.places), 4), np.uint8)
    weights[:, 0] = 255  # the whole of it
    attributes = {
        "POSITION": block.add(shape.places.astype(np.float32), bounds=True, target=VERTICES),
        "NORMAL": block.add(shape.normals.astype(np.float32), target=VERTICES),
        "JOINTS_0": block.add(carried, target=VERTICES),
        "WEIGHTS_0": block.add(weights, target=VERTICES),
    }
    corners = block.add(shape.corners.ravel().astype(counted), target=CORNERS)
    return {"name": "body", "primitives": [{"attributes": attributes, "indices": corners, "material": 0}]}


def _animation(motion: Motion, block: Block) -> dict[str, Any]:
    times = (np.arange(len(motion)) / motion.fps).astype(np.float32)
    if np.any(np.diff(times) <= 0):
        raise MocapError(
            f"'{shortened(motion.name)}' at {motion.fps:g} Hz is too fast for a .glb: resample it."
        )
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
