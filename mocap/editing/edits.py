"""Edits: a motion changed smoothly so that its joints meet constraints, and its feet still stand."""

import numpy as np

from mocap._shared.arrays import Array, runs
from mocap._shared.records import NamedTuple
from mocap.body.motion import Motion
from mocap.editing.bodies import Body, priced
from mocap.editing.constraint_checks import require_pins_of, require_reachable, warn_of_errors
from mocap.editing.constraints import Pins
from mocap.editing.pins import join_pins
from mocap.editing.poses import MotionOrPoses, Poses, poses_of, with_part
from mocap.editing.solver import EVERY_FRAME, solve_stages
from mocap.editing.stages import Stage, closing_stages
from mocap.editing.standing import CLOSED, allowed_by, floor_for, mark_met, plants_within, region_around
from mocap.editing.toes import SLACK, bend_toes, lowest_of_feet
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
    if frames is not None:
        return brought(motion, motion, pins, body, frames)
    lowest = lowest_of_feet(motion)
    edited = motion
    for window in _windows(pins, motion.fps):
        edited = brought(edited, motion, pins.limited_to(window), body, window, lowest)
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

    def counted_from(self, first: int) -> "Section":
        """Return the section with frames counted from another one than the first."""
        return Section(*(slice(frames.start - first, frames.stop - first) for frames in self))


def section_of(frames: slice, count: int, fps: float) -> Section:
    """Return the section for frames that may change, of a motion of `count` frames."""
    start, stop, _ = frames.indices(count)
    margin = round(TUNED.margin * fps)
    return Section(slice(start, stop), slice(max(0, start - margin), min(count, stop + margin)))


def brought(  # noqa: PLR0913 (two motions, constraints, what may change, and what is known)
    motion: Motion,
    source: MotionOrPoses,
    pins: Pins,
    body: Body | None = None,
    frames: slice = EVERY_FRAME,
    lowest: Array | None = None,
) -> Motion:
    """Change a motion as `edit` does, with the plants and the floor of the motion that it was made of.

    Of both motions only the frames near those that may change are looked at, with all frames of plants that
    reach there. The whole of them shows which joints are hinges, and how low feet are.

    Parameters
    ----------
    motion, source, pins : F frames.
    body, frames : as for `edit`.
    lowest : of the source, from `lowest_of_feet`, if it is known already.
    """
    if not len(range(len(motion))[frames]):  # nothing may change
        warn_of_errors(motion, pins.indices, pins.errors(poses_of(motion)), CLOSED)
        return motion
    lowest = lowest_of_feet(source) if lowest is None else lowest
    return with_part(motion, _changed(motion, source, pins, body, frames, lowest), frames)


def _changed(  # noqa: PLR0913 (as for `brought`)
    motion: Motion, source: MotionOrPoses, pins: Pins, body: Body | None, frames: slice, lowest: Array
) -> Motion:
    """Return the frames that `brought` changes.

    If joints would sink, the constraints are solved for again, together with a floor.
    """
    section = section_of(frames, len(motion), motion.fps)
    region = region_around(source, section.outer)
    section = section.counted_from(region.start)
    base = region.poses if source is motion else poses_of(motion[region.frames])
    stays = np.ones(len(base), bool)
    stays[section.inner] = False
    allowed = allowed_by(pins[region.frames], region.poses, lowest)[section.outer]
    steady = plants_within(region.plants, region.poses.with_frames_of(base, stays), section.inner)
    wanted = join_pins(steady, pins[region.frames])[section.outer]
    outer = base[section.outer]
    solved = solved_section(outer, motion, wanted, body, section.inner_of_outer)
    bent = solved.updated(bend_toes(solved, allowed))
    floor = floor_for(bent, region.plants.joints, allowed)
    if floor.errors(solved).max() > SLACK:
        solved = solved_section(outer, motion, join_pins(floor, wanted), body, section.inner_of_outer)
        bent = solved.updated(bend_toes(solved, allowed))
    marked = mark_met(bent, wanted.indices, wanted.errors(bent), region.plants[section.outer])
    return marked.motion[section.inner_of_outer]


def solved_section(
    outer: Poses, clip: MotionOrPoses, pins: Pins, body: Body | None = None, inner: slice = EVERY_FRAME
) -> Poses:
    """Return the outer frames of a section, changed so that they meet the constraints on them.

    Parameters
    ----------
    outer : F frames.
    clip : the whole motion, which shows the hinges.
    pins : constraints of the F frames.
    body : as for `edit`.
    inner : those of the F frames that may change.
    """
    require_reachable(outer.motion, pins)
    if body is None:
        body = priced(clip, pins.movers(outer.motion.skeleton), TUNED.trunk, TUNED.neck)
    return solve_stages(outer, pins, edit_stages(), body, inner).poses


def edit_stages() -> tuple[Stage, ...]:
    """Return the stages of an edit: splines make the change, then each frame closes what they leave."""
    splines = Stage(knots=TUNED.knots, decay=TUNED.decay, weight=TUNED.weight, lead=TUNED.lead)
    return splines, *closing_stages()
