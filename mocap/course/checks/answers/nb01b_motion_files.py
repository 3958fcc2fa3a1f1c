"""Notebook 01b: inputs, right answers and mistakes of `own_axes` and `strikes`."""

import numpy as np

from mocap._shared.arrays import Array, Indices, Mask
from mocap.body import euler, rotations
from mocap.course.checks.answers.common import Arguments
from mocap.course.comparisons import close_rotations

# ---- own_axes


def draw_own_axes(rng: np.random.Generator) -> Arguments:
    """Draw three angles in degrees, most of them oblique and some multiples of 90."""
    angles = [rng.choice([0, 90, -90, 180, *rng.uniform(-80, 80, 16)]) for _ in range(3)]
    return tuple(map(float, angles))


def right_own_axes(z: float, x: float, y: float) -> Array:
    """Return the quaternion of three rotations about the joint's own axes: first z, then x, then y."""
    return euler.from_euler("ZXY", np.radians([z, x, y]))


same_own_axes = close_rotations


def mistake_fixed_axes(z: float, x: float, y: float) -> object:
    """Return R_y R_x R_z, the rotations about the fixed axes of the world in the order z, x, y."""
    return euler.from_euler("zxy", np.radians([z, x, y]))


def mistake_degrees_as_radians(z: float, x: float, y: float) -> object:
    """Return R_z R_x R_y for angles whose degrees are taken as radians."""
    return euler.from_euler("ZXY", [z, x, y])


def mistake_alphabetical(z: float, x: float, y: float) -> object:
    """Return R_x R_y R_z, with each angle about its own axis."""
    return euler.from_euler("XYZ", np.radians([x, y, z]))


def mistake_single_rotation(z: float, x: float, y: float) -> object:
    """Return one rotation whose rotation vector is (x, y, z), converted to radians."""
    return rotations.from_rotvec(np.radians([x, y, z]))


# ---- strikes


def draw_strikes(rng: np.random.Generator) -> Arguments:
    """Draw a mask of runs of 1 to 11 frames, which are on the ground and off it by turns."""
    runs = rng.integers(1, 12, rng.integers(3, 9))
    return (np.repeat((np.arange(len(runs)) + rng.integers(2)) % 2, runs).astype(bool),)


def right_strikes(contact: Mask) -> Indices:
    """Return the frames in contact whose previous frame is not."""
    return np.flatnonzero(contact[1:] & ~contact[:-1]) + 1


def mistake_frame_early(contact: Mask) -> object:
    """Return the last frame without contact before each strike."""
    return right_strikes(contact) - 1


def mistake_all_standing_frames(contact: Mask) -> object:
    """Return all frames in contact."""
    return np.flatnonzero(contact)


def mistake_lifts_too(contact: Mask) -> object:
    """Return the frames whose contact differs from that of the previous frame: strikes and lifts."""
    return np.flatnonzero(contact[1:] != contact[:-1]) + 1


def mistake_lifts(contact: Mask) -> object:
    """Return the frames without contact whose previous frame is in contact."""
    return np.flatnonzero(~contact[1:] & contact[:-1]) + 1


def mistake_first_frame(contact: Mask) -> object:
    """Return the strikes, and also frame 0 if the clip begins in contact."""
    return np.flatnonzero(np.diff(contact, prepend=False) & contact)


def mistake_number_of_strikes(contact: Mask) -> object:
    """Return the number of strikes."""
    return len(right_strikes(contact))
