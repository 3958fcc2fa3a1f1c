"""Feet that stay where they stand: footskate cleaned up in the five steps of [KSG02].

Captured feet drift while they stand, and blended feet slide. So each plant gets one place (1); the places say
where the ankle must be (2); the root moves so that both legs reach (3); the legs bend (4); and around each
plant the corrections come and go smoothly (5).

Four things differ from the paper. Step 5 is taken with step 2, as one curve that bends least, instead of by
fades. While only the ball stands, the foot turns about it as the knee asks. The root only rises or falls, by
at most 2 cm, the pelvis lists by at most 4°, and no bone is stretched, because a skeleton's lengths are
fixed. And the root, the pelvis and all knees are found together, by the same sum that step 5 makes least, in
which a knee's angle counts most, so that no knee pops at any frame rate. A plant that the leg cannot reach,
or that would still jolt a knee, is moved to where its foot was then, and at last let go.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np
from scipy.ndimage import binary_propagation, maximum_filter1d

from mocap._shared.arrays import Array, Mask, runs
from mocap.body.kinematics import GlobalPoses, forward_kinematics
from mocap.body.limbs import Leg, find_legs
from mocap.body.motion import Motion, require_motion
from mocap.errors import MocapError, shortened, warn
from mocap.feet.ankle_targets import FootTarget, foot_target
from mocap.feet.footplants import least_frames, settle
from mocap.feet.hip_heights import Pelvis, find_pelvis, listed_rotations
from mocap.feet.least_bending import MOST, Excess, Held, hold_plants
from mocap.feet.leg_track import UP, LegTrack, pose_leg, track_leg

# Plants are moved by this fraction of the distance to their foot. With 0.25 or 0.35 slow walks accelerate by
# up to 1.27 times as much as they did.
FRACTION = 0.5
FALLS = 0.9  # Plants are moved again as long as the worst excess falls by this factor each time.


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
    held : for some ankles and balls where they shall stand, shape (F, 3), metres, nan where that is left
        open. All other plants are where they stand on average, or so much nearer that the leg reaches,
        or nearer to where the joint was when a knee would jolt.
    poses : the poses of the motion in the world, if they are known already.

    Returns
    -------
    The same frames. Within each plant its joint stays in one place, but for rounding. The root's height
    differs by at most 2 cm for a leg of 0.85 m, and the pelvis lists by at most 4° further. The rotations of
    hips, knees and ankles differ, and those of the joints that keep the trunk's direction. Contacts are
    settled: gaps shorter than 0.05 s are closed, and plants as short, or let go, are no longer marked.

    Raises
    ------
    MocapError : for legs that cannot be found, and marks that are missing.

    Warns
    -----
    MocapWarning : for plants that are let go. To hold them would take a longer leg, move the root further, or
        make a knee jump in 1/30 s by 0.6 % of the leg's length further than it did, and than is usual.

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
    for target, (bend, wanted) in zip(solution.targets, solution.poses, strict=True):
        pose[:, target.track.leg[:3]] = pose_leg(target.track, bend, wanted, target.turn, listed)
    released = marks_by_joint(motion, legs, settled & ~marks)
    _warn_of_plants_let_go(motion, released, MOST * tracks[0].length)
    contacts = {**motion.contacts, **marks_by_joint(motion, legs, marks)}
    roots = motion.root_positions + solution.rise[:, None] * UP
    return replace(motion, root_positions=roots, rotations=pose, contacts=contacts)


def _solve(
    tracks: Sequence[LegTrack], pelvis: Pelvis, marks: Mask, held: Mapping[int, Array] | None
) -> tuple[Mask, Held]:
    """Hold plants; move those that exceed bounds, and let go those for which that does not help.

    Returns
    -------
    The marks (L, 2, F) of the plants that are held, and the correction that holds them.
    """
    frames = marks.shape[-1]
    span = least_frames(tracks[0].motion.fps)
    moved = np.zeros((len(tracks), frames, 3))
    last_worst = np.inf
    moves = not held
    while True:
        # Steps 1, 2 and 5: each plant gets a place, and between plants the ankles go from place to place.
        legs = zip(tracks, marks, moved, strict=True)
        targets = [foot_target(track, mark, held or {}, shift) for track, mark, shift in legs]
        # Steps 3 and 4: the root rises or falls, the pelvis lists, and the knees bend.
        solution = hold_plants(targets, pelvis)
        excesses = solution.excesses
        if not excesses or not marks.any():
            return marks, solution
        worst = max(float(amount.max()) for _, amount in excesses)
        moves = moves and worst < FALLS * last_worst
        last_worst = worst
        if moves:
            for leg, frame in {(leg, frame) for leg, _, frame in _nearest(marks, excesses, span)}:
                moved[leg] += _towards_foot(solution.targets[leg], frame)
        else:
            # Each round unmarks at least one planted frame, so they end: at the latest when none is left.
            marks = let_go(marks, excesses, span)


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


def _towards_foot(target: FootTarget, frame: int) -> Array:
    """Move the plant of a frame towards where its joint was in that frame, (F, 3), metres."""
    kind = int(not target.marks[0, frame])
    joint = (target.track.ankle, target.track.ball)[kind]
    distance = joint[frame] - target.places[kind, frame]
    plant = binary_propagation(np.arange(len(target.planted)) == frame, mask=target.planted)
    return np.where(plant[:, None], FRACTION * distance, 0.0)


def let_go(marks: Mask, excesses: Sequence[Excess], span: int) -> Mask:
    """Unmark the plants nearest to where they go furthest beyond their bounds.

    Parameters
    ----------
    marks : shape (L, 2, F): when each leg's ankle and ball stand; settled for `span`.
    excesses : of legs with a plant each, above 0 somewhere.
    span : how many frames to unmark before and after, and how many a plant or a gap lasts at least.

    Returns
    -------
    Settled marks, a proper part of those given: a gap made here is as long as `span` or touches an end of the
    clip, so `settle` does not close it, and the frame nearest to the worst one is in it.
    """
    kept = marks.copy()
    for leg, joint, frame in _nearest(marks, excesses, span):
        row = kept[leg, joint]  # a part of `kept` itself
        row[max(frame - span, 0) : frame + span + 1] = False
        row[:] = settle(row, span)
    return kept


def _nearest(marks: Mask, excesses: Sequence[Excess], span: int) -> Iterator[tuple[int, int, int]]:
    """Give the plants nearest to the worst frames, as for `let_go`: leg, joint, and the plant's frame."""
    frames = np.arange(marks.shape[-1])
    for legs, amount in excesses:
        # The worst frames: no other frame within `span` is worse.
        is_peak = (amount > 0) & (amount == maximum_filter1d(amount, 2 * span + 1))
        for worst in np.flatnonzero(is_peak):
            distances = np.where(marks[legs], np.abs(frames - worst), len(frames))  # (legs, 2, F)
            nearest = distances.min()
            for plant in np.argwhere(distances.min(axis=-1) == nearest):  # two may be as near
                leg, joint = plant.tolist()
                yield leg + (legs.start or 0), joint, int(distances[leg, joint].argmin())


def _warn_of_plants_let_go(motion: Motion, released: Mapping[str, Mask], bound: float) -> None:
    """Warn of plants that were let go, in the order of the motion's contacts."""
    names = [name for name in motion.contacts if name in released]
    plants = [f"{name} {start}-{stop - 1}" for name in names for start, stop in runs(released[name])]
    if not plants:
        return
    listed = ", ".join(plants[:2]) + (f" and {len(plants) - 2} more" if len(plants) > 2 else "")
    reason = f"would move the root by more than {100 * bound:.2g} cm, stretch a leg or jolt a knee"
    warn(f"'{shortened(motion.name, 30)}': to hold these plants {reason}, so they are let go: {listed}.")
