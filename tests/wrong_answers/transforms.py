import math

import numpy as np


def other_way_round(points, angle, x, z):
    c, s = np.cos(angle), np.sin(angle)
    px, py, pz = points.T
    return np.column_stack([px * c - pz * s + x, py, pz * c + px * s + z])


def moved_and_then_turned(points, angle, x, z):
    c, s = np.cos(angle), np.sin(angle)
    matrix = np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])
    return (points + np.array([x, 0, z])) @ matrix.T


def lifted(points, angle, x, z):
    c, s = np.cos(angle), np.sin(angle)
    moved = points @ np.array([[c, 0, -s], [0, 1, 0], [s, 0, c]])
    moved[:, 0] += x
    moved[:, 1] += z
    return moved


def turned_only(points, angle, x, z):
    c, s = np.cos(angle), np.sin(angle)
    return points @ np.array([[c, 0, -s], [0, 1, 0], [s, 0, c]])


def all_signs(angle, x, z):
    return -angle, -x, -z


def shift_turned_on(angle, x, z):
    c, s = np.cos(angle), np.sin(angle)
    return -angle, -(x * c + z * s), -(z * c - x * s)


def shift_kept_its_sign(angle, x, z):
    c, s = np.cos(angle), np.sin(angle)
    return -angle, x * c - z * s, z * c + x * s


def same_turn_again(angle, x, z):
    c, s = np.cos(angle), np.sin(angle)
    return angle, -(x * c - z * s), -(z * c + x * s)


def differences(moving, target):
    return tuple(np.array(target) - np.array(moving))


def the_target_moves(moving, target):
    turn = moving[0] - target[0]
    c, s = np.cos(turn), np.sin(turn)
    x, z = target[1] * c + target[2] * s, target[2] * c - target[1] * s
    return turn, moving[1] - x, moving[2] - z


def turned_away(moving, target):
    turn = moving[0] - target[0]
    c, s = np.cos(turn), np.sin(turn)
    x, z = moving[1] * c + moving[2] * s, moving[2] * c - moving[1] * s
    return turn, target[1] - x, target[2] - z


def the_whole_heading(moving, target):
    turn = target[0]
    c, s = np.cos(turn), np.sin(turn)
    x, z = moving[1] * c + moving[2] * s, moving[2] * c - moving[1] * s
    return turn, target[1] - x, target[2] - z


def plain_difference(a, b):
    return b - a


def from_b(a, b):
    return math.remainder(a - b, math.tau)


def never_to_the_right(a, b):
    return np.mod(b - a, 2 * np.pi)


def without_side(a, b):
    return abs(math.remainder(b - a, math.tau))


def plain_mean(headings):
    return sum(headings) / len(headings)


def cosine_first(headings):
    return np.arctan2(np.cos(headings).sum(), np.sin(headings).sum())


def half_the_circle(headings):
    return np.arctan(np.sin(headings).sum() / np.cos(headings).sum())


def middle_one(headings):
    return np.median(headings)


WRONG = {
    "move_points": [
        (other_way_round, "sign of θ"),
        (moved_and_then_turned, "turn first"),
        (lifted, "the height"),
        (turned_only, "not moved"),
    ],
    "undo": [
        (all_signs, "wrong order"),
        (shift_turned_on, "turned the wrong way"),
        (shift_kept_its_sign, "sign of the shift"),
        (same_turn_again, "sign of the angle"),
    ],
    "lay_on": [
        (differences, "about the origin"),
        (the_target_moves, "`moving` that should move"),
        (turned_away, "sign of the angle"),
        (the_whole_heading, "a heading already"),
    ],
    "turn_between": [
        (plain_difference, "-340°"),
        (from_b, "from b to a"),
        (never_to_the_right, "350°"),
        (without_side, "keep the sign"),
    ],
    "mean_heading": [
        (plain_mean, "opposite of where both look"),
        (cosine_first, "sine first"),
        (half_the_circle, "half the circle"),
        (middle_one, "median"),
    ],
}
