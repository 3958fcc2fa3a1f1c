"""One face for edits: say where joints shall be, and get a motion that does it.

Spacetime comes within millimetres of the pins. Triangles close the rest: `feet.clean_up` for planted feet,
then any other limb of two bones, such as an arm, turns at both. Feet first: the clean-up may raise the root.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from mocap._shared.arrays import Array, Mask
from mocap.body.kinematics import forward_kinematics
from mocap.body.limbs import Leg, legs_of
from mocap.body.motion import Motion
from mocap.editing.linear_bodies import Body
from mocap.editing.pins import Pins, join_pins, plant_pins
from mocap.editing.reaching import TOLERANCE, ready, warn_of_gaps
from mocap.editing.spacetime_solver import KNOTS, WEIGHT, solved_again
from mocap.feet.ankle_targets import smooth_fill
from mocap.feet.footskate import clean_up
from mocap.feet.leg_ik import pose_leg
from mocap.feet.leg_track import LegTrack

CLOSED = 1e-4  # metres: what a triangle may leave without a warning
SHORT = 1e-6  # metres: no bone of a limb


def edit(
    motion: Motion,
    pins: Pins,
    *,
    body: Body | None = None,
    knots: float | Sequence[float] = KNOTS,
    legs: Sequence[Leg] | None = None,
) -> Motion:
    """Change a motion so that its joints are where pins ask, and its planted feet still stand.

    `spacetime` brings all joints near, `feet.clean_up` puts planted feet to their places, and then each other
    pinned joint at the end of a limb, below a hinge, is put to its place by turning the two bones above it.

    Parameters
    ----------
    motion : F frames; its `contacts` say when feet stand.
    pins : what is asked. Plants stand where they stood, unless the pins hold them elsewhere.
    body : which joints turn, at what price; by default `body_of(motion, joints)` of all pinned joints.
    knots : seconds between knots of the change. Several, such as (0.5, 0.25, 0.125), are solved one after the
        other as in `refined`: twice as slow, and smoother where few frames are pinned or much is asked.
    legs : found by name by default; () for a body that stands on none.

    Returns
    -------
    The edited motion; the motion as it is if the pins ask for nothing.

    Raises
    ------
    MocapError : for pins of another motion, pins that no pose can meet, contacts or legs that are missing.

    Warns
    -----
    MocapWarning : for plants that are let go, and for pins that are missed: by more than 0.1 mm where a limb
        ends, by more than 5 mm elsewhere.

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
    if not pins.asked.any():
        ready(motion, pins, body, WEIGHT)
        return motion
    legs = legs_of(motion.skeleton, legs)
    pins = join_pins(plant_pins(motion, legs), pins) if legs else pins
    body = ready(motion, pins, body, WEIGHT)
    edited = solved_again(motion, pins, body, np.atleast_1d(knots).tolist(), WEIGHT)
    if legs:
        edited = clean_up(edited, legs, pins=pins)
    tolerance = np.full(pins.asked.shape, TOLERANCE)
    for limb in _limbs(motion, pins, body):
        track = LegTrack(edited, limb, forward_kinematics(edited))
        if track.bends:
            known, gap = _left(motion, track, pins)
            edited = _closed(track, known, gap)
            tolerance[known, pins.joints.index(limb.ankle)] = CLOSED
    warn_of_gaps(edited, pins, tolerance)
    return edited


def _limbs(motion: Motion, pins: Pins, body: Body) -> list[Leg]:
    """Find the limbs of two bones whose end is held somewhere, and what is between them is not.

    Between the bones is a hinge, or the limb is on one side of the body, as arms and legs are: the bones of a
    neck, nearly in line, would fold to close a millimetre.
    """
    skeleton, limbs = motion.skeleton, []
    hinges = {joint for joint, axes in zip(body.joints, body.axes, strict=True) if axes.shape[1] == 1}
    held = {pins.joints[column] for column in np.flatnonzero(pins.held.any(axis=(0, 2)))}
    above = {joint for end in held for joint in skeleton.path_to_root(end)[1:]}
    bones = np.linalg.norm(skeleton.offsets, axis=-1)
    for end in sorted(held):
        middle = int(skeleton.parents[end])
        start = int(skeleton.parents[middle]) if middle > 0 else 0
        bends = middle in hinges or (skeleton.side(end) != "middle" and end not in above)
        if start > 0 and bends and middle not in held and min(bones[end], bones[middle]) > SHORT:
            limbs.append(Leg(start, middle, end, (skeleton.children(end) or [end])[0]))
    return limbs


def _left(motion: Motion, track: LegTrack, pins: Pins) -> tuple[Mask, Array]:
    """Say in which frames a limb's end is known, (F,), and what is left to its place there, (F, 3), metres.

    Where a foot stands, the clean-up has put it to its place, or let it go: there the limb stays.
    """
    limb, column, names = track.leg, pins.joints.index(track.leg.ankle), motion.skeleton.names
    held = pins.held[:, column].any(axis=-1)
    stands = np.zeros(len(motion), bool)
    for joint in (limb.ankle, limb.ball):
        for clip in (motion, track.motion):
            stands |= clip.contacts.get(names[joint], stands)
    gap = pins.gap(track.poses.positions)[:, column]
    return held | stands, np.where(stands[:, None], 0.0, gap)


def _closed(track: LegTrack, known: Mask, gap: Array) -> Motion:
    """Carry a limb's end by the gap where it is known, and smoothly between; its two bones turn."""
    motion = track.motion
    if not gap[known].any():
        return motion
    wanted = track.ankle + smooth_fill(gap, known, motion.fps) - track.hip
    share = np.minimum(track.hinge.reach / np.linalg.norm(wanted, axis=-1), 1.0)
    posed = pose_leg(track, track.hip + share[:, None] * wanted, np.zeros_like(wanted))
    turned = motion.rotations.copy()
    turned[:, track.leg[:3]] = posed
    return replace(motion, rotations=turned)
