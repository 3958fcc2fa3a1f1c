import numpy as np


def how_many(seams, control):
    limit = np.quantile(control, 0.95)
    return len([jump for jump in seams if jump > limit])


def above_the_median(seams, control):
    return sum(seams > np.median(control)) / len(seams)


def above_the_largest(seams, control):
    return sum(seams > max(control)) / len(seams)


def among_themselves(seams, control):
    return sum(seams > np.quantile(seams, 0.95)) / len(seams)


def in_ones(seams, control):
    return (seams > np.percentile(control, 0.95)).mean()


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
    "beyond_control": [
        (how_many, "number of all seams"),
        (above_the_median, "nothing special"),
        (above_the_largest, "one extreme value"),
        (among_themselves, "with themselves"),
        (in_ones, "95, not 0.95"),
    ],
    "seam_jump": [
        (a_frame_late, "one frame too late"),
        (per_frame, "metres per frame"),
        (an_acceleration, "acceleration"),
        (anywhere, "the whole clip"),
    ],
    "reaction_time": [
        (in_frames, "those are frames"),
        (half_of_it, "fall evenly"),
        (all_of_it, "when the blend ends"),
        (of_the_new, "those of the old motion"),
    ],
    "ground_slid": [
        (in_space, "includes the height"),
        (with_touch_down, "comes down"),
        (between_plants, "from one plant to the next"),
        (with_swings, "only planted feet slide"),
    ],
}
