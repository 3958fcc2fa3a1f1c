"""Walks along paths, as the trials of graphs and of steering measure them."""

from collections.abc import Sequence
from functools import cache

import numpy as np
from _trials import Clips, Row

from mocap import graphs
from mocap.body import GroundPath, circle, s_curve
from mocap.graphs import MotionGraph
from mocap.graphs.compiled_graph import CompiledGraph, compile_graph
from mocap.steering import follow_path
from mocap.steering.followed import Followed
from mocap.synthesis.walk_to_motion import with_footplants

WINDOW = 10  # frames
THRESHOLD = 0.04  # metres
PATHS = (s_curve(12.0), circle(2.0))


@cache
def graph_of(clips: Clips) -> MotionGraph:
    """Build and prune a graph, with the plants of its clips."""
    return with_footplants(graphs.prune(graphs.build(clips, window=WINDOW, threshold=THRESHOLD)))


@cache
def compiled(clips: Clips) -> CompiledGraph:
    """Compile this graph, once; for constants that are not read then."""
    return compile_graph(graph_of(clips))


def followed(
    graph: CompiledGraph, *, bend: float = 0.0, paths: Sequence[GroundPath] = PATHS
) -> list[Followed]:
    """Follow each of the paths."""
    return [follow_path(graph, path, bend=bend) for path in paths]


def measures(walks: list[Followed]) -> Row:
    """Average the distances from the path and the transitions per second; the largest distance of all."""
    means = [walk.off.mean() for walk in walks]
    worst = [walk.off.max() for walk in walks]
    seams = [walk.seams_per_second for walk in walks]
    row = {"off, cm": 100 * float(np.mean(means)), "worst, cm": 100 * float(max(worst))}
    return row | {"seams/s": float(np.mean(seams)), "takes, s": float(np.mean([w.seconds for w in walks]))}
