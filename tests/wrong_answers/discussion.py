import numpy as np


def its_place(thresholds, frames, share):
    return next(place for place, kept in enumerate(frames) if kept >= share * max(frames))


def one_too_early(thresholds, frames, share):
    best = None
    for threshold, kept in zip(thresholds, frames, strict=True):
        if kept < share * frames.max():
            best = threshold
    return best


def the_most(thresholds, frames, share):
    return thresholds[list(frames).index(max(frames))]


def the_loosest(thresholds, frames, share):
    return [t for t, kept in zip(thresholds, frames, strict=True) if kept >= share * max(frames)][-1]


def second_differences(x):
    return np.sqrt(((x[2:] - 2 * x[1:-1] + x[:-2]) ** 2).sum(axis=1))


def a_frame_late(positions, start, stop, fps):
    return max(second_differences(positions)[start:stop]) * fps


def per_frame(positions, start, stop, fps):
    return max(second_differences(positions)[start - 1 : stop - 1])


def an_acceleration(positions, start, stop, fps):
    return per_frame(positions, start, stop, fps) * fps * fps


def anywhere(positions, start, stop, fps):
    return second_differences(positions).max() * fps


def in_frames(weights, fps):
    return next(frame for frame, weight in enumerate(weights) if weight < 0.5)


def half_of_it(weights, fps):
    return 0.5 * len(weights) / fps


def all_of_it(weights, fps):
    return weights.size / fps


def of_the_new(weights, fps):
    return next(frame for frame, weight in enumerate(weights) if weight > 0.5) / fps


def way(steps):
    return float(np.sqrt((steps[:, [0, 2]] ** 2).sum(axis=1)).sum())


def in_space(positions, planted):
    steps = (positions[1:] - positions[:-1])[planted[:-1] & planted[1:]]
    return np.sqrt((steps**2).sum(axis=1)).sum()


def with_touch_down(positions, planted):
    return way((positions[1:] - positions[:-1])[planted[1:]])


def between_plants(positions, planted):
    standing = positions[planted]
    return way(standing[1:] - standing[:-1])


def with_swings(positions, planted):
    return way(positions[1:] - positions[:-1])


WRONG = {
    "enough_threshold": [
        (its_place, "place in the list"),
        (one_too_early, "does not suffice"),
        (the_most, "a share of it is enough"),
        (the_loosest, "the strictest makes"),
    ],
    "seam_jump": [
        (a_frame_late, "a frame too late"),
        (per_frame, "metres a frame"),
        (an_acceleration, "acceleration"),
        (anywhere, "the whole clip"),
    ],
    "reaction_time": [
        (in_frames, "those are frames"),
        (half_of_it, "fall evenly"),
        (all_of_it, "when the blend ends"),
        (of_the_new, "the old motion's"),
    ],
    "ground_slid": [
        (in_space, "the height is in it"),
        (with_touch_down, "comes down"),
        (between_plants, "from one plant to the next"),
        (with_swings, "only planted feet slide"),
    ],
}
