"""Which windows of two clips are alike: a grid of distances, its minima, and how one lies on the other."""

from collections.abc import Sequence
from itertools import combinations_with_replacement
from typing import NamedTuple

import numpy as np

from mocap._shared.arrays import Array
from mocap.course.lab.own.tools import Tools


class Match(NamedTuple):
    """A transition: the window at `leave` of clip `source` blends into the one at `enter` of `target`.

    Windows are named by their first frames. `cost` is the RMS distance of the points, metres; `angle`, `x`
    and `z` lay the target on the source.
    """

    source: int
    leave: int
    target: int
    enter: int
    cost: float
    angle: float
    x: float
    z: float


def window_distances(a: Array, b: Array, window: int, by: Tools) -> Array:
    """Measure D between all windows of two clouds, shapes (F, P, 3): (F_a - k + 1, F_b - k + 1), m².

    With points on the ground as complex numbers g = z + ix, and means over a window's points,
    D = S + S' - 2 mean(y y') - 2 |mean(g ḡ') - mean(g) mean(ḡ')|: the grid of notebook 02b.
    """
    origin = np.array([*a.mean(axis=(0, 1))]) * [1, 0, 1]  # numbers near 0 lose no digits
    heights, grounds = [], []
    for cloud in (a - origin, b - origin):
        heights.append(cloud[..., 1])
        grounds.append(cloud[..., 2] + 1j * cloud[..., 0])
    count = window * a.shape[1]
    products = grounds[0] @ grounds[1].conj().T
    both = by.window_sums(products.real, window) + 1j * by.window_sums(products.imag, window)
    means = [_sums(ground.sum(axis=1), window) / count for ground in grounds]
    sizes = [
        _sums((height**2 + np.abs(ground) ** 2).sum(axis=1), window) / count - np.abs(mean) ** 2
        for height, ground, mean in zip(heights, grounds, means, strict=True)
    ]
    level = by.window_sums(heights[0] @ heights[1].T, window) / count
    turned = np.abs(both / count - means[0][:, None] * means[1].conj())
    return np.asarray(np.maximum(sizes[0][:, None] + sizes[1] - 2 * level - 2 * turned, 0))


def _sums(numbers: Array, window: int) -> Array:
    return np.convolve(numbers, np.ones(window), mode="valid")


def find_matches(clouds: Sequence[Array], window: int, threshold: float, by: Tools) -> list[Match]:
    """Find the transitions between all pairs of clips, and within each clip, both ways.

    Parameters
    ----------
    clouds : shape (F, P, 3) each, metres.
    window : frames in a transition.
    threshold : the largest RMS distance, metres.
    by : whose functions work.
    """
    found = []
    for first, second in combinations_with_replacement(range(len(clouds)), 2):
        a, b = clouds[first], clouds[second]
        grid = window_distances(a, b, window, by)
        for i, j in by.inner_minima(grid, threshold**2):
            if first == second and j - i < window:  # both ways come from one half of the grid
                continue
            points, others = (cloud[at : at + window].reshape(-1, 3) for cloud, at in ((a, i), (b, j)))
            angle = float(by.best_angle(points, others))
            there = (angle, *map(float, by.best_shift(points, others, angle)))
            cost = float(np.sqrt(grid[i, j]))
            found.append(Match(first, int(i), second, int(j), cost, *there))
            found.append(Match(second, int(j), first, int(i), cost, *map(float, by.undo(*there))))
    return found
