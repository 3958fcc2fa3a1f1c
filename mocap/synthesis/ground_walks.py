"""Trajectories of walks on the ground, for searches whose cost depends on the root's position [KGP02, 4.2].

Ground points are complex numbers z + ix, with z ahead and x to the left. A clip of a walk is transformed by
p ↦ rotation · p + translation. Each edge rotates and translates all later clips, therefore the transform of a
clip is a cumulative product.
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
"""The cost of an edge, from the ground points along it, the number of frames before it, and the edge."""


class Stand(NamedTuple):
    """The state of a walk: the transform p ↦ rotation · p + translation of its next clip, and its length.

    Parameters
    ----------
    rotation, translation : the transform, complex; |rotation| = 1, and the translation is in metres.
    frames : the number of frames of the walk.
    along : the arc length along the path, metres, if the walk follows one.
    """

    rotation: complex
    translation: complex
    frames: int = 0
    along: float = 0.0


class GroundWalks:
    """The walks through a motion graph as trajectories of the root on the ground.

    Parameters
    ----------
    motion_graph : the graph.

    Examples
    --------
    The walk of 20 frames that deviates least from the line straight ahead:

    >>> from mocap import body, datasets, graphs, synthesis
    >>> clips = [body.resample(datasets.sample("walk_curve_1"), 30)]
    >>> walks = GroundWalks(graphs.prune(graphs.build(clips, window=10, threshold=0.04)))
    >>> node, start = walks.start(40)
    >>> problem = walks.problem(lambda points, before, edge: (points.imag**2).sum(), frames=20)
    >>> found = synthesis.branch_and_bound(problem, node, start)
    >>> found.state.frames, walks.points(found.walk, start).shape
    (20, (20,))

    Notebook: 07b-searching-ahead
    """

    def __init__(self, motion_graph: MotionGraph | CompiledGraph) -> None:
        self.graph = compile_graph(motion_graph)
        self.number: dict[SearchEdge, int] = {edge: n for n, edge in enumerate(self.graph.edges)}

    def start(self, number: int) -> tuple[Node, Stand]:
        """Return the node with a number, and the state in which its root is at the origin and moves to +z."""
        rotation = np.exp(-1j * self.graph.going[number])
        return self.graph.nodes[number], Stand(rotation, -rotation * self.graph.at[number])

    def step(self, stand: Stand, edge: SearchEdge) -> tuple[slice, Points, Stand]:
        """Extend a walk by one edge.

        Returns
        -------
        The rows of the frames of the edge in the arrays of all frames, the ground points of the root in these
        frames, and the state at the end of the edge.
        """
        graph = self.graph
        number = self.number[edge]
        frames = graph.frames[number]
        rows = slice(graph.first[number], graph.first[number] + frames)
        points = stand.rotation * graph.ground[rows] + stand.translation
        rotation = stand.rotation * graph.rotation[number]
        translation = stand.translation + stand.rotation * graph.translation[number]
        return rows, points, Stand(rotation, translation, stand.frames + int(frames), stand.along)

    def points(self, walk: Sequence[SearchEdge], stand: Stand) -> Points:
        """Compute the ground point of the root in each frame of a walk, shape (F,)."""
        edges = np.array([self.number[edge] for edge in walk])
        return walk_track(self.graph, edges, stand.rotation, stand.translation)[0]

    def problem(self, price: Price, *, frames: float = math.inf) -> Problem:
        """Return a search problem: `price` is the cost of an edge. A walk of `frames` frames is complete."""

        def step(stand: Stand, edge: SearchEdge) -> tuple[float, Stand]:
            _, points, next_stand = self.step(stand, edge)
            return float(price(points, stand.frames, edge)), next_stand

        return Problem(self.graph.source.graph, step, lambda stand: stand.frames >= frames)
