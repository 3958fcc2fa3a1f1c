"""The kinds of motion that a walking page offers: each is tried on six lines when the page is made."""

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from scipy.spatial import cKDTree

from mocap._shared.arrays import Array
from mocap.body.ground_path import GroundPath, arcs, circle, s_curve
from mocap.body.motion import Motion
from mocap.errors import MocapWarning, NoWalk, shortened, warn
from mocap.graphs.motion_graph import MotionGraph
from mocap.graphs.pruning import prune
from mocap.synthesis.random_walks import random_walk
from mocap.widgets.walk_bending import Bendable, bend_onto

Node = tuple[int, int]
STANDING = "stand"  # the label of a body that stands, which follows no line
START = (0.0, 0.0)  # of lines, metres
STRAIGHT = (1.0, 0.0)  # an arc: metres, and radians
LEFT = (3.0, np.pi / 2)
RIGHT = (3.0, -np.pi / 2)
CORNER = (1.2, np.pi / 2)
# A line straight on, bends to the left and to the right, an S, a circle, and two corners.
SHAPES = ([(5.0, 0.0)], [STRAIGHT, LEFT], [STRAIGHT, RIGHT], [STRAIGHT, CORNER, STRAIGHT, CORNER, STRAIGHT])
TRIALS = (s_curve(6.0), circle(1.0), *(arcs(START, 0.0, shape) for shape in SHAPES))
"""The lines on which each kind of motion is tried."""

SLOWEST = 0.3  # metres per second: a slower motion goes nowhere
LEAST_FRACTION = 0.95  # of the frames that are of the kind
FARTHEST = 0.1  # metres: the largest mean distance from a line
FINE = 0.01  # metres between the points of a line from which distances are measured
XZ = [0, 2]  # columns of a position on the ground


def labels_throughout(graph: MotionGraph, nodes: tuple[Node, Node], edge: Mapping[str, Any]) -> set[str]:
    """Return the labels of all frames that an edge between two nodes plays or blends.

    Examples
    --------
    >>> from mocap import datasets, graphs
    >>> clip = datasets.sample("jog")  # at first it walks
    >>> graph = graphs.from_transitions([clip], [], window=10)
    >>> labels_throughout(graph, ((0, 0), (0, 9)), {"kind": "clip", "frames": 9})
    {'walk'}
    >>> labels_throughout(graph, ((0, 0), (0, len(clip))), {"kind": "clip", "frames": len(clip)})
    set()
    """
    frames = edge["frames"]
    start, (target, end) = nodes
    spans = (start, (target, end - frames))
    return set.intersection(*(_labels_in(graph.clips[clip], frame, frames) for clip, frame in spans))


def _labels_in(clip: Motion, start: int, frames: int) -> set[str]:
    """Return the labels of all of some frames of a clip."""
    return {label for label, mark in clip.labels.items() if mark[start : start + frames].all()}


def kinds_that_work(graph: MotionGraph, labels: Sequence[str], bendable: Bendable) -> list[str]:
    """Return the kinds of motion that can follow lines, the most frequent first. Each is tried on `TRIALS`.

    Warns
    -----
    MocapWarning : for a kind that is omitted, with the reason.

    Examples
    --------
    >>> from mocap import body, datasets, graphs
    >>> clips = [body.resample(datasets.sample("walk_circle"), 30)]
    >>> graph = graphs.prune(graphs.build(clips, window=10, threshold=0.04))
    >>> kinds_that_work(graph, ["walk"], Bendable.of(clips))
    ['walk']
    """
    frames = dict.fromkeys(labels, 0)
    for clip in graph.clips:
        for label, mark in clip.labels.items():
            frames[label] += int(mark.sum())
    working = []
    for label in sorted(set(labels) - {STANDING}, key=lambda label: -frames[label]):
        try:
            _try_kind(graph, label, bendable)
        except NoWalk as shortfall:
            warn(f"The page has no button for '{shortened(label, 40)}': {str(shortfall)[:120]}")
        else:
            working.append(label)
    return working


def _try_kind(graph: MotionGraph, label: str, bendable: Bendable) -> None:
    """Bend a walk of a kind onto each line of `TRIALS`; raise `NoWalk` if one is not good enough."""
    of_kind = []
    for start, end, key, edge in graph.graph.edges(keys=True, data=True):
        if label in labels_throughout(graph, (start, end), edge):
            of_kind.append((start, end, key))
    part = replace(graph, graph=graph.graph.edge_subgraph(of_kind).copy())
    with warnings.catch_warnings(action="ignore", category=MocapWarning):
        pruned = prune(part)
    for seed, line in enumerate(TRIALS):
        edges = random_walk(pruned, seconds=line.length / SLOWEST, seed=seed)
        bent = bend_onto(pruned, edges, line, bendable)
        _check(bent, label, line)


def _check(bent: Motion, label: str, line: GroundPath) -> None:
    """Raise `NoWalk` unless a bent walk is of a kind, reaches the end of a line, and keeps to it."""
    track = bent.root_positions[:, XZ]
    frames = int(np.searchsorted(_metres(track), line.length))
    if frames == len(track):
        raise NoWalk(f"it goes more slowly than {SLOWEST} m/s.")
    fraction = bent.labels[label][:frames].mean()
    if fraction < LEAST_FRACTION:
        raise NoWalk(f"only {fraction:.0%} of a walk are of it.")
    distances, _ = cKDTree(line.resampled(FINE).points).query(track[:frames])
    if distances.mean() > FARTHEST:
        raise NoWalk(f"it is {100 * distances.mean():.0f} cm off a line of {line.length:.1f} m.")


def _metres(track: Array) -> Array:
    """Return the metres along a track (F, 2) in each frame."""
    return np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(track, axis=0).T))])
