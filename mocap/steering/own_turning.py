"""How a walk turns by itself: what a line asks for beyond that is what it costs to bend the walk along it."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from mocap._shared.arrays import Array, Indices, Points
from mocap.body.ground_path import GroundPath
from mocap.body.motion import Motion
from mocap.body.planar import from_ground, heading, on_ground
from mocap.editing.path_editing import Ride, moving_frames, ride_of
from mocap.errors import MocapError
from mocap.graphs.compiled_graph import CompiledGraph, walk_track
from mocap.graphs.edge_tables import clip_rows


class OwnTurning(NamedTuple):
    """How the T frames of all edges of a graph turn and move on along their own path, without its sway.

    `turn` (T,): radians in each frame; `step` (T,): metres in each frame; `ground` (T,): where the path is in
    the coordinates of the clip that the edge leaves; `going` (N,): the heading of the path at each node,
    radians, in the coordinates of its clip.
    """

    turn: Array
    step: Array
    ground: Points
    going: Array


@lru_cache(maxsize=2)  # to find it again makes following a line of 17 m a fifth slower
def turning_of(graph: CompiledGraph) -> OwnTurning:
    """Follow the path of every edge: how far it goes, and by how much it turns, frame by frame.

    The path is that of `editing.ride_of`, so that the sway of the body is no turning. In a transition both
    clips' headings are blended as their poses are; the difference of the two is turned through as well.

    Examples
    --------
    >>> from mocap import body, datasets, graphs
    >>> clips = [body.resample(datasets.sample("walk_circle"), 30)]
    >>> graph = graphs.compile_graph(graphs.prune(graphs.build(clips, window=10, threshold=0.04)))
    >>> own = turning_of(graph)
    >>> len(own.turn) == len(own.step) == len(graph.tracks.step)
    True
    """
    clips = graph.source.clips
    heads, along, *place = np.concatenate([_ride(clip) for clip in clips], axis=1)
    points = on_ground(np.stack(place, axis=1))
    steps = np.diff(along, prepend=along[0])
    steps[np.cumsum([0, *map(len, clips[:-1])])] = 0.0
    plays, starts = graph.plays, graph.tracks.first
    here, there, weight = clip_rows(clips, plays.here), clip_rows(clips, plays.there), 1 - plays.alpha
    other = heads[there] + np.angle(graph.turn)[plays.edge]
    apart = (other - heads[here] + np.pi) % (2 * np.pi) - np.pi
    head = heads[here] + np.where(weight > 0, weight * apart, 0.0)
    turn = np.diff(head, prepend=0.0)
    turn[starts] = head[starts] - heads[clip_rows(clips, plays.here[starts] - np.array([0, 1]))]
    step = plays.alpha * steps[here] + weight * steps[there]
    laid = graph.turn[plays.edge] * points[there] + graph.move[plays.edge]
    ground = plays.alpha * points[here] + weight * laid
    return OwnTurning(turn, step, ground, heads[clip_rows(clips, np.array(graph.nodes))])


def own_ride(graph: CompiledGraph, own: OwnTurning, edges: Indices) -> Ride:
    """Join the paths of the clips that a walk plays to one path, and say where on it each frame is.

    A spline through the whole walk would be too slow where a seam leads from a bend to the left into one to
    the right: the walk strays from its own path there, and from a line on which it is laid, by up to 10 cm.
    """
    paths = replace(graph, tracks=graph.tracks._replace(ground=own.ground))
    points, _ = walk_track(paths, edges, 1.0, 0.0)
    along = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(points)))])
    ground = from_ground(points)
    return Ride(GroundPath(ground), along, ground)


def _ride(clip: Motion) -> Array:
    """Give the heading of a clip's path, the metres along it, and its x and z, (4, F).

    Of a clip that stands it is how the body faces and where it is.
    """
    try:
        ride = ride_of(clip)
    except MocapError:
        x, _, z = clip.root_positions.T
        return np.stack([np.unwrap(heading(clip.rotations[:, 0])), np.zeros(len(clip)), x, z])
    frames = moving_frames(ride.path, ride.along)
    return np.stack([np.asarray(frames.angle), ride.along, np.asarray(frames.x), np.asarray(frames.z)])
