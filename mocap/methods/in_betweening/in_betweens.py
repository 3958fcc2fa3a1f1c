"""A motion from one pose to another, each at its position, in a given time: an in-between.

The walks that `two_sided_search` finds are what the clips can do. Each of the best is bent and retimed, and
the one of lowest cost is kept. Its ends fade into the poses, and its feet are cleaned up.
"""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from mocap.body.motion import Motion
from mocap.errors import NoWalk
from mocap.graphs.compiled_graph import CompiledGraph
from mocap.graphs.edge_tables import Edge
from mocap.methods.in_betweening.end_bending import MOST_TURN, Arrived, bend_to
from mocap.methods.in_betweening.end_poses import meet_poses, stand
from mocap.methods.in_betweening.two_sided_search import TwoSided, find_candidates
from mocap.synthesis.walk_to_motion import to_motion, with_plants

TRIED = 24  # walks that are bent, of all that were found
POSE = 0.1  # metres: the RMS distance by which joints may be moved where the ends fade into the poses

# Times that feet are cleaned up and ends brought to the poses. The clean-up may release what it should hold
# at the ends, by up to 1° of a joint; feet then slide by up to 0.3 mm. After the second round most do not.
# Where a straight leg makes the clean-up lower the root near an end, 1 mm is left; more rounds do not help.
ROUNDS = 2


class InBetween(NamedTuple):
    """A motion from one pose to another, and how it was made.

    `motion`: N + 1 frames, the first and the last of them the requested poses; `walk`: the edges that it
    plays; `arrived`: the walk before its ends faded, and by how much it was turned, lengthened and retimed.
    """

    motion: Motion
    walk: list[Edge]
    arrived: Arrived


def in_between(graph: CompiledGraph, start: Motion, end: Motion, seconds: float) -> InBetween:
    """Find a motion from one pose to another, each at its position, in a given time.

    Parameters
    ----------
    graph : pruned, and compiled.
    start, end : motions of the graph's skeleton, at their positions: from the first frame of one to the last
        frame of the other. Further frames show their velocities. Clips of the graph are met best.
    seconds : from the first frame to the last, rounded to whole frames.

    Raises
    ------
    NoWalk : if no walk arrives although its pace and its steps change by up to a quarter, its turning by up
        to 60° per second and the poses at its ends by up to 10 cm.
    """
    frames = round(seconds * graph.fps)
    starts = find_candidates(graph, start, direction=1, limit=POSE)
    ends = find_candidates(graph, end, direction=-1, limit=POSE)
    source = with_plants(graph.source)
    walks = []
    for joined in TwoSided(graph, (starts, ends), frames).best(TRIED):
        walk = [graph.edges[edge] for edge in joined.edges]
        played = to_motion(source, walk, place=joined.place)
        played = played[joined.first : joined.first + joined.frames + 1]
        arrived = bend_to(played, frames + 1, joined.end, joined.turn)
        if arrived.lack <= POSE / 2 and np.abs(arrived.turned).max() <= MOST_TURN:
            walks.append((joined.cost + arrived.price, walk, arrived))
    if not walks:
        raise NoWalk(f"No walk leads from one pose to the other in {seconds:.1f} s: give another time.")
    _, walk, arrived = min(walks, key=lambda item: item[0])
    motion = meet_poses(replace(arrived.motion, name="in between"), start, end)
    for _ in range(ROUNDS):
        motion = meet_poses(stand(motion), start, end, speed=False)
    return InBetween(motion, walk, arrived)
