import numpy as np

from mocap.body.rotations import multiply, rotate


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
