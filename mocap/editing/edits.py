"""Edits: a motion changed smoothly so that its joints meet constraints, and its feet still stand."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from mocap._shared.arrays import Array, runs
from mocap._shared.records import NamedTuple
from mocap.body.limbs import find_legs
from mocap.body.motion import Motion
from mocap.editing.bodies import Body, priced
from mocap.editing.boxes import Pins
from mocap.editing.pins import join_pins, plant_pins, require_pins_of, require_reachable, warn_of_errors
from mocap.editing.poses import Poses, poses_of, with_part
from mocap.editing.solver import EVERY_FRAME, Stage, closing_stages, solve_stages
from mocap.editing.toes import SLACK, bend_toes, lowest_allowed
from mocap.editing.tuned import TUNED
from mocap.feet.footskate import clean_up

UP = np.array([0.0, 1.0, 0.0])
CLOSED = 1e-4  # metres: constraints with a larger error cause a warning, and plants among them are released


def edit(motion: Motion, pins: Pins, *, body: Body | None = None, frames: slice | None = None) -> Motion:
    """Change a motion so that its joints meet constraints, and its planted feet still stand.

    No joint is farther under the floor than it was, unless the constraints require it.

    Parameters
    ----------
    motion : F frames; its `contacts` say when feet stand.
    pins : the constraints. Plants stand where they stood, unless the constraints hold them elsewhere.
    body : the joints that may rotate, and their prices. By default those above constrained ones, with root
        and trunk at 16 and the neck at 32 times the prices of `body_of`: a hand that reaches tips the trunk
        by some 10°, about as people do. `keep_turned` constrains a trunk that must not tip.
    frames : those that may change, a single range such as `slice(100, 200)`; by default those up to a second
        from a constrained frame. All others stay the same to the last bit, and a plant that is not completely
        inside stays where it was in each frame. With `slice(None)` all frames may change.

    Returns
    -------
    The edited motion; the motion as it is if nothing is constrained.

    Raises
    ------
    MocapError : for constraints of another motion, constraints that no pose can meet, contacts or legs that
        are missing.

    Warns
    -----
    MocapWarning : for constraints that are missed by more than 0.1 mm; plants among them are released.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> from mocap.body.kinematics import joint_positions
    >>> from mocap.editing.pins import pin, pin_errors
    >>> walk = sample("walk_straight")[:240]
    >>> hand = joint_positions(walk)[120, walk.skeleton.index("lwrist")]
    >>> post = pin(walk, "lwrist", range(110, 130), hand + [0.05, 0.2, 0])
    >>> bool(pin_errors(edit(walk, post), post).max() < 1e-9)
    True

    Notebook: 14-levels
    """
    require_pins_of(motion, pins)
    if not pins.constrained.any():
        return motion
    source = poses_of(motion)
    if frames is not None:
        return brought(source, source, pins, body, frames)
    edited = source
    *windows, last = _windows(pins, motion.fps)
    for window in windows:
        part = _changed(edited, source, pins.limited_to(window), body, window)
        edited = edited.with_part(part, window)
    part = _changed(edited, source, pins.limited_to(last), body, last)
    return with_part(edited.motion, part.motion, last)


def _windows(pins: Pins, fps: float) -> list[slice]:
    """List the ranges of frames up to `TUNED.margin` from a constrained frame."""
    margin = round(TUNED.margin * fps)
    is_near = np.zeros(len(pins), bool)
    for start, stop in runs(np.asarray(pins.constrained.any(axis=1))):
        is_near[max(0, start - margin) : stop + margin] = True
    return [slice(start, stop) for start, stop in runs(is_near)]


class _Section(NamedTuple):
    """Frames of an edit: those that may change, `inner`, and those on which it depends, `outer`."""

    inner: slice
    outer: slice

    @property
    def inner_of_outer(self) -> slice:
        """The frames that may change, counted from the first of the outer ones."""
        return slice(self.inner.start - self.outer.start, self.inner.stop - self.outer.start)


def _section(frames: slice, count: int, fps: float) -> _Section:
    """Return the section for frames that may change."""
    start, stop, _ = frames.indices(count)
    margin = round(TUNED.margin * fps)
    return _Section(slice(start, stop), slice(max(0, start - margin), min(count, stop + margin)))


def brought(
    motion: Poses, source: Poses, pins: Pins, body: Body | None = None, frames: slice = EVERY_FRAME
) -> Motion:
    """Change a motion as `edit` does, with the plants and the floor of the motion that it was made of.

    Parameters
    ----------
    motion, source, pins : F frames.
    body, frames : as for `edit`.
    """
    if not len(range(len(motion))[frames]):  # nothing may change
        warn_of_errors(motion.motion, pins.indices, pins.errors(motion), CLOSED)
        return motion.motion
    return with_part(motion.motion, _changed(motion, source, pins, body, frames).motion, frames)


def _changed(motion: Poses, source: Poses, pins: Pins, body: Body | None, frames: slice) -> Poses:
    """Return the frames that `brought` changes.

    If joints would sink, the constraints are solved for again, together with a floor.
    """
    section = _section(frames, len(motion), motion.motion.fps)
    stays = np.ones(len(motion), bool)
    stays[frames] = False
    allowed = allowed_by(pins, source)[section.outer]
    plants = plant_pins(source)
    steady = plants_within(plants, source.with_frames_of(motion, stays), frames)
    wanted = join_pins(steady, pins)[section.outer]
    solved = _solved(motion, wanted, body, section)
    bent = solved.updated(bend_toes(solved, allowed))
    floor = floor_for(bent, plants.joints, allowed)
    if floor.errors(solved).max() > SLACK:
        solved = _solved(motion, join_pins(floor, wanted), body, section)
        bent = solved.updated(bend_toes(solved, allowed))
    marked = mark_met(bent, wanted.indices, wanted.errors(bent), plants[section.outer])
    return marked[section.inner_of_outer]


def _solved(motion: Poses, pins: Pins, body: Body | None, section: _Section) -> Poses:
    """Return the outer frames of a section, changed so that they meet the constraints on them.

    Parameters
    ----------
    motion : F frames: the whole motion, which shows the hinges.
    pins : constraints of the outer frames.
    body : as for `edit`.
    section : of the F frames.
    """
    require_reachable(motion.motion, pins)
    if body is None:
        body = priced(motion, pins.movers(motion.motion.skeleton), TUNED.trunk, TUNED.neck)
    return solve_stages(motion[section.outer], pins, edit_stages(), body, section.inner_of_outer).poses


def edit_stages() -> tuple[Stage, ...]:
    """Return the stages of an edit: splines make the change, then each frame closes what they leave."""
    splines = Stage(knots=TUNED.knots, decay=TUNED.decay, weight=TUNED.weight, lead=TUNED.lead)
    return splines, *closing_stages()


def plants_within(plants: Pins, poses: Poses, frames: slice) -> Pins:
    """Hold feet where they were in all other frames, and in plants that reach from these into them.

    Parameters
    ----------
    plants : of F frames, as from `plant_pins`.
    poses : F frames.
    frames : those that may change, a single range.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> walk = sample("walk_straight")[:240]
    >>> plants = plant_pins(walk)
    >>> plants_within(plants, poses_of(walk), slice(None)) is plants
    True
    >>> bool(plants_within(plants, poses_of(walk), slice(100, 140)).held[:100].all())
    True
    """
    changes = np.zeros(len(poses), bool)
    changes[frames] = True
    if changes.all():
        return plants
    positions = poses.positions[:, list(plants.joints)]
    stays = np.repeat(~changes[:, None], len(plants.joints), axis=1)
    planted = np.asarray(plants.held.all(axis=-1))
    for leg in find_legs(poses.motion.skeleton):  # a rigid foot: both of its joints stay, or neither
        foot = np.isin(plants.joints, leg)
        for start, stop in runs(np.asarray(planted[:, foot].any(axis=1))):
            if not changes[start:stop].all():
                stays[start:stop, foot] |= planted[start:stop, foot]
    low = np.where(stays[..., None], positions, plants.low)
    high = np.where(stays[..., None], positions, plants.high)
    return Pins(plants.joints, low, high)


def allowed_by(pins: Pins, poses: Poses) -> Array:
    """Compute the lowest height allowed for each joint, (F, J), metres, as `lowest_allowed` does.

    If constraints require that a joint be lower, all of its limb may be as low as necessary.
    """
    allowed = lowest_allowed(poses)
    skeleton = poses.motion.skeleton
    for column, joint in enumerate(pins.joints):
        if (pins.high[:, column, 1] < allowed[:, joint] - SLACK).any():
            below = [end for end in range(len(skeleton)) if joint in skeleton.path_to_root(end)]
            allowed[:, [*below, *skeleton.path_to_root(joint)]] = -np.inf
    return allowed


def floor_for(poses: Poses, feet: Sequence[int], allowed: Array) -> Pins:
    """Keep feet, and other joints that are too low, above the heights allowed (F, J), metres."""
    heights = poses.positions[..., 1]
    sinks = (heights < allowed - 2 * SLACK).any(axis=0)
    joints = sorted({*feet, *np.flatnonzero(sinks).tolist()})
    low = np.full((len(poses), len(joints), 3), -np.inf)
    low[..., 1] = allowed[:, joints]
    return Pins(joints, low, np.full_like(low, np.inf))


def mark_met(poses: Poses, joints: Sequence[int], errors: Array, plants: Pins) -> Poses:
    """Warn of constraints that are missed, and mark only those `plants` that are still in their places.

    Parameters
    ----------
    poses : F frames.
    joints : of all constraints, those on positions first, as from `Pins.indices`; those of plants among them.
    errors : shape (F, joints), of these constraints, metres.
    plants : of F frames.

    Examples
    --------
    >>> import warnings
    >>> from mocap.datasets import sample
    >>> walk = sample("walk_straight")[:240]
    >>> plants = plant_pins(walk)
    >>> with warnings.catch_warnings(action="ignore"):
    ...     for up in ([0, 0.00009, 0], [0, 0.00015, 0]):  # metres
    ...         higher = Pins(plants.joints, plants.low + up, plants.high + up)
    ...         errors = higher.errors(poses_of(walk))
    ...         met = mark_met(poses_of(walk), higher.indices, errors, plants)
    ...         print(met.motion.contacts["lfoot"].sum())
    52
    0
    """
    warn_of_errors(poses.motion, joints, errors, CLOSED)
    columns = [joints.index(joint) for joint in plants.joints]
    stands = plants.held.all(axis=-1) & (errors <= CLOSED)[:, columns]
    names = [poses.motion.skeleton.names[joint] for joint in plants.joints]
    contacts = {**poses.motion.contacts, **dict(zip(names, stands.T, strict=True))}
    return Poses(replace(poses.motion, contacts=contacts), poses.positions, poses.matrices)


def clean_feet(motion: Motion, lowest: Array | None = None) -> Motion:
    """Remove foot sliding by `feet.clean_up`, and keep all joints above the floor.

    Parameters
    ----------
    motion : F frames of J joints; its `contacts` say when feet stand.
    lowest : as for `lowest_allowed`.

    Raises
    ------
    MocapError : as for `feet.clean_up`.

    Warns
    -----
    MocapWarning : for plants that are released, as by `feet.clean_up`.

    Examples
    --------
    >>> from mocap.body import joint_positions
    >>> from mocap.datasets import sample
    >>> walk = sample("walk_straight")[:120]
    >>> heights = joint_positions(clean_feet(walk))[walk.contacts["rtoes"], walk.skeleton.index("rtoes"), 1]
    >>> bool(np.ptp(heights) < 1e-9)
    True
    """
    poses = poses_of(motion)
    return raised(clean_up(motion, poses=poses.world), lowest_allowed(poses, lowest))


def raised(motion: Motion, allowed: Array) -> Motion:
    """Raise the tips of toes that are lower than allowed, and other joints under the floor, y = 0.

    Toes bend. If other joints are lower than allowed under the floor, by more than 3 mm, the smallest smooth
    change raises them.

    Parameters
    ----------
    motion : F frames of J joints, with clean feet. Plants stay where they are, or rise to the floor.
    allowed : the lowest height of each joint, (F, J), metres.
    """
    poses = poses_of(motion)
    bent = poses.updated(bend_toes(poses, allowed))
    plants = plant_pins(poses)
    under_floor = np.minimum(allowed, 0.0)
    floor = floor_for(bent, plants.joints, under_floor)
    if floor.errors(bent).max() <= TUNED.sunk:
        return bent.motion
    rise = _rise_of_plants(plants, motion, under_floor)
    wanted = join_pins(floor, Pins(plants.joints, plants.low + rise, plants.high + rise))
    every_frame = _section(EVERY_FRAME, len(poses), motion.fps)
    return bend_toes(_solved(poses, wanted, None, every_frame), allowed)


def _rise_of_plants(plants: Pins, motion: Motion, floor: Array) -> Array:
    """Compute the translations (F, P, 3), metres, that raise plants to the floor (F, J) of their joints."""
    is_planted = plants.held[..., 1]
    depth = np.where(is_planted, floor[:, list(plants.joints)] - plants.low[..., 1], 0.0)
    rise = np.zeros(depth.shape)
    for leg in find_legs(motion.skeleton):  # a rigid foot: both of its joints rise by as much
        foot = np.isin(plants.joints, leg)
        rise[:, foot] = np.maximum(depth[:, foot].max(axis=1, keepdims=True), 0.0)
    return np.asarray(rise[..., None] * UP)
