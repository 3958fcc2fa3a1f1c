"""Walks as they run on the ground, for searches that price where the root is [KGP02, 4.2].

Ground points are complex numbers z + ix: z runs ahead, x to the left. A walk's clip is placed by
p ↦ rotation · p + translation. An edge rotates and translates what comes after it, so the transform of a
clip is a running product.
"""

import math
from collections.abc import Callable, Sequence

import numpy as np

from mocap._shared.arrays import Points
from mocap._shared.records import NamedTuple
from mocap.graphs.compiled_graph import CompiledGraph, compile_graph, walk_track
from mocap.graphs.motion_graph import MotionGraph, Node
from mocap.synthesis.bounded_search import Problem, SearchEdge

Price = Callable[[Points, int, SearchEdge], float]
"""From the root's ground points along an edge, the frames walked before it, and the edge, to its cost."""


class Stand(NamedTuple):
    """Where a walk has led: what comes next is placed by p ↦ rotation · p + translation.

    So many `frames` are walked; and where a path is followed, it is `along` metres along it.
    """

    rotation: complex
    translation: complex
    frames: int = 0
    along: float = 0.0


class GroundWalks:
    """The walks through a motion graph, seen from above.

    Parameters
    ----------
    motion_graph : the graph.

    Examples
    --------
    The walk of 20 frames that strays least from the straight line ahead:

    >>> from mocap import body, datasets, graphs, synthesis
    >>> clips = [body.resample(datasets.sample("walk_curve_1"), 30)]
    >>> walks = GroundWalks(graphs.prune(graphs.build(clips, window=10, threshold=0.04)))
    >>> node, start = walks.start(40)
    >>> problem = walks.problem(lambda points, before, edge: (points.imag**2).sum(), frames=20)
    >>> found = synthesis.branch_and_bound(problem, node, start)
    >>> len(walks.points(found.walk, start)) == found.state.frames >= 20
    True

    Notebook: 07b-searching-ahead
    """

    def __init__(self, motion_graph: MotionGraph | CompiledGraph) -> None:
        self.graph = compile_graph(motion_graph)
        self.number: dict[SearchEdge, int] = {edge: n for n, edge in enumerate(self.graph.edges)}

    def start(self, number: int) -> tuple[Node, Stand]:
        """Stand at a node of this number, at the origin, and move straight ahead."""
        rotation = np.exp(-1j * self.graph.going[number])
        return self.graph.nodes[number], Stand(rotation, -rotation * self.graph.at[number])

    def step(self, stand: Stand, edge: SearchEdge) -> tuple[slice, Points, Stand]:
        """Walk along an edge: the rows of its frames among those of all, the root there, where it leads."""
        graph, e = self.graph, self.number[edge]
        rows = slice(graph.first[e], graph.first[e] + graph.frames[e])
        rotation, translation = (
            stand.rotation * graph.rotation[e],
            stand.translation + stand.rotation * graph.translation[e],
        )
        after = Stand(rotation, translation, stand.frames + int(graph.frames[e]), stand.along)
        return rows, stand.rotation * graph.ground[rows] + stand.translation, after

    def points(self, walk: Sequence[SearchEdge], stand: Stand) -> Points:
        """Give the root in each frame of a walk."""
        edges = np.array([self.number[edge] for edge in walk])
        return walk_track(self.graph, edges, stand.rotation, stand.translation)[0]

    def problem(self, price: Price, *, frames: float = math.inf) -> Problem:
        """Make a search problem: each edge costs what `price` says; a walk of so many frames is complete."""

        def step(stand: Stand, edge: SearchEdge) -> tuple[float, Stand]:
            _, points, after = self.step(stand, edge)
            return float(price(points, stand.frames, edge)), after

        return Problem(self.graph.source.graph, step, lambda stand: stand.frames >= frames)
