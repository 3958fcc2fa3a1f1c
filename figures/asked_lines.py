"""Lines on the ground that walks are asked to follow, none of which a price was chosen by."""

import numpy as np

from mocap.body import GroundPath, arcs, spline
from mocap.errors import NoWalk
from mocap.graphs.compiled_graph import CompiledGraph
from mocap.steering import Settings, follow_path
from mocap.steering.followed import Followed


def random_line(seed: int) -> GroundPath:
    """Make a random line: arcs of 1.2 to 5 m radius, or a spline of 4 to 8 pieces."""
    random = np.random.default_rng(seed)
    count = random.integers(4, 9)
    if seed % 2:
        radii = random.uniform(1.2, 5, count)
        turns = random.uniform(0.3, np.pi, count)
        sides = random.choice([-1, 1], count)
        return arcs((0, 0), 0.0, list(zip(radii * turns, sides * turns, strict=True)))
    headings = np.cumsum(random.uniform(-1.1, 1.1, count))
    directions = np.stack([np.sin(headings), np.cos(headings)], axis=1)
    steps = random.uniform(2, 4.5, count)[:, None] * directions
    return spline(np.vstack([[0, 0], np.cumsum(steps, axis=0)]))


def sine() -> GroundPath:
    """Draw two waves of 7 m, 1.2 m to either side."""
    t = np.linspace(0, 1, 240)
    return GroundPath(np.stack([1.2 * np.sin(4 * np.pi * t), 14 * t], axis=1))


def spiral() -> GroundPath:
    """Draw one and a half turns outwards, from 1.5 to 6.2 m."""
    t = np.linspace(0, 3 * np.pi, 240)
    radii = (1.5 + 0.5 * t)[:, None]
    return GroundPath(radii * np.stack([np.cos(t), np.sin(t)], axis=1))


def zigzag() -> GroundPath:
    """Draw five corners of 100°, 3 m apart."""
    return GroundPath(np.array([[0, 0], *([1.2 * (-1) ** n, 2.0 * n] for n in range(1, 7))]))


def heart() -> GroundPath:
    """Draw a heart 9 m wide, with a cusp at its bottom."""
    t = np.linspace(0.15, 2 * np.pi - 0.15, 240)
    z = 13 * np.cos(t) - 5 * np.cos(2 * t)
    z = z - 2 * np.cos(3 * t) - np.cos(4 * t)
    return GroundPath(0.28 * np.stack([16 * np.sin(t) ** 3, z], axis=1))


LINES = {"sine": sine, "spiral": spiral, "zigzag": zigzag, "heart": heart}


def follow_unbent(graph: CompiledGraph, path: GroundPath) -> Followed:
    """Follow a line with clips as they are, however far off: where that is refused, by a single search.

    A walk that stands is refused all the same.
    """
    try:
        return follow_path(graph, path)
    except NoWalk:
        walk = follow_path(graph, path, settings=Settings(tries=1))
        if np.hypot(*np.diff(walk.track, axis=0).T).sum() < 0.3 * walk.seconds:
            raise
        return walk
