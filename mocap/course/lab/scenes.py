"""All that a page needs to show the inspector: clips, maps to point at, colours.

A clip is sent as its root's places and its joints' rotations, so that the page can blend them. All numbers
are multiples of 5e-6 (metres, or parts of a quaternion), as second differences over time: these are small.
Their bytes go in four planes, the lowest bytes first; the upper planes are almost empty, and compress well.
"""

from __future__ import annotations

import zlib
from collections.abc import Sequence
from typing import Any

import numpy as np

from mocap._shared.arrays import Array, Mask
from mocap.body import rotations
from mocap.body.limbs import find_legs
from mocap.body.motion import Motion
from mocap.body.skeleton import Skeleton
from mocap.course.lab.choices import CELLS, Choices, around
from mocap.errors import MocapError
from mocap.matching.point_clouds import distinct_joints
from mocap.plotting.style import ASKED, COLOURS, CURVES, MARK, PATH, QUIET, SOURCES
from mocap.widgets.packing import SIDES, drawn, packed, with_contacts

STEP = 5e-6  # what a unit of a number means: a clip at 120 Hz needs it so fine, or its jolts would tremble
KEY = "Solid lines: the first clip. Dashed: the second. Blue is left, orange-red is right."
WIDEST = 600  # rows and columns of a grid's picture; of more, blocks of cells become one
LOOK = {
    **{"sides": [COLOURS[side] for side in ("middle", "left", "right")], "curves": list(CURVES)},
    **{"sources": list(SOURCES), "seam": MARK, "path": PATH, "asked": ASKED, "quiet": QUIET},
}


def scene(choices: Choices, show: Sequence[str], track: Array, asked: Array, alt: str) -> dict[str, Any]:
    """Give what the scripts draw; `data` holds the clips' numbers and the grid's shades, compressed.

    Parameters
    ----------
    choices : what can be looked at.
    show : the tabs, in the order in which the course meets them.
    track, asked : of a walk, the root's path and the path asked for, shape (N, 2), points (x, z) in metres.
    alt : a sentence.
    """
    clips, data, abouts = choices.clips, b"", []
    for number, clip in enumerate(clips):
        about, block = packed_clip(clip, len(data), choices.needed(number))
        abouts.append(about)
        data += block
    grid, shades = _shades(choices, len(data))
    seams = [
        {"pick": list(map(int, s[:4])), "before": s.before, "after": s.after, "frame": s.frame}
        for s in choices.seams
    ]
    walk = {"path": track.round(3).tolist(), "asked": asked.round(3).tolist(), "seams": seams}
    return {
        **{"alt": alt, "fps": clips[0].fps, "window": choices.window, "around": around(clips[0].fps)},
        **{"cells": CELLS, "tabs": list(show), "tab": show[-1] if show[-1] != "seam" else show[0]},
        **{"skeleton": packed_skeleton(clips[0].skeleton), "clips": abouts, "colours": LOOK},
        "pick": {name: int(value) for name, value in choices.pick._asdict().items()},
        **{"grid": grid, "graph": _graph(choices), "walk": walk if seams else None},
        "key": KEY + f" The grid by {choices.by}." * bool(choices.by),
        "data": zlib.compress(data + shades, 9),
    }


def _shades(choices: Choices, offset: int) -> tuple[dict[str, Any] | None, bytes]:
    """Turn a grid into shades from 0, the lowest distance, to 255; a block of cells has its lowest shade."""
    if choices.grid is None:
        return None, b""
    distances = np.sqrt(choices.grid)
    every = -(-max(distances.shape) // WIDEST)
    rows, columns = (-(-count // every) for count in distances.shape)
    rest = [(0, -count % every) for count in distances.shape]
    least = np.pad(distances, rest, "edge").reshape(rows, every, columns, every).min(axis=(1, 3))
    shades = np.round(255 * (least - least.min()) / max(float(np.ptp(least)), 1e-9)).astype(np.uint8)
    about = {"rows": rows, "columns": columns, "every": every, "offset": offset, "minima": choices.minima}
    return about, shades.tobytes()


def _graph(choices: Choices) -> dict[str, Any] | None:
    """List a graph's transitions, and the stretches of its clips that it plays."""
    if choices.graph is None:
        return None
    spans: list[list[int]] = []
    for (clip, start), (_, end), kind in sorted(choices.graph.graph.edges(data="kind")):
        if kind == "clip" and spans and spans[-1][::2] == [clip, start]:
            spans[-1][2] = int(end)
        elif kind == "clip":
            spans.append([int(clip), int(start), int(end)])
    offered = zip(choices.transitions, choices.costs, strict=True)
    return {"transitions": [[*map(int, p[:4]), round(100 * cost, 2)] for p, cost in offered], "spans": spans}


def packed_clip(motion: Motion, offset: int, needed: Mask) -> tuple[dict[str, Any], bytes]:
    """Pack a clip.

    Parameters
    ----------
    motion : F frames.
    offset : where its bytes will start.
    needed : shape (F,), the frames that count; the others repeat the last one that does, and take no room.

    Returns
    -------
    What the numbers mean, and the numbers: 3 + 4 J of each frame, 4 bytes each. Of `plants`, a digit per
    frame says which feet stand: 2 the left, 4 the right, 6 both, 0 none.

    Examples
    --------
    >>> from mocap.datasets.samples import sample
    >>> about, block = packed_clip(sample("walk_straight")[:60], 0, np.ones(60, bool))
    >>> about["frames"], about["channels"], len(block) == 4 * 60 * about["channels"], about["plants"][:3]
    (60, 155, True, '444')
    """
    origin = motion.root_positions[0] * [1, 0, 1]
    turns = rotations.continuous(motion.rotations).reshape(len(motion), -1)
    numbers = np.concatenate([motion.root_positions - origin, turns], axis=1)
    kept = numbers[np.maximum.accumulate(np.where(needed, np.arange(len(needed)), 0))]
    planes = np.frombuffer(packed(kept, 0.0, STEP, "<i4"), np.uint8).reshape(-1, 4).T
    standing = np.zeros((len(SIDES), len(motion)), int)
    for name, marks in with_contacts(motion).contacts.items():
        standing[SIDES.index(motion.skeleton.side(motion.skeleton.index(name)))] |= marks
    about = {
        **{"name": motion.name, "frames": len(motion), "channels": numbers.shape[1], "offset": offset},
        **{"origin": origin[[0, 2]].tolist(), "plants": "".join(map(str, 2 * standing[1] + 4 * standing[2]))},
    }
    return about, planes.tobytes()


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
