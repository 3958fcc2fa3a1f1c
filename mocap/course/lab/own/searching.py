"""A walk along a path: all walks advance together, layer by layer, as in notebook 08 [KGP02, Eq. 9].

What a walk costs is the squared distance from the path at equal arc length, summed over its frames, and a
price for each seam. Of the walks in a layer those that stand alike are thinned out, and the cheapest go on.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from mocap._shared.arrays import Points
from mocap.body.ground_path import GroundPath
from mocap.body.planar import on_ground
from mocap.course.lab.own.by_hand import longer
from mocap.course.lab.own.pieces import OwnEdge, OwnGraph, OwnNode
from mocap.course.lab.own.tools import Tools
from mocap.errors import NoWalk

LAYER = 0.15  # metres of path
PLACE, TURN = 0.1, 0.1  # metres and radians: walks that agree so far stand alike
LEAST = 0.1  # metres per second: the least progress
SEAM = 0.05  # m²: the price of a seam
RESCUE = 1.5  # m²: the largest cost that is expected of the next moments


class OwnWalk(NamedTuple):
    """A walk: its edges, how the first one's clip is placed (p ↦ turn · p + move), and what it costs, m²."""

    edges: list[OwnEdge]
    turn: complex
    move: complex
    cost: float


class _State(NamedTuple):
    """A walk while it is searched for; `before` is the walk without its last edge."""

    node: OwnNode
    turn: complex
    move: complex
    along: float
    cost: float
    last: OwnEdge | None
    before: _State | None


def follow_own(
    graph: OwnGraph, path: ArrayLike, by: Tools, *, width: int = 30, seam: float = SEAM
) -> OwnWalk:
    """Find a walk along a path: the cheapest that the layers leave.

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
    waiting = {0: _starts(graph, line, by)}
    for layer in range(int(line.length / LAYER) + 1):
        first = layer == 0  # every walk that starts has cost nothing yet
        while states := waiting.pop(layer, []):
            chosen = states if first else _selected(graph, states, line, width, by)
            first = False
            for state in (new for old in chosen for new in _longer(graph, old, line, seam, by)):
                if state.along >= line.length:
                    best = state if best is None or state.cost < best.cost else best
                elif best is None or state.cost < best.cost:
                    waiting.setdefault(max(layer, int(state.along / LAYER)), []).append(state)
    if best is None:
        raise NoWalk(f"No walk of this graph reaches the end of a path of {line.length:.1f} m.")
    return _traced(best)


def _starts(graph: OwnGraph, line: GroundPath, by: Tools) -> list[_State]:
    """Lay each node on the start of the path, so that the clip goes on in the path's direction."""
    x, z = line.points[0]
    ahead_x, ahead_z = line.at(0.3) - line.points[0]
    frames = max(1, round(0.75 * graph.clips[0].fps))
    states = []
    for clip, frame in graph.edges:
        roots = graph.clips[clip].root_positions[:, [0, 2]]
        at = min(frame, len(roots) - 1 - frames)
        way = roots[at + frames] - roots[at]
        here = roots[min(frame, len(roots) - 1)]
        lay = by.lay_on((np.arctan2(*way), *here), (np.arctan2(ahead_x, ahead_z), x, z))
        turn, move = complex(np.exp(1j * lay[0])), complex(lay[2], lay[1])
        states.append(_State((clip, frame), turn, move, 0.0, 0.0, None, None))
    return states


def _selected(graph: OwnGraph, states: list[_State], line: GroundPath, width: int, by: Tools) -> list[_State]:
    """Choose the walks that go on, by what they have cost and what the next moments would cost."""
    numbers = {node: number for number, node in enumerate(graph.edges)}
    stand, costs = [], []
    for state in states:
        track = _ahead(graph, state)
        place = state.turn * track[0] + state.move
        cell = (place.real / PLACE, place.imag / PLACE, np.angle(state.turn) / TURN)
        stand.append([numbers[state.node], *(round(number) for number in cell)])
        steps = np.abs(np.diff(track[:: len(track) // 4])).cumsum()
        wanted = line.at(state.along + steps) @ [1j, 1]
        off = state.turn * track[len(track) // 4 :: len(track) // 4] + state.move - wanted
        costs.append(state.cost + min(RESCUE, len(track) * np.mean(np.abs(off) ** 2)))
    return [states[number] for number in by.survivors(np.array(stand), np.array(costs), width)]


def _ahead(graph: OwnGraph, state: _State) -> Points:
    """Give the root on the ground in the next 3/4 second of clip; past its end it stands still."""
    clip, frame = state.node
    frames = np.arange(round(0.75 * graph.clips[0].fps))
    roots = graph.clips[clip].root_positions
    return on_ground(roots[np.minimum(frame + frames, len(roots) - 1)])


def _longer(graph: OwnGraph, state: _State, line: GroundPath, seam: float, by: Tools) -> list[_State]:
    """Lengthen a walk by every edge that leaves its node."""
    edges = graph.edges[state.node]
    offered = [(edge.end, edge.track, edge.turn, edge.move, seam * bool(edge.match)) for edge in edges]
    least = LEAST / graph.clips[0].fps
    walk = state.turn, state.move, state.along, state.cost
    walks = longer(walk, offered, line.at, least, by)
    return [
        _State(edge.end, turn, move, along, cost, edge, state)
        for edge, (_, turn, move, along, cost) in zip(edges, walks, strict=True)
    ]


def _traced(state: _State) -> OwnWalk:
    """Go back to the start of a walk, and list its edges."""
    cost, edges = state.cost, []
    while state.last is not None and state.before is not None:
        edges.append(state.last)
        state = state.before
    return OwnWalk(edges[::-1], state.turn, state.move, cost)
