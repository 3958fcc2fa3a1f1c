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
from mocap.errors import MocapError

HALF_SECOND = 0.5  # either side of a key; the accelerations of captured walks then stay what they were


class Key(NamedTuple):
    """One moment that a warp keeps to.

    Parameters
    ----------
    frame : a number of the motion's frames.
    pose : a motion of one frame, which the warp meets there; None for the pose as it was.
    flat : let the curve run level through this key, as at take-off and landing, between which and the ground
        it must not swing.

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
    at: ArrayLike, values: ArrayLike, frames: ArrayLike, *, tension: float = 0.0, flat: Sequence[int] = ()
) -> Array:
    """Run a cardinal spline through keys: smooth, constant outside [WP95, splines].

    A cubic Hermite spline whose slope at key i is (1 - c)(v_{i+1} - v_{i-1}) / (t_{i+1} - t_{i-1}). Ours: it
    is level at both ends, so that it joins the constants outside smoothly, and at the keys in `flat`.

    Parameters
    ----------
    at : shape (K,), rising: the keys' times.
    values : shape (K, ...): the keys' values.
    frames : shape (N,): where to evaluate, in the unit of `at`.
    tension : c, from 0 to 1; 1 is level at every key.
    flat : numbers of keys, counted from 0, at which the curve is level.

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
    at, values = np.asarray(at, float), np.asarray(values, float)
    if at.ndim != 1 or len(at) != len(values) or not np.isfinite(values).all() or not (np.diff(at) > 0).all():
        raise MocapError(f"Keys need finite values {values.shape} at as many times that rise, got {at[:6]}.")
    if not 0 <= tension <= 1:
        raise MocapError(f"A tension lies between 0 and 1, got {tension}.")
    if len(at) == 1:
        return np.repeat(values, np.size(frames), axis=0)
    slopes = np.zeros_like(values)
    run = (at[2:] - at[:-2]).reshape(-1, *[1] * (values.ndim - 1))
    slopes[1:-1] = (1 - tension) * (values[2:] - values[:-2]) / run
    slopes[list(flat)] = 0
    frames = np.asarray(frames, float)
    curve = CubicHermiteSpline(at, values, slopes)(frames)
    curve[frames <= at[0]], curve[frames >= at[-1]] = values[0], values[-1]  # to the last bit
    return np.asarray(curve)


def keys_around(motion: Motion, keys: Sequence[Key], seconds: float = HALF_SECOND) -> list[Key]:
    """Add two keys to some, which say "as it was", some time before the first and after the last of them.

    Parameters
    ----------
    motion : F frames.
    keys : one or more, in order of time.
    seconds : how long before the first key the change begins, and how long after the last one it ends. Where
        the clip begins or ends sooner, that key is left out, and the change holds to the clip's end; and
        where that of `keys` says "as it was" already.

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
    before, after = (
        [Key(key.frame + way)] if key.pose is not None and 0 <= key.frame + way < len(motion) else []
        for key, way in ((keys[0], -half), (keys[-1], half))
    )
    return [*before, *keys, *after]


def offsets(motion: Motion, keys: Sequence[Key]) -> Displacement:
    """Warp by offsets: the displacement that meets every key's pose, and is smooth between them [WP95].

    In the paper: [WP95, offset].

    At key i, b_i = pose ⊖ motion: the root's gap, and log(q⁻¹ q_i) for each joint. The curves through the b_i
    are `cardinal`; outside the keys they are constant. `displaced(motion, offsets(motion, keys))` is the
    warped motion. Feet that stand slide a little between the keys; `feet.clean_up` puts them back.

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
    now = [motion[frame : frame + 1] for frame in frames]
    changes = [difference(key.pose or pose, pose) for key, pose in zip(keys, now, strict=True)]
    flat = [number for number, key in enumerate(keys) if key.flat]
    values = (np.concatenate(part) for part in zip(*changes, strict=True))
    return Displacement(*(cardinal(frames, part, np.arange(len(motion)), flat=flat) for part in values))


def check_keys(motion: Motion, keys: Sequence[Key]) -> None:
    """Raise unless the keys lie on the clip, in order, with poses of one frame and of its skeleton.

    Notebook: 11-warping
    """
    frames = [key.frame for key in keys]
    if not keys or any(not isinstance(frame, int | np.integer) for frame in frames):
        raise MocapError(f"A warp needs one key or more, at numbers of frames, got {frames[:6]}.")
    if not all(before < after for before, after in pairwise([-1, *frames, len(motion)])):
        clip = f"frames of '{motion.name}', 0 to {len(motion) - 1}"
        raise MocapError(f"Keys stand in order of time, once each, at {clip}; got {frames[:6]}.")
    for pose in (key.pose for key in keys if key.pose is not None):
        motion.skeleton.require_same(pose.skeleton)
        if len(pose) != 1:
            raise MocapError(f"The pose of a key needs one frame, got {len(pose)}.")


def scaled(motion: Motion, joint: str | int, gain: ArrayLike) -> Motion:
    """Scale how far a joint turns from a reference: q' = r exp(a log(r⁻¹ q)) [WP95, scale].

    The paper scales an angle about its zero, which a file puts anywhere; here it is a rotation vector about
    the joint's mean rotation over the clip, r [ours]. Noise is scaled as well.

    Parameters
    ----------
    motion : F frames.
    joint : its name or number.
    gain : a, a number or shape (F,).

    Raises
    ------
    MocapError : for a gain that turns the joint beyond half a turn, or is not finite.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> walk = sample("walk_straight")[:200]
    >>> bool(abs(scaled(walk, "lhumerus", 1.0).rotations - walk.rotations).max() < 1e-12)
    True

    Notebook: 11-warping
    """
    number = motion.skeleton.index(joint) if isinstance(joint, str) else joint
    turns, amount = motion.rotations[:, number], np.asarray(gain, float)
    if amount.shape not in ((), (len(motion),)) or not np.isfinite(amount).all():
        raise MocapError(f"A gain is one finite number, or {len(motion)}, got shape {amount.shape}.")
    away = rotations.difference(rotations.mean(turns), turns)
    angles = np.abs(amount) * np.linalg.norm(away, axis=-1)
    if angles.max() > np.pi:
        name, far = motion.skeleton.names[number], f"{np.degrees(angles.max()):.0f}° from its reference"
        raise MocapError(f"Frame {angles.argmax()}: such a gain turns '{name}' by {far}, beyond half a turn.")
    turned = motion.rotations.copy()
    turn = rotations.from_rotvec((amount - 1).reshape(-1, 1) * away)  # r exp(a v) = q exp((a - 1) v)
    turned[:, number] = rotations.multiply(turned[:, number], turn)
    return replace(motion, rotations=turned)
