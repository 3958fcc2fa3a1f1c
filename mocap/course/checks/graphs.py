"""Answers, right and wrong, of exercises about graphs."""

import itertools
from collections import Counter
from itertools import combinations, permutations
from typing import Any

import networkx as nx
import numpy as np

from mocap._shared.arrays import Array
from mocap.course.check import close
from mocap.plain import components

# ---- Notebook 05


def draw_chance_to_last(rng: np.random.Generator) -> tuple[Array, int]:
    """Draw the probabilities of going from segment to segment, some without successor, and a length."""
    count = int(rng.integers(3, 9))
    odds = rng.random((count, count)) * (rng.random((count, count)) < 0.5)
    odds[rng.integers(count)] = 0
    return odds / np.maximum(odds.sum(axis=1, keepdims=True), 1e-9), int(rng.integers(2, 9))


# ---- Notebook 05b


Point = tuple[float, float]


def fixed_point(angle: float, x: float, z: float) -> Point | None:
    """Solve T c = c, with the point (x, z) as the complex number z + ix."""
    if angle == 0:
        return None
    centre = complex(z, x) / (1 - np.exp(1j * angle))
    return float(centre.imag), float(centre.real)


def same_point(given: Any, wanted: Point | None) -> bool:  # noqa: ANN401
    """Compare two points, or two answers that no point stays; a division by zero may give inf or nan."""
    if given is None or wanted is None:
        return given is wanted
    a, b = np.asarray(given, float), np.asarray(wanted, float)
    if a.shape == b.shape and not np.isfinite(b).all():
        return not np.isfinite(a).all()
    return a.shape == b.shape and np.allclose(a, b, rtol=1e-6, atol=1e-9)


Places = list[tuple[int, int]]
Following = dict[tuple[int, int], Places]
Links = list[tuple[int, int, int, int]]


def follow(points: list[list[int]], links: Links, window: int) -> Following:
    """Join each choice point to the next of its clip, and the two ends of each transition."""
    following: Following = {(clip, frame): [] for clip, frames in enumerate(points) for frame in frames}
    for clip, frames in enumerate(points):
        for here, there in itertools.pairwise(frames):
            following[clip, here].append((clip, there))
    for source, leave, target, enter in links:
        following.setdefault((source, leave), []).append((target, enter + window))
    return following


# ---- Notebook 06


Successors = dict[int, list[int]]


def draw_graph(rng: np.random.Generator) -> Successors:
    """Draw a graph of three to eight nodes, with about one edge each."""
    count = int(rng.integers(3, 9))
    joined = rng.random((count, count)) < 1.2 / count
    return {node + 1: (np.flatnonzero(row) + 1).tolist() for node, row in enumerate(joined)}


def after(successors: Successors, start: int) -> set[int]:
    """Find the nodes that a walk from a node reaches."""
    return {int(node) for node in nx.descendants(nx.DiGraph(successors), start)}


# ---- Notebook 06b


def reasons(successors: Successors, kept: set[int]) -> dict[int, str]:
    """Say of each node outside the component why it goes."""
    found = {}
    for node in successors.keys() - kept:
        if not any(node in after(successors, end) | {end} for end in successors[node]):
            found[node] = "dead end"
        else:
            found[node] = "unreached" if after(successors, node) & kept else "sink"
    return found
