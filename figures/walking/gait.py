"""The movements of a body within one cycle of a gait; `walker.toml` holds the figures."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.interpolate import CubicSpline

from mocap._shared.arrays import Array
from walking.footsteps import Roll
from walking.walking_body import FIGURES

Row = tuple[float, ...]
KNEE_STEP = 0.05  # of a cycle: between the numbers of `stance_knee`


@dataclass(frozen=True)
class Trunk:
    """Harmonics of a middle part of the body, in degrees from the vertical and the heading.

    `nod` bends forwards: (mean; cos, sin twice per stride). `turn` brings the left side ahead, and `list`
    raises it: (cos, sin once; cos, sin three times per stride).
    """

    nod: Row
    turn: Row
    list: Row


@dataclass(frozen=True)
class Arm:
    """Harmonics of the left arm, in degrees: (mean; cos, sin once; cos, sin twice per stride).

    `swing` is the angle of the upper arm ahead of hanging down, `out` to the side, `twist` about itself to
    the left. `elbow` and `hand` bend.
    """

    swing: Row
    out: Row
    twist: Row
    elbow: Row
    hand: Row


@dataclass(frozen=True)
class Gait:
    """One way to walk. The name is the label of its frames.

    speed : m/s, with steps of `step` metres; at other speeds these grow as speed ** `step_power`.
    turning : seconds, by which the walker slows down in curves.
    labelled_from : a frame has the gait's label from this weight.
    under : phase after a strike at which the pelvis passes over the foot.
    step_width : metres between the tracks of both ankles; a foot points `toe_out` degrees outwards.
    sway, surge : metres of the pelvis to the left (cos, sin once per stride) and ahead (cos, sin twice).
    height : metres of the pelvis above the floor (mean; cos, sin twice), of the weight `height_weight`; a
        leg that carries the body has weight 1.
    stance_knee : degrees of flexion of a standing leg, every 0.05 cycles from its strike.
    swing_thigh, swing_knee, swing_pitch : coefficients, degrees, of `swing_bump` in the air.
    """

    name: str
    speed: float
    step: float
    step_power: float
    turning: float
    labelled_from: float
    under: float
    step_width: float
    toe_out: float
    sway: Row
    surge: Row
    height: Row
    height_weight: float
    roll: Roll
    stance_knee: Row
    swing_thigh: Row
    swing_knee: Row
    swing_pitch: Row
    pelvis: Trunk
    thorax: Trunk
    head: Trunk
    arm: Arm

    def step_at(self, speed: ArrayLike) -> Array:
        """Length of a step, metres, at a speed in m/s: step · (v / speed) ** step_power."""
        return np.asarray(self.step * np.divide(speed, self.speed) ** self.step_power)


def _read(name: str, figures: Mapping[str, Any]) -> Gait:
    """Make a gait of its part of `walker.toml`."""
    parts: dict[str, Any] = {part: Trunk(**figures[part]) for part in ("pelvis", "thorax", "head")}
    parts["roll"] = Roll(**figures["roll"])
    parts["arm"] = Arm(**figures["arm"])
    return Gait(name=name, **(dict(figures) | parts))


GAITS = {name: _read(name, figures) for name, figures in FIGURES["gaits"].items()}
WALK = GAITS["walk"]


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
    >>> mix([1.0, 3.0], np.array([[1.0, 0.5], [0.0, 0.5]]))
    array([1., 2.])
    """
    return np.asarray((np.asarray(figures, float).T * weights.T).sum(axis=-1).T)


def mix_rolls(rolls: Sequence[Roll], weights: Array) -> Roll:
    """Mix the rolls of several gaits, whose lists are equally long; `weights` (gaits,) add up to one."""
    if weights.max() > 1 - 1e-9:  # one gait alone, up to rounding
        return rolls[int(weights.argmax())]
    flat, heel_off, let_go, lift, strike = (weights @ [roll[:5] for roll in rolls]).tolist()
    heel_rise = weights @ [roll.heel_rise for roll in rolls]
    return Roll(flat, heel_off, let_go, lift, strike, tuple(heel_rise.tolist()))


def stance_knee(gait: Gait, phase: ArrayLike) -> Array:
    """Look up the flexion of a standing leg's knee, radians, at a phase since its strike."""
    knots = KNEE_STEP * np.arange(len(gait.stance_knee))
    curve = CubicSpline(knots, np.radians(gait.stance_knee))
    return np.asarray(curve(np.clip(phase, 0, knots[-1])))


def swing_bump(coefficients: ArrayLike, share: Array) -> Array:
    """Compute what a swing adds to the smoothest way from lift to strike, radians.

    Parameters
    ----------
    coefficients : c, degrees.
    share : shape (F,): 0 at the lift, 1 at the strike.

    Returns
    -------
    (4 u (1 - u))³ Σ cₖ (2 u - 1)ᵏ, shape (F,): zero at both ends, and so are its first two derivatives.

    Examples
    --------
    >>> np.degrees(swing_bump([10.0, 3.0], np.array([0.0, 0.5, 1.0])))
    array([ 0., 10.,  0.])
    """
    window = (4 * share * (1 - share)) ** 3
    return window * np.polynomial.polynomial.polyval(2 * share - 1, np.radians(coefficients))


def harmonics(row: Sequence[float], angle: Array, orders: tuple[int, int]) -> Array:
    """Sum two harmonics: a cos nφ + b sin nφ + c cos mφ + d sin mφ.

    Parameters
    ----------
    row : (a, b, c, d), or (a, b) for one harmonic.
    angle : φ, radians, shape (F,).
    orders : (n, m).
    """
    total = np.zeros_like(angle)
    for order, cosine, sine in zip(orders, row[::2], row[1::2], strict=False):
        total = total + cosine * np.cos(order * angle) + sine * np.sin(order * angle)
    return np.asarray(total)


def pelvis_drift(gait: Gait, phase: Array, vigour: Array) -> Array:
    """Position of the pelvis to the left, up and ahead of its course on the floor, metres, (F, 3)."""
    angle = 2 * np.pi * phase
    sway = harmonics(gait.sway, angle, (1, 3))
    bob = harmonics(gait.height[1:], angle, (2, 4))
    surge = harmonics(gait.surge, angle, (2, 4))
    waves = vigour[:, None] * np.stack([sway, bob, surge], axis=-1)
    return np.asarray(waves + np.array([0, gait.height[0], 0]))


def trunk_angles(trunk: Trunk, phase: Array, vigour: Array) -> Array:
    """Angles of a middle part of the body: rotation vectors (F, 3), radians, relative to the heading.

    x bends forwards, y turns to the left, z lowers the right side.
    """
    angle = 2 * np.pi * phase
    nod = trunk.nod[0] + vigour * harmonics(trunk.nod[1:], angle, (2, 4))
    turn = -vigour * harmonics(trunk.turn, angle, (1, 3))
    side = vigour * harmonics(trunk.list, angle, (1, 3))
    return np.radians(np.stack([nod, turn, side], axis=-1))


def arm_angles(arm: Arm, phase: Array, vigour: Array) -> dict[str, Array]:
    """Angles of the left arm, radians, (F,): swing, out, twist, elbow and hand.

    The right arm does half a cycle later what the left arm does.
    """
    angle = 2 * np.pi * phase
    waves = {}
    for name in ("swing", "out", "twist", "elbow", "hand"):
        row = getattr(arm, name)
        waves[name] = np.radians(row[0] + vigour * harmonics(row[1:], angle, (1, 2)))
    return waves
