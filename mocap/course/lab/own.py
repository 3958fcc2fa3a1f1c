"""A motion graph of one's own: `mocap.plain` by the functions of notebooks 01 to 08, and walks on it."""

from __future__ import annotations

import os
import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import networkx as nx
import numpy as np
from numpy.typing import ArrayLike

from mocap.body.ground_path import GroundPath
from mocap.body.motion import Motion, require_alike
from mocap.course.lab.adopting import whose
from mocap.course.lab.places import NAMES, Tools, pages_of
from mocap.course.lab.places import tools as tools
from mocap.errors import MocapError, MocapWarning, NoWalk
from mocap.graphs import build, prune
from mocap.plain import Edge
from mocap.plotting import bodies_along
from mocap.plotting.picture import Picture, stack
from mocap.steering import follow_path
from mocap.synthesis import seams

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
        NoWalk : where no walk reaches the end of the path.
        """
        search = self.pages.Search(self.clips, self.graph, self.pages.points_along(np.asarray(path, float)))
        try:
            found: OwnWalk = search.walk()
        except ValueError as error:
            said = f"No walk of this graph reaches the end of a path of {search.end:.1f} m."
            raise NoWalk(said) from error
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

    def seams(self, walk: OwnWalk) -> list[int]:
        """Give the frames at which a walk's transitions begin."""
        edges = [self.graph.edges[edge] for edge in walk[0]]
        starts = np.cumsum([0, *(edge["frames"] for edge in edges)])
        return [int(at) for at, edge in zip(starts, edges, strict=False) if edge["kind"] == "transition"]


@dataclass(frozen=True)
class Beside(Picture):
    """A picture of three walks along one path: one's own, that of `mocap.plain`, and the package's.

    Parameters
    ----------
    motion : the walk of the functions in their places; `mocap.save` writes it as BVH.
    """

    motion: Motion


def walk_beside(clips: Sequence[Motion], path: ArrayLike) -> Beside:
    """Walk along a path by the functions of the exercises, by `mocap.plain`, and by the package.

    Parameters
    ----------
    clips : motions of one skeleton and one frame rate, some hundred frames in all: one's own code is slow.
    path : corners on the ground (x, z), shape (N, 2), metres, as from a canvas.

    Returns
    -------
    The walks, which the last line of a cell shows; whose functions ran, and how near the walks are, is
    printed.

    Raises
    ------
    NoWalk, MocapError : as for `OwnGraph` and its `follow`.

    Notebook: 08-path-synthesis
    """
    line, ours = GroundPath(np.asarray(path, float)), tools()
    walks = {}
    for name, by in (("my walk", ours), ("plain's walk", None)):
        graph = OwnGraph(clips, WINDOW, BELOW, by)
        walk = graph.follow(line.points)
        walks[name] = graph.play(walk), graph.seams(walk)
    whole = prune(build(clips, window=WINDOW, threshold=BELOW))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", MocapWarning)  # what is printed says how far it is off
        followed = follow_path(whole, line)
    walks["the package's walk"] = followed.motion(), [seam.frame for seam in seams(whole, followed.walk)]
    print(f"{whose(*NAMES[:-1])}.")
    figures = []
    for name, (walked, marks) in walks.items():
        ground = walked.root_positions[:, None, [0, 2]]
        off = 100 * np.linalg.norm(ground - line.resampled(0.02).points, axis=-1).min(axis=1)
        print(f"{name + ':':19} {len(walked) / walked.fps:.1f} s long, {len(marks)} seams, ", end="")
        print(f"{off.mean():.1f} cm off on average, {off.max():.0f} cm at worst")
        figures.append(bodies_along(walked, seams=marks, path=line.points))
        figures[-1].suptitle(name, fontsize=11)
    alt = "Bodies walk along a black path: in my walk, in plain's, and in the package's."
    return Beside(stack(figures, alt).picture, alt, walks["my walk"][0])


def main(file: str) -> int:
    """Walk along a line by the functions in a file, as `python -m mocap.plain` does: clips, a path, -o."""
    os.environ["MOCAP_MINE"] = file
    print(f"{whose(*NAMES[:-1])}.")
    return int(pages_of(tools(), WINDOW, BELOW).main())
