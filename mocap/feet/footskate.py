"""Feet that stay where they stand: footskate cleaned up in the five steps of [KSG02].

Captured feet drift while they stand, and blended feet slide. Each footplant gets one position (1), from which
the positions of the ankle follow (2). The root moves so that both legs reach them (3), the legs bend (4), and
around each plant the corrections fade in and out (5).

Five things differ from the paper. Step 5 is taken with step 2, as the smoothest curve instead of fades. While
only the ball stands, the foot rotates about it as the knee requires. The toes keep their tilt. The root
only rises or falls, by at most 2 cm, the pelvis lists by at most 4°, and no bone is stretched, because a
skeleton's lengths are fixed. And the root, the pelvis and all knees minimise one sum, that of step 5, in
which the angle of a knee has the largest weight, so that no knee pops at any frame rate.

A plant that the leg cannot reach, or that would still jolt a knee, is moved to where its foot was then. If
that does not help, the plant is shortened to the frames that can be held: those that are left when the frames
in which its joint is furthest from its place are released, until no bound is exceeded.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np
from scipy.ndimage import binary_propagation, maximum_filter1d

from mocap._shared.arrays import Array, Mask, runs
from mocap.body.kinematics import GlobalPoses, forward_kinematics
from mocap.body.legs import Leg
from mocap.body.limbs import find_legs
from mocap.body.motion import Motion, require_motion, rotating_joints
from mocap.errors import MocapError, shortened, warn
from mocap.feet.ankle_targets import FootTarget, foot_target
from mocap.feet.footplants import least_frames, settle
from mocap.feet.hip_heights import Pelvis, find_pelvis, listed_rotations
from mocap.feet.least_bending import MOST, Excess, Held, hold_plants
from mocap.feet.leg_track import UP, LegTrack, kept_toes, pose_leg, track_leg
from mocap.feet.releasing import plant_deviations, release
from mocap.feet.tuned import TUNED


def clean_up(
    motion: Motion,
    legs: Sequence[Leg] | None = None,
    *,
    held: Mapping[int, Array] | None = None,
    poses: GlobalPoses | None = None,
) -> Motion:
    """Make planted feet stand still, at the cost of small changes to the legs and to the hips' heights.

    In the paper: [KSG02, all steps].

    Parameters
    ----------
    motion : its `contacts` say when the legs' ankles and balls stand; `feet.mark_plants` finds them.
    legs : by default those of `body.find_legs`.
    held : positions of some ankles and balls while they stand, shape (F, 3), metres, NaN in frames without
        one. All other plants are at the mean of their joint's positions, or so much nearer that the leg
        reaches, or nearer to the joint in the frame in which a knee would jolt.
    poses : the poses of the motion in the world, if they are known already.

    Returns
    -------
    The same frames. Within each plant its joint stays in one position, except for rounding. The root's height
    differs by at most 2 cm for a leg of 0.85 m, and the pelvis lists by at most 4° further. The rotations of
    hips, knees and ankles differ, and those of the joints that keep the trunk's direction and the toes' tilt.
    Contacts are settled: gaps shorter than 0.05 s are closed, and plants as short are no longer marked, nor
    are frames that are let go.

    Raises
    ------
    MocapError : for legs that cannot be found, and marks that are missing.

    Warns
    -----
    MocapWarning : for plants that are let go, as a whole or in the frames named. To hold them would take a
        longer leg, move the root further, or make a knee jump in 1/30 s by 0.6 % of the leg's length further
        than it did, and than is usual.

    Examples
    --------
    >>> from mocap.blending.joining import join
    >>> from mocap.datasets.samples import sample
    >>> walk = sample("walk_straight")
    >>> skating = join(walk, 500, walk, 242, 40)
    >>> rise = (clean_up(skating).root_positions - skating.root_positions)[:, 1]
    >>> bool(0.002 < abs(rise).max() < 0.01)
    True

    Notebook: 04b-feet
    """
    require_motion(motion)
    legs = find_legs(motion.skeleton) if legs is None else legs
    global_poses = forward_kinematics(motion) if poses is None else poses
    tracks = [track_leg(motion, leg, global_poses) for leg in legs]
    pelvis = find_pelvis(motion, legs, global_poses)
    settled = settled_marks(motion, legs)
    marks, solution = _solve(tracks, pelvis, settled, held)
    pose = listed_rotations(motion, pelvis, legs, global_poses, solution.angle)
    listed = pelvis.rotation(solution.angle)
    rotating = rotating_joints(motion)
    for target, (bend, wanted) in zip(solution.targets, solution.poses, strict=True):
        pose[:, target.track.leg[:3]] = pose_leg(target.track, bend, wanted, target.turn, listed)
        if target.track.leg.has_ball and rotating[target.track.leg.ball]:  # no toe bends that never did
            pose[:, target.track.leg.ball] = kept_toes(target.track, target.turn)
    released = marks_by_joint(motion, legs, settled & ~marks)
    _warn_of_plants_let_go(motion, released, MOST * tracks[0].length)
    contacts = {**motion.contacts, **marks_by_joint(motion, legs, marks)}
    roots = motion.root_positions + solution.rise[:, None] * UP
    return replace(motion, root_positions=roots, rotations=pose, contacts=contacts)


def _solve(
    tracks: Sequence[LegTrack], pelvis: Pelvis, marks: Mask, held: Mapping[int, Array] | None
) -> tuple[Mask, Held]:
    """Hold plants; move those that exceed bounds, and release frames if that does not help.

    Returns
    -------
    The marks (L, 2, F) of the plants that are held, and the correction that holds them.
    """
    held = held or {}
    moved = np.zeros((len(tracks), marks.shape[-1], 3))
    solution = _hold(tracks, pelvis, marks, held, moved)
    if not held:
        moved, solution = _move_plants(tracks, pelvis, marks, solution)
    # Each round unmarks at least one planted frame, so they end: at the latest when none is left.
    while solution.excesses and marks.any():
        deviations = plant_deviations(solution.targets, held)
        fewer = release(marks, solution.excesses, deviations, tracks[0].motion.fps)
        # A plant that is shortened starts again from the mean of the frames that are left.
        moved[_whole_plants(np.any(fewer != marks, axis=1), marks)] = 0.0
        marks = fewer
        solution = _hold(tracks, pelvis, marks, held, moved)
    return marks, solution


def _hold(
    tracks: Sequence[LegTrack], pelvis: Pelvis, marks: Mask, held: Mapping[int, Array], moved: Array
) -> Held:
    """Hold plants, moved by (L, F, 3) metres, whether or not the correction is within its bounds."""
    # Steps 1, 2 and 5: each plant gets a place, and between plants the ankles go from place to place.
    legs = zip(tracks, marks, moved, strict=True)
    targets = [foot_target(track, mark, held, shift) for track, mark, shift in legs]
    # Steps 3 and 4: the root rises or falls, the pelvis lists, and the knees bend.
    return hold_plants(targets, pelvis)


def _move_plants(
    tracks: Sequence[LegTrack], pelvis: Pelvis, marks: Mask, solution: Held
) -> tuple[Array, Held]:
    """Move plants that exceed bounds towards their feet, as long as the worst excess falls.

    The moves of plants that still exceed bounds at last are taken back.

    Returns
    -------
    The displacements of plants, (L, F, 3), metres, and the solution with them.
    """
    span = least_frames(tracks[0].motion.fps)
    moved = np.zeros((len(tracks), marks.shape[-1], 3))
    while solution.excesses and marks.any():
        tried = moved.copy()
        for leg, frame in set(_nearest(marks, solution.excesses, span)):
            tried[leg] += _towards_foot(solution.targets[leg], frame)
        changed = _hold(tracks, pelvis, marks, {}, tried)
        if changed.worst >= TUNED.falls * solution.worst:
            break
        moved = tried
        solution = changed
    if solution.excesses:
        moved[_due_plants(marks, solution.excesses, span)] = 0.0
        solution = _hold(tracks, pelvis, marks, {}, moved)
    return moved, solution


def settled_marks(motion: Motion, legs: Sequence[Leg]) -> Mask:
    """Read when each leg's ankle and ball stand, (L, 2, F), short plants and gaps settled.

    The ball of a foot without toes never stands.
    """
    names = [[motion.skeleton.names[joint] for joint in (leg.ankle, leg.ball)] for leg in legs]
    missing = [name for pair in names for name in pair if name not in motion.contacts]
    if missing:
        unknown = f"when these joints stand: {', '.join(missing)}"
        raise MocapError(f"'{motion.name}' does not say {unknown}; mark_plants finds out.")
    span = least_frames(motion.fps)
    marks = np.array([[settle(motion.contacts[name], span) for name in pair] for pair in names])
    marks[[not leg.has_ball for leg in legs], 1] = False
    return marks


def marks_by_joint(motion: Motion, legs: Sequence[Leg], marks: Mask) -> dict[str, Mask]:
    """Return when joints stand, by their names, of marks (L, 2, F) as from `settled_marks`."""
    by_name = {}
    for leg, leg_marks in zip(legs, marks, strict=True):
        for joint, mark in zip(leg[2:] if leg.has_ball else leg[2:3], leg_marks, strict=False):
            by_name[motion.skeleton.names[joint]] = mark
    return by_name


def _due_plants(marks: Mask, excesses: Sequence[Excess], span: int) -> Mask:
    """Find the plants of feet that are nearest to local maxima of excesses, (L, F)."""
    due = np.zeros((len(marks), marks.shape[-1]), bool)
    for leg, frame in _nearest(marks, excesses, span):
        due[leg, frame] = True
    return _whole_plants(due, marks)


def _whole_plants(seeds: Mask, marks: Mask) -> Mask:
    """Find all frames of the plants of feet that have a seed, (L, F), by marks (L, 2, F)."""
    pairs = zip(seeds, marks, strict=True)
    return np.array([binary_propagation(seed, mask=mark.any(axis=0)) for seed, mark in pairs])


def _towards_foot(target: FootTarget, frame: int) -> Array:
    """Move the plant of a frame towards where its joint was in that frame, (F, 3), metres."""
    kind = int(not target.marks[0, frame])
    joint = (target.track.ankle, target.track.ball)[kind]
    distance = joint[frame] - target.places[kind, frame]
    plant = binary_propagation(np.arange(len(target.planted)) == frame, mask=target.planted)
    return np.where(plant[:, None], TUNED.move * distance, 0.0)


def _nearest(marks: Mask, excesses: Sequence[Excess], span: int) -> Iterator[tuple[int, int]]:
    """Yield the legs and the frames of the plants that are nearest to local maxima of excesses."""
    frames = np.arange(marks.shape[-1])
    for legs, amount in excesses:
        # The worst frames: no other frame within `span` is worse.
        is_peak = (amount > 0) & (amount == maximum_filter1d(amount, 2 * span + 1))
        for worst in np.flatnonzero(is_peak):
            distances = np.where(marks[legs], np.abs(frames - worst), len(frames))  # (legs, 2, F)
            nearest = distances.min()
            for plant in np.argwhere(distances.min(axis=-1) == nearest):  # two may be as near
                leg, joint = plant.tolist()
                yield leg + (legs.start or 0), int(distances[leg, joint].argmin())


def _warn_of_plants_let_go(motion: Motion, released: Mapping[str, Mask], bound: float) -> None:
    """Warn of plants that were let go, in the order of the motion's contacts."""
    names = [name for name in motion.contacts if name in released]
    plants = [f"{name} {start}-{stop - 1}" for name in names for start, stop in runs(released[name])]
    if not plants:
        return
    listed = ", ".join(plants[:2]) + (f" and {len(plants) - 2} more" if len(plants) > 2 else "")
    reason = f"would move the root by more than {100 * bound:.2g} cm, stretch a leg or jolt a knee"
    warn(f"'{shortened(motion.name, 30)}': to hold these plants {reason}, so they are let go: {listed}.")
