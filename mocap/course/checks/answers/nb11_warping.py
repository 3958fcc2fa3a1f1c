"""Notebook 11: inputs, right answers and mistakes of `offset_curve`, `cardinal_slopes` and `flight_time`."""

import numpy as np

from mocap._shared.arrays import Array
from mocap.body.rotations import from_rotvec, inverse, multiply, to_rotvec
from mocap.course.checks.answers.common import Arguments
from mocap.course.comparisons import close_rotations


def long_way(quaternion: Array) -> Array:
    """Return a rotation vector without taking the shorter of the two arcs."""
    real = quaternion[0]
    vector = quaternion[1:]
    length = np.linalg.norm(vector)
    return np.asarray(2 * np.arctan2(length, real) * vector / length)


# ---- offset_curve


def draw_offset_curve(rng: np.random.Generator) -> Arguments:
    """Draw a joint's rotations, a key, the pose asked for there (of either sign), and the shares."""
    q = from_rotvec(rng.normal(size=3) + rng.normal(scale=0.15, size=(20, 3)).cumsum(axis=0))
    key = int(rng.integers(5, 15))
    pose = multiply(q[key], from_rotvec(rng.normal(size=3))) * rng.choice([-1, 1])
    share = np.clip(1 - np.abs(np.arange(20) - key) / 6, 0, 1)
    return q, key, pose, share


def right_offset_curve(q: Array, key: int, pose: Array, share: Array) -> Array:
    """Return the rotations after their share of the offset at the key frame, in the joint's own frame."""
    return multiply(q, from_rotvec(share[:, None] * to_rotvec(multiply(inverse(q[key]), pose))))


same_offset_curve = close_rotations


def mistake_offset_on_the_left(q: Array, key: int, pose: Array, share: Array) -> object:
    """Return exp(share b) q, with the offset b = log(q_key⁻¹ pose) of the joint's own frame."""
    return multiply(from_rotvec(share[:, None] * to_rotvec(multiply(inverse(q[key]), pose))), q)


def mistake_opposite_offset(q: Array, key: int, pose: Array, share: Array) -> object:
    """Return q exp(-share b), which at the key rotates away from the pose."""
    return multiply(q, from_rotvec(-share[:, None] * to_rotvec(multiply(inverse(q[key]), pose))))


def mistake_rotation_vectors_subtracted(q: Array, key: int, pose: Array, share: Array) -> object:
    """Return q exp(share b) with b = log(pose) - log(q_key)."""
    return multiply(q, from_rotvec(share[:, None] * (to_rotvec(pose) - to_rotvec(q[key]))))


def mistake_long_way_round(q: Array, key: int, pose: Array, share: Array) -> object:
    """Return q exp(share b) with a rotation vector b longer than π if w < 0 in q_key⁻¹ pose."""
    return multiply(q, from_rotvec(share[:, None] * long_way(multiply(inverse(q[key]), pose))))


def mistake_offset_of_each_frame(q: Array, key: int, pose: Array, share: Array) -> object:
    """Return q exp(share b) with b = log(q⁻¹ pose) of each frame instead of the key's."""
    return multiply(q, from_rotvec(share[:, None] * to_rotvec(multiply(inverse(q), pose))))


def mistake_whole_offset(q: Array, key: int, pose: Array, share: Array) -> object:
    """Return q exp(b) in every frame, whatever its share."""
    return multiply(q, from_rotvec(to_rotvec(multiply(inverse(q[key]), pose))))


def mistake_numbers_mixed(q: Array, key: int, pose: Array, share: Array) -> object:
    """Return (1 - share) q + share · pose, component by component, not normalised."""
    return (1 - share[:, None]) * q + share[:, None] * pose


def mistake_parents_frame(q: Array, key: int, pose: Array, share: Array) -> object:
    """Return exp(share b) q, with the offset b = log(pose q_key⁻¹) of the parent's frame."""
    return multiply(from_rotvec(share[:, None] * to_rotvec(multiply(pose, inverse(q[key])))), q)


# ---- cardinal_slopes


def draw_cardinal_slopes(rng: np.random.Generator) -> Arguments:
    """Draw 3 to 6 keys at increasing frames, their values, and a tension."""
    count = int(rng.integers(3, 7))
    return rng.uniform(3, 30, count).cumsum(), rng.normal(size=count), float(rng.uniform(0.1, 0.9))


def right_cardinal_slopes(times: Array, values: Array, tension: float) -> Array:
    """Return the slopes of a cardinal spline: of each key that of its neighbours' chord; 0 at the ends."""
    slopes = np.zeros(len(times))
    rises = values[2:] - values[:-2]
    slopes[1:-1] = (1 - tension) * rises / (times[2:] - times[:-2])
    return slopes


def mistake_number_of_keys(times: Array, values: Array, tension: float) -> object:
    """Divide the rise from the key before to the key after by 2 instead of by the time between them."""
    slopes = np.zeros(len(times))
    rises = values[2:] - values[:-2]
    slopes[1:-1] = (1 - tension) * rises / 2
    return slopes


def mistake_no_tension(times: Array, values: Array, tension: float) -> object:
    """Return the slopes of tension 0, those of a Catmull-Rom spline."""
    return right_cardinal_slopes(times, values, 0.0)


def mistake_tension_for_slack(times: Array, values: Array, tension: float) -> object:
    """Multiply the chords' slopes by the tension instead of one minus the tension."""
    return right_cardinal_slopes(times, values, 1 - tension)


def mistake_steep_ends(times: Array, values: Array, tension: float) -> object:
    """Return one-sided differences times (1 - tension) as the slopes at both ends."""
    slopes = (1 - tension) * np.gradient(values, times)
    rises = values[2:] - values[:-2]
    slopes[1:-1] = (1 - tension) * rises / (times[2:] - times[:-2])
    return slopes


def mistake_next_key_alone(times: Array, values: Array, tension: float) -> object:
    """Return (1 - tension) times the slope of the chord from each inner key to the next."""
    slopes = np.zeros(len(times))
    rises = values[2:] - values[1:-1]
    slopes[1:-1] = (1 - tension) * rises / (times[2:] - times[1:-1])
    return slopes


# ---- flight_time


def draw_flight_time(rng: np.random.Generator) -> Arguments:
    """Draw the rise of a jump, and the height that is added to it, in metres."""
    return float(rng.uniform(0.1, 0.6)), float(rng.uniform(0.05, 0.5))


def right_flight_time(rise: float, added: float) -> float:
    """Return the ratio of two flight times: a rise takes the square root of twice the height over g."""
    return float(np.sqrt((rise + added) / rise))


def mistake_ratio_of_heights(rise: float, added: float) -> object:
    """Return the ratio of the new rise to the old one, without the square root."""
    return (rise + added) / rise


def mistake_ratio_of_added(rise: float, added: float) -> object:
    """Return the ratio of the added height to the old rise."""
    return added / rise


def mistake_squared_ratio(rise: float, added: float) -> object:
    """Return the square of the ratio of the rises."""
    return ((rise + added) / rise) ** 2


def mistake_linearised(rise: float, added: float) -> object:
    """Return 1 + added / (2 rise), the first-order approximation of the square root."""
    return 1 + added / (2 * rise)


def mistake_root_of_added(rise: float, added: float) -> object:
    """Return the square root of the ratio of the added height to the old rise."""
    return np.sqrt(added / rise)


def mistake_inverse_ratio(rise: float, added: float) -> object:
    """Return the old flight time divided by the new one."""
    return np.sqrt(rise / (rise + added))


def mistake_in_seconds(rise: float, added: float) -> object:
    """Return the new flight time 2 √(2 (rise + added) / g), up and down, in seconds."""
    return 2 * np.sqrt(2 * (rise + added) / 9.81)
