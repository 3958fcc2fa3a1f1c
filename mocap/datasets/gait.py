"""What a body does within one cycle of walking, sneaking or jogging, as tables of figures.

The phase of the cycle counts strides: the left heel strikes at 0, the right one at 1/2. The harmonics are
fitted to average cycles of real people and made symmetric: the right arm does at phase p + 1/2 what the left
arm does at p, mirrored, and a joint in the middle is its own mirror image half a cycle later. So
a middle joint nods (x) twice per stride, but turns (y) and leans (z) once.

Source of the figures: subject 16 of the CMU Graphics Lab Motion Capture Database (mocap.cs.cmu.edu), trials
15, 16, 31, 32, 47, 58 for walking and 35, 45 for jogging. Trunk, arms and pelvis are fits. The elbows swing a
quarter more, because the average over trials damps them. Feet and knees are adjusted to this body by a few
degrees. The database has no trial of sneaking: it is the walk, crouched, adjusted by eye.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike
from scipy.interpolate import CubicSpline

from mocap._shared.arrays import Array
from mocap.datasets.footsteps import Roll, foot_pitch

Row = tuple[float, ...]
Rows = tuple[Row, Row, Row]


@dataclass(frozen=True, eq=False)
class Gait:
    """One way to walk: when the feet roll, how the legs bend, how the rest of the body swings.

    Parameters
    ----------
    name : the label its frames carry.
    roll : how the feet roll and swing.
    knee : degrees of flexion of a standing leg, every 0.05 cycles from its strike on.
    stride, cadence : metres per stride and steps per minute of the walks that the figures come from.
    under : the phase after a strike at which the pelvis passes over the foot.
    step_width, toe_out : metres between the tracks of the two ankles; degrees a foot points outwards.
    sway, surge : metres of the pelvis, to the left (cos, sin, once per stride), forwards (twice per stride).
    height : metres of the pelvis (mean; cos, sin twice per stride).
    height_weight : the weight of this height; a leg that carries the body has weight 1.
    trunk : degrees of the middle joints: x (mean; cos, sin twice per stride), y, z (cos, sin once).
    arm : degrees of the left arm's joints: x, y, z (mean; cos, sin once; cos, sin twice per stride).
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
    trunk: Mapping[str, Rows]
    arm: Mapping[str, Rows]

    @property
    def speed(self) -> float:
        """Metres per second."""
        return self.stride * self.cadence / 120


WALK = Gait(
    name="walk",
    roll=Roll(
        flat=0.10,
        heel_off=0.35,
        lift=0.545,
        pitch=(0, -3.5, -8.5, -17, -33, -53, -63, -58, -43, -23.5, -6, 9, 20, 17, 8, 0),
        swing=(0.035, 0.110, -0.107, 0.256),
    ),
    knee=(20, 24, 24, 21.5, 18.5, 17.5, 18, 18.5, 17.5, 17.5, 19.5, 26, 40, 55),
    stride=1.35,
    cadence=105,
    under=0.256,
    step_width=0.10,
    toe_out=5.0,
    sway=(-0.0057, 0.0218),
    surge=(-0.0061, 0.0108),
    height=(0.980, -0.011, 0.003),
    height_weight=0.05,
    trunk={
        "root": ((0.6, 1.5, -0.3), (-3.5, -0.5), (-4.5, 3.5)),
        "lowerback": ((-0.5, -0.6, -0.3), (2.3, 0.4), (5.1, -2.6)),
        "upperback": ((6.4, -0.2, 0.0), (3.5, 0.4), (0.4, -1.2)),
        "thorax": ((0.3, 0.3, 0.1), (1.7, 0.2), (-2.9, 0.1)),
        "lowerneck": ((-10.4, -0.3, 0.0), (-0.5, 0.0), (0.0, 0.0)),
        "upperneck": ((5.3, -0.5, 0.2), (-0.6, 0.1), (0.5, 0.1)),
        "head": ((14.0, -0.1, 0.1), (-0.3, 0.0), (0.0, 0.0)),
    },
    arm={
        "humerus": ((1.0, 6.0, 0.3, -0.9, 0.9), (-14.7, 7.2, 2.2, -0.2, 3.2), (2.2, -3.9, 0.3, 0.9, -0.8)),
        "radius": ((-25.1, 6.2, 3.4, -0.8, 1.0), (0, 0, 0, 0, 0), (14.5, -3.6, -2.0, 0.5, -0.6)),
        "wrist": ((0, 0, 0, 0, 0), (-9.8, -4.3, -2.1, 0.2, -1.4), (0, 0, 0, 0, 0)),
        "hand": ((6.3, 0.1, 0.4, 0, 0), (-0.7, 0.2, 0.1, 0, 0), (13.8, -1.2, -0.3, -0.1, -0.3)),
        "fingers": ((0, 0, 0, 0, 0), (0, 0, 0, 0, 0), (-7.1, 0, 0, 0, 0)),
    },
)

JOG = Gait(
    name="jog",
    roll=Roll(
        flat=0.03,
        heel_off=0.13,
        lift=0.21,
        pitch=(0, -15, -37, -56, -66, -73, -79, -86, -92, -93, -85, -72, -48, -25, -9, 3, 4, 1, 0),
        swing=(0.262, 0.136, -0.17, 0.185),
    ),
    knee=(33, 43, 44.5, 40.5, 34, 27),
    stride=2.22,
    cadence=154,
    under=0.060,
    step_width=0.06,
    toe_out=2.0,
    sway=(0.010, 0.001),
    surge=(0.012, -0.011),
    height=(0.970, -0.008, -0.041),
    height_weight=4.0,
    trunk={
        "root": ((6.8, -0.7, -1.2), (3.0, -1.5), (-1.5, 4.3)),
        "lowerback": ((3.3, 0.2, 2.7), (2.1, -2.2), (2.1, -6.6)),
        "upperback": ((6.1, 0.5, 1.1), (2.9, -3.5), (-0.4, -1.7)),
        "thorax": ((-2.2, 0.4, -0.6), (1.4, -1.7), (-2.2, 2.6)),
        "lowerneck": ((-16.2, 0.4, -0.2), (-1.1, 1.0), (-0.9, 0.4)),
        "upperneck": ((-3.7, -0.7, -1.0), (-1.4, 1.2), (2.2, 1.4)),
        "head": ((12.0, -0.3, -0.3), (-0.7, 0.6), (0.6, 0.6)),
    },
    arm={
        "humerus": (
            (20.7, 6.3, -10.3, 0.6, -3.9),
            (-37.6, 0.8, -1.2, -0.5, -0.2),
            (-1.7, -1.8, 5.6, -0.3, 0.5),
        ),
        "radius": ((-94.1, -3.7, -7.3, 1.2, 3.0), (0, 0, 0, 0, 0), (54.3, 2.1, 4.2, -0.7, -1.7)),
        "wrist": ((0, 0, 0, 0, 0), (-4.0, 0.6, -1.2, -1.2, 0.3), (0, 0, 0, 0, 0)),
        "hand": ((4.0, -0.3, 0, 0.2, 0.6), (0.9, -0.1, 0, 0.1, -0.1), (16.2, -0.7, 1.3, 0.3, 0.5)),
        "fingers": ((0, 0, 0, 0, 0), (0, 0, 0, 0, 0), (-15.0, 0, 0, 0, 0)),
    },
)

SNEAK = replace(
    WALK,
    name="sneak",
    roll=Roll(
        flat=0.20,
        heel_off=0.50,
        lift=0.68,
        pitch=(0, -3, -12, -28, -42, -40, -28, -15, -6, 0, 4, 5, 4, 2, 0),
        swing=(0.12, 0.0, 0.0, 0.0),
    ),
    knee=(40, 44, 47, 48, 48, 47, 46, 45, 44, 43, 43, 44, 47, 52, 58),
    stride=0.95,
    cadence=64,
    under=0.32,
    step_width=0.13,
    sway=(-0.020, 0.036),
    trunk={
        **WALK.trunk,
        "root": ((14.0, 1.4, 0.5), (-4.0, -1.7), (-3.0, 1.3)),
        "lowerback": ((8.0, -0.4, -0.5), (2.1, 1.0), (3.2, -0.7)),
        "upperback": ((9.0, -0.1, -0.1), (3.2, 1.3), (0.7, -1.1)),
        "lowerneck": ((-22.0, -0.3, -0.1), (-0.5, -0.1), (0.0, 0.0)),
        "upperneck": ((-8.0, -0.5, 0.0), (-0.6, -0.1), (0.5, 0.2)),
    },
    arm={
        **WALK.arm,
        "humerus": ((-18.0, 5.7, 1.8, -1.2, 0.3), (-22.0, 5, 3, -1.7, 2.7), (9.0, -3.9, -0.7, 1.2, -0.2)),
        "radius": ((-55.0, 4.1, 3.9, -0.9, 0.4), (0, 0, 0, 0, 0), (31.8, -2.4, -2.2, 0.5, -0.2)),
    },
)


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
