"""Strides that change from one kind to another, such as from a walk to a jog, by blending over the phases."""

import warnings
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mocap._shared.arrays import Array, Indices, runs
from mocap._shared.easing import quintic_step
from mocap.body import rotations
from mocap.body.kinematics import joint_positions
from mocap.body.limbs import find_legs
from mocap.body.motion import Motion
from mocap.body.planar import PlanarTransform, on_ground
from mocap.errors import MocapError, MocapWarning
from mocap.feet.footskate import clean_up
from mocap.methods.parametric_graphs.examples import FINE, Examples
from mocap.methods.parametric_graphs.stride_spaces import measure_mixes
from mocap.methods.parametric_graphs.tuned import TUNED


def changing_strides(first: Examples, second: Examples, *, stands: str = "") -> Examples:
    """Blend strides of one kind into strides of another, phase by phase [ours; KG03's transition on phases].

    Each stride of the first kind is paired with the stride of the second kind with the most similar turn. All
    rates and poses are blended smoothly between the phases 0.2 and 0.8. Therefore the start matches strides
    of the first kind, and the end those of the second. A foot moves from its position in the first kind to
    that in the second while it swings, and rests before and after.

    Parameters
    ----------
    first, second : examples over the same phases, of one skeleton and rate.
    stands : "first" or "second" for examples that do not walk, such as punches. Only their end or their
        beginning is used, and the turns in a pair may differ.

    Returns
    -------
    At most 60 examples with turns that both kinds have, without pairs in which a foot does not swing.

    Raises
    ------
    MocapError, SkeletonMismatch : for examples over different phases, of different skeletons or rates, and
        for steps, in which one foot stands.

    Examples
    --------
    >>> from mocap.datasets.samples import sample
    >>> from mocap.body import resample
    >>> from mocap.methods.parametric_graphs.strides import cut_strides
    >>> kinds = [cut_strides([resample(sample(f"walk_6m_{speed}_0"), 30)]) for speed in (0.7, 1.65)]
    >>> speeds = [kind.values[:, 1].mean() for kind in (kinds[0], changing_strides(*kinds), kinds[1])]
    >>> np.round(speeds, 2).tolist()
    [0.7, 1.08, 1.7]
    """
    if len(first.grid) != len(second.grid) or not np.allclose(first.grid, second.grid):
        raise MocapError("A change goes between examples over the same phases.")
    first.require_joinable(second)
    first_rows, second_rows = _pairs(first, second, any_turn=bool(stands))
    first = first.take(first_rows)
    second = second.take(second_rows)
    if stands == "first":
        first = _still_outside(first, -1, TUNED.change_from)
    elif stands == "second":
        second = _still_outside(second, TUNED.change_to, 2)
    fractions = _fractions(first, second)
    complete = np.flatnonzero(np.isfinite(fractions).all(axis=(1, 2)))
    if not complete.size:
        raise MocapError("In a change each foot swings, but in none of the pairs: cut strides, not steps.")
    first = first.take(complete)
    second = second.take(complete)
    fractions = fractions[complete]
    faded = _faded(first, second, fractions)
    changes = _with_feet_led(faded, first, second, fractions)
    return replace(changes, values=measure_mixes(changes, np.eye(len(changes))))


def _fractions(first: Examples, second: Examples) -> Array:
    """Compute the blend weight of the second kind at each phase, for each joint, (N, G, J).

    The joints of a leg are blended while it swings. Their weights are NaN if it never does.
    """
    grid = first.grid
    skeleton = first.skeleton
    first_contacts = np.where(grid[:, None] < 1, first.contacts, 1)
    second_contacts = np.where(grid[:, None] > 0, second.contacts, 1)
    contacts = first_contacts * second_contacts
    fade = quintic_step((grid - TUNED.change_from) / (TUNED.change_to - TUNED.change_from))
    fractions = np.tile(fade[:, None], (len(first), 1, len(skeleton)))
    for leg in find_legs(skeleton):
        ankle = first.contact_names.index(skeleton.names[leg.ankle])
        ball = first.contact_names.index(skeleton.names[leg.ball])
        for row in range(len(first)):
            start, stop = _swing(first, contacts[row, :, ankle], contacts[row, :, ball])
            fractions[row, :, list(leg)] = quintic_step((grid - start) / (stop - start))
    return fractions


def _swing(examples: Examples, ankle: Array, ball: Array) -> tuple[float, float]:
    """Return the phases at which the longest swing of a foot starts and stops, or NaN if it never swings.

    Parameters
    ----------
    examples : their grid has G phases.
    ankle, ball : shape (G,), contacts.
    """
    first, last = examples.ends
    later = TUNED.strike_phases
    swings = [swing for swing in runs(ankle < 0.5) if first + later < swing[1] <= last + later]
    if not swings:
        return np.nan, np.nan
    ankle_lift, strike = max(swings, key=np.ptp)
    lift = ankle_lift + ball[ankle_lift:strike].argmin() - 1  # the ball leaves the ground last
    start, stop = np.clip(examples.grid[[max(lift, 0), strike]], *TUNED.step_phases)
    return float(start), float(stop)


def _faded(first: Examples, second: Examples, fractions: Array) -> Examples:
    """Blend poses with the weights of their joints, and rates with those of the root.

    A foot has no contact while it is blended. The rate of time is blended, not time itself.
    """
    root_fraction = fractions[..., 0]

    def fade(start: NDArray[Any], end: NDArray[Any]) -> NDArray[Any]:
        return np.asarray((1 - root_fraction) * start + root_fraction * end)

    step = first.grid[1] - first.grid[0]
    first_rate, second_rate = (np.gradient(kind.seconds, step, axis=1) for kind in (first, second))
    contact_joints = [first.skeleton.index(name) for name in first.contact_names]
    feet = fractions[..., contact_joints]
    second_contacts = np.where(feet >= 1, second.contacts, 0)
    # reads: statement: one field a line
    return replace(
        first,
        seconds=first.integrated(fade(first_rate, second_rate)),
        speeds=fade(first.speeds, second.speeds),
        turning=fade(first.turning, second.turning),
        heights=fade(first.heights, second.heights),
        poses=_faded_poses(first.poses, second.poses, fractions[..., None]),
        contacts=np.where(feet <= 0, first.contacts, second_contacts),
        sway=(first.sway + second.sway) / 2,
        offset=(first.offset + second.offset) / 2,
        dropped=0,
    )


def _faded_poses(first: Array, second: Array, fractions: Array) -> Array:
    """Interpolate unit quaternions (N, G, J, 4) linearly, along the shorter arc, and normalise them."""
    opposite = (first * second).sum(axis=-1, keepdims=True) < 0  # q and -q are one rotation
    poses = (1 - fractions) * first + fractions * np.where(opposite, -1, 1) * second
    return np.asarray(poses / np.linalg.norm(poses, axis=-1, keepdims=True))


def _with_feet_led(faded: Examples, first: Examples, second: Examples, fractions: Array) -> Examples:
    """Constrain each foot to a blend of its paths in both kinds, which are aligned at phase 1."""
    poses = faded.poses.copy()
    heights = faded.heights.copy()
    _, last = faded.ends
    positions = np.arange(float(len(faded.grid)))
    for row, weights in enumerate(np.eye(len(faded))):
        fps = FINE / faded.seconds[row, last]
        motion, facing = faded.motion(weights, positions, fps)
        source, _ = first.motion(weights, positions, fps)
        target, target_facing = second.motion(weights, positions, fps)
        rotation = np.exp(1j * (facing[last] - target_facing[last]))
        aligned = _aligned_at(last, target, motion, rotation)
        source_joints = joint_positions(source)
        shift = joint_positions(aligned) - source_joints
        clean = _lead_feet(motion, source_joints + fractions[row, ..., None] * shift)
        clean_poses = clean.rotations.copy()
        clean_poses[:, 0] = rotations.multiply(rotations.about_y(-facing), clean_poses[:, 0])
        opposite = (clean_poses * poses[row]).sum(axis=-1, keepdims=True) < 0
        poses[row] = clean_poses * np.where(opposite, -1, 1)
        heights[row] = clean.root_positions[:, 1]
    return replace(faded, heights=heights, poses=poses)


def _aligned_at(frame: int, motion: Motion, reference: Motion, rotation: complex) -> Motion:
    """Rotate a motion, and translate its root in one frame to that of a reference."""
    start = on_ground(motion.root_positions[frame])
    end = on_ground(reference.root_positions[frame])
    return PlanarTransform.from_complex(rotation, end - rotation * start).apply_motion(motion)


def _lead_feet(motion: Motion, paths: Array) -> Motion:
    """Make ankles and balls follow the paths of their joints (F, J, 3), and remove foot sliding.

    `clean_up` solves the inverse kinematics: a foot that is marked in all frames is held on its path.
    """
    always = dict.fromkeys(motion.contacts, np.ones(len(motion), bool))
    held = dict(enumerate(np.swapaxes(paths, 0, 1)))
    with warnings.catch_warnings(action="ignore", category=MocapWarning):  # of feet in the air
        led = clean_up(replace(motion, contacts=always), held=held)
    return clean_up(replace(led, contacts=motion.contacts))


def _still_outside(examples: Examples, low: float, high: float) -> Examples:
    """Freeze the poses and the motion of examples before phase `low` and after phase `high`."""
    rows = np.searchsorted(examples.grid, np.clip(examples.grid, low, high) - 1e-9)
    is_moving = rows == np.arange(len(rows))
    # reads: statement: one field a line
    return replace(
        examples,
        speeds=examples.speeds * is_moving,
        turning=examples.turning * is_moving,
        heights=examples.heights[:, rows],
        poses=examples.poses[:, rows],
        contacts=np.maximum(examples.contacts, ~is_moving[:, None]),
    )


def _pairs(first: Examples, second: Examples, any_turn: bool) -> tuple[Indices, Indices]:
    """Pair examples of two kinds, in any combination or with the most similar turns.

    Without `any_turn`, examples whose turn is more than 5° outside those of the second kind are left out.
    """
    turns = first.values[:, 0]
    second_turns = second.values[:, 0]
    lowest = second_turns.min() - TUNED.turn_beyond
    highest = second_turns.max() + TUNED.turn_beyond
    is_within = (turns >= lowest) & (turns <= highest)
    usable = np.flatnonzero(any_turn | is_within)
    if not usable.size:
        raise MocapError("The two kinds have no turn in common, so that none can change into the other.")
    first_rows = usable[_spread(turns[usable])]
    if any_turn:
        count = min(max(len(turns), len(second_turns)), TUNED.change_examples)
        return np.resize(first_rows, count), np.resize(_spread(second_turns), count)
    differences = np.abs(turns[first_rows][:, None] - second_turns)
    return first_rows, differences.argmin(axis=1)


def _spread(turns: Array) -> Indices:
    """Return the rows of at most `TUNED.change_examples` turns, evenly spread over their ascending order."""
    ascending = np.argsort(turns)
    evenly = np.linspace(0, len(turns) - 1, TUNED.change_examples).round().astype(int)
    return np.asarray(ascending[np.unique(evenly)])
