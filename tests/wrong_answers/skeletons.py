import numpy as np

from mocap.body.rotations import from_rotvec, multiply, rotate


def two_separate_angles(upper, fore, shoulder, elbow):
    x = upper * np.cos(shoulder) + fore * np.cos(elbow)
    y = upper * np.sin(shoulder) + fore * np.sin(elbow)
    return np.array([x, y])


def seen_from_the_elbow(upper, fore, shoulder, elbow):
    return fore * np.array([np.cos(shoulder + elbow), np.sin(shoulder + elbow)])


def sine_first(upper, fore, shoulder, elbow):
    both = shoulder + elbow
    return [
        upper * np.sin(shoulder) + fore * np.sin(both),
        upper * np.cos(shoulder) + fore * np.cos(both),
    ]


def folded_back(upper, fore, shoulder, elbow):
    arm = upper * np.exp(1j * shoulder) + fore * np.exp(1j * (shoulder - elbow))
    return arm.real, arm.imag


def whole_angle(axis, angle):
    n = axis / np.sqrt(axis @ axis)
    return np.concatenate([[np.cos(angle)], np.sin(angle) * n])


def axis_as_it_comes(axis, angle):
    x, y, z = axis * np.sin(angle / 2)
    return np.array([np.cos(angle / 2), x, y, z])


def scalar_last(axis, angle):
    x, y, z = axis / np.linalg.norm(axis) * np.sin(angle / 2)
    return np.array([x, y, z, np.cos(angle / 2)])


def radians_twice(axis, angle):
    return from_rotvec(np.deg2rad(angle) * axis / np.linalg.norm(axis))


def other_order(a, b):
    return multiply(b, a)


def no_cross(a, b):
    w, u, t, v = a[0], a[1:], b[0], b[1:]
    return np.array([w * t - u @ v, *(w * v + t * u)])


def plus_dot(a, b):
    w, u, t, v = a[0], a[1:], b[0], b[1:]
    return np.array([w * t + np.dot(u, v), *(w * v + t * u + np.cross(u, v))])


def number_by_number(a, b):
    return [p * q for p, q in zip(a, b, strict=True)]


def turned_by_itself(skeleton, turns, joint):
    point = skeleton.offsets[joint] * 0
    while joint != 0:
        point = point + skeleton.offsets[joint]
        point = rotate(turns[joint], point)
        joint = skeleton.parents[joint]
    return point


def root_left_out(skeleton, turns, joint):
    point = skeleton.offsets[joint]
    joint = skeleton.parents[joint]
    while joint > 0:
        point = rotate(turns[joint], point) + skeleton.offsets[joint]
        joint = skeleton.parents[joint]
    return point


def one_turn_each(skeleton, turns, joint):
    parts = []
    while joint > 0:
        parent = skeleton.parents[joint]
        parts.append(rotate(turns[parent], skeleton.offsets[joint]))
        joint = parent
    return np.sum(parts, axis=0)


def at_rest(skeleton, turns, joint):
    total = np.zeros(3)
    while joint > 0:
        total += skeleton.offsets[joint]
        joint = skeleton.parents[joint]
    return total


WRONG = {
    "hand": [
        (two_separate_angles, "angles act on"),
        (seen_from_the_elbow, "the elbow itself"),
        (sine_first, "swapped"),
        (folded_back, "same direction"),
    ],
    "axis_angle": [
        (whole_angle, "half the angle"),
        (axis_as_it_comes, "length 1"),
        (scalar_last, "stands first"),
        (radians_twice, "radians already"),
    ],
    "hamilton": [
        (other_order, "that is b a"),
        (no_cross, "cross product is missing"),
        (plus_dot, "sign of the dot"),
        (number_by_number, "number by number"),
    ],
    "climb": [
        (turned_by_itself, "its own offset"),
        (root_left_out, "the root turns too"),
        (one_turn_each, "turned by its parent alone"),
        (at_rest, "at rest"),
    ],
}
