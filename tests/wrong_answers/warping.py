import numpy as np
from scipy.spatial.transform import Rotation


def turn(q):
    return Rotation.from_quat(q, scalar_first=True)


def quat(rotation):
    return rotation.as_quat(scalar_first=True)


def offset(q, key, pose):
    return (turn(q[key]).inv() * turn(pose)).as_rotvec()


def on_the_left(q, key, pose, share):
    return quat(Rotation.from_rotvec(np.outer(share, offset(q, key, pose))) * turn(q))


def backwards(q, key, pose, share):
    b = (turn(pose).inv() * turn(q[key])).as_rotvec()
    return quat(turn(q) * Rotation.from_rotvec(np.outer(share, b)))


def subtracted(q, key, pose, share):
    b = turn(pose).as_rotvec() - turn(q[key]).as_rotvec()
    return quat(turn(q) * Rotation.from_rotvec(np.outer(share, b)))


def long_way(q, key, pose, share):
    w, x, y, z = q[key] * [1, -1, -1, -1]
    a, b, c, d = pose
    real = w * a - x * b - y * c - z * d
    vector = w * pose[1:] + a * np.array([x, y, z]) + np.cross([x, y, z], pose[1:])
    angle = 2 * np.arccos(np.clip(real, -1, 1))
    spin = angle * vector / np.linalg.norm(vector)
    return quat(turn(q) * Rotation.from_rotvec(np.outer(share, spin)))


def towards_the_pose(q, key, pose, share):
    b = (turn(q).inv() * turn(pose)).as_rotvec()
    return quat(turn(q) * Rotation.from_rotvec(share[:, None] * b))


def all_of_it(q, key, pose, share):
    return quat(turn(q) * Rotation.from_rotvec(offset(q, key, pose)))


def in_the_parent(q, key, pose, share):
    b = (turn(pose) * turn(q[key]).inv()).as_rotvec()
    return quat(Rotation.from_rotvec(np.outer(share, b)) * turn(q))


def by_count(times, values, tension):
    inner = [(1 - tension) * (c - a) / 2 for a, c in zip(values, values[2:], strict=False)]
    return np.array([0, *inner, 0])


def inner(times, values):
    pairs = zip(values, values[2:], times, times[2:], strict=False)
    return np.array([(c - a) / (s - r) for a, c, r, s in pairs])


def loose(times, values, tension):
    return np.array([0, *inner(times, values), 0])


def upside_down(times, values, tension):
    return np.array([0, *tension * inner(times, values), 0])


def with_sloping_ends(times, values, tension):
    first = (values[1] - values[0]) / (times[1] - times[0])
    last = (values[-1] - values[-2]) / (times[-1] - times[-2])
    return (1 - tension) * np.array([first, *inner(times, values), last])


def to_the_next(times, values, tension):
    ahead = np.diff(values)[1:] / np.diff(times)[1:]
    return np.array([0, *(1 - tension) * ahead, 0])


def ratio(rise, more):
    return 1 + more / rise


def added(rise, more):
    return more / rise


def root_of_added(rise, more):
    return (more / rise) ** 0.5


def shorter(rise, more):
    return (rise / (rise + more)) ** 0.5


def seconds(rise, more):
    return 2 * (2 * (rise + more) / 9.81) ** 0.5


WRONG = {
    "offset_curve": [
        (on_the_left, "on the left of q"),
        (backwards, "goes the other way"),
        (subtracted, "subtract rotation vectors"),
        (long_way, "the long way round"),
        (towards_the_pose, "every frame towards the one pose"),
        (all_of_it, "the whole offset"),
        (in_the_parent, "in the parent's frame"),
    ],
    "cardinal_slopes": [
        (by_count, "by the number of keys"),
        (loose, "is missing"),
        (upside_down, "multiply by the tension"),
        (with_sloping_ends, "must be level"),
        (to_the_next, "to the next key only"),
    ],
    "flight_time": [
        (ratio, "ratio of the heights"),
        (added, "what is added"),
        (root_of_added, "not Δ alone"),
        (shorter, "the inverse"),
        (seconds, "in seconds"),
    ],
}
