"""A warp by scale: a(t) θ(t), about a reference [WP95]."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from mocap._shared.arrays import Array
from mocap.body import rotations
from mocap.body.motion import Motion
from mocap.editing.keys import Key, cardinal, check_keys
from mocap.errors import MocapError

LEAST = np.radians(5.0)  # a joint nearer than this to its reference gives no gain that can be trusted


def gains(motion: Motion, joint: str | int, keys: Sequence[Key], *, about: ArrayLike | None = None) -> Array:
    """Warp by scale: the gain a(t) of one joint that comes nearest to every key's pose [WP95, scale].

    At key i the paper's a_i = θ_i / θ(t_i); of rotation vectors v = log(r⁻¹ q) and v_i the nearest gain is
    a_i = v·v_i / v·v [ours]. A key without a pose has gain 1. Where the joint is near its reference, a tiny θ
    in the denominator would throw it far off everywhere else; such a key is refused.

    Parameters
    ----------
    motion : F frames.
    joint : its name or number.
    keys : one or more, in order of time.
    about : the reference r, a quaternion (4,); the joint's mean rotation over the clip by default.

    Returns
    -------
    Shape (F,), for `scaled`.

    Raises
    ------
    MocapError : as `offsets`, and for a key with a pose where the joint is within 5° of the reference.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> walk = sample("walk_straight")[:200]
    >>> gains(walk, "lhumerus", [Key(0), Key(60, walk[60:61])])[[0, 30, 199]].round(6)
    array([1., 1., 1.])
    """
    check_keys(motion, keys)
    number, reference = _joint(motion, joint), _reference(motion, joint, about)
    asked = []
    for key in keys:
        now = _from(reference, motion.rotations[key.frame, number])
        wish = now if key.pose is None else _from(reference, key.pose.rotations[0, number])
        size = np.linalg.norm(now)
        if key.pose is not None and size < LEAST:
            raise MocapError(
                f"Frame {key.frame}: '{motion.skeleton.names[number]}' is {np.degrees(size):.1f}° from its "
                f"reference, so this key would scale it by {_ratio(wish, now):.3g}: give an offset instead."
            )
        asked.append(1.0 if key.pose is None else _ratio(wish, now))
    flat = [place for place, key in enumerate(keys) if key.flat]
    return cardinal([key.frame for key in keys], asked, np.arange(len(motion)), flat=flat)


def scaled(motion: Motion, joint: str | int, gain: ArrayLike, *, about: ArrayLike | None = None) -> Motion:
    """Scale how far a joint turns from a reference: q' = r exp(a log(r⁻¹ q)) [WP95, scale].

    The paper scales an angle about its zero, which a file puts anywhere; here it is a rotation vector about a
    reference [ours]. Noise is scaled as well.

    Parameters
    ----------
    motion : F frames.
    joint : its name or number.
    gain : a, a number or shape (F,).
    about : the reference r, a quaternion (4,); the joint's mean rotation over the clip by default.

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
    number, reference = _joint(motion, joint), _reference(motion, joint, about)
    amount = _amount(motion, gain)
    away = _from(reference, motion.rotations[:, number])
    angles = np.abs(amount) * np.linalg.norm(away, axis=-1)
    if angles.max() > np.pi:
        frame = int(angles.argmax())
        raise MocapError(
            f"Frame {frame}: a gain of {amount[frame]:.3g} turns '{motion.skeleton.names[number]}' by "
            f"{np.degrees(angles[frame]):.0f}° from its reference, beyond half a turn."
        )
    turned = motion.rotations.copy()
    turn = rotations.from_rotvec((amount - 1)[:, None] * away)  # r exp(a v) = q exp((a - 1) v)
    turned[:, number] = rotations.multiply(turned[:, number], turn)
    return replace(motion, rotations=turned)


def scaled_height(motion: Motion, gain: ArrayLike, *, about: float | None = None) -> Motion:
    """Scale the root's height about one height: y' = r + a (y - r), in metres [WP95].

    Parameters
    ----------
    motion : F frames.
    gain : a, a number or shape (F,).
    about : r, metres; the clip's mean height by default.

    Raises
    ------
    MocapError : for numbers that are not finite.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> walk = sample("walk_straight")
    >>> flat = scaled_height(walk, 0.0, about=0.9)
    >>> float(abs(flat.root_positions[:, 1] - 0.9).max())
    0.0
    """
    heights = motion.root_positions[:, 1]
    middle = float(heights.mean() if about is None else about)
    if not np.isfinite(middle):
        raise MocapError(f"A height to scale about is a finite number, got {middle}.")
    roots = motion.root_positions.copy()
    roots[:, 1] = middle + _amount(motion, gain) * (heights - middle)
    return replace(motion, root_positions=roots)


def _joint(motion: Motion, joint: str | int) -> int:
    number = motion.skeleton.index(joint) if isinstance(joint, str) else joint
    if not 0 <= number < len(motion.skeleton):
        raise MocapError(f"'{motion.name}' has {len(motion.skeleton)} joints, so none has number {joint}.")
    return number


def _reference(motion: Motion, joint: str | int, about: ArrayLike | None) -> Array:
    """Give the reference of length 1, or the joint's mean rotation over the clip."""
    if about is None:
        return rotations.mean(motion.rotations[:, _joint(motion, joint)])
    given = np.asarray(about, float)
    if given.shape != (4,) or not abs(np.linalg.norm(given) - 1) < 1e-6:
        raise MocapError(f"A reference is a quaternion of length 1, got {given.ravel()[:6].tolist()}.")
    return given


def _from(reference: Array, turns: Array) -> Array:
    return rotations.to_rotvec(rotations.multiply(rotations.inverse(reference), turns))


def _ratio(wish: Array, now: Array) -> float:
    return float(wish @ now) / max(float(now @ now), 1e-300)


def _amount(motion: Motion, gain: ArrayLike) -> Array:
    """Give a gain for every frame."""
    given = np.asarray(gain, float)
    if given.shape not in ((), (len(motion),)) or not np.isfinite(given).all():
        raise MocapError(f"A gain is one finite number, or {len(motion)}, got shape {given.shape}.")
    return np.broadcast_to(given, (len(motion),))
