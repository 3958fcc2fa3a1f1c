"""A cycle closed by a warp: its last pose becomes its first one [WP95].

The pose at the end of a stride is nearly that at its beginning. The gap between them, one laid on the other
over the ground, is offset along a ramp over the whole cycle, so that no frame shows it.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from mocap.body.motion import Motion, concatenate
from mocap.body.planar import lay_on
from mocap.editing.displacements import Displacement, difference, displaced
from mocap.errors import MocapError


def looped(motion: Motion, first: int, last: int) -> Motion:
    """Cut out a cycle and close it: its last frame is its first one, farther on over the ground [WP95].

    The first pose is laid on the last one by heading and place. What is left between them, d = first ⊖ last,
    is added along a ramp u = 0 … 1. Ours: the ramp is straight. So speeds change by d / duration in the whole
    cycle; a ramp that eases in and out changes them more on the way.

    Parameters
    ----------
    motion : F frames.
    first, last : the two frames that look alike, a stride apart, for example.

    Returns
    -------
    last - first + 1 frames; `repeated` lays one behind the other. Feet that stand slide by as much as the gap
    asks for; `feet.clean_up` puts them back.

    Raises
    ------
    MocapError : for frames that are not on the clip, or not in this order.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> looped(sample("walk_straight"), 240, 377)
    Motion('walk_straight', 138 frames at 120 Hz, 38 joints)

    Notebook: 11-warping
    """
    if not 0 <= first < last < len(motion):
        raise MocapError(
            f"A cycle runs from a frame to a later one of '{motion.name}', which has {len(motion)}; "
            f"got {first} and {last}."
        )
    cycle = motion[first : last + 1]
    end = lay_on(cycle, cycle, len(cycle) - 1).apply_motion(cycle[:1])
    gap = difference(end, cycle[-1:])
    ramp = np.linspace(0, 1, len(cycle))
    warped = displaced(cycle, Displacement(ramp[:, None] * gap.root, ramp[:, None, None] * gap.turns))
    marks = {joint: np.append(mark[:-1], mark[0]) for joint, mark in warped.contacts.items()}
    return replace(warped, contacts=marks)


def repeated(cycle: Motion, times: int) -> Motion:
    """Lay a cycle behind itself, so many times.

    Parameters
    ----------
    cycle : its last frame is its first one, farther on, as `looped` makes it; that frame is counted once.
    times : 1 or more.

    Raises
    ------
    MocapError : for another number of times, and a cycle of a single frame.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> stride = looped(sample("walk_straight"), 240, 377)
    >>> len(repeated(stride, 3)) == 3 * (len(stride) - 1) + 1
    True

    Notebook: 11-warping
    """
    if times < 1 or len(cycle) < 2:
        raise MocapError(f"A cycle of {len(cycle)} frames cannot be repeated {times} times.")
    copies = [cycle]
    for _ in range(times - 1):
        last = copies[-1]
        copies.append(lay_on(cycle, last, len(last) - 1).apply_motion(cycle))
    return concatenate([*(copy[:-1] for copy in copies), copies[-1][-1:]])
