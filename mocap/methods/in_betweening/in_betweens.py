"""A motion from one pose to another, each at its position, in a given time: an in-between.

The walks that `two_sided_search` finds are what the clips can do. Each of the best is bent and retimed, and
the one of lowest cost is kept. Its ends fade into the poses, and its feet are cleaned up.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from mocap._shared.records import NamedTuple
from mocap.body.motion import Motion, concatenate, require_motion
from mocap.editing.displacements import difference, displaced
from mocap.errors import NoWalk
from mocap.graphs.compiled_graph import CompiledGraph, compile_graph
from mocap.graphs.edge_tables import Edge
from mocap.graphs.motion_graph import MotionGraph
from mocap.methods.in_betweening.end_bending import Arrived, bend_to
from mocap.methods.in_betweening.end_poses import meet_poses, stand
from mocap.methods.in_betweening.planted_feet import put_back
from mocap.methods.in_betweening.tuned import TUNED
from mocap.methods.in_betweening.two_sided_search import Candidates, Joined, TwoSided, find_candidates
from mocap.synthesis.walk_to_motion import to_motion, with_plants


class InBetween(NamedTuple):
    """A motion from one pose to another, and how it was made.

    `motion`: N + 1 frames, the first and the last of them the requested poses; `walk`: the edges that it
    plays; `arrived`: the walk before its ends faded, and by how much it was turned, lengthened and retimed.
    """

    motion: Motion
    walk: list[Edge]
    arrived: Arrived


def in_between(graph: MotionGraph | CompiledGraph, start: Motion, end: Motion, seconds: float) -> InBetween:
    """Find a motion from one pose to another, each at its position, in a given time.

    Parameters
    ----------
    graph : pruned; for many in-betweens, compiled once by `graphs.compile_graph`.
    start, end : motions of the graph's skeleton, at their positions: from the first frame of one to the last
        frame of the other. Further frames show their velocities. Clips of the graph are met best.
    seconds : from the first frame to the last, rounded to whole frames.

    Raises
    ------
    NoWalk : if no walk arrives although its pace and its steps change by up to a quarter, its turning by up
        to 60° per second and the poses at its ends by up to 10 cm.
    """
    compiled = compile_graph(graph)
    require_motion(start)
    require_motion(end)
    starts = find_candidates(compiled, start, direction=1, limit=TUNED.pose)
    ends = find_candidates(compiled, end, direction=-1, limit=TUNED.pose)
    return _connect(compiled, (starts, ends), (start, end), seconds)


def fill_gap(graph: MotionGraph | CompiledGraph, first: Motion, second: Motion, seconds: float) -> InBetween:
    """Find a motion that fills the gap between two motions, each at its position.

    As `in_between`, for poses whose past and future are known: a character continues the one motion and
    arrives in the other. Its candidates move as both do, and its ends start with their velocities.

    Parameters
    ----------
    graph : as for `in_between`.
    first, second : motions of the graph's skeleton. From the last frame of one to the first of the other.
    seconds : from one to the other. In less than `SHORTEST` seconds `interpolate` does better.

    Returns
    -------
    The in-between at the rate of the graph. Its first pose is the last of `first`, its last the first of
    `second`.

    Raises
    ------
    NoWalk : as `in_between`.

    Examples
    --------
    >>> from mocap import body, datasets, graphs
    >>> walk = body.resample(datasets.sample("walk_curve_1"), 30)
    >>> graph = graphs.build([walk], window=10, threshold=0.04)
    >>> found = fill_gap(graph, walk[:100], walk[130:], 31 / 30)  # frames 99 to 130
    >>> len(found.motion), bool(abs(found.motion.root_positions - walk.root_positions[99:131]).max() < 0.01)
    (32, True)
    """
    compiled = compile_graph(graph)
    require_motion(first)
    require_motion(second)
    starts = find_candidates(compiled, first, direction=-1, limit=TUNED.pose)
    ends = find_candidates(compiled, second, direction=1, limit=TUNED.pose)
    start = first[-1:]
    if len(first) > 1:
        start = concatenate([start, _next_frame(first[-2:-1], start)])
    end = second[:1]
    if len(second) > 1:
        end = concatenate([_next_frame(second[1:2], end), end])
    return _connect(compiled, (starts, ends), (start, end), seconds)


def _next_frame(earlier: Motion, pose: Motion) -> Motion:
    """Continue for a frame with the velocity from one frame to the next."""
    return displaced(pose, difference(pose, earlier))


def _connect(
    graph: CompiledGraph,
    candidates: tuple[Candidates, Candidates],
    poses: tuple[Motion, Motion],
    seconds: float,
) -> InBetween:
    """Search, bend and fade: a motion from the first frame of one pose to the last frame of the other."""
    start, end = poses
    frames = round(seconds * graph.fps)
    joined = TwoSided(graph, candidates, frames).best(TUNED.most_tried)
    source = with_plants(graph.source)
    walks: list[tuple[float, list[Edge], Arrived]] = []
    for group in range(0, len(joined), TUNED.tried):
        walks = list(_arriving(source, graph, joined[group : group + TUNED.tried], frames))
        if walks:
            break
    else:
        metres = np.linalg.norm(end.root_positions[-1] - start.root_positions[0])
        request = f"{metres:.1f} m in {seconds:.1f} s"
        raise NoWalk(
            f"No walk leads from one pose to the other, {request}: give another time, or more clips."
        )
    _, walk, arrived = min(walks, key=lambda item: item[0])
    motion = meet_poses(replace(arrived.motion, name="in between"), start, end)
    for _ in range(TUNED.rounds):
        motion = meet_poses(stand(motion), start, end, speed=False)
    return InBetween(put_back(motion), walk, arrived)


def _arriving(
    source: MotionGraph, graph: CompiledGraph, joined: Sequence[Joined], frames: int
) -> Iterator[tuple[float, list[Edge], Arrived]]:
    """Bend walks, and yield those that arrive within the limits, each with its cost."""
    for candidate in joined:
        walk = [graph.edges[edge] for edge in candidate.edges]
        played = to_motion(source, walk, start=candidate.place)
        played = played[candidate.first : candidate.first + candidate.frames + 1]
        arrived = bend_to(played, frames + 1, candidate.end, candidate.angle)
        if arrived.lack <= TUNED.pose / 2 and np.abs(arrived.turned).max() <= TUNED.most_turn:
            yield candidate.cost + arrived.price, walk, arrived
