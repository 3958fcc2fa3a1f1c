"""The slow ways, kept to judge the fast ones by."""

from functools import cache

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from mocap._shared.arrays import runs
from mocap.body import PlanarTransform, joint_positions
from mocap.matching.point_clouds import unit_weights


def slides(motion):
    """Return how far a joint is from its mean place at most, for each plant, metres."""
    positions = joint_positions(motion)
    plants = [
        positions[start:stop, motion.skeleton.index(name)]
        for name, marks in motion.contacts.items()
        for start, stop in runs(marks)
    ]
    return np.array([np.linalg.norm(plant - plant.mean(axis=0), axis=-1).max() for plant in plants])


def squared_distance(transform, points, others, weights):
    """Σ w ‖p - T p'‖² as it is written."""
    return float(weights @ ((points - PlanarTransform(*transform).apply_points(others)) ** 2).sum(-1))


def _windows(points, window, weights):
    """Lay out every window as one row: x, y and z times √w, shape (F - k + 1, k P) each, x and z centred."""
    rows = np.moveaxis(sliding_window_view(points, window, axis=0), -1, 1).reshape(-1, len(weights), 3)
    x, y, z = np.moveaxis(rows - np.einsum("p,npc->nc", weights, rows)[:, None] * [1, 0, 1], -1, 0)
    return [np.ascontiguousarray(part * np.sqrt(weights)) for part in (x, y, z)]


def distance_oracle(a, b, window, weights=None, taper=None):
    """The distance grid of points (F, P, 3), row by row: one window of a against all of b at a time."""
    w = np.outer(unit_weights(taper, window), unit_weights(weights, a.shape[1])).ravel()
    xb, yb, zb = _windows(b, window, w)
    sizes = sum((part**2).sum(1) for part in (xb, yb, zb))
    rows = []
    for i in range(len(a) - window + 1):
        xa, ya, za = (part[0] for part in _windows(a[i : i + window], window, w))
        turned = np.hypot(xb @ xa + zb @ za, xb @ za - zb @ xa)
        rows.append(xa @ xa + ya @ ya + za @ za + sizes - 2 * yb @ ya - 2 * turned)
    return np.array(rows)


def least_sum(grid, slope, begin=(0, 0), end=None):
    """The least sum of a path between two cells, as the rule is written: a state for each length of a run."""
    (top, left), (bottom, right) = begin, end or (grid.shape[0] - 1, grid.shape[1] - 1)

    @cache
    def best(i, j, state):
        if i < top or j < left:
            return np.inf
        if state == 0:
            if (i, j) == begin:
                return 2 * grid[i, j]
            return 2 * grid[i, j] + min(best(i - 1, j - 1, other) for other in range(2 * slope + 1))
        if state <= slope:
            return grid[i, j] + best(i - 1, j, state - 1)
        return grid[i, j] + best(i, j - 1, 0 if state == slope + 1 else state - 1)

    return min(best(bottom, right, state) for state in range(2 * slope + 1))


def path_sum(costs, path):
    """Costs along a path, each by the frames that its step advances; the first cell counts 2."""
    return float(costs[tuple(path.T)] @ np.append(2, np.abs(np.diff(path, axis=0)).sum(axis=1)))


def longest_run(path):
    """The number of straight steps of one direction that follow each other."""
    runs, run, last = [0], 0, None
    for step in map(tuple, np.diff(path, axis=0).tolist()):
        run = run + 1 if step == last else 1
        last = step
        runs += [run] * (step != (1, 1))
    return max(runs)
