import numpy as np

from mocap.body.rotations import inverse, multiply


def about_the_floor(hips, ratio, low_s, low_t, centre):
    middle = np.array([centre[0], 0, centre[1]])
    return middle + ratio * (hips - middle)


def old_ankles(hips, ratio, low_s, low_t, centre):
    middle = np.array([centre[0], low_s, centre[1]])
    return middle + ratio * (hips - middle)


def swapped(hips, ratio, low_s, low_t, centre):
    new = about_the_floor(hips, ratio, low_s, low_t, centre)
    new[:, 1] = low_s + ratio * (hips[:, 1] - low_t)
    return new


def about_the_origin(hips, ratio, low_s, low_t, centre):
    return [0, low_t, 0] + ratio * (hips - np.array([0, low_s, 0]))


def as_far(hips, ratio, low_s, low_t, centre):
    new = hips.copy()
    new[:, 1] = low_t + ratio * (new[:, 1] - low_s)
    return new


def other_way_round(hips, ratio, low_s, low_t, centre):
    middle = np.array([centre[0], low_s, centre[1]])
    return [0, low_t - low_s, 0] + middle + (hips - middle) / ratio


def stance_forgotten(source, target, turn):
    return multiply(source, multiply(turn, target))


def on_the_right(source, target, turn):
    return multiply(multiply(inverse(source), target), turn)


def never_laid(source, target, turn):
    return multiply(inverse(source), target)


def inverse_last(source, target, turn):
    return multiply(multiply(turn, target), inverse(source))


def from_target_to_source(source, target, turn):
    return multiply(inverse(target), multiply(inverse(turn), source))


def laid_back(source, target, turn):
    return multiply(inverse(source), multiply(inverse(turn), target))


def sixfold(u):
    return [(1 - u) ** 3, 3 * u**3 - 6 * u**2 + 4, -3 * u**3 + 3 * u**2 + 3 * u + 1, u**3]


def late_first(u):
    return np.array(sixfold(u))[::-1] / 6


def through_the_points(u):
    basis = np.array([[0, 2, 0, 0], [-1, 0, 1, 0], [2, -5, 4, -1], [-1, 3, -3, 1]]) / 2
    return np.array([1, u, u**2, u**3]) @ basis


def bezier(u):
    v = 1 - u
    return [v**3, 3 * v**2 * u, 3 * v * u**2, u**3]


def straight(u):
    return [0, 1 - u, u, 0]


WRONG = {
    "scaled_root": [
        (about_the_floor, "scaled about the floor"),
        (old_ankles, "stand at `low_t`"),
        (swapped, "are swapped"),
        (about_the_origin, "origin of the world"),
        (as_far, "too long for these legs"),
        (other_way_round, "the wrong way round"),
    ],
    "bone_turn": [
        (stance_forgotten, "is not taken off"),
        (on_the_right, "A stands on the wrong side"),
        (never_laid, "A is missing"),
        (inverse_last, "inverse stands on the wrong side"),
        (from_target_to_source, "the inverse of C"),
        (laid_back, "do not invert it"),
    ],
    "design_row": [
        (sixfold, "add up to 6"),
        (late_first, "the order is reversed"),
        (through_the_points, "Catmull and Rom"),
        (bezier, "Bernstein"),
        (straight, "linear"),
    ],
}
