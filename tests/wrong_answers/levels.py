import numpy as np


def wrong_way(p, low, high):
    return p - np.minimum(np.maximum(p, low), high)


def nearest_point(p, low, high):
    return np.minimum(np.maximum(p, low), high)


def to_the_middle(p, low, high):
    both = np.isfinite(low) & np.isfinite(high)
    with np.errstate(invalid="ignore"):
        return np.where(both, 0.5 * (low + high) - p, 0.0)


def floors_only(p, low, high):
    return np.where(p < low, low - p, 0.0)


def ceilings_only(p, low, high):
    return np.where(p > high, high - p, 0.0)


def held_is_free(p, low, high):
    into = np.minimum(np.maximum(p, low), high) - p
    into[low == high] = 0
    return into


def distance(p, low, high):
    return np.abs(np.clip(p, low, high) - p)


def arm_times_axis(joint, end, axis, turn):
    return np.cross(end - joint, turn @ axis)


def own_frame(joint, end, axis, turn):
    return np.cross(axis, end - joint)


def inverse_matrix(joint, end, axis, turn):
    return np.cross(np.linalg.inv(turn) @ axis, end - joint)


def from_the_origin(joint, end, axis, turn):
    return np.cross(turn @ axis, end)


def turned_at_last(joint, end, axis, turn):
    return turn @ np.cross(axis, end - joint)


def beta(weights, data):
    return weights * data[:, None] / (weights**2).sum(1)[:, None]


def weighted(weights, alone):
    total = weights.sum(0)
    return np.where(total > 0, (weights * alone).sum(0) / np.where(total > 0, total, 1), 0)


def weighted_by_w(weights, data):
    return weighted(weights, beta(weights, data))


def columns(weights, data):
    squares = (weights**2).sum(0)
    alone = weights * data[:, None] / np.where(squares > 0, squares, 1)
    return weighted(weights**2, alone)


def divides_by_nothing(weights, data):
    with np.errstate(all="ignore"):
        return (weights**2 * beta(weights, data)).sum(0) / (weights**2).sum(0)


def mean_of_the_data(weights, data):
    return weighted(weights, np.tile(data[:, None], weights.shape[1]))


def least_squares(weights, data):
    return np.linalg.pinv(weights) @ data


WRONG = {
    "clip_gap": [
        (wrong_way, "the sign"),
        (nearest_point, "nearest point of the box"),
        (to_the_middle, "the middle of the box"),
        (floors_only, "a ceiling must push down"),
        (ceilings_only, "a floor must push up"),
        (held_is_free, "held at this number"),
        (distance, "has a direction"),
    ],
    "position_slope": [
        (arm_times_axis, "the other way"),
        (own_frame, "in the joint's own frame"),
        (inverse_matrix, "the wrong way"),
        (from_the_origin, "not at the origin"),
        (turned_at_last, "mixes two frames"),
    ],
    "local_fit": [
        (weighted_by_w, "weighted by w², not by w"),
        (columns, "not a column"),
        (divides_by_nothing, "0 divided by 0"),
        (mean_of_the_data, "the mean of the data"),
        (least_squares, "together"),
    ],
}
