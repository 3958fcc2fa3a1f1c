"""The slow ways, kept to judge the fast ones by."""

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from mocap.point_clouds import align, unit_weights
from mocap.transforms import PlanarTransform


def squared_distance(transform, points, others, weights):
    """Σ w ‖p - T p'‖² as it is written."""
    return float(weights @ ((points - PlanarTransform(*transform).points(others)) ** 2).sum(-1))


def distance_rows(a, b, window, rows, weights=None, taper=None):
    """Some rows of the distance grid of points (F, P, 3): lay all windows of b on one of a at a time."""
    joint, frame = unit_weights(weights, a.shape[1]), unit_weights(taper, window)
    w = np.outer(frame, joint).ravel()
    windows = sliding_window_view(b, window, axis=0)  # (F - k + 1, P, 3, k)
    others = np.moveaxis(windows, -1, 1).reshape(len(windows), -1, 3)
    for i in rows:
        points = np.broadcast_to(a[i : i + window].reshape(-1, 3), others.shape)
        left = points - PlanarTransform(*(f[:, None] for f in align(points, others, w))).points(others)
        yield (left**2).sum(-1) @ w


def distance_oracle(a, b, window, weights=None, taper=None):
    """The whole grid, row by row."""
    return np.array(list(distance_rows(a, b, window, range(len(a) - window + 1), weights, taper)))
