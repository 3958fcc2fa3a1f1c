"""Groups that several tests walk with."""

from functools import cache

import numpy as np

from mocap.methods.groups import RATE, Configuration, GroupGraph, Scene, build_group, simulate


@cache
def flock(count: int = 12, seconds: float = 120.0) -> Configuration:
    return simulate(count, seconds)


def graph(count: int = 12, nodes: int = 8, **settings) -> GroupGraph:
    return _graph(count, nodes, **settings)


_graph = cache(lambda count, nodes, **settings: build_group(count, nodes=nodes, **settings))


def accelerations(paths):
    """Measure accelerations along paths (F, N), (F - 2, N) m/s²."""
    return np.abs(np.diff(paths, 2, axis=0)) * RATE**2


def gap(width: float, at: complex, length: float = 0.0) -> Scene:
    """A wall of discs across the way with one gap, and behind it walls as long as the corridor is."""
    sides = [(at + sign * 1j * (width / 2 + 1 + 1.6 * k), 1.0) for sign in (-1, 1) for k in range(9)]
    along = np.arange(0.0, length, 0.6)
    sides += [(at + sign * 1j * (width / 2 + 0.5) + z, 0.5) for sign in (-1, 1) for z in along]
    return Scene((complex(at.real + length + (10 if length else 14)),), tuple(sides))


def course(seed: int, points: int = 5, discs: int = 8) -> Scene:
    """Draw legs of 8 to 12 m that turn by up to 100 degrees, and discs beside and on the way."""
    random = np.random.default_rng(seed)
    heading, here, way = 0.0, 0j, []
    for leg in range(points):
        heading += random.uniform(-1.7, 1.7) if leg else 0.0
        here = here + random.uniform(8, 12) * np.exp(1j * heading)
        way.append(complex(here))
    corners, rocks = [0j, *way], []
    while len(rocks) < discs:
        leg = random.integers(points)
        spot = corners[leg] + random.uniform(0.25, 0.75) * (corners[leg + 1] - corners[leg])
        spot += random.normal(0, 2.5) * np.exp(2j * np.pi * random.random())
        radius = random.uniform(0.4, 1.0)
        clear = all(abs(spot - corner) > radius + 3.5 for corner in corners)
        if clear and all(abs(spot - rock) > radius + size + 1.0 for rock, size in rocks):
            rocks.append((complex(spot), float(radius)))
    return Scene(tuple(way), tuple(rocks))


def around(seed: int, discs: int = 5) -> Scene:
    """Draw a goal ahead, aside or behind, and discs clear of it and of the start."""
    random, rocks = np.random.default_rng(seed), []
    goal = complex(random.uniform(8, 24) * np.exp(1j * random.uniform(-np.pi, np.pi)))
    while len(rocks) < discs:
        rock = complex(random.uniform(-18, 18) + 1j * random.uniform(-18, 18))
        rocks += [rock] * (abs(rock) > 5 and abs(rock - goal) > 4)
    return Scene((goal,), tuple((rock, 1.0) for rock in rocks))


def pocket(depth: float) -> Scene:
    """A U of discs, open towards the start, with the goal behind it."""
    back = [14 + 1.5j * k for k in range(-3, 4)]
    arms = [14 - 1.5 * k + 4.5j * side for k in range(1, round(depth / 1.5) + 1) for side in (-1, 1)]
    return Scene((24 + 0j,), tuple((complex(centre), 0.8) for centre in back + arms))
