"""Checks of notebook 01b."""

import numpy as np

from mocap._shared.arrays import Array, Indices, Mask
from mocap.body import euler, rotations
from mocap.course.check import Check, Mistake, close_rotations

own_axes = Check(
    name="own_axes",
    asks="the quaternion of R = Rz Rx Ry, for angles in degrees",
    start="make a quaternion for each axis with from_rotvec; multiply them in the order of the formula.",
    draw=lambda rng: tuple(float(rng.choice([0, 90, -90, 180, *rng.uniform(-80, 80, 16)])) for _ in range(3)),
    truth=lambda z, x, y: euler.from_euler("ZXY", np.radians([z, x, y])),
    mistakes=[
        Mistake(
            lambda z, x, y: euler.from_euler("zxy", np.radians([z, x, y])),
            "that is Ry Rx Rz: the first channel of the file stands leftmost in the product.",
        ),
        Mistake(
            lambda z, x, y: euler.from_euler("ZXY", [z, x, y]),
            "the file's angles are in degrees; sine and cosine take radians.",
        ),
        Mistake(
            lambda z, x, y: euler.from_euler("XYZ", np.radians([x, y, z])),
            "that is Rx Ry Rz, the order of the alphabet; the channels of this file have another order.",
        ),
        Mistake(
            lambda z, x, y: rotations.from_rotvec(np.radians([x, y, z])),
            "that is one turn about the axis (x, y, z); three turns in a row are a different rotation.",
        ),
    ],
    same=close_rotations,
)


def _acclaim(axis: Array, angles: Array, order: str = "xyz", *, swapped: bool = False) -> Array:
    c, m = (euler.from_euler(order, np.radians(turns)) for turns in (axis, angles))
    left, right = (rotations.inverse(c), c) if swapped else (c, rotations.inverse(c))
    return rotations.multiply(rotations.multiply(left, m), right)


def _two_turns(rng: np.random.Generator) -> tuple[Array, Array]:
    """Draw the angles of two turns: mostly different ones, sometimes the same, opposite, or none."""
    axis, angles = rng.uniform(-80, 80, (2, 3)).round(1)
    special = [axis, -axis, np.zeros(3)]
    return axis, np.array([*special, *[angles] * 12][rng.integers(15)])


acclaim_turn = Check(
    name="acclaim_turn",
    asks="the quaternion of L = C M C⁻¹, for angles in degrees",
    start="make C and M with from_euler and small letters; then multiply C, M and inverse(C).",
    draw=_two_turns,
    truth=_acclaim,
    mistakes=[
        Mistake(
            lambda axis, angles: rotations.multiply(
                *(euler.from_euler("xyz", np.radians(turns)) for turns in (axis, angles))
            ),
            "that is C M: without C⁻¹, a bone that does not move would be turned by C.",
        ),
        Mistake(
            lambda axis, angles: _acclaim(axis, angles, swapped=True),
            "that is C⁻¹ M C: C stands on the left.",
        ),
        Mistake(
            lambda axis, angles: _acclaim(axis, angles, "XYZ"),
            "capitals are the body's own axes; Acclaim files turn about fixed axes, which are small letters.",
        ),
        Mistake(
            lambda axis, angles: _acclaim(np.degrees(axis), np.degrees(angles)),
            "the file's angles are in degrees; sine and cosine take radians.",
        ),
        Mistake(
            lambda axis, angles: euler.from_euler("xyz", np.radians(angles)),
            "that is M alone: it turns about the bone's own axes, and C says where these lie.",
        ),
    ],
    same=close_rotations,
)


def _contact(rng: np.random.Generator) -> tuple[Mask]:
    """Draw runs of standing and swinging; half of them begin with standing."""
    runs = rng.integers(1, 12, rng.integers(3, 9))
    return (np.repeat((np.arange(len(runs)) + rng.integers(2)) % 2, runs).astype(bool),)


def _strikes(contact: Mask) -> Indices:
    return np.flatnonzero(contact[1:] & ~contact[:-1]) + 1


strikes = Check(
    name="strikes",
    asks="the frames at which the contact changes from False to True",
    start="a strike is True, and the frame before it is False: compare contact[1:] with contact[:-1].",
    draw=_contact,
    truth=_strikes,
    mistakes=[
        Mistake(
            lambda contact: _strikes(contact) - 1,
            "each of your frames is one too early: contact[1:] begins with frame 1.",
        ),
        Mistake(
            np.flatnonzero, "those are all frames in which the foot stands; a strike is only the first one."
        ),
        Mistake(
            lambda contact: np.flatnonzero(contact[1:] != contact[:-1]) + 1,
            "those are all changes: half of them are lifts, where the contact changes from True to False.",
        ),
        Mistake(lambda contact: _strikes(~contact), "those are the lifts: there the foot leaves the ground."),
        Mistake(
            lambda contact: np.flatnonzero(np.diff(contact, prepend=False) & contact),
            "a clip that begins with a standing foot has no strike in frame 0: nobody knows when it landed.",
        ),
        Mistake(lambda contact: len(_strikes(contact)), "that is how many there are; return the frames."),
    ],
)
