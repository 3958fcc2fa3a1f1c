"""Feet that stay where they stand: footskate cleaned up in the five steps of [KSG02].

Captured feet creep while they stand, blended feet slide. So each plant gets one place (1), which tells where
the ankle shall be (2); the root moves so that both legs reach (3); the legs bend (4); and around each plant
the corrections come and go smoothly (5). Three departures from the paper. Step 5 is taken with step 2, as
one curve that bends least, instead of by fades. While only the ball stands, the foot may turn about it, so
that the ankle need not follow. And no bone is ever stretched, a skeleton's lengths being fixed: instead
the root moves up or down by what keeps the knees bent as they were, and a plant out of reach is an error.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.ndimage import gaussian_filter1d, maximum_filter1d

from mocap import rotations
from mocap.errors import MocapError
from mocap.kinematics import GlobalPoses, forward_kinematics
from mocap.leg_posing import knee_hinge, pose_leg
from mocap.legs import Leg, legs_of
from mocap.motion import Motion
from mocap.plants import least_frames, runs, settle

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

FADE = 0.06  # seconds in which a correction dies away, where no other plant is near
STRAIGHT = np.radians(5.0)  # a knee less bent counts as bent by this: no leg rules the root alone


class FootTarget(NamedTuple):
    """Where an ankle shall be, `ankle` (F, 3) in metres, and how its foot turns, `turn` (F, 3) in radians.

    Turns are rotation vectors in the world's frame; `planted` (F,) says when the ankle or the ball stands.
    """

    ankle: Array
    turn: Array
    planted: Mask


def clean_up(motion: Motion, legs: Sequence[Leg] | None = None) -> Motion:
    """Make planted feet stand still, at the cost of small changes to the legs and to the root's height.

    Parameters
    ----------
    motion : its `contacts` tell when the legs' ankles and balls stand; `plants.mark_plants` marks them.
    legs : found by name by default.

    Returns
    -------
    The same frames; within each plant its joint stays in one place, to rounding. Only the root's height,
    the hips, knees and ankles differ. Contacts are settled: a plant, or a gap between two, that is shorter
    than 0.05 s is none.

    Raises
    ------
    MocapError : for legs that cannot be found, marks that are missing, and a foot out of its leg's reach.

    Examples
    --------
    >>> from mocap.joining import join
    >>> from mocap.synthetic import generate
    >>> walk = generate("walk_straight")
    >>> skating = join(walk, 500, walk, 233, 40)
    >>> rise = (clean_up(skating).root_positions - skating.root_positions)[:, 1]
    >>> bool(0.002 < abs(rise).max() < 0.01)
    True
    """
    legs = legs_of(motion.skeleton, legs)
    motion = replace(motion, contacts={**motion.contacts, **_settled_contacts(motion, legs)})
    poses = forward_kinematics(motion)
    targets = [foot_target(motion, leg, poses.positions) for leg in legs]
    rise = _root_rise(motion, legs, poses, targets)
    poses = GlobalPoses(poses.positions + rise[:, None, None] * [0.0, 1.0, 0.0], poses.matrices)
    pose = motion.rotations.copy()
    for leg, target in zip(legs, targets, strict=True):
        ankle = _within_reach(motion, leg, poses, target)
        pose[:, leg[:3]] = pose_leg(motion, leg, poses, ankle, target.turn)
    roots = motion.root_positions + rise[:, None] * [0.0, 1.0, 0.0]
    return replace(motion, root_positions=roots, rotations=pose)


def _settled_contacts(motion: Motion, legs: Sequence[Leg]) -> dict[str, Mask]:
    joints = [motion.skeleton.names[joint] for leg in legs for joint in (leg.ankle, leg.ball)]
    if missing := [joint for joint in joints if joint not in motion.contacts]:
        raise MocapError(
            f"'{motion.name}' does not say when these joints stand: {', '.join(missing)}; "
            "mark_plants finds out."
        )
    return {joint: settle(motion.contacts[joint], least_frames(motion.fps)) for joint in joints}


def foot_target(motion: Motion, leg: Leg, positions: Array) -> FootTarget:
    """Place a foot's plants, and carry its ankle from one to the next: steps 1, 2 and 5 of [KSG02].

    Parameters
    ----------
    motion : with contacts for the leg's ankle and ball.
    leg : whose foot.
    positions : of all joints, shape (F, J, 3), metres.
    """
    ankle, ball = positions[:, leg.ankle], positions[:, leg.ball]
    flat, down = (motion.contacts[motion.skeleton.names[joint]] for joint in (leg.ankle, leg.ball))
    length = float(leg.lengths(motion.skeleton)[2])
    places = place_plants((ankle, ball), (flat, down), length)
    # Where only the ball stands, the ankle stays as near as the foot's length allows to where it is on its
    # way from and to its own plants: that the foot must turn a little is seen less than a leg that stretches.
    near = ankle + smooth_fill(places[0] - ankle, flat, motion.fps)
    away = near - places[1]
    behind = places[1] + length * away / np.linalg.norm(away, axis=-1, keepdims=True)
    goal = np.where(flat[:, None], places[0], behind)
    turn = np.zeros_like(ankle)
    turn[down] = rotations.to_rotvec(rotations.between((ball - ankle)[down], (places[1] - goal)[down]))
    moved = smooth_fill(goal - ankle, flat | down, motion.fps)
    return FootTarget(ankle + moved, smooth_fill(turn, down, motion.fps), flat | down)


def place_plants(joints: tuple[Array, Array], marks: tuple[Mask, Mask], length: float) -> Array:
    """Give each plant of an ankle and its ball one place: where the joint is on average [KSG02, step 1].

    A plant that starts while the other joint stands is placed a foot's length from that, in the mean
    direction, so that the rigid foot fits both.

    Parameters
    ----------
    joints : the ankle's and the ball's positions, (F, 3) each, metres.
    marks : when they stand, (F,) each.
    length : from ankle to ball, metres.

    Returns
    -------
    Shape (2, F, 3): the places while a joint stands, and the joints' own positions elsewhere.
    """
    places = np.array(joints)
    placed = np.zeros((2, len(places[0])), bool)
    plants = sorted((start, stop, kind) for kind in (0, 1) for start, stop in runs(marks[kind]).tolist())
    for start, stop, kind in plants:
        own, other = joints[kind], joints[1 - kind]
        place = own[start:stop].mean(axis=0)
        if placed[1 - kind, start]:
            together = np.flatnonzero(placed[1 - kind, start:stop]) + start
            away = (own - other)[together].mean(axis=0)
            place = places[1 - kind, start] + length * away / np.linalg.norm(away)
        places[kind, start:stop], placed[kind, start:stop] = place, True
    return places


def _root_rise(
    motion: Motion, legs: Sequence[Leg], poses: GlobalPoses, targets: Sequence[FootTarget]
) -> Array:
    """Raise or lower the root so that the knees change little and both legs reach: step 3 of [KSG02].

    A rise h makes the leg from a hip to its target d + g h long, g the upright share of its direction, and a
    knee bent by φ turns by as much as the length changes, over sin φ. Least squares over the legs
    and the rise itself, Σ ((d + g h - d_before) / sin φ)² + h², has the solution below.
    """
    above, below = np.zeros(len(motion)), np.ones(len(motion))
    limit = np.full(len(motion), np.inf)
    for leg, target in zip(legs, targets, strict=True):
        hinge = knee_hinge(leg, poses, motion.skeleton.names[leg.knee])
        hip = poses.positions[:, leg.hip]
        before = np.linalg.norm(poses.positions[:, leg.ankle] - hip, axis=-1)
        apart = hip - target.ankle
        distance = np.linalg.norm(apart, axis=-1)
        upright = apart[:, 1] / distance
        stiffness = 1 / (np.sin(hinge.straight) ** 2 + np.sin(STRAIGHT) ** 2)
        above += stiffness * upright * (before - distance)
        below += stiffness * upright**2
        reach = np.minimum(hinge.reach, before.max())  # no straighter than the clip ever is
        level = apart[:, 0] ** 2 + apart[:, 2] ** 2
        limit = np.minimum(limit, np.sqrt(np.maximum(reach**2 - level, 0.0)) - apart[:, 1])
    rise = above / below
    radius = round(FADE * motion.fps)
    # A maximum as wide as the bell that smooths it: what is taken off stays enough.
    excess = maximum_filter1d(np.maximum(rise - limit, 0.0), 2 * radius + 1)
    return np.asarray(rise - gaussian_filter1d(excess, radius / 2, radius=radius))


def _within_reach(motion: Motion, leg: Leg, poses: GlobalPoses, target: FootTarget) -> Array:
    """Let a foot in the air go only as far as its leg; a planted one must be reached."""
    hip = poses.positions[:, leg.hip]
    reach = knee_hinge(leg, poses, motion.skeleton.names[leg.knee]).reach
    apart = target.ankle - hip
    share = np.minimum(reach / np.linalg.norm(apart, axis=-1), 1.0)
    return np.asarray(hip + np.where(target.planted, 1.0, share)[:, None] * apart)


def smooth_fill(values: Array, known: Mask, fps: float) -> Array:
    """Fill in the frames that are not known with the curve that bends least and stays near 0.

    It minimises Σ |c_{f-1} - 2 c_f + c_{f+1}|² + κ⁴ Σ |c_f|² with the known frames held: value and slope go
    on at both ends of a plant, and die away within `FADE` = 1 / (κ · fps) where the next plant is far.

    Parameters
    ----------
    values : shape (F, C); what stands in frames not known does not matter.
    known : shape (F,).
    fps : frames a second.

    Returns
    -------
    Shape (F, C); all 0 where nothing is known.

    Examples
    --------
    >>> smooth_fill(np.array([[0.0], [9], [1]]), np.array([True, False, True]), 120.0).round(3)[:, 0]
    array([0. , 0.5, 1. ])
    """
    filled = np.where(known[:, None], values, 0.0)
    if known.all() or not known.any():
        return filled
    frames = len(values)
    bend = sparse.diags([1.0, -2.0, 1.0], [0, 1, 2], shape=(max(frames - 2, 0), frames))
    cost = (bend.T @ bend + (FADE * fps) ** -4.0 * sparse.identity(frames)).tocsc()
    free = ~known
    pull = cost[free][:, known] @ filled[known]
    filled[free] = -sparse.linalg.splu(cost[free][:, free].tocsc()).solve(pull)
    return filled
