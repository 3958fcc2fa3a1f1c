import numpy as np


def second_differences(x):
    return x[2:] - 2 * x[1:-1] + x[:-2]


def added(result, first, second, alpha):
    share = alpha[:, None]
    mixed = share * second_differences(first) + (1 - share) * second_differences(second)
    return np.sqrt(((second_differences(result) - mixed) ** 2).sum(axis=1))


def a_frame_early(result, first, second, alpha, fps):
    return max(added(result, first, second, alpha[:-2])) * fps


def a_frame_late(result, first, second, alpha, fps):
    return max(added(result, first, second, alpha[2:])) * fps


def the_wrong_share(result, first, second, alpha, fps):
    return max(added(result, first, second, 1 - alpha[1:-1])) * fps


def of_the_result(result, first, second, alpha, fps):
    return np.linalg.norm(second_differences(result), axis=1).max() * fps


def places_first(result, first, second, alpha, fps):
    mixed = alpha[:, None] * first + (1 - alpha)[:, None] * second
    return np.linalg.norm(second_differences(result - mixed), axis=1).max() * fps


def per_frame(result, first, second, alpha, fps):
    return max(added(result, first, second, alpha[1:-1]))


def an_acceleration(result, first, second, alpha, fps):
    return per_frame(result, first, second, alpha, fps) * fps * fps


def how_many(seams, baseline):
    limit = np.quantile(baseline, 0.95)
    return len([jump for jump in seams if jump > limit])


def above_the_median(seams, baseline):
    return sum(seams > np.median(baseline)) / len(seams)


def above_the_largest(seams, baseline):
    return sum(seams > max(baseline)) / len(seams)


def among_themselves(seams, baseline):
    return sum(seams > np.quantile(seams, 0.95)) / len(seams)


def in_ones(seams, baseline):
    return (seams > np.percentile(baseline, 0.95)).mean()


def without_waiting(asked, leaves, weights, fps):
    return next(frame for frame, weight in enumerate(weights) if weight < 0.5) / fps


def only_waiting(asked, leaves, weights, fps):
    return (min(leave for leave in leaves if leave >= asked) - asked) / fps


def waited(asked, leaves):
    return leaves[np.searchsorted(leaves, asked)] - asked


def in_frames(asked, leaves, weights, fps):
    return waited(asked, leaves) + int(np.argmax(weights < 0.5))


def half_of_it(asked, leaves, weights, fps):
    return (waited(asked, leaves) + 0.5 * len(weights)) / fps


def all_of_it(asked, leaves, weights, fps):
    return (waited(asked, leaves) + weights.size) / fps


def the_nearest(asked, leaves, weights, fps):
    nearest = min(leaves, key=lambda leave: abs(leave - asked))
    return (nearest - asked + int(np.argmax(weights < 0.5))) / fps


WRONG = {
    "added_jolt": [
        (a_frame_early, "a frame early"),
        (a_frame_late, "a frame late"),
        (the_wrong_share, "share of the first clip"),
        (of_the_result, "the jolt of the result"),
        (places_first, "mix the places"),
        (per_frame, "metres per frame"),
        (an_acceleration, "acceleration"),
    ],
    "beyond_baseline": [
        (how_many, "number of all seams"),
        (above_the_median, "nothing special"),
        (above_the_largest, "one extreme value"),
        (among_themselves, "with themselves"),
        (in_ones, "95, not 0.95"),
    ],
    "reaction_time": [
        (without_waiting, "waits for the next transition"),
        (only_waiting, "waiting alone"),
        (in_frames, "those are frames"),
        (half_of_it, "fall evenly"),
        (all_of_it, "when the blend ends"),
        (the_nearest, "in the past"),
    ],
}
