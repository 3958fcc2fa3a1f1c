"""The ends of a walk brought to two poses: what they lack fades into the walk."""

from __future__ import annotations

import numpy as np

from mocap._shared.arrays import Array
from mocap.body.motion import Motion
from mocap.editing.displacements import Displacement, difference, displaced
from mocap.editing.retiming import at_frames
from mocap.steering.moments import Moment

FADE = 0.5  # seconds over which a difference fades, at most; half of a walk that is shorter than two of it


def meet_poses(
    motion: Motion, start: Moment, end: Moment, *, speed: bool = True
) -> tuple[Motion, Displacement]:
    """Add what the first and the last frame lack to two poses, and let it fade into the walk.

    The differences fade as in `blending.inertialize`: by a quintic that starts with
    the speed by which they change at the pose, and ends at rest. At the end of the walk it runs backwards.

    Parameters
    ----------
    motion : F frames, which starts and ends near to the poses.
    start, end : the poses.
    speed : whether the fades start with the speed of the differences; else they are level.

    Returns
    -------
    The motion, and what was added.
    """
    window = max(1.0, min(FADE * motion.fps, (len(motion) - 1) / 2))
    frames, last = np.arange(len(motion)), len(motion) - 1
    parts = [
        _fading(motion, start, (0, 1, speed), frames / window),
        _fading(motion, end, (last, -1, speed), (last - frames) / window),
    ]
    added = Displacement(*(one + other for one, other in zip(*parts, strict=True)))
    return displaced(motion, added), added


def _fading(motion: Motion, moment: Moment, at: tuple[int, int, bool], u: Array) -> Displacement:
    """Let the difference at a frame fade: x(u) = (1 - u)⁴ (x + (4 x + v T) u), and 0 from u = 1 on.

    `at`: the frame, the way into the motion, 1 or -1, and whether v counts.
    """
    frame, way, speed = at
    here = difference(moment.placed(), motion[frame : frame + 1])
    drift = Displacement(0 * here.root, 0 * here.turns)
    if speed and moment.has(way):
        step = way * motion.fps / moment.motion.fps
        then = difference(moment.placed(way), at_frames(motion, [frame + step]))
        window = 1 / (abs(step) * abs(u[1] - u[0]))  # so many of the moment's frames
        drift = Displacement(*((b - a) * window for a, b in zip(here, then, strict=True)))
    fade, late = (1 - np.minimum(u, 1)) ** 4, np.minimum(u, 1)
    curves = []
    for x, v in zip(here, drift, strict=True):
        shape = (-1, *np.ones(x.ndim - 1, int))
        curves.append(fade.reshape(shape) * (x + (4 * x + v) * late.reshape(shape)))
    return Displacement(*curves)
