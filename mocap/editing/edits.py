"""Edits: a motion changed smoothly so that its joints meet constraints, and its feet still stand."""

import numpy as np

from mocap._shared.arrays import runs
from mocap._shared.records import NamedTuple
from mocap.body.motion import Motion
from mocap.editing.above_floor import Heights, Solving, meet_above_floor
from mocap.editing.bodies import Body, priced
from mocap.editing.constraint_checks import require_pins_of, warn_of_errors
from mocap.editing.constraints import Pins
from mocap.editing.pins import join_pins
from mocap.editing.poses import MotionOrPoses, motion_of, poses_of, with_part
from mocap.editing.solver import EVERY_FRAME
from mocap.editing.stages import Stage, closing_stages
from mocap.editing.standing import (
    CLOSED,
    Source,
    allowed_by,
    mark_met,
    plants_within,
    source_of,
)
from mocap.editing.tuned import TUNED


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
    >>> from mocap.editing import pin, pin_errors
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
    if frames is None:
        parts = [(window, pins.limited_to(window)) for window in _windows(pins, motion.fps)]
    else:
        parts = [(frames, pins)]
    source = source_of(motion)
    edited = motion
    for window, part in parts:
        edited = brought(edited, source, part, body, window)
    return edited


def _windows(pins: Pins, fps: float) -> list[slice]:
    """List the ranges of frames up to `TUNED.margin` from a constrained frame."""
    margin = round(TUNED.margin * fps)
    is_near = np.zeros(len(pins), bool)
    for start, stop in runs(np.asarray(pins.constrained.any(axis=1))):
        is_near[max(0, start - margin) : stop + margin] = True
    return [slice(start, stop) for start, stop in runs(is_near)]


class Section(NamedTuple):
    """Frames of an edit: those that may change, `inner`, and those on which it depends, `outer`."""

    inner: slice
    outer: slice

    @property
    def inner_of_outer(self) -> slice:
        """The frames that may change, counted from the first of the outer ones."""
        return slice(self.inner.start - self.outer.start, self.inner.stop - self.outer.start)


def section_of(frames: slice, count: int, fps: float) -> Section:
    """Return the section for frames that may change, of a motion of `count` frames."""
    start, stop, _ = frames.indices(count)
    margin = round(TUNED.margin * fps)
    return Section(slice(start, stop), slice(max(0, start - margin), min(count, stop + margin)))


def brought(
    motion: Motion, source: Source, pins: Pins, body: Body | None = None, frames: slice = EVERY_FRAME
) -> Motion:
    """Change a motion as `edit` does, with the plants and the floor of the motion that it was made of.

    Only the frames near those that may change are solved for. The whole of the motion shows which joints are
    hinges, that of the source where feet stand, and how low they are.

    Parameters
    ----------
    motion, pins : F frames.
    source : the motion that it was made of, F frames.
    body, frames : as for `edit`.
    """
    if len(range(len(motion))[frames]):
        return with_part(motion, _changed(motion, source, pins, body, frames), frames)
    # No frame may change.
    warn_of_errors(motion, pins.indices, pins.errors(poses_of(motion)), CLOSED)
    return motion


def _changed(motion: Motion, source: Source, pins: Pins, body: Body | None, frames: slice) -> Motion:
    """Return the frames that `brought` changes."""
    section = section_of(frames, len(motion), motion.fps)
    inner = section.inner_of_outer
    source_poses = poses_of(source.clip[section.outer])
    base = source_poses if source.clip is motion else poses_of(motion[section.outer])
    stays = np.ones(len(base), bool)
    stays[inner] = False
    plants = source.plants[section.outer]
    steady = plants_within(plants, source_poses.with_frames_of(base, stays), inner, source.feet.legs)
    wanted = join_pins(steady, pins[section.outer])
    allowed = allowed_by(pins[section.outer], source_poses, source)
    heights = Heights(source.feet, allowed, allowed, plants.joints)
    solving = edit_solving(motion, body)._replace(frames=inner, first_frame=section.outer.start)
    changed = meet_above_floor(base, wanted, solving, heights)
    marked = mark_met(changed, wanted, plants, section.outer.start)
    return marked[inner]


def edit_solving(clip: MotionOrPoses, body: Body | None = None) -> Solving:
    """Return how an edit solves: splines make the change, then each frame closes what they leave.

    Parameters
    ----------
    clip : the whole motion, which shows the hinges.
    body : as for `edit`.
    """

    def body_for(pins: Pins) -> Body:
        movers = pins.movers(motion_of(clip).skeleton)
        return priced(clip, movers, TUNED.trunk, TUNED.neck) if body is None else body

    return Solving(edit_stages(), body_for)


def edit_stages() -> tuple[Stage, ...]:
    """Return the stages of an edit: splines, and then those that close what they leave."""
    splines = Stage(knots=TUNED.knots, decay=TUNED.decay, weight=TUNED.weight, lead=TUNED.lead)
    return splines, *closing_stages()
