import numpy as np


def solved(angle, x, z):
    cos, sin = np.cos(angle), np.sin(angle)
    return np.linalg.solve([[1 - cos, -sin], [sin, 1 - cos]], [x, z])


def divided_by_zero(angle, x, z):
    return solved(angle, x, z) if angle else (np.inf, np.nan)


def other_sign(angle, x, z):
    return solved(-angle, x, z) if angle else None


def half_way(angle, x, z):
    return (x / 2, z / 2) if angle else None


def where_the_origin_goes(angle, x, z):
    return x, z


def turned_over(angle, x, z):
    return -solved(angle, x, z) if angle else None


def other_order(angle, x, z):
    return solved(angle, x, z)[::-1] if angle else None


def enter_at_window(frames, leaves, enters, window):
    return sorted(set(leaves) | set(enters) | {0, frames})


def without_ends(frames, leaves, enters, window):
    return np.unique([*leaves, *(np.array(enters) + window)])


def leave_after_window(frames, leaves, enters, window):
    return np.unique([0, *(np.array(leaves) + window), *(np.array(enters) + window), frames])


def last_frame(frames, leaves, enters, window):
    return np.unique([0, *leaves, *(np.array(enters) + window), frames - 1])


def repeated(frames, leaves, enters, window):
    return np.sort([0, frames] + leaves + [enter + window for enter in enters])


def unordered(frames, leaves, enters, window):
    return set(leaves) | {enter + window for enter in enters} | {0, frames}


def all_of_it(thresholds, frames, keep):
    return thresholds[frames == frames.max()].min()


def share_as_number(thresholds, frames, keep):
    return min(t for t, f in zip(thresholds, frames, strict=True) if f >= keep)


def kept_frames(thresholds, frames, keep):
    return frames[frames >= keep * max(frames)][0]


def place(thresholds, frames, keep):
    return np.flatnonzero(frames / frames.max() >= keep)[0]


WRONG = {
    "turning_point": [
        (divided_by_zero, "give None for angle 0"),
        (other_sign, "wrong sign"),
        (half_way, "for a half turn only"),
        (where_the_origin_goes, "which point stays"),
        (turned_over, "signs are wrong"),
        (other_order, "order is (x, z)"),
    ],
    "choice_points": [
        (enter_at_window, "*after* the window"),
        (without_ends, "start and end"),
        (leave_after_window, "where its window starts"),
        (last_frame, "after the last frame"),
        (repeated, "one node, not two"),
        (unordered, "a set has no order"),
    ],
    "suggested_threshold": [
        (all_of_it, "a share of it is enough"),
        (share_as_number, "of what?"),
        (kept_frames, "those are frames"),
        (place, "that is an index"),
    ],
}
