from dataclasses import replace

import numpy as np

from mocap.body.rotations import slerp


def by_sines(start, end, amount):
    with np.errstate(invalid="ignore", divide="ignore"):
        angle = np.arccos(np.dot(start, end))
        whole = np.sin(angle)
        return np.sin((1 - amount) * angle) / whole * start + np.sin(amount * angle) / whole * end


def without_a_branch(start, end, amount):
    return by_sines(start, -end if start @ end < 0 else end, amount)


def with_a_branch(start, end, amount):
    if start @ end < 0:
        end = -end
    if start @ end > 1 - 1e-12:
        return (1 - amount) * start + amount * end
    return by_sines(start, end, amount)


def with_a_rough_branch(start, end, amount):
    return start if abs(start @ end) > 1 - 1e-12 else with_a_branch(start, end, amount)


def backwards(start, end, amount):
    return with_a_branch(end, start if start @ end >= 0 else -start, amount)


def backwards_without_a_branch(start, end, amount):
    return without_a_branch(end, start if start @ end >= 0 else -start, amount)


def normalised_line(start, end, amount):
    if start @ end < 0:
        end = -end
    q = start + amount * (end - start)
    return q / np.sqrt((q**2).sum())


def bare_line(start, end, amount):
    if start @ end < 0:
        end = -end
    return start + amount * (end - start)


def line_the_long_way(start, end, amount):
    q = start + amount * (end - start)
    return q / np.sqrt((q**2).sum())


def line_as_it_is(start, end, amount):
    return start + amount * (end - start)


def not_divided(start, end, amount):
    angle = np.arccos(np.clip(abs(start @ end), 0, 1))
    end = -end if start @ end < 0 else end
    return np.sin((1 - amount) * angle) * start + np.sin(amount * angle) * end


def rising(window):
    t = np.arange(1, window + 1) / window
    return t**3 * (10 - 15 * t + 6 * t**2)


def a_frame_late(window):
    t = np.arange(window) / window
    return 1 - t**3 * (10 - 15 * t + 6 * t**2)


def end_to_end(window):
    t = np.arange(window) / (window - 1)
    return 1 - t**3 * (10 - 15 * t + 6 * t**2)


def cubic(window):
    t = np.arange(1, window + 1) / window
    return 1 + t**2 * (2 * t - 3)


def roots_of(a, b, alpha):
    return b.root_positions + alpha.reshape(-1, 1) * (a.root_positions - b.root_positions)


def turns_of(a, b, alpha):
    frames = [slerp(b.rotations[f], a.rotations[f], alpha[f]) for f in range(len(a))]
    return np.array(frames)


def shares_swapped(a, b, alpha):
    return roots_of(b, a, alpha), turns_of(b, a, alpha)


def slerp_backwards(a, b, alpha):
    return roots_of(a, b, alpha), turns_of(b, a, alpha)


def roots_swapped(a, b, alpha):
    return roots_of(b, a, alpha), turns_of(a, b, alpha)


def roots_alone(a, b, alpha):
    return roots_of(a, b, alpha), a.rotations.copy()


def root_joint_alone(a, b, alpha):
    turns = a.rotations.copy()
    turns[:, 0] = turns_of(a, b, alpha)[:, 0]
    return roots_of(a, b, alpha), turns


def bare_lines(a, b, alpha):
    share = alpha.reshape(-1, 1, 1)
    return roots_of(a, b, alpha), b.rotations + share * (a.rotations - b.rotations)


def unit_lines(a, b, alpha):
    roots, turns = bare_lines(a, b, alpha)
    return roots, turns / np.sqrt((turns**2).sum(-1))[..., None]


def unit_lines_the_short_way(a, b, alpha):
    nearer = np.where((a.rotations * b.rotations).sum(-1)[..., None] < 0, -1.0, 1.0)
    return unit_lines(a, replace(b, rotations=nearer * b.rotations), alpha)


WRONG = {
    "short_way": [
        (by_sines, "the long way round: if"),
        (without_a_branch, "sin Ω is 0"),
        (with_a_rough_branch, "sin Ω is 0"),
        (backwards, "yours runs backwards."),
        (backwards_without_a_branch, "yours runs backwards."),
        (normalised_line, "not at constant speed"),
        (bare_line, "cuts through the sphere"),
        (line_the_long_way, "on a straight line, and"),
        (line_as_it_is, "does not keep the length 1, and"),
        (not_divided, "divide by the sine"),
    ],
    "quintic": [
        (rising, "these rise"),
        (a_frame_late, "one frame late"),
        (end_to_end, "would be wasted"),
        (cubic, "the cubic"),
    ],
    "mix": [
        (shares_swapped, "you give that share to b"),
        (slerp_backwards, "the rotations run backwards"),
        (roots_swapped, "in the roots, alpha"),
        (roots_alone, "the joints are still a's"),
        (root_joint_alone, "only the root"),
        (bare_lines, "a straight line leaves"),
        (unit_lines, "the long way round: use slerp"),
        (unit_lines_the_short_way, "not at constant speed"),
    ],
}
