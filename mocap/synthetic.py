"""Walks made from nothing but figures: the clips that come with the package.

How a walk is made, in the order of this file: a `Course` tells, frame by frame, how far the walker has come
and where in the cycle; the feet are planted along the route (`footsteps`); the gait's tables swing the
trunk and the arms (`gait`); and the legs join the two (`walker`). Small random differences from step to
step see to it that no two frames are the same.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.ndimage import gaussian_filter1d

from mocap import rotations
from mocap.errors import MocapError
from mocap.footsteps import FootPath, Route, Steps, foot_path, smoothstep, winding
from mocap.gait import JOG, SNEAK, WALK, Gait, joint_angles, knee_flexion, pelvis_drift
from mocap.motion import Motion
from mocap.walker import FOOT, FPS, HIPS, SKELETON, leg, pelvis_height

Array = NDArray[np.float64]

GRAVITY = 9.81
STANDING_KNEE = np.radians(18.0)
PAD = 4.0  # seconds planned before the first frame and after the last, so that every foot has a next step
GAITS = {gait.name: gait for gait in (WALK, SNEAK, JOG)}

# Routes, as metres and the degrees turned to the left on them: loops both ways, then two ways to wander.
_CIRCLE = [(7.5, 360), (3.8, 180), (1.9, 180), (1.9, -180), (3.8, -180), (12.5, -600)]
_CURVE_1 = [(3.0, 260), (0.9, -80), (3.7, 330), (3.9, -330), (3.4, 300), (0.9, -80), (2.6, 230)]
_CURVE_1 += [(3.7, -330), (1.0, 80), (2.9, -260), (4.1, 320)]
_CURVE_2 = [(1.4, 120), (2.2, -200), (0.9, 80), (2.9, -260), (0.9, 80), (2.7, -240), (3.6, 320)]
_CURVE_2 += [(1.1, -80), (4.3, 310), (4.8, -330), (4.5, 310)]
_STOP_AND_GO = [(3.5, 0), (2.4, 90), (2.5, 0), (2.4, -90), (10.0, 0)]
_STRIDES, _RESTS = (5, 4.5, 4), (2, 2.5, 2, 2.5)  # between the halts, and the seconds of each halt

# Style, speed in metres a second, route.
CLIPS = {
    "walk_circle": ("walk", 0.80, _CIRCLE),
    "walk_curve_1": ("walk", 0.74, _CURVE_1),
    "walk_curve_2": ("walk", 0.71, _CURVE_2),
    "walk_straight": ("walk", 1.1, [(11.0, 0)]),
    "sneak": ("sneak", 0.5, [(3.0, 50), (3.0, -90), (3.0, 70)]),
    "jog": ("jog", 2.8, [(8.0, 0), (9.0, 150), (5.0, 0), (9.0, -150), (6.0, 0)]),
}
NAMES = (*CLIPS, "stop_and_go")


def generate(name: str) -> Motion:
    """Make one of the bundled clips; the same one, to the last bit, each time.

    Parameters
    ----------
    name : one of `NAMES`.

    Returns
    -------
    A motion of `walker.SKELETON` at 120 Hz: labelled, and with the foot plants as `contacts`.

    Raises
    ------
    MocapError : for an unknown name.

    Examples
    --------
    >>> generate("walk_straight")
    Motion('walk_straight', 1201 frames at 120 Hz, 38 joints)
    """
    if name not in NAMES:
        raise MocapError(f"No bundled clip '{name}'; there are: {', '.join(NAMES)}.")
    seed = NAMES.index(name)
    if name == "stop_and_go":
        rng = np.random.default_rng(seed)
        motion = _perform(Route(winding(_STOP_AND_GO)), _halting(WALK, _STRIDES, _RESTS), WALK, rng)
    else:
        style, speed, stretches = CLIPS[name]
        motion = walk(winding(stretches), style=style, speed=speed, seed=seed)
    return replace(motion, name=name)


def walk(path: ArrayLike, *, style: str = "walk", speed: float | None = None, seed: int = 0) -> Motion:
    """Walk along a path on the ground, from its start to its end, at a steady speed.

    Parameters
    ----------
    path : shape (N, 2), metres: points (x, z); a smooth curve is laid through them.
    style : one of "walk", "sneak", "jog".
    speed : metres a second; by default the style's own.
    seed : another number gives other small differences from step to step.

    Returns
    -------
    A motion of `walker.SKELETON` at 120 Hz, labelled `style`, with the foot plants as `contacts`: the ankle
    (`lfoot`, `rfoot`) while the sole lies flat, the ball (`ltoes`, `rtoes`) until it leaves the ground.

    Raises
    ------
    MocapError : for an unknown style, a speed not above 0 or beyond the legs' reach, or a path that is none.

    Examples
    --------
    >>> walk([[0, 0], [0, 2], [1, 4]], speed=1.2)
    Motion('walk', 427 frames at 120 Hz, 38 joints)
    """
    if style not in GAITS:
        raise MocapError(f"No style '{style}'; there are: {', '.join(GAITS)}.")
    gait = GAITS[style]
    speed = gait.speed if speed is None else speed
    if not (np.isfinite(speed) and speed > 0):
        raise MocapError(f"A walk needs a speed above 0, got {speed}.")
    route, rng = Route(path), np.random.default_rng(seed)
    return _perform(route, _steady(gait, speed, route.length / speed, rng), gait, rng)


class Course(NamedTuple):
    """The walker's way, for all frames and `PAD` seconds before and after them.

    `times` in seconds, `phase` in cycles, `distance` along the route in metres, `vigour` of the movements
    (1 as in the gait's tables, 0 standing), all of one length; `skipped` are the steps left out at halts.
    """

    times: Array
    phase: Array
    distance: Array
    vigour: Array
    skipped: Array


def _times(seconds: float) -> Array:
    return np.arange(-round(PAD * FPS), round((seconds + PAD) * FPS) + 1) / FPS


def _steady(gait: Gait, speed: float, seconds: float, rng: np.random.Generator) -> Course:
    """Walk on at a speed that wanders by a few percent; who walks slower takes shorter and fewer steps."""
    times = _times(seconds)
    wander = _drift(rng, times, 2)
    pace = np.maximum(speed + 0.06 * wander[:, 0], speed / 2)
    strides = gait.cadence / 120 * (pace / gait.speed) ** 0.2 * (1 + 0.03 * wander[:, 1])  # a second
    phase, distance = (np.cumsum(rate) / FPS for rate in (strides, pace))
    vigour = (pace / strides / gait.stride) ** 0.25
    start = round(PAD * FPS)
    return Course(times, phase - phase[start], distance - distance[start], vigour, np.empty(0))


def _halting(gait: Gait, strides: Sequence[float], rests: Sequence[float]) -> Course:
    """Stand, walk, stand, and so on: where both feet stand the phase rests, and then a step is left out.

    `strides` are their numbers between the halts, multiples of 1/2; `rests` the seconds, one more of them.
    """
    closing = np.concatenate([[0.0], np.cumsum(strides)])  # the strikes that bring the feet together
    hold = closing + 0.3
    rate = gait.cadence / 120
    arrive = (hold - hold[0]) / rate + np.concatenate([[0.0], np.cumsum(rests[:-1])])
    times = _times(float(arrive[-1] + rests[-1]))
    knots = np.stack([arrive, arrive + np.asarray(rests)], axis=-1).ravel()
    phase = gaussian_filter1d(np.interp(times, knots, np.repeat(hold, 2)), 0.15 * FPS)
    moving = np.zeros_like(phase)
    for start, stop in pairwise(closing):  # the pelvis arrives with the last step but one
        moving += smoothstep((phase - start - 0.4) / 0.9) * smoothstep(
            (stop - 0.5 + gait.under - phase) / 0.9
        )
    distance = 0.88 * gait.stride * np.cumsum(moving * np.gradient(phase))
    return Course(times, phase, distance, gaussian_filter1d(np.sqrt(moving), 0.1 * FPS), closing + 0.5)


def _drift(rng: np.random.Generator, times: Array, count: int) -> Array:
    """Draw `count` smooth noises of unit size, shape (F, count), from sines of 2 to 11 seconds."""
    periods = rng.uniform(2.0, 11.0, (6, count))
    starts = rng.uniform(0.0, 2 * np.pi, (6, count))
    waves = np.sin(2 * np.pi * times[:, None, None] / periods + starts)
    return np.asarray(waves.sum(axis=1) / np.sqrt(3))


class Travel(NamedTuple):
    """Where the body heads: `heading`, `bank` to the left (F,), radians; `ahead`, `left` (F, 3)."""

    heading: Array
    bank: Array
    ahead: Array
    left: Array


def _travel(route: Route, course: Course) -> Travel:
    """Face along the route and lean into its turns: tan(bank) = v · dθ/dt / g."""
    heading = gaussian_filter1d(route.heading(course.distance), 0.1 * FPS)
    push = np.gradient(course.distance) * np.gradient(heading) * FPS**2
    bank = gaussian_filter1d(np.arctan(push / GRAVITY), 0.15 * FPS)
    level = np.zeros_like(heading)
    ahead = np.stack([np.sin(heading), level, np.cos(heading)], axis=-1)
    return Travel(heading, bank, ahead, np.stack([np.cos(heading), level, -np.sin(heading)], axis=-1))


def _plan(
    route: Route, course: Course, bank: Array, gait: Gait, rng: np.random.Generator
) -> dict[str, Steps]:
    """Plant each foot where the pelvis will be when it passes over it, half a step's width to its side."""
    plans = {}
    for side, first, outwards in (("l", 0.0, 1), ("r", 0.5, -1)):
        strikes = np.arange(np.floor(course.phase[0]) - 2, course.phase[-1] + 2) + first
        strikes = strikes[~np.isin(strikes, course.skipped)]
        distance, lean = (
            np.interp(strikes + gait.under, course.phase, values) for values in (course.distance, bank)
        )
        luck = rng.standard_normal((4, len(strikes)))
        yaws = route.heading(distance)
        left = outwards * (gait.step_width / 2 + 0.009 * luck[0]) - 0.9 * np.tan(lean)
        places = route.place(distance + 0.012 * luck[1])
        places += left[:, None] * np.stack([np.cos(yaws), -np.sin(yaws)], axis=-1)
        yaws = yaws + outwards * np.radians(gait.toe_out + 1.5 * luck[2])
        vigour = np.maximum(0.5, np.interp(strikes[1:] - 0.25, course.phase, course.vigour))
        plans[side] = Steps(strikes, places, yaws, vigour * (1 + 0.03 * luck[3, 1:]))
    return plans


def _upper_body(course: Course, gait: Gait, travel: Travel, rng: np.random.Generator) -> dict[str, Array]:
    """Swing the trunk and the arms, never twice the same; chest and head look ahead into a turn."""
    angles = joint_angles(gait, course.phase, course.vigour * (1 + 0.1 * _drift(rng, course.times, 1)[:, 0]))
    for joint in ("lowerback", "upperback", "thorax", "upperneck", "lhumerus", "rhumerus"):
        angles[joint] += np.radians(1.3) * _drift(rng, course.times, 3)
    for joint in ("lradius", "rradius"):  # an elbow is a hinge: it bends more or less, but about one axis
        usual = np.linalg.norm(angles[joint], axis=-1).mean()
        angles[joint] *= 1 + np.radians(3.0) / usual * _drift(rng, course.times, 1)
    soon, later = (np.interp(course.times + s, course.times, travel.heading) for s in (0.12, 0.35))
    for joints, lead in (
        (("upperback", "thorax"), soon - travel.heading),
        (("upperneck", "head"), later - soon),
    ):
        for joint in joints:
            angles[joint][:, 1] += lead / 2
    angles["root"][:, 2] -= travel.bank
    return angles


def _perform(route: Route, course: Course, gait: Gait, rng: np.random.Generator) -> Motion:
    """Plan with the seconds before and after, cut them off, and pose the whole body."""
    travel = _travel(route, course)
    plans = _plan(route, course, travel.bank, gait, rng)
    angles = _upper_body(course, gait, travel, rng)
    inside = slice(round(PAD * FPS), len(course.times) - round(PAD * FPS))
    times, phase, distance, vigour = (values[inside] for values in course[:4])
    heading, bank, ahead, left = (values[inside] for values in travel)
    turns = {joint: rotations.from_rotvec(turn[inside]) for joint, turn in angles.items()}
    turns["root"] = rotations.multiply(rotations.about_y(heading), turns["root"])
    feet = {side: foot_path(steps, phase, gait.roll, FOOT) for side, steps in plans.items()}
    drift = pelvis_drift(gait, phase, vigour)
    drift[:, [0, 2]] += 0.003 * _drift(rng, times, 2)
    x, z = route.place(distance).T
    root = np.stack([x, drift[:, 1] * np.cos(bank), z], axis=-1)
    root += drift[:, :1] * left + drift[:, 2:] * ahead
    root[:, 1] = _ride(root, turns["root"], feet, gait, vigour)
    for side, foot in feet.items():
        turns |= leg(side, turns["root"], root, foot, ahead)
    still = np.broadcast_to(rotations.IDENTITY, (len(root), 4))
    pose = np.stack([turns.get(joint, still) for joint in SKELETON.names], axis=1)
    standing = feet["l"].flat & feet["r"].flat
    labels = {gait.name: ~standing} | ({"stand": standing} if standing.any() else {})
    contacts = {side + "foot": foot.flat for side, foot in feet.items()}
    contacts |= {side + "toes": foot.planted for side, foot in feet.items()}
    return Motion(SKELETON, root, pose, FPS, gait.name, labels, contacts)


def _ride(root: Array, pelvis: Array, feet: dict[str, FootPath], gait: Gait, vigour: Array) -> Array:
    """Find the pelvis's height: straighter knees the less it moves."""
    hips = {side: rotations.rotate(pelvis, HIPS[side]) for side in feet}
    bends = {
        side: STANDING_KNEE + vigour * (knee_flexion(gait, foot.stance) - STANDING_KNEE)
        for side, foot in feet.items()
    }
    return pelvis_height(root, hips, feet, bends, gait.height_weight)
