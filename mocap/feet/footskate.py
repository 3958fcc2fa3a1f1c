"""Feet that stay where they stand: footskate cleaned up in the five steps of [KSG02].

Captured feet creep while they stand, blended feet slide. So each plant gets one place (1), which tells where
the ankle shall be (2); the root moves so that both legs reach (3); the legs bend (4); and around each plant
the corrections come and go smoothly (5). Three departures from the paper. Step 5 is taken with step 2, as
one curve that bends least, instead of by fades. While only the ball stands, the foot may turn about it, so
that the ankle need not follow. And no bone is ever stretched, a skeleton's lengths being fixed: instead
the root moves up or down by what keeps the knees bent as they were, eased where a knee would jolt; and a
plant that would move it further than 2 cm, or still jolt a knee, is let go there.
"""

import warnings
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from scipy.ndimage import maximum_filter1d

from mocap._shared.arrays import Array, Mask, runs
from mocap.body.kinematics import GlobalPoses, forward_kinematics
from mocap.body.limbs import Leg, legs_of
from mocap.body.motion import Motion
from mocap.errors import MocapError, MocapWarning
from mocap.feet.ankle_targets import FootTarget, foot_target
from mocap.feet.footplants import least_frames, settle
from mocap.feet.knee_smoothing import smooth_knees
from mocap.feet.leg_ik import knee_hinge, pose_leg
from mocap.feet.root_height import MOST, root_rise

Costs = list[tuple[Sequence[Leg], Array]]  # by legs: what their plants cost in each frame, if above 0

JOLT = 0.001  # by how much more than a knee ever jolts it may jolt afterwards


def clean_up(motion: Motion, legs: Sequence[Leg] | None = None) -> Motion:
    """Make planted feet stand still, at the cost of small changes to the legs and to the root's height.

    Parameters
    ----------
    motion : its `contacts` tell when the legs' ankles and balls stand; `feet.mark_plants` marks them.
    legs : found by name by default.

    Returns
    -------
    The same frames; within each plant its joint stays in one place, to rounding. Only the root's height,
    by at most 2 cm, the hips, knees and ankles differ. Contacts are settled: a plant, or a gap between two,
    that is shorter than 0.05 s is none, and nor is one that was let go.

    Raises
    ------
    MocapError : for legs that cannot be found, and marks that are missing.

    Warns
    -----
    MocapWarning : for plants that are let go around the frames where to hold them would take a longer leg,
        move the root further, or make a knee's acceleration larger than 99.9 % of the knees' own are.

    Examples
    --------
    >>> from mocap.blending.joining import join
    >>> from mocap.datasets.generated import generate
    >>> walk = generate("walk_straight")
    >>> skating = join(walk, 500, walk, 233, 40)
    >>> rise = (clean_up(skating).root_positions - skating.root_positions)[:, 1]
    >>> bool(0.002 < abs(rise).max() < 0.01)
    True

    Notebook: 04-blending
    """
    legs = legs_of(motion.skeleton, legs)
    motion = replace(motion, contacts={**motion.contacts, **_settled_contacts(motion, legs)})
    poses = forward_kinematics(motion)
    motion, targets, rise = _affordable(motion, legs, poses)
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


def _affordable(
    motion: Motion, legs: Sequence[Leg], poses: GlobalPoses
) -> tuple[Motion, list[FootTarget], Array]:
    """Let plants go until the rest jolts no knee and moves the root by `MOST` at most.

    Returns the motion with contacts anew, the targets, and the root's rise, (F,) metres.
    """
    start = motion
    while True:
        targets = [foot_target(motion, leg, poses) for leg in legs]
        rise = root_rise(motion, legs, poses, targets)
        costs: Costs = [(legs, np.abs(rise) - MOST), *_lacks(motion, legs, poses, targets, rise)]
        if all(cost.max() <= 0 for _, cost in costs):
            rise, targets, jolts = smooth_knees(motion, legs, poses, targets, rise)
            costs = [(legs, np.abs(rise) - MOST), (legs, jolts - JOLT)]
        if all(cost.max() <= 0 for _, cost in costs) or not any(target.planted.any() for target in targets):
            break
        motion = _let_go(motion, costs)
    gone = {name: runs(marks & ~motion.contacts[name]) for name, marks in start.contacts.items()}
    told = [f"{name} {a}-{b - 1}" for name, rows in gone.items() for a, b in rows]
    if told:
        warnings.warn(
            f"'{motion.name}': to hold these plants would move the root by more than {100 * MOST:.0f} cm, "
            f"stretch a leg or jolt a knee, so they are let go: {', '.join(told[:4])}"
            + (f" and {len(told) - 4} more." if len(told) > 4 else "."),
            MocapWarning,
            stacklevel=3,
        )
    return motion, targets, rise


def _lacks(
    motion: Motion, legs: Sequence[Leg], poses: GlobalPoses, targets: Sequence[FootTarget], rise: Array
) -> Costs:
    """Measure for each leg how much it is too short where it is planted, (F,), metres."""
    lacks: Costs = []
    for leg, target in zip(legs, targets, strict=True):
        reach = knee_hinge(leg, poses, motion.skeleton.names[leg.knee]).reach
        wanted = target.ankle - poses.positions[:, leg.hip] - rise[:, None] * [0.0, 1.0, 0.0]
        lack = np.linalg.norm(wanted, axis=-1) - reach - 1e-9
        lacks.append(([leg], np.where(target.planted, lack, -1.0)))
    return lacks


def _let_go(motion: Motion, costs: Costs) -> Motion:
    """Unmark the plants nearest to where the costs are worst, for `SPAN` before and after."""
    contacts = {name: marks.copy() for name, marks in motion.contacts.items()}
    span = least_frames(motion.fps)
    for legs, cost in costs:
        names = [motion.skeleton.names[joint] for leg in legs for joint in (leg.ankle, leg.ball)]
        for worst in np.flatnonzero((cost > 0) & (cost == maximum_filter1d(cost, 2 * span + 1))):
            marked = np.array([motion.contacts[name] for name in names])
            away = np.where(marked, np.abs(np.arange(len(motion)) - worst), len(motion))
            for name, gaps in zip(names, away, strict=True):
                if gaps.min() == away.min():
                    near = int(gaps.argmin())
                    contacts[name][max(near - span, 0) : near + span + 1] = False
                    contacts[name] = settle(contacts[name], span)
    return replace(motion, contacts=contacts)


def _within_reach(motion: Motion, leg: Leg, poses: GlobalPoses, target: FootTarget) -> Array:
    """Let a foot in the air go only as far as its leg; a planted one must be reached."""
    hip = poses.positions[:, leg.hip]
    reach = knee_hinge(leg, poses, motion.skeleton.names[leg.knee]).reach
    apart = target.ankle - hip
    share = np.minimum(reach / np.linalg.norm(apart, axis=-1), 1.0)
    return np.asarray(hip + np.where(target.planted, 1.0, share)[:, None] * apart)
