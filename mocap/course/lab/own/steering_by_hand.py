"""A walk that takes one command after the other: at each node the edge that fits best goes on."""

from collections.abc import Callable

import numpy as np

from mocap._shared.arrays import Points
from mocap.body.planar import on_ground
from mocap.course.lab.own.pieces import OwnEdge, OwnGraph
from mocap.course.lab.own.searching import OwnWalk
from mocap.course.lab.own.tools import Tools

AHEAD = 1.5  # seconds of clip that a choice looks ahead: with less, no turn is seen in time


def steer_own(
    graph: OwnGraph, command: Callable[[float], tuple[float, float]], seconds: float, by: Tools
) -> OwnWalk:
    """Walk for some seconds, and choose each edge by the command of that moment.

    Parameters
    ----------
    graph : from `build_own`.
    command : from the time in seconds to a heading in radians (0 is +z, π/2 is +x) and a speed, metres per
        second.
    seconds : how long to walk.
    by : whose functions work.

    Notebook: 08b-steering
    """
    fps = graph.clips[0].fps
    node, turn, move, edges, frames = next(iter(graph.edges)), 1 + 0j, 0j, [], 0
    while frames < seconds * fps:
        choice = graph.edges[node]
        heading, speed = command(frames / fps)
        tracks = [_ahead(graph, edge, round(AHEAD * fps)) for edge in choice]
        edge = choice[int(by.next_edge(turn, tracks, heading, speed, fps))]
        edges.append(edge)
        frames += len(edge.track) - 1
        turn, move, node = turn * edge.turn, move + turn * edge.move, edge.end
    return OwnWalk(edges, 1 + 0j, 0j, 0.0)


def _ahead(graph: OwnGraph, edge: OwnEdge, frames: int) -> Points:
    """Follow the root along an edge, and then on along the clip that it enters."""
    clip, frame = edge.end
    there = edge.turn * on_ground(graph.clips[clip].root_positions[frame : frame + frames]) + edge.move
    return np.concatenate([edge.track, there])[: frames + 1]
