"""The search from both poses finds what a full search finds."""

from functools import cache

import numpy as np
import pytest

from mocap.body import resample
from mocap.body.planar import PlanarTransform
from mocap.datasets import samples
from mocap.graphs import compile_graph, from_transitions
from mocap.matching.transitions import Transition
from mocap.methods.in_betweening import two_sided_search
from tests.tuning import tune


def tiny():
    """Make a graph so small that all its walks can be listed."""
    clip = resample(samples.sample("walk_circle"), 30)[:200]
    moves = [(40, 90), (60, 150), (100, 30), (120, 60), (140, 110)]
    ways = [PlanarTransform(0.2 * n, 0.1 * n, 0.3) for n in range(len(moves))]
    found = [Transition(0, i, 0, j - 10, 0.02, way) for (i, j), way in zip(moves, ways, strict=True)]
    return compile_graph(from_transitions([clip], found, window=10))


@cache
def every_walk(frames):
    """List the walks of the tiny graph from frame 20 to frame 160 in so many frames, slowly and clearly."""
    graph, found = tiny(), []

    def go(edges, length):
        node, goal = graph.edges[edges[-1]][1], (0, 160)
        for number, (start, end, _) in enumerate(graph.edges):
            if start != node or length > 1.25 * frames:
                continue
            if not graph.blended[number] and start[1] <= goal[1] < end[1]:
                found.append(([*edges, number], length + goal[1] - start[1]))
            go([*edges, number], length + int(graph.frames[number]))

    first = next(n for n, (a, b, _) in enumerate(graph.edges) if a[1] <= 20 < b[1] and not graph.blended[n])
    go([first], graph.edges[first][1][1] - 20)
    return found


def first_half(graph, edges, frames):
    """Give a walk's edges up to the first point at half of the frames or later."""
    ends = np.cumsum([graph.edges[edges[0]][1][1] - 20, *(int(graph.frames[edge]) for edge in edges[1:])])
    return tuple(edges[: int((ends >= frames / 2).argmax()) + 1])


@pytest.mark.parametrize("frames", [100, 140, 200])
def test_the_search_finds_an_end_for_every_first_half_that_a_full_search_finds(monkeypatch, frames):
    graph = tiny()
    clip = graph.source.clips[0]
    tune(monkeypatch, two_sided_search, candidates=1)
    near = tuple(
        two_sided_search.find_candidates(graph, some, direction=way, limit=np.inf)
        for some, way in ((clip[20:], 1), (clip[:161], -1))
    )
    found = two_sided_search.TwoSided(graph, near, frames).best(1000)
    most = 1.25**0.85
    lengths = {tuple(edges): n for edges, n in every_walk(frames) if 1 / most <= n / frames <= most}
    walks = [tuple(joined.edges.tolist()) for joined in found]
    assert [joined.frames for joined in found] == [lengths[walk] for walk in walks]
    found, every = ({first_half(graph, walk, frames) for walk in some} for some in (walks, lengths))
    assert found == every
