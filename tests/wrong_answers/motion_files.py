from itertools import pairwise

import numpy as np

from mocap.body.euler import from_euler
from mocap.body.rotations import from_rotvec, inverse, multiply


def from_the_right(z, x, y):
    q = from_euler("y", [np.radians(y)])
    return multiply(multiply(q, from_euler("x", [np.radians(x)])), from_euler("z", [np.radians(z)]))


def in_degrees(z, x, y):
    return multiply(multiply(from_rotvec([0, 0, z]), from_rotvec([x, 0, 0])), from_rotvec([0, y, 0]))


def alphabet(z, x, y):
    x, y, z = np.radians([x, y, z])
    return multiply(from_rotvec([x, 0, 0]), multiply(from_rotvec([0, y, 0]), from_rotvec([0, 0, z])))


def all_at_once(z, x, y):
    return from_rotvec(np.radians([x, y, z]))


def turn(degrees, order="xyz"):
    return from_euler(order, np.radians(degrees))


def without_inverse(axis, angles):
    return multiply(turn(axis), turn(angles))


def inverse_first(axis, angles):
    return multiply(multiply(inverse(turn(axis)), turn(angles)), turn(axis))


def about_own_axes(axis, angles):
    c = turn(axis, "XYZ")
    return multiply(multiply(c, turn(angles, "XYZ")), inverse(c))


def degrees_as_radians(axis, angles):
    c = from_euler("xyz", axis)
    return multiply(multiply(c, from_euler("xyz", angles)), inverse(c))


def motion_alone(axis, angles):
    return turn(angles)


def frame_before(contact):
    return [f for f in range(len(contact) - 1) if contact[f + 1] and not contact[f]]


def all_standing(contact):
    return np.nonzero(contact)[0]


def all_changes(contact):
    return [f for f in range(1, len(contact)) if contact[f] != contact[f - 1]]


def lifts(contact):
    return [f for f in range(1, len(contact)) if contact[f - 1] and not contact[f]]


def frame_0_too(contact):
    return [f for f in range(len(contact)) if contact[f] and (f == 0 or not contact[f - 1])]


def counted(contact):
    return sum(bool(b and not a) for a, b in pairwise(contact))


WRONG = {
    "own_axes": [
        (from_the_right, "stands leftmost"),
        (in_degrees, "take radians"),
        (alphabet, "alphabet"),
        (all_at_once, "one turn about"),
    ],
    "acclaim_turn": [
        (without_inverse, "that is C M"),
        (inverse_first, "stands on the left"),
        (about_own_axes, "own axes"),
        (degrees_as_radians, "take radians"),
        (motion_alone, "M alone"),
    ],
    "strikes": [
        (frame_before, "too early"),
        (all_standing, "in which the foot stands"),
        (all_changes, "half of them are lifts"),
        (lifts, "those are the lifts"),
        (frame_0_too, "in frame 0"),
        (counted, "return the frames"),
    ],
}
