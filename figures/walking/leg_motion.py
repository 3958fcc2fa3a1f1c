"""How the legs move: stance on the ground, the height of the pelvis above it, and the swing between.

A standing foot is given by its footplant. The height of the pelvis follows from the standing leg's knee.
In the air the leg moves by its angles: thigh, knee and splay leave the ground and strike it with the angles,
speeds and accelerations that they have on the ground, and follow the gait's swing between. Hence no joint
jumps when a foot lifts or strikes.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from scipy.linalg import solveh_banded

from mocap._shared.arrays import Array, Indices, Mask
from mocap._shared.easing import quintic_step
from mocap.body import rotations
from walking.footsteps import (
    Foot,
    FootPath,
    Footplant,
    about_ball,
    about_heel,
    ball_height,
    ball_of,
    landing_pitch,
    pitch_for_leg,
    rising_pitch,
    toe_angle,
)
from walking.gait import WALK, Gait, mix, stance_knee, swing_bump
from walking.gait_timing import Timing
from walking.walking_body import (
    FOOT,
    FPS,
    LegAngles,
    from_leg_angles,
    hip_above_ankle,
    leg_length,
    to_leg_angles,
)

STRAIGHTEST = np.radians(4.5)  # a knee bends so far at least
SOFT_HEEL = np.radians(2.0)  # of pitch: a heel leaves the floor gently
SOFT_KNEE = np.radians(3.0)  # near this flexion a swinging knee straightens more and more slowly
STANDING_KNEE = np.radians(7.0)  # of one who stands still
MID_STANCE = 0.3  # phase since the strike
TOUCH = 0.10  # of the stance's duration, before the strike: the leg begins to carry the pelvis
LOADED = 0.02  # of the stance after the strike: it carries the pelvis alone
LETTING_GO = 0.15  # of the stance: so long the load falls to nothing
PUSH_OFF = 0.5  # of the time from heel off to lift, after which the heel rises as the knee requires
STIFF = 150.0  # weight of squared second differences of the pelvis's height
REACH = 400.0  # weight of heights that a leg cannot reach
SLACK = 0.035  # metres that the pelvis may be too high for a leg that is not loaded yet
CLEARANCE = 0.020  # metres between the floor and the tip of the toes in mid swing
TOES_UP = np.radians(18.0)  # so far toes bend up in the air to clear the floor
MOST_SPEED = np.radians(400.0)  # per second: of thigh and knee at both ends of a swing
MOST_PUSH = np.radians(5000.0)  # per second²
TIPTOE = 0.8  # of the foot's length from ball to ankle, which a foot on its ball adds to the leg
ENDING = 0.4  # of the swing: so long the speeds of the lift last, and those of the strike
ENDS = 5  # frames on the ground from which a swing takes its speeds


class Stance(NamedTuple):
    """One foot as its nearest footplant has it, frame by frame, also while it is in the air.

    `ankle` (F, 3) in metres; `pitch`, `yaw` (F,) in radians. `number` (F,) counts the footplant. `flat` and
    `planted` (F,) mark where ankle and ball stand still, `grounded` where heel or ball do. `load` (F,) is 1
    while the leg carries the body; `since` (F,) is the phase since the strike, which rests while a foot
    stands longer than usual. `push_off` (F,) goes from 0 at heel off to 1, where the pitch follows the leg:
    the foot turns about its `ball` (F, 3), metres.
    """

    ankle: Array
    pitch: Array
    yaw: Array
    number: Indices
    flat: Mask
    planted: Mask
    grounded: Mask
    load: Array
    since: Array
    push_off: Array
    ball: Array


def stand(plants: Sequence[Footplant], phase: Array, foot: Foot) -> Stance:
    """Roll one foot over its footplants, as its gait's tables say.

    Parameters
    ----------
    plants : in order; the first strikes before the first frame, the last one after the last.
    phase : shape (F,), cycles, never falling.
    foot : its shape.
    """
    middles = [(plant.lift + plant.next_strike) / 2 for plant in plants]
    number = np.searchsorted(middles, phase)
    earlier = [plants[0], *plants[:-1]]
    pieces = []
    for k in np.unique(number):
        pieces.append(_stand_on(earlier[k], plants[k], phase[number == k], foot))
    joined = Stance(*map(np.concatenate, zip(*pieces, strict=True)))
    return joined._replace(number=number)


def _stand_on(earlier: Footplant, plant: Footplant, phase: Array, foot: Foot) -> Stance:
    """Roll a foot over a footplant, from the middle of the swing before it to that of the next swing."""
    roll = plant.roll
    since = phase - plant.strike
    local = phase - plant.next_strike + 1
    until = roll.lift - local
    landing = since < roll.flat
    landing_angle = earlier.vigour * landing_pitch(roll, since)
    rising_angle = plant.vigour * rising_pitch(roll, local)
    pitch = np.where(landing, landing_angle, rising_angle)
    yaw = np.full_like(phase, plant.yaw)
    on_heel = about_heel(plant.position, yaw, pitch, foot)
    on_ball = about_ball(plant.position, yaw, pitch, foot)
    grounded = (since >= 0) & (until >= 0)
    planted = grounded & ~landing
    ankle = np.where(landing[:, None], on_heel, on_ball)
    flat = planted & (local <= roll.heel_off)
    load = _load(since / roll.lift, (roll.let_go - local) / roll.lift)
    late = np.maximum(roll.lift / 2, roll.lift - until)
    in_turn = np.where(since < roll.lift / 2, since, late)
    rising_time = PUSH_OFF * (roll.lift - roll.heel_off)
    rising = quintic_step((local - roll.heel_off) / rising_time)
    ball = np.tile(ball_of(plant, foot), (len(phase), 1))
    number = np.zeros(len(phase), int)
    return Stance(ankle, pitch, yaw, number, flat, planted, grounded, load, in_turn, rising, ball)


def _load(since: Array, until: Array) -> Array:
    """Load of a leg, 0 to 1, by the time since the strike and until it lets go, in shares of the stance."""
    return np.asarray(quintic_step((since + TOUCH) / (LOADED + TOUCH)) * quintic_step(until / LETTING_GO))


def push_off(plants: Sequence[Footplant], stance: Stance, hip: Array, knee: Array, foot: Foot) -> Stance:
    """Raise the heel of a standing foot until the knee bends as it should.

    From heel off the pitch passes from the gait's table to the one at which the knee bends by `knee` (F,),
    radians; `hip` (F, 3) is the hip joint, metres. The heel rises at least until the leg reaches the foot.
    """
    pitch = stance.pitch.copy()
    ankle = stance.ankle.copy()
    for number in np.unique(stance.number[stance.planted]):
        rising = np.flatnonzero((stance.number == number) & stance.planted & ~stance.flat)
        plant = plants[number]
        by_leg = pitch_for_leg(hip[rising], plant, leg_length(knee[rising]), foot)
        by_leg = -SOFT_HEEL * np.logaddexp(0, -by_leg / SOFT_HEEL)  # the heel stays above the floor
        pitch[rising] += stance.push_off[rising] * (by_leg - pitch[rising])
        reaching = pitch_for_leg(hip[rising], plant, leg_length(STRAIGHTEST), foot)
        pitch[rising] = np.minimum(pitch[rising], reaching)
        ankle[rising] = about_ball(plant.position, stance.yaw[rising], pitch[rising], foot)
    return stance._replace(pitch=pitch, ankle=ankle)


def target_knee(stance: Stance, timing: Timing) -> Array:
    """Flexion of the standing knee, radians, (F,): the less the walker moves, the more as in standing."""
    knee = mix([stance_knee(gait, stance.since) for gait in timing.gaits], timing.weights)
    upright = stance_knee(WALK, MID_STANCE)
    crouch = mix([stance_knee(gait, MID_STANCE) - upright for gait in timing.gaits], timing.weights)
    still = STANDING_KNEE + crouch
    return np.asarray(still + np.minimum(timing.vigour, 1.1) * (knee - still))


def pelvis_height(
    root: Array, hips: Mapping[str, Array], stances: Mapping[str, Stance], timing: Timing
) -> Array:
    """Height of the pelvis, metres, (F,), at which the loaded knees bend as they should.

    The targets t are those of the legs, weighted by their loads, and of the gait by its `height_weight`. The
    heights h, with second differences h'', minimise

        Σ weight (h - t)² + 150 Σ (h'')² + 400 Σ max(0, h - limit)².

    A sum of convex terms has one minimum. The last term turns on and off by frames, so a few rounds of least
    squares find it.

    Parameters
    ----------
    root : shape (F, 3): the pelvis at the gait's own height, metres.
    hips : {side: (F, 3)}: from the root to the hip joints, metres.
    stances : {side: the foot on the ground}.
    timing : of these frames.
    """
    gait_weight = _mixed(timing, "height_weight")
    targets = gait_weight * root[:, 1]
    weights = gait_weight.copy()
    limit = np.full(len(root), np.inf)
    for side, stance in stances.items():
        hip = root + hips[side]
        knee = target_knee(stance, timing)
        above_ankle = hip_above_ankle(stance.ankle - hip, knee) - hips[side][:, 1]
        targets += stance.load * (stance.ankle[:, 1] + above_ankle)
        weights += stance.load
        highest = _highest_hip(hip, stance, knee) - hips[side][:, 1]
        bound = stance.grounded | (stance.load > 0)
        limit = np.where(bound, np.minimum(limit, highest), limit)
    return _nearest_smooth(targets / weights, weights, limit)


def _highest_hip(hip: Array, stance: Stance, knee: Array) -> Array:
    """Height of a hip, metres, (F,), up to which its leg reaches the foot, flat or on its ball.

    `hip` (F, 3) gives its position over the floor, `knee` (F,) the target of the flexion on the ball.
    """
    flat = stance.ankle[:, 1] + hip_above_ankle(stance.ankle - hip, STRAIGHTEST)
    foot_length = np.hypot(FOOT.instep, FOOT.ankle - FOOT.ball)
    longest = leg_length(knee) + TIPTOE * foot_length
    squares = ((stance.ball - hip)[:, [0, 2]] ** 2).sum(axis=-1)
    on_ball = FOOT.ball + np.sqrt(np.maximum(longest**2 - squares, 0.01))
    slack = np.where(stance.grounded, 0.0, SLACK * (1 - stance.load))
    return np.where(stance.push_off > 0, on_ball, flat) + slack


def _mixed(timing: Timing, name: str) -> Array:
    """Mix a number of the gaits by their weights, (F,)."""
    numbers = np.array([getattr(gait, name) for gait in timing.gaits])
    return np.asarray(numbers @ timing.weights)


def _nearest_smooth(target: Array, weight: Array, limit: Array) -> Array:
    """Smooth curve (F,) near the targets by their weights, which keeps to the limit."""
    count = len(target)
    bands = np.zeros((3, count))  # of the matrix DᵀD; D takes second differences
    bands[2] = 6 * STIFF
    bands[2, [0, -1]] = STIFF
    bands[2, [1, -2]] = 5 * STIFF
    bands[1] = -4 * STIFF
    bands[1, [1, -1]] = -2 * STIFF
    bands[0] = STIFF
    above = np.zeros(count, bool)
    for _ in range(30):
        extra = np.where(above, REACH, 0.0)
        sides = weight * target + extra * np.where(above, limit, 0.0)
        matrix = bands.copy()
        matrix[2] += weight + extra
        height = solveh_banded(matrix, sides)
        if np.array_equal(above, height > limit):
            break
        above = height > limit
    return np.asarray(height)


def swing(
    plants: Sequence[Footplant], stance: Stance, hip: Array, heading: Array, timing: Timing
) -> FootPath:
    """Move one leg through the air between its footplants.

    Parameters
    ----------
    plants : of the foot.
    stance : of the foot, by `stand`.
    hip : shape (F, 3): the hip joint, metres.
    heading : shape (F,): where the pelvis faces, radians.
    timing : of these frames.

    Returns
    -------
    The foot's path over the F frames. It does not move, up to rounding, where `flat` and `planted` are set.
    """
    upright = rotations.about_y(-heading)
    on_ground = rotations.rotate(upright, stance.ankle - hip)
    angles = np.stack([*to_leg_angles(on_ground), stance.pitch], axis=-1)
    ankle = stance.ankle.copy()
    pitch = stance.pitch.copy()
    yaw = stance.yaw.copy()
    clearance = np.zeros(len(hip))
    for plant, following in pairwise(plants):
        share = (timing.phase - plant.lift) / (plant.next_strike - plant.lift)
        air = np.flatnonzero((share > 0) & (share < 1))
        if not len(air) or air[0] < ENDS or air[-1] + ENDS >= len(hip):
            continue  # the plan goes beyond the frames
        leg_angles, pitch[air] = _swing_angles(plant, angles, share, air, timing.gaits)
        reach = rotations.rotate(rotations.inverse(upright[air]), from_leg_angles(leg_angles))
        clearance[air] = CLEARANCE * _amid(share[air])
        ankle[air] = hip[air] + reach
        ankle[air, 1] += _lift_needed(ankle[air], pitch[air], clearance[air], share[air])
        yaw[air] = plant.yaw + quintic_step(share[air]) * (following.yaw - plant.yaw)
    toe = toe_angle(ankle, pitch, FOOT, clearance)
    return FootPath(ankle, pitch, yaw, toe, stance.flat, stance.planted)


def _swing_angles(
    plant: Footplant, ground: Array, share: Array, air: Indices, gaits: Sequence[Gait]
) -> tuple[LegAngles, Array]:
    """Angles of a leg in the air, and the pitch of its foot.

    `ground` (F, 4) are those while the foot is on the ground, `share` (F,) of the swing is 0 at the lift and
    1 at the strike, `air` lists the frames between. The angles keep value, speed and acceleration at both
    ends, and have the bump of the gait between.
    """
    leaving = slice(air[0] - ENDS, air[0])
    landing = slice(air[-1] + 1, air[-1] + 1 + ENDS)
    seconds = len(air) / FPS
    lift = _at_end(share[leaving], ground[leaving], 0.0, seconds)
    strike = _at_end(share[landing], ground[landing], 1.0, seconds)
    thigh, knee, splay, pitch = _between_ends(lift, strike, share[air, None]).T
    for weight, gait in zip(plant.weights, gaits, strict=True):
        amount = weight * plant.vigour
        thigh = thigh + amount * swing_bump(gait.swing_thigh, share[air])
        knee = knee + amount * swing_bump(gait.swing_knee, share[air])
        pitch = pitch + amount * swing_bump(gait.swing_pitch, share[air])
    return LegAngles(thigh, _bent(knee), splay), pitch


def _bent(knee: Array) -> Array:
    """Keep knees bent: κ becomes s log(1 + exp(κ / s)), s = 3°, which is above 0 and soon κ."""
    return np.asarray(SOFT_KNEE * np.logaddexp(0, knee / SOFT_KNEE))


def _at_end(share: Array, values: Array, end: float, seconds: float) -> Array:
    """Value, first and second derivative of angles (N, 4) at an end of a swing, by a cubic: (3, 4).

    A foot that strikes may push the leg faster than a swing can take over; speed and acceleration are
    limited to those of people.
    """
    value, speed, half_push = np.polynomial.polynomial.polyfit(share - end, values, 3)[:3]
    fastest = MOST_SPEED * seconds
    strongest = MOST_PUSH * seconds**2
    limited_speed = np.clip(speed, -fastest, fastest)
    return np.stack([value, limited_speed, np.clip(2 * half_push, -strongest, strongest)])


def _between_ends(start: Array, stop: Array, share: Array) -> Array:
    """Go from one value to another, with given first and second derivatives at both ends.

    Parameters
    ----------
    start, stop : value, first and second derivative (3, 4) with respect to `share`.
    share : shape (frames, 1), from 0 to 1.

    Returns
    -------
    The quintic step between the values, and at each end v u + a u² / 2 times (1 - u / w)³ (1 + 3 u / w),
    which is gone at u = w = 0.4: what happens at the lift does not shape the rest of the swing.
    """
    ends = start[0] + quintic_step(share) * (stop[0] - start[0])
    lifting = _dying(start[1], start[2], share)
    striking = _dying(-stop[1], stop[2], 1 - share)
    return np.asarray(ends + lifting + striking)


def _dying(speed: Array, push: Array, share: Array) -> Array:
    """Movement that begins with a speed and an acceleration, and is gone after 0.4 of the swing."""
    fresh = np.clip(1 - share / ENDING, 0, 1)
    slowly = fresh**3 * (1 + 3 * (1 - fresh))
    return np.asarray((speed * share + (push / 2) * share**2) * slowly)


def _amid(share: Array) -> Array:
    """Window over a swing: 0 at its ends, 1 in the middle third."""
    return quintic_step(3 * share) * quintic_step(3 - 3 * share)


def _lift_needed(ankle: Array, pitch: Array, clearance: Array, share: Array) -> Array:
    """Metres, (frames,), by which an ankle is raised so that its foot clears the floor.

    The ball stays above the floor after the lift, the toes clear it by `clearance` (frames,) in the second
    half of the swing, and the heel stays above it before the strike.
    """
    ball = ball_height(ankle, pitch, FOOT)
    early = quintic_step(share / 0.2) * quintic_step((0.8 - share) / 0.4)
    raised = _scaled(early, FOOT.ball - ball, (share > 0.08) & (share < 0.6))
    tip = ball + raised + FOOT.toe * np.sin(pitch + TOES_UP)
    middle = (4 * share * (1 - share)) ** 3
    raised += _scaled(middle, FOOT.ball + clearance - tip, (share > 0.45) & (share < 0.85))
    ankle_above_heel = FOOT.ankle * np.cos(pitch) + FOOT.heel * np.sin(pitch)
    heel = ankle[:, 1] + raised - ankle_above_heel
    late = quintic_step((share - 0.5) / 0.3) * quintic_step((1 - share) / 0.25)
    return raised + _scaled(late, -heel, (share > 0.6) & (share < 0.9))


def _scaled(bump: Array, needed: Array, frames: Mask) -> Array:
    """Scale a bump so that it is as high as needed in some frames, and nowhere below 0."""
    height = np.max(needed[frames] / bump[frames], initial=0.0)
    return np.asarray(height * bump)
