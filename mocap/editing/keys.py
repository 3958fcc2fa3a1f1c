"""Keys, the curve through them, and warps by offsets, θ(t) + b(t), and by scale, a(t) θ(t) [WP95]."""

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike
from scipy.interpolate import CubicHermiteSpline

from mocap._shared.arrays import Array
from mocap._shared.records import NamedTuple
from mocap.body import rotations
from mocap.body.motion import Motion
from mocap.editing.displacements import Displacement, difference
from mocap.editing.tuned import TUNED
from mocap.errors import MocapError


class Key(NamedTuple):
    """A frame at which a warp has a given pose.

    Parameters
    ----------
    frame : the index of a frame of the motion.
    pose : a motion of one frame, which the warp meets there; None for the pose of the motion.
    flat : whether the derivative of the curve is 0 at this key, as at take-off and landing, where the curve
        must not overshoot towards the ground.

    Examples
    --------
    >>> Key(40), Key(60, flat=True).flat
    (Key(frame=40, pose=None, flat=False), True)

    Notebook: 11-warping
    """

    frame: int
    pose: Motion | None = None
    flat: bool = False


def cardinal(
    times: ArrayLike, values: ArrayLike, frames: ArrayLike, *, tension: float = 0.0, flat: Sequence[int] = ()
) -> Array:
    """Evaluate a cardinal spline through keys; it is constant outside them [WP95, splines].

    A cubic Hermite spline whose derivative at key i is (1 - c)(v_{i+1} - v_{i-1}) / (t_{i+1} - t_{i-1}).
    Ours: the derivative is 0 at both ends, for a smooth transition to the constants outside, and at the keys
    in `flat`.

    Parameters
    ----------
    times : shape (K,), rising: the times of the keys.
    values : shape (K, ...): the values of the keys.
    frames : shape (N,): where to evaluate the spline, in the unit of `times`.
    tension : c, from 0 to 1; with 1 the derivative is 0 at every key.
    flat : indices of keys, from 0, at which the derivative is 0.

    Returns
    -------
    Shape (N, ...).

    Raises
    ------
    MocapError : for times that do not rise, numbers that are not finite, and a tension outside [0, 1].

    Examples
    --------
    >>> cardinal([0, 10, 30], [0, 1, -1], [5, 15, 20]).round(6)
    array([ 0.541667,  0.59375 , -0.083333])

    Notebook: 11-warping
    """
    times = np.asarray(times, float)
    values = np.asarray(values, float)
    _require_rising(times, values)
    if not 0 <= tension <= 1:
        raise MocapError(f"A tension lies between 0 and 1, got {tension}.")
    if len(times) == 1:
        return np.repeat(values, np.size(frames), axis=0)
    durations = (times[2:] - times[:-2]).reshape(-1, *[1] * (values.ndim - 1))
    derivatives = np.zeros_like(values)
    derivatives[1:-1] = (1 - tension) * (values[2:] - values[:-2]) / durations
    derivatives[list(flat)] = 0
    frames = np.asarray(frames, float)
    curve = np.asarray(CubicHermiteSpline(times, values, derivatives)(frames))
    # Exactly the values of the first and the last key outside them.
    curve[frames <= times[0]] = values[0]
    curve[frames >= times[-1]] = values[-1]
    return curve


def _require_rising(times: Array, values: Array) -> None:
    """Raise unless there is a finite value for each of the times, which rise."""
    has_times = times.ndim == 1 and len(times) == len(values)
    if not has_times or not np.isfinite(values).all() or not (np.diff(times) > 0).all():
        problem = f"Keys need finite values {values.shape} at as many times that rise"
        raise MocapError(f"{problem}, got {times[:6]}.")


def keys_around(motion: Motion, keys: Sequence[Key], seconds: float = TUNED.key_margin) -> list[Key]:
    """Add keys with the pose of the motion before the first key and after the last one.

    Parameters
    ----------
    motion : F frames.
    keys : one or more, in order of time.
    seconds : the time from the added key to the first one, and from the last one to the added key. No key is
        added outside the clip, where the change holds to the clip's end, nor beside a key without a pose.

    Returns
    -------
    The keys, for `offsets`.

    Raises
    ------
    MocapError : for a time that is shorter than a frame.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> walk = sample("walk_straight")
    >>> [key.frame for key in keys_around(walk, [Key(100, walk[100:101])])]
    [40, 100, 160]
    >>> [key.frame for key in keys_around(walk, [Key(20, walk[20:21])])]  # from the clip's start on
    [20, 80]
    >>> [key.frame for key in keys_around(walk, [Key(60, walk[60:61]), Key(1097, walk[1097:1098])])]
    [0, 60, 1097, 1157]
    >>> [key.frame for key in keys_around(walk, [Key(40), Key(60, walk[60:61])], seconds=1 / 120)]
    [40, 60, 61]

    Notebook: 11-warping
    """
    if not (np.isfinite(seconds) and seconds * motion.fps >= 1):
        raise MocapError(f"A change takes a frame or more to come and go, got {seconds} s.")
    half = round(seconds * motion.fps)
    first = _unchanged(motion, keys[0], -half)
    last = _unchanged(motion, keys[-1], half)
    return [*first, *keys, *last]


def _unchanged(motion: Motion, key: Key, offset: int) -> list[Key]:
    """Return a key without a pose, `offset` frames from a key with one, if that frame is in the clip."""
    frame = key.frame + offset
    is_needed = key.pose is not None and 0 <= frame < len(motion)
    return [Key(frame)] if is_needed else []


def offsets(motion: Motion, keys: Sequence[Key]) -> Displacement:
    """Compute the smooth displacement that meets the poses of all keys: a warp by offsets [WP95].

    In the paper: [WP95, offset].

    At key i, b_i = pose ⊖ motion: the difference of root positions, and log(q⁻¹ q_i) for each joint. The
    curves through the b_i are `cardinal`; outside the keys they are constant. The warped motion is
    `displaced(motion, offsets(motion, keys))`. Standing feet slide a little between the keys; `feet.clean_up`
    removes that.

    Parameters
    ----------
    motion : F frames.
    keys : one or more, in order of time.

    Raises
    ------
    MocapError : for no keys, and for keys off the clip, out of order, or with a pose of several frames.
    SkeletonMismatch : for a pose of another skeleton.

    Examples
    --------
    >>> from dataclasses import replace
    >>> from mocap.datasets import sample
    >>> from mocap.editing import displaced
    >>> walk = sample("walk_straight")[:200]
    >>> higher = replace(walk[100:101], root_positions=walk.root_positions[100:101] + [0, 0.1, 0])
    >>> warped = displaced(walk, offsets(walk, [Key(60), Key(100, higher), Key(140)]))
    >>> (warped.root_positions - walk.root_positions)[[50, 80, 100], 1].round(3) + 0.0
    array([0.  , 0.05, 0.1 ])

    Notebook: 11-warping
    """
    check_keys(motion, keys)
    frames = [key.frame for key in keys]
    poses = [motion[frame : frame + 1] for frame in frames]
    changes = [difference(key.pose or pose, pose) for key, pose in zip(keys, poses, strict=True)]
    flat = [number for number, key in enumerate(keys) if key.flat]
    values = (np.concatenate(part) for part in zip(*changes, strict=True))
    return Displacement(*(cardinal(frames, part, np.arange(len(motion)), flat=flat) for part in values))


def check_keys(motion: Motion, keys: Sequence[Key]) -> None:
    """Raise unless keys are on the clip, in order of time, with poses of one frame and of its skeleton.

    Notebook: 11-warping
    """
    frames = [key.frame for key in keys]
    if not keys or any(not isinstance(frame, int | np.integer) for frame in frames):
        raise MocapError(f"A warp needs one key or more, at numbers of frames, got {frames[:6]}.")
    if not all(first < second for first, second in pairwise([-1, *frames, len(motion)])):
        clip = f"frames of '{motion.name}', 0 to {len(motion) - 1}"
        raise MocapError(f"Keys stand in order of time, once each, at {clip}; got {frames[:6]}.")
    for pose in (key.pose for key in keys if key.pose is not None):
        motion.skeleton.require_same(pose.skeleton)
        if len(pose) != 1:
            raise MocapError(f"The pose of a key needs one frame, got {len(pose)}.")


def scaled(motion: Motion, joint: str | int, gain: ArrayLike) -> Motion:
    """Scale the rotation of a joint relative to its mean: q' = r exp(a log(r⁻¹ q)) [WP95, scale].

    The paper scales an angle relative to its zero, which depends on the file. Here a rotation vector is
    scaled, relative to the joint's mean rotation over the clip, r [ours]. Noise is also scaled.

    Parameters
    ----------
    motion : F frames.
    joint : its name or index.
    gain : a, a number or shape (F,).

    Raises
    ------
    MocapError : for a gain that is not finite, or that rotates the joint by more than 180°.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> walk = sample("walk_straight")[:200]
    >>> bool(abs(scaled(walk, "lhumerus", 1.0).rotations - walk.rotations).max() < 1e-12)
    True

    Notebook: 11-warping
    """
    number = motion.skeleton.index(joint) if isinstance(joint, str) else joint
    local = motion.rotations[:, number]
    factor = np.asarray(gain, float)
    if factor.shape not in ((), (len(motion),)) or not np.isfinite(factor).all():
        raise MocapError(f"A gain is one finite number, or {len(motion)}, got shape {factor.shape}.")
    vectors = rotations.difference(rotations.mean(local), local)
    angles = np.abs(factor) * np.linalg.norm(vectors, axis=-1)
    if angles.max() > np.pi:
        turn = f"'{motion.skeleton.names[number]}' by {np.degrees(angles.max()):.0f}° from its reference"
        raise MocapError(f"Frame {angles.argmax()}: such a gain turns {turn}, beyond half a turn.")
    change = rotations.from_rotvec((factor - 1).reshape(-1, 1) * vectors)  # r exp(a v) = q exp((a - 1) v)
    scaled_rotations = motion.rotations.copy()
    scaled_rotations[:, number] = rotations.multiply(local, change)
    return replace(motion, rotations=scaled_rotations)
