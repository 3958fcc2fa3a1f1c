"""Walks made from nothing but figures: the clips that come with the package.

How a walk is made: a course tells, frame by frame, how far the walker has come, where in the cycle and in
which gait (`gait_timing`); the feet are planted along the route (`footsteps`); the gait's tables swing the
trunk and the arms (`gait`); and the legs join the two (`walking_body`). Small random differences from step to
step see to it that no two frames are the same.
"""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from scipy.ndimage import gaussian_filter1d

from mocap._shared.arrays import Array, Mask
from mocap.body import rotations
from mocap.body.motion import Motion
from mocap.datasets.footsteps import FootPath, Route, Steps, foot_path, winding
from mocap.datasets.gait import JOG, SNEAK, WALK, joint_angles, knee_flexion, mix, mix_rolls, pelvis_drift
from mocap.datasets.gait_timing import Timing, changing, drift, halting, steady
from mocap.datasets.walking_body import FOOT, FPS, HIPS, SKELETON, leg, pelvis_height
from mocap.errors import MocapError

GRAVITY = 9.81
STANDING_KNEE = np.radians(18.0)
GAITS = {gait.name: gait for gait in (WALK, SNEAK, JOG)}

# Routes, as metres and the degrees turned to the left on them: loops both ways, then two ways to wander.
_CIRCLE = [(7.5, 360), (3.8, 180), (1.9, 180), (1.9, -180), (3.8, -180), (12.5, -600)]
_CURVE_1 = [(3.0, 260), (0.9, -80), (3.7, 330), (3.9, -330), (3.4, 300), (0.9, -80), (2.6, 230)]
_CURVE_1 += [(3.7, -330), (1.0, 80), (2.9, -260), (4.1, 320)]
_CURVE_2 = [(1.4, 120), (2.2, -200), (0.9, 80), (2.9, -260), (0.9, 80), (2.7, -240), (3.6, 320)]
_CURVE_2 += [(1.1, -80), (4.3, 310), (4.8, -330), (4.5, 310)]
_STOP_AND_GO = [(3.5, 0), (2.4, 90), (2.5, 0), (2.4, -90), (10.0, 0)]
_STRIDES, _RESTS = (5, 4.5, 4), (2, 2.5, 2, 2.5)  # between the halts, and the seconds of each halt

# Speed in metres a second, route.
STEADY = {
    "walk_circle": (0.80, _CIRCLE),
    "walk_curve_1": (0.74, _CURVE_1),
    "walk_curve_2": (0.71, _CURVE_2),
    "walk_straight": (1.1, [(11.0, 0)]),
}
# The gait to change into, route, stages: at that second, that speed, and so much of the gait.
_SNEAK = [(0, 0.78, 0), (3.5, 0.78, 0), (6.0, 0.5, 1), (13.0, 0.5, 1), (15.5, 0.78, 0)]
_SNEAK += [(18.0, 0.78, 0), (20.5, 0.5, 1), (27.5, 0.5, 1), (30.0, 0.78, 0), (33.5, 0.78, 0)]
_JOG = [(0, 1.1, 0), (3.0, 1.1, 0), (4.2, 1.3, 0), (5.6, 2.5, 1), (6.6, 2.8, 1)]
_JOG += [(11.5, 2.8, 1), (12.5, 2.5, 1), (13.9, 1.3, 0), (15.1, 1.1, 0)]
_JOG += [(17.0, 1.1, 0), (18.2, 1.3, 0), (19.6, 2.5, 1), (20.6, 2.8, 1)]
_JOG += [(25.5, 2.8, 1), (26.5, 2.5, 1), (27.9, 1.3, 0), (29.1, 1.1, 0), (32.1, 1.1, 0)]
CHANGING = {
    "sneak": (SNEAK, [(3.5, 0), (4.5, 130), (4.0, -40), (4.5, -130), (4.5, 40)], _SNEAK),
    "jog": (JOG, [(11.0, 0), (9.0, 150), (21.0, 0), (9.0, -150), (12.0, 0)], _JOG),
}
NAMES = (*STEADY, *CHANGING, "stop_and_go")


def generate(name: str) -> Motion:
    """Make one of the bundled clips; the same one, to the last bit, each time.

    Parameters
    ----------
    name : one of `NAMES`.

    Returns
    -------
    A motion of `datasets.SKELETON` at 120 Hz: labelled, and with the foot plants as `contacts`.

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
    rng = np.random.default_rng(seed)
    if name in STEADY:
        speed, stretches = STEADY[name]
        motion = generate_walk(winding(stretches), speed=speed, seed=seed)
    elif name in CHANGING:
        gait, stretches, stages = CHANGING[name]
        motion = _perform(Route(winding(stretches)), changing((WALK, gait), stages, rng), rng)
    else:
        motion = _perform(Route(winding(_STOP_AND_GO)), halting(WALK, _STRIDES, _RESTS), rng)
    return replace(motion, name=name)


def generate_walk(
    path: ArrayLike, *, style: str = "walk", speed: float | None = None, seed: int = 0
) -> Motion:
    """Walk along a path on the ground, from its start to its end, at a steady speed.

    Parameters
    ----------
    path : shape (N, 2), metres: points (x, z); a smooth curve is laid through them.
    style : one of "walk", "sneak", "jog".
    speed : metres a second; by default the style's own.
    seed : another number gives other small differences from step to step.

    Returns
    -------
    A motion of `datasets.SKELETON` at 120 Hz, labelled `style`, with the foot plants as `contacts`: the ankle
    (`lfoot`, `rfoot`) while the sole lies flat, the ball (`ltoes`, `rtoes`) until it leaves the ground.

    Raises
    ------
    MocapError : for an unknown style, a speed not above 0 or beyond the legs' reach, or a path that is none.

    Examples
    --------
    >>> generate_walk([[0, 0], [0, 2], [1, 4]], speed=1.2)
    Motion('walk', 427 frames at 120 Hz, 38 joints)

    Notebook: 01-skeletons-and-clips
    """
    if style not in GAITS:
        raise MocapError(f"No style '{style}'; there are: {', '.join(GAITS)}.")
    gait = GAITS[style]
    speed = gait.speed if speed is None else speed
    if not (np.isfinite(speed) and speed > 0):
        raise MocapError(f"A walk needs a speed above 0, got {speed}.")
    route, rng = Route(path), np.random.default_rng(seed)
    return _perform(route, steady(gait, speed, route.length / speed, rng), rng)


class Travel(NamedTuple):
    """Where the body heads: `heading`, `bank` to the left (F,), radians; `ahead`, `left` (F, 3)."""

    heading: Array
    bank: Array
    ahead: Array
    left: Array


def _travel(route: Route, course: Timing) -> Travel:
    """Face along the route and lean into its turns: tan(bank) = v · dθ/dt / g."""
    heading = gaussian_filter1d(route.heading(course.distance), 0.1 * FPS)
    push = np.gradient(course.distance) * np.gradient(heading) * FPS**2
    bank = gaussian_filter1d(np.arctan(push / GRAVITY), 0.15 * FPS)
    level = np.zeros_like(heading)
    ahead = np.stack([np.sin(heading), level, np.cos(heading)], axis=-1)
    return Travel(heading, bank, ahead, np.stack([np.cos(heading), level, -np.sin(heading)], axis=-1))


def _plan(route: Route, course: Timing, bank: Array, rng: np.random.Generator) -> dict[str, Steps]:
    """Plant each foot where the pelvis will be when it passes over it, half a step's width to its side."""
    plans = {}
    for side, first, outwards in (("l", 0.0, 1), ("r", 0.5, -1)):
        strikes = np.arange(np.floor(course.phase[0]) - 2, course.phase[-1] + 2) + first
        strikes = strikes[~np.isin(strikes, course.skipped)]
        weights = np.stack([np.interp(strikes, course.phase, weight) for weight in course.weights])
        under, width, toe_out = (
            mix([getattr(gait, name) for gait in course.gaits], weights)
            for name in ("under", "step_width", "toe_out")
        )
        distance, lean = (
            np.interp(strikes + under, course.phase, values) for values in (course.distance, bank)
        )
        luck = rng.standard_normal((4, len(strikes)))
        yaws = route.heading(distance)
        left = outwards * (width / 2 + 0.009 * luck[0]) - 0.9 * np.tan(lean)
        places = route.place(distance + 0.012 * luck[1])
        places += left[:, None] * np.stack([np.cos(yaws), -np.sin(yaws)], axis=-1)
        yaws = yaws + outwards * np.radians(toe_out + 1.5 * luck[2])
        vigour = np.maximum(0.5, np.interp(strikes[1:] - 0.25, course.phase, course.vigour))
        rolls = [mix_rolls([gait.roll for gait in course.gaits], weight) for weight in weights.T[:-1]]
        plans[side] = Steps(strikes, places, yaws, vigour * (1 + 0.03 * luck[3, 1:]), rolls)
    return plans


def _upper_body(course: Timing, travel: Travel, rng: np.random.Generator) -> dict[str, Array]:
    """Swing the trunk and the arms, never twice the same; chest and head look ahead into a turn."""
    amplitude = course.vigour * (1 + 0.1 * drift(rng, course.times, 1)[:, 0])
    swings = [joint_angles(gait, course.phase, amplitude) for gait in course.gaits]
    angles = {joint: mix([swing[joint] for swing in swings], course.weights) for joint in swings[0]}
    for joint in ("lowerback", "upperback", "thorax", "upperneck", "lhumerus", "rhumerus"):
        angles[joint] += np.radians(1.3) * drift(rng, course.times, 3)
    for joint in ("lradius", "rradius"):  # an elbow is a hinge: it bends more or less, but about one axis
        usual = np.linalg.norm(angles[joint], axis=-1).mean()
        angles[joint] *= 1 + np.radians(3.0) / usual * drift(rng, course.times, 1)
    soon, later = (np.interp(course.times + s, course.times, travel.heading) for s in (0.12, 0.35))
    for joints, lead in (
        (("upperback", "thorax"), soon - travel.heading),
        (("upperneck", "head"), later - soon),
    ):
        for joint in joints:
            angles[joint][:, 1] += lead / 2
    angles["root"][:, 2] -= travel.bank
    return angles


def _perform(route: Route, course: Timing, rng: np.random.Generator) -> Motion:
    """Plan with the seconds before and after, cut them off, and pose the whole body."""
    travel = _travel(route, course)
    plans = _plan(route, course, travel.bank, rng)
    angles = _upper_body(course, travel, rng)
    turns = {joint: rotations.from_rotvec(turn[course.inside]) for joint, turn in angles.items()}
    heading, bank, ahead, left = (values[course.inside] for values in travel)
    course = course.cut()
    turns["root"] = rotations.multiply(rotations.about_y(heading), turns["root"])
    feet = {side: foot_path(steps, course.phase, FOOT) for side, steps in plans.items()}
    swing = mix([pelvis_drift(gait, course.phase, course.vigour) for gait in course.gaits], course.weights)
    swing[:, [0, 2]] += 0.003 * drift(rng, course.times, 2)
    x, z = route.place(course.distance).T
    root = np.stack([x, swing[:, 1] * np.cos(bank), z], axis=-1)
    root += swing[:, :1] * left + swing[:, 2:] * ahead
    root[:, 1] = _ride(root, turns["root"], feet, course)
    for side, foot in feet.items():
        turns |= leg(side, turns["root"], root, foot, ahead)
    still = np.broadcast_to(rotations.IDENTITY, (len(root), 4))
    pose = np.stack([turns.get(joint, still) for joint in SKELETON.names], axis=1)
    contacts = {side + "foot": foot.flat for side, foot in feet.items()}
    contacts |= {side + "toes": foot.planted for side, foot in feet.items()}
    return Motion(SKELETON, root, pose, FPS, course.gaits[0].name, _labels(course, feet), contacts)


def _ride(root: Array, pelvis: Array, feet: dict[str, FootPath], course: Timing) -> Array:
    """Find the pelvis's height: straighter knees the less it moves."""
    hips = {side: rotations.rotate(pelvis, HIPS[side]) for side in feet}
    bends = {}
    for side, foot in feet.items():
        knee = mix([knee_flexion(gait, foot.stance) for gait in course.gaits], course.weights)
        bends[side] = STANDING_KNEE + course.vigour * (knee - STANDING_KNEE)
    height_weight = mix([gait.height_weight for gait in course.gaits], course.weights)
    return pelvis_height(root, hips, feet, bends, height_weight)


def _labels(course: Timing, feet: dict[str, FootPath]) -> dict[str, Mask]:
    """Call each frame what there is most of in it, or standing where both soles lie flat."""
    standing = feet["l"].flat & feet["r"].flat
    most = course.weights.argmax(axis=0)
    labels = {gait.name: (most == number) & ~standing for number, gait in enumerate(course.gaits)}
    return labels | ({"stand": standing} if standing.any() else {})
