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


def joined(points, transitions, window, leaves=0, enters=None):
    following = {(clip, frame): [] for clip, frames in enumerate(points) for frame in frames}
    for clip, frames in enumerate(points):
        for n in range(len(frames) - 1):
            following[clip, frames[n]] += [(clip, frames[n + 1])]
    enters = window if enters is None else enters
    for source, leave, target, enter in transitions:
        following.setdefault((source, leave + leaves), []).append((target, enter + enters))
    return following


def enters_at_the_window(points, transitions, window):
    return joined(points, transitions, window, enters=0)


def leaves_after_the_window(points, transitions, window):
    return joined(points, transitions, window, leaves=window)


def one_long_clip(points, transitions, window):
    following = joined(points, transitions, window)
    for clip in range(len(points) - 1):
        following[clip, points[clip][-1]] += [(clip + 1, points[clip + 1][0])]
    return following


def everything_later(points, transitions, window):
    following = joined(points, transitions, window)
    for clip, frames in enumerate(points):
        for n, frame in enumerate(frames):
            following[clip, frame] += [(clip, later) for later in frames[n + 2 :]]
    return following


def never_across(points, transitions, window):
    return joined(points, [], window)


def ends_forgotten(points, transitions, window):
    following = joined(points, transitions, window)
    return {node: following[node] for node in following if following[node]}


def both_ways(points, transitions, window):
    following = joined(points, transitions, window)
    for source, leave, target, enter in transitions:
        following[target, enter + window] += [(source, leave)]
    return following


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
    "successors_of": [
        (enters_at_the_window, "not at enter"),
        (leaves_after_the_window, "not at leave + window"),
        (one_long_clip, "to the start of the next clip"),
        (everything_later, "the next choice point"),
        (never_across, "transitions are missing"),
        (ends_forgotten, "empty list"),
        (both_ways, "leads one way"),
    ],
}
