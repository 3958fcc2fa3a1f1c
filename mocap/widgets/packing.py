"""Bodies and motions as numbers for the browser: all scripts of the package read what is packed here.

A motion's numbers are whole multiples of a step. They are sent channel by channel as second differences over
time, which are small and compress well; `numbersOf` in `player_scene.js` sums them up again.
"""

from typing import Any

import numpy as np

from mocap._shared.arrays import Array, Indices
from mocap.body import Motion, Skeleton, joint_positions
from mocap.errors import MocapError
from mocap.feet.footplants import mark_plants
from mocap.plotting.bodies import bones, head_joints
from mocap.plotting.style import ASTRAY, COLOURS, MARK
from mocap.widgets.walk_figure import posed

SIDES = ("middle", "left", "right")  # the scripts know a side by its number
LOOK = {"sides": [COLOURS[side] for side in SIDES], "marks": {"seam": MARK, "astray": ASTRAY}}
SCREEN = 60.0  # frames per second that a screen shows; of a faster clip, frames are left out


def packed_body(skeleton: Skeleton) -> tuple[Indices, dict[str, Any]]:
    """Choose the joints of a body that are drawn, and pack what is drawn around them.

    Returns
    -------
    The joints at which bones end, and the root, in order; and what counts these joints: `bones` in rows
    (from, to, number of the side), the `head` or None, and the `parts` and `pieces` of `posed`.

    Examples
    --------
    >>> from mocap.datasets.samples import SKELETON
    >>> joints, body = packed_body(SKELETON)
    >>> len(joints), body["joints"], body["bones"][0]
    (38, 38, [1, 2, 1])
    """
    starts, ends, sides = bones(skeleton)
    joints = np.unique([0, *starts, *ends])
    pairs = np.searchsorted(joints, [starts, ends]).T.tolist()
    heads = np.searchsorted(joints, [joint for joint in head_joints(skeleton) if joint in joints]).tolist()
    lines = [[*pair, SIDES.index(side)] for pair, side in zip(pairs, sides, strict=True)]
    body = {"joints": len(joints), "bones": lines, "head": heads[-1] if heads else None}
    return joints, body | posed(skeleton, joints)


def packed(values: Array, low: Array | float, step: Array | float, kind: str) -> bytes:
    """Pack numbers over time, shape (F, ...), as whole multiples of a step above the lowest.

    Parameters
    ----------
    values : shape (F, ...); each place of the rest is a channel.
    low, step : that a number counts from, and its unit; alike for all, or as the last axis asks.
    kind : "<u2" for numbers up to 65535, whose differences wrap around, or "<i4".

    Examples
    --------
    >>> np.frombuffer(packed(np.array([[0.0], [0.1], [0.3]]), 0.0, 0.1, "<i4"), "<i4").tolist()
    [0, 1, 1]
    """
    numbers = np.round((values - low) / step).astype(kind)
    changes = np.diff(numbers, 2, axis=0, prepend=np.zeros_like(numbers, shape=(2, *numbers.shape[1:])))
    return np.moveaxis(changes, 0, -1).tobytes()


def packed_character(
    motion: Motion, colour: str, step: float | None = None, places: Array | None = None
) -> tuple[dict[str, Any], bytes]:
    """Pack where the drawn joints of a motion are, for `Character` in `player_scene.js`.

    Parameters
    ----------
    motion : the motion; of more than 60 frames per second, some are left out.
    colour : of the body and its path.
    step : metres; by default as fine as 16 bits can tell.
    places : of all joints, shape (F, J, 3), metres; by default those of `joint_positions`.

    Returns
    -------
    What the numbers mean, and the numbers.

    Examples
    --------
    >>> from mocap.datasets.samples import sample
    >>> character, data = packed_character(sample("walk_straight"), "#000000")
    >>> character["fps"], character["frames"], len(data) == 2 * 3 * character["joints"] * character["frames"]
    (60.0, 601, True)
    """
    joints, body = packed_body(motion.skeleton)
    stride = max(1, int(motion.fps / SCREEN))
    points = (joint_positions(motion) if places is None else places)[::stride, joints]  # (F, J, 3)
    low, high = points.min(axis=(0, 1)), points.max(axis=(0, 1))
    steps = np.full(3, step) if step else np.maximum(high - low, 1e-6) / 65535
    about = {
        **{"name": motion.name, "fps": motion.fps / stride, "frames": len(points), **body},
        **{"low": low.tolist(), "step": steps.tolist()},
        **{"colour": colour, "path_colour": colour, "sources": [], "seams": [], "astray": [], "prints": []},
    }
    return about, packed(points, low, steps, "<u2")


def with_contacts(motion: Motion) -> Motion:
    """Mark the footplants of a captured clip, which has no contacts; a body without legs has none."""
    if motion.contacts:
        return motion
    try:
        return mark_plants(motion)
    except MocapError:
        return motion
