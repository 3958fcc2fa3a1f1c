"""A warp by scale: a(t) θ(t), about a reference [WP95]."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from mocap.body import rotations
from mocap.body.motion import Motion
from mocap.errors import MocapError


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
    number = motion.skeleton.index(joint) if isinstance(joint, str) else joint
    if not 0 <= number < len(motion.skeleton):
        raise MocapError(f"'{motion.name}' has {len(motion.skeleton)} joints, so none has number {joint}.")
    turns = motion.rotations[:, number]
    reference = rotations.mean(turns) if about is None else np.asarray(about, float)
    if reference.shape != (4,) or not abs(np.linalg.norm(reference) - 1) < 1e-6:
        raise MocapError(f"A reference is a quaternion of length 1, got {reference.ravel()[:6].tolist()}.")
    amount = np.asarray(gain, float)
    if amount.shape not in ((), (len(motion),)) or not np.isfinite(amount).all():
        raise MocapError(f"A gain is one finite number, or {len(motion)}, got shape {amount.shape}.")
    amount = np.broadcast_to(amount, len(motion))
    away = rotations.to_rotvec(rotations.multiply(rotations.inverse(reference), turns))
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
