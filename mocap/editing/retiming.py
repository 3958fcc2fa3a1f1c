"""Time warps: the time at which each moment of a motion happens, t = g(t') [WP95].

The paper takes a cardinal spline through the time keys. Between keys at uneven distances such a curve
overshoots, and the motion runs backwards for a while. Here g is PCHIP [ours], the piecewise cubic of F. N.
Fritsch and R. E. Carlson (1980), which rises wherever its keys rise.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike
from scipy.interpolate import PchipInterpolator

from mocap._shared.arrays import Array, Indices
from mocap.body import rotations
from mocap.body.motion import Motion
from mocap.errors import MocapError

MAX_FRAMES = 1_000_000  # frames of a retimed clip; more come from a mistake in a key
TOLERANCE = 1e-6  # frames, for seconds that were rounded


def retime(motion: Motion, keys: Sequence[tuple[float, float]]) -> Motion:
    """Warp the time of a motion, by PCHIP through time keys [WP95, time warp].

    Parameters
    ----------
    motion : F frames.
    keys : two or more pairs (new second, old second); both rise, and the old ones are in the clip.

    Returns
    -------
    A motion at the same rate, from the first key to the last one. Standing feet may slide by a fraction of a
    millimetre between old frames; `feet.clean_up` removes that.

    Raises
    ------
    MocapError : for fewer than two keys, seconds that do not rise, and old seconds outside the clip.

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
    new, old = _time_keys(keys).T
    tolerance = TOLERANCE / motion.fps
    if old[0] < -tolerance or old[-1] > motion.duration + tolerance:
        outside = old[0] if old[0] < 0 else old[-1]
        raise MocapError(f"Second {outside:g} is not on '{motion.name}', which lasts {motion.duration:g} s.")
    count = np.floor((new[-1] - new[0]) * motion.fps + TOLERANCE) + 1
    if count > MAX_FRAMES:
        raise MocapError(f"These time keys ask for {count:.3g} frames; at most {MAX_FRAMES} are made.")
    times = new[0] + np.arange(int(count)) / motion.fps
    return at_frames(motion, PchipInterpolator(new, old)(times) * motion.fps)


def _time_keys(keys: Sequence[tuple[float, float]]) -> Array:
    """Return time keys as an array (K, 2); raise unless there are two or more, and both columns rise."""
    pairs = np.asarray(keys, float)
    are_pairs = pairs.shape[1:] == (2,) and len(pairs) >= 2
    if not are_pairs or not (np.diff(pairs, axis=0) > 0).all():
        raise MocapError(f"A retiming needs two or more pairs (new, old second) that rise, got {keys[:6]}.")
    return pairs


def at_frames(motion: Motion, frames: ArrayLike) -> Motion:
    """Interpolate a motion at moments between its frames, by cubic Hermite curves.

    Between frames i and i + 1 the root, and each joint's rotation vector log(q_i⁻¹ q), follow a cubic Hermite
    curve whose derivatives are the central differences at both frames (one-sided at the clip's ends) [ours].
    With linear interpolation and slerp, as in `Motion.at`, the speed jumps at each old frame, which is
    visible in slow motion.

    Parameters
    ----------
    motion : F frames.
    frames : shape (N,), from 0 to F - 1; the first or the last frame is taken for those outside.

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
    steps = (-1, 0, 1, 2)
    neighbours = [np.clip(start + step, 0, last) for step in steps]
    weights = _hermite_weights(moments - start, neighbours)
    base = motion.rotations[start]
    root_positions = np.zeros((len(moments), 3))
    vectors = np.zeros((*base.shape[:2], 3))
    for step, weight, frame in zip(steps, weights, neighbours, strict=True):
        root_positions += weight[:, None] * motion.root_positions[frame]
        if step != 0:  # the rotation from a frame to itself is 0
            vectors += weight[:, None, None] * rotations.difference(base, motion.rotations[frame])
    interpolated = rotations.multiply(base, rotations.from_rotvec(vectors))
    nearest = motion[np.round(moments).astype(int)]
    return replace(nearest, root_positions=root_positions, rotations=interpolated)


def _hermite_weights(fraction: Array, neighbours: Sequence[Indices]) -> tuple[Array, ...]:
    """Return the weights of frames i - 1 to i + 2 for a cubic Hermite curve from frame i to i + 1.

    Parameters
    ----------
    fraction : shape (N,), the position between frames i and i + 1, from 0 to 1.
    neighbours : the indices of the four frames, (N,) each, clipped to those of the clip.

    Examples
    --------
    >>> halfway = _hermite_weights(np.array([0.5]), [np.array([frame]) for frame in (3, 4, 5, 6)])
    >>> [float(weight[0]) for weight in halfway]
    [-0.0625, 0.5625, 0.5625, -0.0625]
    """
    previous, start, end, following = neighbours
    start_span = np.maximum(end - previous, 1)  # frames: two, and one at an end of the clip
    end_span = np.maximum(following - start, 1)
    start_slope = (fraction**3 - 2 * fraction**2 + fraction) / start_span
    end_slope = (fraction**3 - fraction**2) / end_span
    end_value = 3 * fraction**2 - 2 * fraction**3
    return -start_slope, 1 - end_value - end_slope, end_value + start_slope, end_slope
