"""In-betweens: a motion from one pose to another, each at its position, in a given time.

`two_sided_search` finds walks through the clips. Each of the best is bent and retimed, and the one of lowest
cost is selected. Its ends are blended into the poses, and foot sliding is removed.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from mocap._shared.records import NamedTuple
from mocap.body.concatenation import concatenate
from mocap.body.motion import Motion, require_motion
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
from mocap.synthesis.walk_to_motion import to_motion, with_footplants


class InBetween(NamedTuple):
    """A motion from one pose to another, and the walk from which it was made.

    Parameters
    ----------
    motion : N + 1 frames, of which the first and the last are the requested poses.
    walk : the edges of the walk.
    arrived : the walk before its ends were blended, with its rotation, lengthening and retiming.
    """

    motion: Motion
    walk: list[Edge]
    arrived: Arrived


def in_between(graph: MotionGraph | CompiledGraph, start: Motion, end: Motion, seconds: float) -> InBetween:
    """Find a motion from one pose to another, each at its position, in a given time.

    Parameters
    ----------
    graph : pruned. For several in-betweens, compile it once by `graphs.compile_graph`.
    start, end : motions of the graph's skeleton, at their positions. The in-between leads from the first
        frame of `start` to the last frame of `end`. Further frames of both define velocities. Poses from the
        clips of the graph are met best.
    seconds : from the first frame to the last, rounded to whole frames.

    Raises
    ------
    NoWalk : if no walk arrives when its pace and its steps may change by a quarter, its angular speed by 60°
        per second and the poses at its ends by 10 cm.
    """
    compiled = compile_graph(graph)
    require_motion(start)
    require_motion(end)
    starts = find_candidates(compiled, start, direction=1, limit=TUNED.pose)
    ends = find_candidates(compiled, end, direction=-1, limit=TUNED.pose)
    return _connect(compiled, (starts, ends), (start, end), seconds)


def fill_gap(graph: MotionGraph | CompiledGraph, first: Motion, second: Motion, seconds: float) -> InBetween:
    """Find a motion that fills the gap between two motions, each at its position.

    Like `in_between`, for poses whose past and future are known: the character continues the first motion and
    arrives in the second. Candidates have similar velocities, and the ends are blended with the velocities of
    both motions.

    Parameters
    ----------
    graph : as for `in_between`.
    first, second : motions of the graph's skeleton. The gap is from the last frame of `first` to the first
        frame of `second`.
    seconds : the duration of the gap. Below `SHORTEST` seconds, `interpolate` is more accurate.

    Returns
    -------
    The in-between at the rate of the graph. Its first pose is the last of `first`, and its last pose is the
    first of `second`.

    Raises
    ------
    NoWalk : as for `in_between`.

    Examples
    --------
    >>> from mocap import body, datasets, graphs
    >>> walk = body.resample(datasets.sample("walk_curve_1"), 30)
    >>> graph = graphs.build([walk], window=10, threshold=0.04)
    >>> found = fill_gap(graph, walk[:100], walk[130:], 31 / 30)  # frames 99 to 130
    >>> errors = abs(found.motion.root_positions - walk.root_positions[99:131])  # metres
    >>> len(found.motion), float(errors.max().round(2))
    (32, 0.0)
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
    """Extrapolate a pose by one frame, with the velocity from an earlier frame to it."""
    return displaced(pose, difference(pose, earlier))


def _connect(
    graph: CompiledGraph,
    candidates: tuple[Candidates, Candidates],
    poses: tuple[Motion, Motion],
    seconds: float,
) -> InBetween:
    """Search, bend and blend a motion from the first frame of the start to the last frame of the end."""
    start, end = poses
    frames = round(seconds * graph.fps)
    joined = TwoSided(graph, candidates, frames).best(TUNED.most_tried)
    source = with_footplants(graph.source)
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
    """Bend walks, and yield those that arrive within the limits, with their costs."""
    for candidate in joined:
        walk = [graph.edges[edge] for edge in candidate.edges]
        played = to_motion(source, walk, start=candidate.transform)
        played = played[candidate.first : candidate.first + candidate.frames + 1]
        arrived = bend_to(played, frames + 1, candidate.end, candidate.angle)
        if arrived.lack <= TUNED.pose / 2 and np.abs(arrived.turned).max() <= TUNED.most_rotation:
            yield candidate.cost + arrived.price, walk, arrived
