"""A walk as a motion: each piece is laid where the one before ends, and the transitions are blended."""

from collections.abc import Sequence

import numpy as np

from mocap._shared.arrays import Array
from mocap.body.motion import Motion
from mocap.course.lab.own.by_hand import mixed
from mocap.course.lab.own.pieces import OwnEdge, OwnGraph
from mocap.course.lab.own.searching import OwnWalk
from mocap.course.lab.own.tools import Tools

Poses = tuple[Array, Array]
Place = tuple[float, float, float]


def play_own(graph: OwnGraph, walk: OwnWalk, by: Tools) -> Motion:
    """Play a walk, shape (F, ...): copy stretches of clip, blend transitions [KGP02, Eqs. 5 and 6].

    Each frame is moved by the product of the transforms of all transitions before it.

    Notebook: 08b-steering
    """
    transforms = [(float(np.angle(walk.turn)), walk.move.imag, walk.move.real)]
    parts = []
    for edge in walk.edges:
        here = by.product_of(np.array(transforms))
        if edge.match:
            transforms.append((edge.match.angle, edge.match.x, edge.match.z))
            parts.append(_blended(graph, edge, (here, by.product_of(np.array(transforms))), by))
        else:
            parts.append(_placed(graph.clips[edge.start[0]][edge.start[1] : edge.end[1]], here, by))
    roots, turns = (np.concatenate(arrays) for arrays in zip(*parts, strict=True))
    clip = graph.clips[0]
    return Motion(clip.skeleton, roots, turns, clip.fps, "my walk")


def _placed(clip: Motion, place: Place, by: Tools) -> Poses:
    """Turn a piece of clip about the vertical, and move it over the ground."""
    about_y = np.array([np.cos(place[0] / 2), 0, np.sin(place[0] / 2), 0])
    turns = clip.rotations.copy()
    turns[:, 0] = [by.hamilton(about_y, turn) for turn in turns[:, 0]]
    return np.asarray(by.move_points(clip.root_positions, *place)), turns


def _blended(graph: OwnGraph, edge: OwnEdge, places: Sequence[Place], by: Tools) -> Poses:
    """Blend the two windows of a transition, each where it lies."""
    assert edge.match
    match, k = edge.match, graph.window
    windows = [graph.clips[match.source][match.leave : match.leave + k]]
    windows.append(graph.clips[match.target][match.enter : match.enter + k])
    first, second = (
        Motion(clip.skeleton, *_placed(clip, place, by), clip.fps)
        for clip, place in zip(windows, places, strict=True)
    )
    return mixed(first, second, np.asarray(by.quintic(k)), by)
