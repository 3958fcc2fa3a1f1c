"""Walks on a graph of one's own: along a path or by commands, and as motions."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from mocap._shared.arrays import Array
from mocap.body.ground_path import GroundPath
from mocap.body.motion import Motion
from mocap.body.planar import on_ground
from mocap.course.lab.own.building import OwnEdge, OwnGraph, OwnNode, Tools
from mocap.errors import NoWalk

LAYER = 0.15  # metres of path
PLACE, TURN = 0.1, 0.1  # metres and radians: walks that agree so far stand alike
LEAST = 0.1  # metres per second: the least progress
RESCUE = 1.5  # m²: the largest cost that is expected of the next moments
SOON, AHEAD = 0.75, 1.5  # seconds of clip that a search and a choice look ahead: with less, no turn is seen


class OwnWalk(NamedTuple):
    """A walk: its edges, how the first one's clip is placed (p ↦ turn · p + move), and what it costs, m²."""

    edges: Sequence[OwnEdge]
    turn: complex
    move: complex
    cost: float


class _State(NamedTuple):
    """A walk while it is searched for: where it stands, its metres along the path, and where it began."""

    node: OwnNode
    turn: complex
    move: complex
    along: float
    cost: float
    start: tuple[complex, complex]
    edges: tuple[OwnEdge, ...] = ()


def follow_own(
    graph: OwnGraph, path: ArrayLike, by: Tools, *, width: int = 30, seam: float = 0.05
) -> OwnWalk:
    """Find a walk along a path: all walks advance together, layer by layer, as in notebook 08 [KGP02, Eq. 9].

    What a walk costs is the squared distance from the path at equal arc length, summed over its frames, and a
    price for each seam. Of the walks in a layer those that stand alike are thinned out, and the cheapest go
    on.

    Parameters
    ----------
    graph : from `build_own`.
    path : corners on the ground (x, z), shape (N, 2), metres.
    by : whose functions work.
    width : the walks that go on from a layer.
    seam : the price of a seam, m².

    Raises
    ------
    NoWalk : where no walk reaches the end of the path.
    """
    line, best = GroundPath(np.asarray(path, float)), None
    waiting = {0: starts(graph, line, by)}
    for layer in range(int(line.length / LAYER) + 1):
        while states := waiting.pop(layer, []):
            begins = not states[0].edges  # every walk that begins has cost nothing yet
            chosen = states if begins else _selected(graph, states, line, width, by)
            for state in (new for old in chosen for new in _longer(graph, old, line, seam, by)):
                if best is not None and state.cost >= best.cost:
                    continue
                if state.along >= line.length:
                    best = state
                else:
                    waiting.setdefault(max(layer, int(state.along / LAYER)), []).append(state)
    if best is None:
        raise NoWalk(f"No walk of this graph reaches the end of a path of {line.length:.1f} m.")
    return OwnWalk(best.edges, *best.start, best.cost)


def starts(graph: OwnGraph, line: GroundPath, by: Tools) -> list[_State]:
    """Lay each node on the start of the path, so that the clip goes on in the path's direction."""
    x, z = line.points[0]
    ahead_x, ahead_z = line.at(0.3) - line.points[0]
    frames = max(1, round(SOON * graph.clips[0].fps))
    states = []
    for clip, frame in graph.edges:
        roots = graph.clips[clip].root_positions[:, [0, 2]]
        at = min(frame, len(roots) - 1 - frames)
        way = roots[at + frames] - roots[at]
        here = roots[min(frame, len(roots) - 1)]
        lay = by.lay_on((np.arctan2(*way), *here), (np.arctan2(ahead_x, ahead_z), x, z))
        start = complex(np.exp(1j * lay[0])), complex(lay[2], lay[1])
        states.append(_State((clip, frame), *start, 0.0, 0.0, start))
    return states


def _selected(
    graph: OwnGraph, states: Sequence[_State], line: GroundPath, width: int, by: Tools
) -> list[_State]:
    """Choose the walks that go on, by what they have cost and what the next moments would cost."""
    numbers = {node: number for number, node in enumerate(graph.edges)}
    frames = np.arange(round(SOON * graph.clips[0].fps))
    every = len(frames) // 4
    stand, costs = [], []
    for state in states:
        clip, frame = state.node
        roots = graph.clips[clip].root_positions  # past the end of its clip a body stands still
        track = on_ground(roots[np.minimum(frame + frames, len(roots) - 1)])
        place = state.turn * track[0] + state.move
        cell = (place.real / PLACE, place.imag / PLACE, np.angle(state.turn) / TURN)
        stand.append([numbers[state.node], *(round(number) for number in cell)])
        steps = np.abs(np.diff(track[::every])).cumsum()
        off = state.turn * track[every::every] + state.move - line.at(state.along + steps) @ [1j, 1]
        costs.append(state.cost + min(RESCUE, len(track) * np.mean(np.abs(off) ** 2)))
    return [states[number] for number in by.survivors(np.array(stand), np.array(costs), width)]


def _longer(graph: OwnGraph, state: _State, line: GroundPath, seam: float, by: Tools) -> list[_State]:
    """Lengthen a walk by every edge: by `lengthen`, or by `edge_cost` for one edge after the other."""
    edges = graph.edges[state.node]
    least = LEAST / graph.clips[0].fps
    if _is_given(by.lengthen):
        offered = [(edge.end, edge.track, edge.turn, edge.move, seam * bool(edge.match)) for edge in edges]
        walks = by.lengthen(state[1:5], offered, line.at, least)
        return [
            _State._make((*walk, state.start, (*state.edges, e)))
            for walk, e in zip(walks, edges, strict=True)
        ]
    longer = []
    for edge in edges:
        placed = state.turn * edge.track + state.move
        ground = np.stack([placed.imag, placed.real], axis=1)
        more, along = by.edge_cost(ground, line.at, state.along, least)
        turn, move = state.turn * edge.turn, state.move + state.turn * edge.move
        cost = state.cost + more + seam * bool(edge.match)
        longer.append(_State(edge.end, turn, move, along, cost, state.start, (*state.edges, edge)))
    return longer


def _is_given(function: Any) -> bool:  # noqa: ANN401 (a place of the course, or any function)
    return bool(getattr(function, "yours", True))


def steer_own(
    graph: OwnGraph, command: Callable[[float], tuple[float, float]], seconds: float, by: Tools
) -> OwnWalk:
    """Walk for some seconds, and choose at each node the edge that fits the command of that moment.

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
    soon = round(AHEAD * fps)
    node, turn, move, edges, frames = next(iter(graph.edges)), 1 + 0j, 0j, [], 0
    while frames < seconds * fps:
        tracks = []
        for edge in graph.edges[node]:
            clip, frame = edge.end
            there = edge.turn * on_ground(graph.clips[clip].root_positions[frame : frame + soon]) + edge.move
            tracks.append(np.concatenate([edge.track, there])[: soon + 1])
        chosen = graph.edges[node][int(by.next_edge(turn, tracks, *command(frames / fps), fps))]
        edges.append(chosen)
        frames += len(chosen.track) - 1
        turn, move, node = turn * chosen.turn, move + turn * chosen.move, chosen.end
    return OwnWalk(edges, 1 + 0j, 0j, 0.0)


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
            source, leave, target, enter, _, lay = edge.match
            transforms.append(tuple(lay))
            first = _placed(graph.clips[source][leave : leave + graph.window], here, by)
            there = by.product_of(np.array(transforms))
            second = _placed(graph.clips[target][enter : enter + graph.window], there, by)
            parts.append(_mixed(first, second, np.asarray(by.quintic(graph.window)), by))
        else:
            part = _placed(graph.clips[edge.start[0]][edge.start[1] : edge.end[1]], here, by)
            parts.append((part.root_positions, part.rotations))
    roots, turns = (np.concatenate(arrays) for arrays in zip(*parts, strict=True))
    clip = graph.clips[0]
    return Motion(clip.skeleton, roots, turns, clip.fps, "my walk")


def _placed(clip: Motion, place: tuple[float, float, float], by: Tools) -> Motion:
    """Turn a piece of clip about the vertical, and move it over the ground."""
    about_y = np.array([np.cos(place[0] / 2), 0, np.sin(place[0] / 2), 0])
    turns = clip.rotations.copy()
    turns[:, 0] = [by.hamilton(about_y, turn) for turn in turns[:, 0]]
    return Motion(clip.skeleton, np.asarray(by.move_points(clip.root_positions, *place)), turns, clip.fps)


def _mixed(first: Motion, second: Motion, alpha: Array, by: Tools) -> tuple[Array, Array]:
    """Mix two windows by `mix`, or one joint of one frame after the other by `short_way`."""
    if _is_given(by.mix):
        roots, turns = by.mix(first, second, alpha)
        return np.asarray(roots), np.asarray(turns)
    turns = [
        [by.short_way(start, end, share) for start, end in zip(starts, ends, strict=True)]
        for starts, ends, share in zip(second.rotations, first.rotations, alpha, strict=True)
    ]
    share = alpha[:, None]
    return share * first.root_positions + (1 - share) * second.root_positions, np.array(turns)
