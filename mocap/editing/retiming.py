"""Time warped: when each moment of a motion happens, t = g(t') [WP95].

The paper runs a cardinal spline through the time keys. Where keys lie unevenly such a curve overshoots, and
the motion runs backwards for a while. Here g is PCHIP [ours], the piecewise cubic of F. N. Fritsch and R. E.
Carlson (1980), which rises wherever its keys rise.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike
from scipy.interpolate import PchipInterpolator

from mocap.body import rotations
from mocap.body.motion import Motion
from mocap.errors import MocapError

MOST = 1_000_000  # frames of a retimed clip; more is a slip in a key


def retime(motion: Motion, keys: Sequence[tuple[float, float]]) -> Motion:
    """Let a motion's moments happen at other times, by PCHIP through the time keys [WP95, time warp].

    Parameters
    ----------
    motion : F frames.
    keys : two or more pairs (new second, old second); both rise, and the old ones lie on the clip.

    Returns
    -------
    A motion at the same rate, from the first key's moment to the last one's. Feet that stand may slide by a
    fraction of a millimetre between old frames; `feet.clean_up` puts them back.

    Raises
    ------
    MocapError : for fewer than two keys, seconds that do not rise, and old seconds off the clip.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> walk = sample("walk_straight")[:241]  # 2 s
    >>> retime(walk, [(0, 0), (1, 0.5), (2.5, 2)]).duration
    2.5
    >>> len(retime(walk, [(0, 0), (0.7, 0.5)]))  # 0.7 s are 84 frames, and one more shows the end
    85

    Notebook: 11-warping
    """
    pairs, slack = np.asarray(keys, float), 1e-6 / motion.fps
    if np.shape(pairs)[1:] != (2,) or len(pairs) < 2 or not (np.diff(pairs, axis=0) > 0).all():
        raise MocapError(f"A retiming needs two or more pairs (new, old second) that rise, got {keys[:6]}.")
    new, old = pairs.T
    if old[0] < -slack or old[-1] > motion.duration + slack:
        off = old[0] if old[0] < 0 else old[-1]
        raise MocapError(f"Second {off:g} is not on '{motion.name}', which lasts {motion.duration:g} s.")
    count = np.floor((new[-1] - new[0]) * motion.fps + 1e-6) + 1
    if count > MOST:
        raise MocapError(f"These time keys ask for {count:.3g} frames; at most {MOST} are made.")
    times = new[0] + np.arange(int(count)) / motion.fps
    return at_frames(motion, PchipInterpolator(new, old)(times) * motion.fps)


def at_frames(motion: Motion, frames: ArrayLike) -> Motion:
    """Show a motion at moments between its frames.

    Between frames i and i + 1 the root, and each joint's rotation vector log(q_i⁻¹ q), run along a cubic
    Hermite curve whose slopes are the central differences at both frames (one-sided at the clip's ends)
    [ours]. Straight lines and slerp, as in `Motion.at`, change speed at each old frame, which shows in slow
    motion.

    Parameters
    ----------
    motion : F frames.
    frames : shape (N,), from 0 to F - 1; those outside show the first or the last frame.

    Returns
    -------
    N frames at the motion's rate; labels and contacts come from the nearest frame.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> walk = sample("walk_straight")[:9]
    >>> at_frames(walk, [0, 2.5, 8])
    Motion('walk_straight', 3 frames at 120 Hz, 0.0167 s, 38 joints)
    >>> falls = replace(walk, root_positions=np.arange(9)[:, None] ** 2 * [0, -1, 1])
    >>> at_frames(falls, [-1, 0.5, 2.5, 7.5, 9]).root_positions[:, 2].tolist()
    [0.0, 0.375, 6.25, 56.375, 64.0]
    """
    last = len(motion) - 1
    moments = np.clip(np.asarray(frames, float), 0, last)
    start = np.minimum(moments.astype(int), max(last - 1, 0))
    u, base = moments - start, motion.rotations[start]
    around = [np.clip(start + step, 0, last) for step in (-1, 0, 1, 2)]
    before, here, there, after = around
    first, second = (np.maximum(b - a, 1) for a, b in ((before, there), (here, after)))  # one or two frames
    rise, fall, end = (u**3 - 2 * u**2 + u) / first, (u**3 - u**2) / second, 3 * u**2 - 2 * u**3
    weights = (-rise, 1 - end - fall, end + rise, fall)  # of the four frames, for a cubic Hermite curve
    root, turn = np.zeros((len(u), 3)), np.zeros((*base.shape[:2], 3))
    for weight, frame in zip(weights, around, strict=True):
        root += weight[:, None] * motion.root_positions[frame]
        if frame is not here:  # from a frame to itself nothing turns
            turn += weight[:, None, None] * rotations.difference(base, motion.rotations[frame])
    turned, nearest = rotations.multiply(base, rotations.from_rotvec(turn)), np.round(moments).astype(int)
    return replace(motion[nearest], root_positions=root, rotations=turned)
