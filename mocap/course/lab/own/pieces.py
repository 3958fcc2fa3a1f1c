"""A graph of pieces: clips are cut at their choice points, transitions join them, one component stays."""

import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from mocap._shared.arrays import Points
from mocap._shared.collector import uncollected
from mocap.body.motion import Motion, require_alike
from mocap.body.planar import on_ground
from mocap.course.lab.own.clouds import joint_cloud
from mocap.course.lab.own.matches import Match, find_matches
from mocap.course.lab.own.tools import Tools
from mocap.errors import MocapError

OwnNode = tuple[int, int]


class OwnEdge(NamedTuple):
    """An edge: a stretch of clip, or a transition if there is a `match`.

    `track` is the root on the ground before the edge and in each of its frames, z + ix in the coordinates of
    the clip that it leaves; `turn` and `move` lay the clip that it enters on this one.
    """

    start: OwnNode
    end: OwnNode
    match: Match | None
    track: Points
    turn: complex
    move: complex


@dataclass(frozen=True, eq=False)
class OwnGraph:
    """A graph: its clips, the window of its transitions, and the edges that leave each of its nodes."""

    clips: tuple[Motion, ...]
    window: int
    edges: dict[OwnNode, list[OwnEdge]]

    def __repr__(self) -> str:
        count = sum(edge.match is not None for edges in self.edges.values() for edge in edges)
        return f"OwnGraph({len(self.clips)} clips, {len(self.edges)} nodes, {count} transitions)"


@uncollected()
def build_own(clips: Sequence[Motion], window: int, threshold: float, by: Tools) -> OwnGraph:
    """Build a motion graph of clips, and keep the component that plays most frames.

    Parameters
    ----------
    clips : motions of one skeleton and one frame rate.
    window, threshold : of the transitions: frames, and metres.
    by : whose functions work.

    Raises
    ------
    SkeletonMismatch, MocapError : for no clips, clips that differ in skeleton or rate or are shorter than the
        window, and where there is no loop: the threshold is too low.

    Notebook: 08b-steering
    """
    require_alike(clips)
    if not 2 <= window <= min(map(len, clips), default=0):
        raise MocapError(
            f"A graph takes one clip or more, and a window of 2 frames up to the shortest, got {window}."
        )
    matches = find_matches([joint_cloud(clip, by) for clip in clips], window, threshold, by)
    points = [
        by.choice_points(
            len(clip),
            [match.leave for match in matches if match.source == number],
            [match.enter for match in matches if match.target == number],
            window,
        )
        for number, clip in enumerate(clips)
    ]
    following = by.successors_of(points, [match[:4] for match in matches], window)
    with _deeper(len(following)):
        components = by.tarjan(following)
    kept = by.component_to_keep(components, _played(points))
    if len(kept) < 2:
        raise MocapError(f"No walk goes on for ever with transitions below {threshold} m: allow more.")
    edges = _edges(OwnGraph(tuple(clips), window, {}), points, matches, by)
    inside = {node: [edge for edge in edges[node] if edge.end in kept] for node in sorted(kept)}
    return OwnGraph(tuple(clips), window, inside)


def _played(points: list[list[int]]) -> list[tuple[OwnNode, OwnNode, int]]:
    """List the stretches of clip with the frames that they play."""
    return [
        ((clip, here), (clip, there), there - here)
        for clip, frames in enumerate(points)
        for here, there in pairwise(frames)
    ]


def _edges(
    graph: OwnGraph, points: list[list[int]], matches: list[Match], by: Tools
) -> dict[OwnNode, list[OwnEdge]]:
    """Make the edges that leave each node, with the root's track along each."""
    roots = [on_ground(clip.root_positions) for clip in graph.clips]
    steps = range(-1, graph.window)
    alpha = np.append(1.0, by.quintic(graph.window))  # the frame before the window is the source's
    edges: dict[OwnNode, list[OwnEdge]] = {}
    for start, end, frames in _played(points):
        track = roots[start[0]][np.maximum(start[1] + np.arange(-1, frames), 0)]
        edges.setdefault(start, []).append(OwnEdge(start, end, None, track, 1, 0))
    for match in matches:
        start, end = (match.source, match.leave), (match.target, match.enter + graph.window)
        turn, move = complex(np.exp(1j * match.angle)), complex(match.z, match.x)
        here = roots[match.source][np.maximum(match.leave + np.array(steps), 0)]
        there = turn * roots[match.target][np.maximum(match.enter + np.array(steps), 0)] + move
        edges.setdefault(start, []).append(
            OwnEdge(start, end, match, alpha * here + (1 - alpha) * there, turn, move)
        )
    return edges


@contextmanager
def _deeper(levels: int) -> Iterator[None]:
    """Let functions call themselves so often: a search that goes down a clip is as deep as it has nodes."""
    before = sys.getrecursionlimit()
    sys.setrecursionlimit(before + 4 * levels)
    try:
        yield
    finally:
        sys.setrecursionlimit(before)
