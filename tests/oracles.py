"""The slow ways, kept to judge the fast ones by."""

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from mocap.body.planar import PlanarTransform
from mocap.matching.point_clouds import unit_weights


def squared_distance(transform, points, others, weights):
    """Σ w ‖p - T p'‖² as it is written."""
    return float(weights @ ((points - PlanarTransform(*transform).apply_points(others)) ** 2).sum(-1))


def _windows(points, window, weights):
    """Lay out every window as one row: x, y and z times √w, shape (F - k + 1, k P) each, x and z centred."""
    rows = np.moveaxis(sliding_window_view(points, window, axis=0), -1, 1).reshape(-1, len(weights), 3)
    x, y, z = np.moveaxis(rows - np.einsum("p,npc->nc", weights, rows)[:, None] * [1, 0, 1], -1, 0)
    return [np.ascontiguousarray(part * np.sqrt(weights)) for part in (x, y, z)]


def distance_rows(a, b, window, rows, weights=None):
    """Some rows of the distance grid of points (F, P, 3): one window of a against all of b at a time."""
    w = np.tile(unit_weights(weights, a.shape[1]) / window, window)
    xb, yb, zb = _windows(b, window, w)
    sizes = sum((part**2).sum(1) for part in (xb, yb, zb))
    for i in rows:
        xa, ya, za = (part[0] for part in _windows(a[i : i + window], window, w))
        turned = np.hypot(xb @ xa + zb @ za, xb @ za - zb @ xa)
        yield xa @ xa + ya @ ya + za @ za + sizes - 2 * yb @ ya - 2 * turned


def distance_oracle(a, b, window, weights=None):
    """The whole grid, row by row."""
    return np.array(list(distance_rows(a, b, window, range(len(a) - window + 1), weights)))
