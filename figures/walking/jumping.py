"""A jump, generated from a few figures: crouch, push off, fly, land, stand.

The centre of mass comes first: its height runs from pose to pose by quintic curves that fit place, speed and
acceleration, and in the air it is the parabola of gravity. The feet stand, rise on their balls, leave the
ground, and land where they stood. Trunk and arms swing from pose to pose. Then the pelvis is put where the
centre of mass of the whole body is the one asked for, and the legs join the pelvis and the feet.

Source of the figures: trials 01 to 04 of subject 16, and trial 04 of subject 02, of the CMU Graphics Lab
Motion Capture Database (mocap.cs.cmu.edu), rounded, and adjusted to this body by eye. The body lands more
softly than people do: it is pushed with 25 m/s² at most, they are with 35 to 59.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import NamedTuple

import numpy as np
from scipy.interpolate import BPoly, PchipInterpolator
from scipy.ndimage import gaussian_filter1d

from mocap._shared.arrays import Array, Mask
from mocap._shared.easing import quintic_step
from mocap.body import rotations
from mocap.body.motion import Motion
from mocap.quality.falling import centre_of_mass
from walking.footsteps import FootPath, about_ball, toe_angle
from walking.gait_timing import drift
from walking.walking_body import FIGURES, FOOT, FPS, SKELETON, leg

GRAVITY = 9.81
STANDING = 1.0  # metres: the height of the centre of mass
TAKE_OFF = 1.055  # metres
ABSORBED = 0.86  # metres
STAND = 1.0  # seconds
CROUCH = 0.45  # seconds
RISE = 0.55  # seconds
HALF_STANCE = 0.085  # metres from the middle to an ankle
TOE_OUT = 7.0  # degrees
AHEAD = 0.085  # metres from the ankles to the centre of mass, above the middle of the soles
HANG = (0.085, -0.91, -0.09)  # metres from the centre of mass to an ankle that hangs in the air
EXTEND = 0.21  # metres that the body rises until the legs hang
TUCK = 0.03  # metres that they are drawn up then
HEELS_UP = 44.0  # degrees that the soles point down at take-off
HEELS_FIRST = 36.0  # degrees that they point down at landing
BALL_RATE = 350.0  # degrees that they turn at take-off, for each metre of the jump's speed
LAND_RATE = 290.0  # degrees that they turn at landing
STILL = 0.0  # no speed, no acceleration
CATCH = 5.0  # m/s²: the push where the body is lowest after the landing

# Degrees at these moments: standing, lowest, take-off, apex, landing, absorbed, standing. The trunk leans
# forwards; the upper arm swings forwards, the elbow bends.
_TRUNK = (5, 44, 12, 12, 8, 20, 5)
_ARM = (2, -48, 38, 12, 6, -8, 2)
_ELBOW = (26, 30, 60, 42, 48, 38, 26)
# Shares of the trunk's lean, joint by joint; the neck holds the head up.
_LEAN = {
    "root": 0.55,
    "lowerback": 0.2,
    "upperback": 0.15,
    "thorax": 0.1,
    "lowerneck": -0.4,
    "upperneck": -0.3,
}
Curve = Callable[[Array], Array]


class Course(NamedTuple):
    """When a jump's poses are reached, seconds, and how high its centre of mass is then.

    `speed` is that of take-off and landing, metres per second; `lowest` and `absorbed` are where the body is
    lowest before and after the flight.
    """

    speed: float
    depth: float
    still: float
    lowest: float
    take_off: float
    apex: float
    landing: float
    absorbed: float
    recovered: float
    end: float

    @property
    def poses(self) -> tuple[float, ...]:
        """The seven moments of the tables."""
        return self[2:-1]


def generate_jump(rise: float = 0.3, *, seed: int = 0) -> Motion:
    """Jump up and land.

    Parameters
    ----------
    rise : metres from take-off to the apex of the centre of mass, 0.15 to 0.5.
    seed : another number gives other small differences.

    Returns
    -------
    A motion of `walking_body.SKELETON` at 120 Hz, labelled "stand" and "jump", with the footplants as
    `contacts`. In the air the centre of mass, as `quality.centre_of_mass` weighs it, falls at 9.81 m/s².
    """
    course = plan_jump(rise)
    times = np.arange(int(course.end * FPS)) / FPS
    rng = np.random.default_rng(seed)
    centre = np.stack([0 * times, _height(course)(times), 0 * times + AHEAD], axis=-1)
    centre[:, [0, 2]] += 0.004 * drift(rng, times, 2) * _standing(course, times)[:, None]
    angles = _swings(course, times, rng)
    return _posed(centre, angles, {side: _foot(side, course, times) for side in "lr"}, course)


def plan_jump(rise: float) -> Course:
    """Say when each pose of a jump is reached: the higher the jump, the deeper and quicker the push.

    Examples
    --------
    >>> round(plan_jump(0.3).landing - plan_jump(0.3).take_off, 3)
    0.495
    """
    speed = float(np.sqrt(2 * GRAVITY * rise))
    depth = 0.13 + 0.035 * speed
    push = 1.3 * 2 * (TAKE_OFF - STANDING + depth) / speed
    absorb = 1.4 * 2 * (TAKE_OFF - ABSORBED) / speed
    spans = [STAND, CROUCH, push, speed / GRAVITY, speed / GRAVITY, absorb, RISE, STAND]
    return Course(speed, depth, *np.cumsum(spans).tolist())


def _height(course: Course) -> Curve:
    """Give the height of the centre of mass over time: quintics on the ground, a parabola in the air."""
    speed = course.speed
    low = STANDING - course.depth
    pushing = 1.25 * speed**2 / (2 * (TAKE_OFF - low))
    apex = TAKE_OFF + speed**2 / (2 * GRAVITY)
    on_ground = [(STANDING, STILL, STILL), (low, STILL, pushing)]
    aloft = [(TAKE_OFF, speed, -GRAVITY), (apex, STILL, -GRAVITY), (TAKE_OFF, -speed, -GRAVITY)]
    landed = [(ABSORBED, STILL, CATCH), (STANDING, STILL, STILL)]
    return _through(course.poses, on_ground + aloft + landed)


def _through(moments: tuple[float, ...], states: object) -> Curve:
    """Join (place, speed, acceleration) at some moments by quintics; constant outside."""
    curve = BPoly.from_derivatives(moments, states)
    return lambda times: np.asarray(curve(np.clip(times, moments[0], moments[-1])))


def _standing(course: Course, times: Array) -> Array:
    """Weigh the sway: 1 where the body stands, 0 from the crouch to the end of the landing."""
    middle = (course.recovered + course.still) / 2
    half = (course.recovered - course.still) / 2
    return quintic_step((np.abs(times - middle) - half) / 0.5)


def _foot(side: str, course: Course, times: Array) -> FootPath:
    """Stand, rise on the ball, fly, land on the ball, and stand again on the same place."""
    out = 1 if side == "l" else -1
    pitch = _pitch(course)
    height = _height(course)
    place = np.array([out * HALF_STANCE, 0.0])
    heading = out * np.radians(TOE_OUT)

    def on_ground(moments: Array) -> Array:
        yaw = np.full_like(moments, heading)
        return about_ball(np.tile(place, (len(moments), 1)), yaw, pitch(moments), FOOT)

    def from_centre(moments: Array) -> Array:
        centre = np.zeros((len(moments), 3))
        centre[:, 1] = height(moments)
        return on_ground(moments) - centre

    up = course.take_off
    down = course.landing
    hang = np.zeros((3, 3))
    hang[0] = [out * HANG[0], *HANG[1:]]
    states = [_state(from_centre, up), hang, hang, _state(from_centre, down)]
    air = (times > up) & (times < down)
    hung = EXTEND / course.speed
    ankle = on_ground(times)
    ankle[air] = _through((up, up + hung, down - hung, down), states)(times[air])
    share = (times[air] - up) / (down - up)
    tucked = TUCK * 64 * (share * (1 - share)) ** 3
    ankle[air, 1] += height(times[air]) + tucked
    yaw = np.full_like(times, heading)
    turn = pitch(times)
    flat = (turn == 0) & ~air
    return FootPath(ankle, turn, yaw, toe_angle(ankle, turn, FOOT), flat, ~air)


def _pitch(course: Course) -> Curve:
    """Give how far the toes point up, radians: flat, heels up, pointed in the air, heels down."""
    up = course.take_off
    down = course.landing
    rise = BALL_RATE * course.speed
    fall = LAND_RATE * course.speed
    flat = (STILL, STILL, STILL)
    leaving = [flat, (-HEELS_UP, -rise, STILL), (-HEELS_UP - 10, STILL, STILL)]
    landing = [(-HEELS_FIRST - 8, STILL, STILL), (-HEELS_FIRST, fall, STILL), flat]
    # From rest to a pitch and its rate in 2.5 pitch / rate seconds, a quintic never turns the other way.
    heels_off = up - 2.5 * HEELS_UP / rise
    heels_down = down + 2 * HEELS_FIRST / fall
    hung = EXTEND / course.speed
    moments = (heels_off, up, up + hung, down - hung, down, heels_down)
    return _through(moments, np.radians(leaving + landing))


def _state(curve: Curve, moment: float, step: float = 1e-3) -> Array:
    """Give a curve's place, speed and acceleration at a moment, by differences."""
    earlier, value, later = curve(moment + step * np.array([-1.0, 0.0, 1.0]))
    speed = (later - earlier) / (2 * step)
    push = (later - 2 * value + earlier) / step**2
    return np.stack([value, speed, push])


def _swings(course: Course, times: Array, rng: np.random.Generator) -> dict[str, Array]:
    """Swing trunk and arms from pose to pose, with small noises: rotation vectors (F, 3), radians."""
    inside = np.clip(times, course.still, course.recovered)
    rows = [np.radians(row) for row in (_TRUNK, _ARM, _ELBOW)]
    curves = [PchipInterpolator(course.poses, row)(inside) for row in rows]
    trunk, arm, elbow = (gaussian_filter1d(curve, 0.04 * FPS) for curve in curves)
    nod = np.array([1.0, 0.0, 0.0])
    angles = {}
    for joint, share in _LEAN.items():
        noise = np.radians(0.8) * drift(rng, times, 3)
        angles[joint] = np.outer(share * trunk, nod) + noise
    hinge = np.array(FIGURES["arms"]["hinge"])  # the left elbow's axis
    for side, mirror in (("l", np.array([1, 1, 1])), ("r", np.array([1, -1, -1]))):
        reach = np.outer(-arm, nod) + np.array([0.0, -0.2, 0.06])
        angles[side + "humerus"] = reach * mirror + np.radians(1.3) * drift(rng, times, 3)
        bend = elbow + np.radians(2.0) * drift(rng, times, 1)[:, 0]
        angles[side + "radius"] = np.outer(bend, hinge / np.linalg.norm(hinge) * mirror)
    return angles


def _posed(
    centre: Array, angles: Mapping[str, Array], feet: Mapping[str, FootPath], course: Course
) -> Motion:
    """Put the pelvis where the centre of mass is the one asked for, and join it to the feet."""
    turns = {joint: rotations.from_rotvec(turn) for joint, turn in angles.items()}
    still = np.broadcast_to(rotations.IDENTITY, (len(centre), 4))
    ahead = np.tile([0.0, 0.0, 1.0], (len(centre), 1))
    contacts = {side + "foot": foot.flat for side, foot in feet.items()}
    contacts |= {side + "toes": foot.planted for side, foot in feet.items()}
    root = centre - [0.0, 0.03, 0.0]
    for _ in range(14):  # each round leaves a fourth of the gap, for the feet do not follow the root
        for side, foot in feet.items():
            turns |= leg(side, turns["root"], root, foot, ahead)
        pose = np.stack([turns.get(joint, still) for joint in SKELETON.names], axis=1)
        motion = Motion(SKELETON, root, pose, FPS, "jump", _labels(course, len(root)), contacts)
        root = root + centre - centre_of_mass(motion)
    return motion


def _labels(course: Course, frames: int) -> dict[str, Mask]:
    times = np.arange(frames) / FPS
    jumping = (times > course.still) & (times < course.recovered)
    return {"stand": ~jumping, "jump": jumping}
