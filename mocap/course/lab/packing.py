"""Clips as small blocks of bytes, which `inspector_maths.js` reads.

A clip is sent as its root's places and its joints' rotations, so that the page can blend them. All numbers
are multiples of 5e-6 (metres, or parts of a quaternion), as second differences over time: these are small.
Their bytes go in four planes, the lowest bytes first; the upper planes are almost empty, and compress well.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from mocap._shared.arrays import Mask
from mocap.body import rotations
from mocap.body.limbs import find_legs
from mocap.body.motion import Motion
from mocap.body.skeleton import Skeleton
from mocap.errors import MocapError
from mocap.matching.point_clouds import distinct_joints
from mocap.widgets.packing import SIDES, drawn, packed, with_contacts

STEP = 5e-6  # what a unit of a number means: a clip at 120 Hz needs it so fine, or its jolts would tremble


def packed_clip(motion: Motion, offset: int, needed: Mask) -> tuple[dict[str, Any], bytes]:
    """Pack a clip.

    Parameters
    ----------
    motion : F frames.
    offset : where its bytes will start.
    needed : shape (F,), the frames that count; the others repeat the last one that does, and take no room.

    Returns
    -------
    What the numbers mean, and the numbers: 3 + 4 J of each frame, 4 bytes each.

    Examples
    --------
    >>> from mocap.datasets.samples import sample
    >>> about, block = packed_clip(sample("walk_straight")[:60], 0, np.ones(60, bool))
    >>> about["frames"], about["channels"], len(block) == 4 * 60 * about["channels"]
    (60, 155, True)
    """
    origin = motion.root_positions[0, [0, 2]]
    places = motion.root_positions - [origin[0], 0, origin[1]]
    turns = rotations.continuous(motion.rotations).reshape(len(motion), -1)
    numbers = np.concatenate([places, turns], axis=1)
    kept = numbers[np.maximum.accumulate(np.where(needed, np.arange(len(needed)), 0))]
    planes = np.frombuffer(packed(kept, 0.0, STEP, "<i4"), np.uint8).reshape(-1, 4).T
    about = {
        "name": motion.name,
        "frames": len(motion),
        "channels": numbers.shape[1],
        "origin": origin.tolist(),
        "offset": offset,
        "plants": plants(motion),
    }
    return about, planes.tobytes()


def plants(motion: Motion) -> str:
    """Write which feet stand, a digit per frame: 2 the left, 4 the right, 6 both, 0 none.

    Feet that are not marked are marked by `feet.mark_plants`; a body without legs has none.

    Examples
    --------
    >>> from mocap.datasets.samples import sample
    >>> sorted(set(plants(sample("walk_straight"))))
    ['0', '2', '4']
    """
    motion = with_contacts(motion)
    standing = np.zeros((len(SIDES), len(motion)), bool)
    for name, marks in motion.contacts.items():
        standing[SIDES.index(motion.skeleton.side(motion.skeleton.index(name)))] |= marks
    return "".join(map(str, 2 * standing[1] + 4 * standing[2]))


def packed_skeleton(skeleton: Skeleton) -> dict[str, Any]:
    """List what draws and measures a body: parents, offsets, points, bones, head and balls of the feet.

    Examples
    --------
    >>> from mocap.datasets.samples import SKELETON
    >>> body = packed_skeleton(SKELETON)
    >>> [(SKELETON.names[joint], SIDES[side]) for joint, side in body["feet"]]
    [('ltoes', 'left'), ('rtoes', 'right')]
    """
    joints, lines, head = drawn(skeleton)
    try:
        balls = [leg.ball for leg in find_legs(skeleton)]
    except MocapError:
        balls = []
    return {
        "parents": skeleton.parents.tolist(),
        "offsets": skeleton.offsets.tolist(),
        "points": list(map(int, distinct_joints(skeleton))),
        "bones": [[int(joints[a]), int(joints[b]), side] for a, b, side in lines],
        "head": None if head is None else int(joints[head]),
        "feet": [[int(ball), SIDES.index(skeleton.side(ball))] for ball in balls],
    }
