import math

import numpy as np


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


def never_negative(a, b):
    return math.acos(max(-1.0, min(1.0, math.cos(b - a))))


def half_turns_dropped(a, b):
    return np.mod(b - a, np.pi)


def on_the_far_side(headings):
    return np.mean([heading % math.tau for heading in headings]) + np.pi


def twin_of(angles):
    a, b, c = angles
    return np.array([a + np.pi, np.pi - b, c + np.pi])


def brought_near(before, angles):
    return before + (np.asarray(angles) - before + np.pi) % (2 * np.pi) - np.pi


def nearer(before, first, second):
    return first if abs(first - before).sum() < abs(second - before).sum() else second


def only_whole_turns(before, angles):
    return np.unwrap([before, angles], axis=0)[1]


def always_the_twin(before, angles):
    return brought_near(before, twin_of(angles))


def no_whole_turns(before, angles):
    return nearer(before, angles, twin_of(angles))


def middle_angle_wrong(before, angles):
    return nearer(before, brought_near(before, angles), brought_near(before, angles + np.pi))


def stays_where_it_was(before, angles):
    return before.copy()


def on_the_last_place(parts):
    places = []
    for clip, start, stop in parts:
        move = places[-1] - clip[start] if places else np.zeros(2)
        places.extend(clip[start:stop] + move)
    return np.array(places)


def as_stored(parts):
    return np.vstack([clip[start:stop] for clip, start, stop in parts])


def without_adding_up(parts):
    places = list(parts[0][0][parts[0][1] : parts[0][2]])
    for k in range(1, len(parts)):
        clip, start, stop = parts[k]
        before, _, end = parts[k - 1]
        places.extend(clip[start:stop] + before[end] - clip[start])
    return np.array(places)


def one_too_far(parts):
    places, move = [], np.zeros(2)
    for k, (clip, start, stop) in enumerate(parts):
        places.extend(clip[start:stop] + move)
        if k + 1 < len(parts):
            following, first, _ = parts[k + 1]
            move = move + clip[stop + 1] - following[first]
    return np.array(places)


WRONG = {
    "turn_between": [
        (plain_difference, "-340°"),
        (from_b, "from b to a"),
        (never_to_the_right, "350°"),
        (without_side, "keep the sign"),
        (never_negative, "arccos gives only"),
        (half_turns_dropped, "half turns not"),
    ],
    "mean_heading": [
        (plain_mean, "opposite of where both look"),
        (cosine_first, "sine first"),
        (half_the_circle, "half the circle"),
        (middle_one, "median"),
        (on_the_far_side, "off by half a turn"),
    ],
    "nearest_twin": [
        (only_whole_turns, "never take the twin"),
        (always_the_twin, "always take the twin"),
        (no_whole_turns, "whole turns are missing"),
        (middle_angle_wrong, "middle angle of the twin"),
        (stays_where_it_was, "the frame before"),
    ],
    "chain": [
        (on_the_last_place, "bug five is still there"),
        (as_stored, "leaps from clip to clip"),
        (without_adding_up, "add up the moves"),
        (one_too_far, "you skip a frame"),
    ],
}
