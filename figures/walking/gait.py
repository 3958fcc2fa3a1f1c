"""What a body does within one cycle of walking, sneaking or jogging; `walker.toml` holds the figures."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from scipy.interpolate import CubicSpline

from mocap._shared.arrays import Array
from walking.footsteps import Roll, foot_pitch
from walking.walking_body import FIGURES

Row = Sequence[float]


class Gait(NamedTuple):
    """One way to walk: when the feet roll, how the legs bend, how the rest of the body swings.

    The name is the label of its frames; `walker.toml` says what the figures are.
    """

    name: str
    roll: Roll
    knee: Row
    stride: float
    cadence: float
    under: float
    step_width: float
    toe_out: float
    sway: Row
    surge: Row
    height: Row
    height_weight: float
    trunk: Mapping[str, Sequence[Row]]
    arm: Mapping[str, Sequence[Row]]

    @property
    def speed(self) -> float:
        """Metres per second."""
        return self.stride * self.cadence / 120


GAITS = {
    name: Gait(name, **figures | {"roll": Roll(**figures["roll"])})
    for name, figures in FIGURES["gaits"].items()
}
WALK, SNEAK, JOG = GAITS.values()


def mix(figures: Sequence[ArrayLike], weights: Array) -> Array:
    """Mix the figures of several gaits: Σ w f.

    Parameters
    ----------
    figures : for each gait a number, or an array of shape (F,) or (F, 3).
    weights : shape (gaits, F); those of a frame add up to one.

    Returns
    -------
    Shape (F,) or (F, 3).

    Examples
    --------
    >>> mix([WALK.stride, JOG.stride], np.array([[1.0, 0.5], [0.0, 0.5]]))
    array([1.35 , 1.785])
    """
    return np.asarray((np.asarray(figures, float).T * weights.T).sum(axis=-1).T)


def mix_rolls(rolls: Sequence[Roll], weights: Array) -> Roll:
    """Mix the rolls of several gaits; `weights` (gaits,) add up to one."""
    if weights.max() > 1 - 1e-9:  # one gait alone, up to rounding
        return rolls[int(weights.argmax())]
    flat, heel_off, lift = (weights @ [roll[:3] for roll in rolls]).tolist()
    knots = [np.linspace(roll.heel_off, 1 + roll.flat, 20) for roll in rolls]
    pitches = [np.degrees(foot_pitch(roll, knot)) for roll, knot in zip(rolls, knots, strict=True)]
    up, early_up, on, early_on = (weights @ [roll.swing for roll in rolls]).tolist()
    return Roll(flat, heel_off, lift, tuple((weights @ pitches).tolist()), (up, early_up, on, early_on))


def knee_flexion(gait: Gait, phase: ArrayLike) -> Array:
    """Look up how far a standing leg's knee bends, radians, at a phase since its strike."""
    curve = CubicSpline(0.05 * np.arange(len(gait.knee)), np.radians(gait.knee))
    return np.asarray(curve(np.clip(phase, 0, 0.05 * (len(gait.knee) - 1))))


def pelvis_drift(gait: Gait, phase: ArrayLike, amplitude: ArrayLike) -> Array:
    """Sum the harmonics of the pelvis: to its left, up, forwards, shape (F, 3), metres."""
    once, twice = (2 * np.pi * n * np.asarray(phase, float) for n in (1, 2))
    mean, *rise = gait.height
    waves = [_wave(gait.sway, once), _wave(rise, twice), _wave(gait.surge, twice)]
    return np.asarray(amplitude)[..., None] * np.stack(waves, -1) + [0.0, mean, 0.0]


def joint_angles(gait: Gait, phase: ArrayLike, amplitude: ArrayLike) -> dict[str, Array]:
    """Sum the harmonics of the trunk and both arms.

    Parameters
    ----------
    phase : shape (F,), cycles.
    amplitude : shape (F,); 1 for the walk of the tables, 0 for its mean pose.

    Returns
    -------
    {joint: rotation vectors (F, 3), radians}; x bends forwards, y turns to the left, z leans to the right.

    Examples
    --------
    >>> sorted(joint_angles(WALK, [0.0], [1.0]))[:4]
    ['head', 'lfingers', 'lhand', 'lhumerus']
    """
    phase, amplitude = np.asarray(phase, float), np.asarray(amplitude, float)
    once, twice = 2 * np.pi * phase, 4 * np.pi * phase
    angles = {}
    for joint, (nod, turn, lean) in gait.trunk.items():
        waves = [_wave(nod[1:], twice), _wave(turn, once), _wave(lean, once)]
        angles[joint] = np.radians(amplitude[:, None] * np.stack(waves, -1) + [nod[0], 0.0, 0.0])
    for joint, rows in gait.arm.items():
        for side, shift, mirror in (("l", 0.0, [1, 1, 1]), ("r", np.pi, [1, -1, -1])):
            waves = [_wave(row[1:3], once + shift) + _wave(row[3:5], twice) for row in rows]
            means = [row[0] for row in rows]
            angles[side + joint] = np.radians(amplitude[:, None] * np.stack(waves, -1) + means) * mirror
    return angles


def _wave(row: ArrayLike, angle: Array) -> Array:
    cosine, sine = np.asarray(row, float)
    return np.asarray(cosine * np.cos(angle) + sine * np.sin(angle))
