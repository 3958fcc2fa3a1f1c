"""A motion graph of one's own: `mocap.plain` by the functions of notebooks 01 to 08, and walks on it."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence

import networkx as nx
import numpy as np
from numpy.typing import ArrayLike

from mocap.body.motion import Motion, require_alike
from mocap.course.lab.adopting import whose
from mocap.course.lab.places import NAMES, Tools, pages_of
from mocap.course.lab.places import tools as tools
from mocap.errors import MocapError
from mocap.plain import Edge

WINDOW, BELOW = 10, 0.05  # of the transitions: frames, and metres
AHEAD = 1.5  # seconds that a choice looks ahead: with less, no turn is seen


OwnWalk = tuple[list[Edge], complex, complex]
"""A walk: its edges, and how the first one's clip is placed, p ↦ turn · p + move."""


class OwnGraph:
    """A motion graph of clips, of which the component that plays most frames is kept, and walks on it.

    Parameters
    ----------
    clips : motions of one skeleton and one frame rate.
    window, threshold : of the transitions: frames, and metres.
    by : whose functions work; None for those of `mocap.plain`.

    Attributes
    ----------
    pages : the copy of `mocap.plain` in which these functions have their places.
    found, graph : all transitions, and the nodes and edges that are kept, as in `mocap.plain`.

    Raises
    ------
    SkeletonMismatch, MocapError : for no clips, clips that differ in skeleton or rate or are shorter than the
        window, and where there is no loop: the threshold is too low.

    Notebook: 08b-steering
    """

    def __init__(self, clips: Sequence[Motion], window: int, threshold: float, by: Tools | None) -> None:
        self.clips, self.pages = require_alike(clips), pages_of(by, window, threshold)
        self.by = by or Tools()
        if not 2 <= window <= min(map(len, self.clips)):
            raise MocapError(f"A graph takes a window of two frames up to the shortest clip, got {window}.")
        self.found = self.pages.find_transitions(self.clips)
        self.graph: nx.MultiDiGraph = self.pages.prune(self.pages.cut_and_join(self.clips, self.found))
        if len(self.graph) < 2:
            raise MocapError(f"No walk goes on for ever with transitions below {threshold} m: allow more.")

    def follow(self, path: ArrayLike) -> OwnWalk:
        """Find a walk along a path: all walks advance layer by layer, as in notebook 08 [KGP02, Eq. 9].

        Parameters
        ----------
        path : corners on the ground (x, z), shape (N, 2), metres.

        Raises
        ------
        ValueError : where no walk comes to the end of the path.
        """
        search = self.pages.Search(self.clips, self.graph, self.pages.points_along(np.asarray(path, float)))
        found: OwnWalk = search.walk()
        return found

    def steer(self, command: Callable[[float], tuple[float, float]], seconds: float) -> OwnWalk:
        """Walk for some seconds, and choose at each node the edge that fits the command of that moment.

        Parameters
        ----------
        command : from the time in seconds to a heading in radians (0 is +z, π/2 is +x) and a speed, metres
            per second.
        seconds : how long to walk.
        """
        fps, pages = self.clips[0].fps, self.pages
        search, soon = pages.Search(self.clips, self.graph, pages.points_along(np.eye(2))), round(AHEAD * fps)
        node, lay, edges, frames = min(self.graph), (1 + 0j, 0j), [], 0
        while frames < seconds * fps:
            ways, tracks = list(self.graph.out_edges(node, keys=True)), []
            for way in ways:
                (clip, frame), (turn, move) = way[1], self.graph.edges[way]["lay"]
                there = turn * search.roots[clip][frame : frame + soon] + move
                tracks.append(np.concatenate([search.tracks[way], there])[: soon + 1])
            edges.append(ways[int(self.by.next_edge(lay[0], tracks, *command(frames / fps), fps))])
            frames += len(search.tracks[edges[-1]]) - 1
            node, lay = edges[-1][1], pages.product(lay, self.graph.edges[edges[-1]]["lay"])
        return edges, 1, 0

    def play(self, walk: OwnWalk) -> Motion:
        """Play a walk, shape (F, ...): copy stretches of clip, blend transitions [KGP02, Eqs. 5 and 6]."""
        roots, turns = self.pages.to_motion(self.clips, self.graph, *walk)
        return Motion(self.clips[0].skeleton, roots, turns, self.clips[0].fps, "my walk")


def main(file: str) -> int:
    """Walk along a line by the functions in a file, as `python -m mocap.plain` does: clips, a path, -o."""
    os.environ["MOCAP_MINE"] = file
    print(f"{whose(*NAMES[:-1])}.")
    return int(pages_of(tools(), WINDOW, BELOW).main())
