"""Notebook 04b: inputs, right answers and mistakes of `slide`, `plant_marks` and `knee_bend`."""

import numpy as np

from mocap._shared.arrays import Array, Mask
from mocap.course.checks.answers.common import Arguments, grown

# ---- slide


def draw_slide(rng: np.random.Generator) -> Arguments:
    """Draw a joint that drifts by about a centimetre a frame, and the frames in which it is planted."""
    positions = rng.normal(size=(20, 3)).cumsum(axis=0) * 0.01
    planted = np.arange(20) - rng.integers(0, 10) < rng.integers(4, 10)
    return positions, planted


def right_slide(positions: Array, planted: Mask) -> float:
    """Return the largest distance of a planted frame from the mean place, in centimetres."""
    ground = positions[planted][:, [0, 2]]
    return float(100 * np.linalg.norm(ground - ground.mean(axis=0), axis=1).max())


def mistake_slide_with_height(positions: Array, planted: Mask) -> object:
    """Return the largest distance in space of a planted frame from the mean position, in centimetres."""
    ground = positions[planted]
    return 100 * np.linalg.norm(ground - ground.mean(axis=0), axis=1).max()


def mistake_in_metres(positions: Array, planted: Mask) -> object:
    """Return the largest distance of a planted frame from the mean position, in metres."""
    return right_slide(positions, planted) / 100


def mistake_all_frames(positions: Array, planted: Mask) -> object:
    """Return the largest distance of any frame from the mean of all frames, in centimetres."""
    ground = positions[:, [0, 2]]
    return 100 * np.linalg.norm(ground - ground.mean(axis=0), axis=1).max()


def mistake_mean_of_all_frames(positions: Array, planted: Mask) -> object:
    """Return the largest distance of a planted frame from the mean of all frames, in centimetres."""
    ground = positions[planted][:, [0, 2]]
    return 100 * np.linalg.norm(ground - positions[:, [0, 2]].mean(axis=0), axis=1).max()


def mistake_from_first_place(positions: Array, planted: Mask) -> object:
    """Return the largest distance of a planted frame from the first planted one, in centimetres."""
    ground = positions[planted][:, [0, 2]]
    return 100 * np.linalg.norm(ground - ground[0], axis=1).max()


def mistake_first_to_last(positions: Array, planted: Mask) -> object:
    """Return the distance between the first planted frame and the last, in centimetres."""
    ground = positions[planted][:, [0, 2]]
    return 100 * np.hypot(*(ground[-1] - ground[0]))


def mistake_length_of_path(positions: Array, planted: Mask) -> object:
    """Return the length of the path over the ground in the planted frames, in centimetres."""
    return 100 * np.hypot(*np.diff(positions[planted][:, [0, 2]], axis=0).T).sum()


# ---- plant_marks


def draw_plant_marks(rng: np.random.Generator) -> Arguments:
    """Draw noisy speeds of several levels, and the two speeds between which a contact may go on."""
    level = np.repeat(rng.uniform(0.0, 1.0, 8), rng.integers(2, 6, 8))
    return np.abs(level + rng.normal(0, 0.08, len(level))), 0.25, 0.5


def right_plant_marks(speed: Array, start: float, stay: float) -> Mask:
    """Return the runs below the higher speed that fall below the lower one."""
    return grown(speed, start, stay)


def mistake_start_alone(speed: Array, start: float, stay: float) -> object:
    """Mark the frames below `start`."""
    return speed < start


def mistake_stay_alone(speed: Array, start: float, stay: float) -> object:
    """Mark the frames below `stay`."""
    return speed < stay


def mistake_forwards_alone(speed: Array, start: float, stay: float) -> object:
    """Mark frames below `start`, and those after them while the speed is below `stay`."""
    return grown(speed, start, stay, (1,))


def mistake_backwards_alone(speed: Array, start: float, stay: float) -> object:
    """Mark frames below `start`, and those before them while the speed is below `stay`."""
    return grown(speed, start, stay, (-1,))


def mistake_inverted(speed: Array, start: float, stay: float) -> object:
    """Mark the frames outside the right runs."""
    return ~right_plant_marks(speed, start, stay)


# ---- knee_bend


def draw_knee_bend(rng: np.random.Generator) -> Arguments:
    """Draw the lengths of a thigh and a shank, and a distance that the leg can reach."""
    bones = rng.uniform(0.3, 0.5, 2)
    return *bones, float(bones.sum() * rng.uniform(0.5, 0.99))


def right_knee_bend(thigh: float, shank: float, distance: float) -> float:
    """Return the angle of the knee by the law of cosines, 0 for a straight leg."""
    cosine = (thigh**2 + shank**2 - distance**2) / (2 * thigh * shank)
    return float(np.pi - np.arccos(cosine))


def mistake_angle_between_bones(thigh: float, shank: float, distance: float) -> object:
    """Return the angle between thigh and shank, π for a straight leg."""
    return np.pi - right_knee_bend(thigh, shank, distance)


def mistake_in_degrees(thigh: float, shank: float, distance: float) -> object:
    """Return the angle of the knee in degrees."""
    return np.degrees(right_knee_bend(thigh, shank, distance))


def mistake_hip_angle(thigh: float, shank: float, distance: float) -> object:
    """Return the angle at the hip, between the thigh and the line from hip to ankle."""
    cosine = (thigh**2 + distance**2 - shank**2) / (2 * thigh * distance)
    return np.arccos(cosine)


def mistake_negative_bend(thigh: float, shank: float, distance: float) -> object:
    """Return the negative angle of the knee."""
    return -right_knee_bend(thigh, shank, distance)
