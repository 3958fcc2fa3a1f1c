"""A motion graph by the functions of the exercises: joints, distances, transitions, nodes and edges.

On the ground a place is a complex number, z + ix, and a clip is placed by p ↦ turn · p + move.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from itertools import combinations_with_replacement, pairwise
from types import SimpleNamespace
from typing import NamedTuple

import numpy as np

from mocap._shared.arrays import Array, Points
from mocap._shared.collector import uncollected
from mocap.body.motion import Motion, require_alike
from mocap.body.planar import PlanarTransform, on_ground
from mocap.course.checks import all_checks
from mocap.course.lab.adopting import slots
from mocap.course.lab.guarding import Slot
from mocap.errors import MocapError
from mocap.matching import Transition, distinct_joints

NAMES = (
    *("climb", "window_sums", "inner_minima", "best_angle", "best_shift", "undo", "choice_points"),
    *("successors_of", "tarjan", "component_to_keep", "lay_on", "edge_cost", "lengthen", "survivors"),
    *("product_of", "hamilton", "move_points", "quintic", "short_way", "mix", "next_edge"),
)
"""The exercises in the order in which a motion graph needs them."""
PARTS = {"lengthen": "edge_cost", "mix": "short_way"}
"""What stands in for a function that nobody wrote, and what it is made of."""

OwnNode = tuple[int, int]
Tools = SimpleNamespace  # a function for each of `NAMES`, as `tools.climb`


def tools() -> Tools:
    """Take the student's functions, where they passed their checks, and the package's for the rest.

    Notebook: 08b-steering
    """
    return Tools(**{slot.name: slot for slot in slots(*NAMES)})


def packages() -> Tools:
    """Take the package's functions alone.

    Examples
    --------
    >>> packages().quintic(4).round(3).tolist()
    [0.896, 0.5, 0.104, 0.0]
    """
    return Tools(**{name: Slot(all_checks()[name]) for name in NAMES})


def joint_cloud(clip: Motion, by: Tools) -> Array:
    """Give the joints that are different points, shape (F, P, 3), metres: each climbs to the root.

    Examples
    --------
    >>> from mocap import datasets
    >>> joint_cloud(datasets.sample()[:2], packages()).shape
    (2, 31, 3)
    """
    joints = distinct_joints(clip.skeleton)
    frames = zip(clip.root_positions, clip.rotations, strict=True)
    return np.array(
        [[root + by.climb(clip.skeleton, turns, joint) for joint in joints] for root, turns in frames]
    )


def window_distances(a: Array, b: Array, window: int, by: Tools) -> Array:
    """Measure D between all windows of two clouds, shapes (F, P, 3): (F_a - k + 1, F_b - k + 1), m².

    With points on the ground as complex numbers g = z + ix, and means over a window's points,
    D = S + S' - 2 mean(y y') - 2 |mean(g ḡ') - mean(g) mean(ḡ')|: the grid of notebook 02b.
    """

    def sums(numbers: Array) -> Array:
        return np.convolve(numbers, np.ones(window), mode="valid")

    origin = a.mean(axis=(0, 1)) * [1, 0, 1]  # numbers near 0 lose no digits
    clouds = [cloud - origin for cloud in (a, b)]
    heights = [cloud[..., 1] for cloud in clouds]
    grounds = [cloud[..., 2] + 1j * cloud[..., 0] for cloud in clouds]
    count = window * a.shape[1]
    means = [sums(ground.sum(axis=1)) / count for ground in grounds]
    sizes = [
        sums((height**2 + np.abs(ground) ** 2).sum(axis=1)) / count - np.abs(mean) ** 2
        for height, ground, mean in zip(heights, grounds, means, strict=True)
    ]
    products = grounds[0] @ grounds[1].conj().T
    both = by.window_sums(products.real, window) + 1j * by.window_sums(products.imag, window)
    turned = np.abs(both / count - means[0][:, None] * means[1].conj())
    level = by.window_sums(heights[0] @ heights[1].T, window) / count
    return np.asarray(np.maximum(sizes[0][:, None] + sizes[1] - 2 * level - 2 * turned, 0))


def find_matches(clouds: Sequence[Array], window: int, threshold: float, by: Tools) -> list[Transition]:
    """Find the transitions between all pairs of clips, and within each clip, both ways.

    Parameters
    ----------
    clouds : shape (F, P, 3) each, metres.
    window : frames in a transition.
    threshold : the largest RMS distance, metres.
    by : whose functions work.
    """
    found = []
    for first, second in combinations_with_replacement(range(len(clouds)), 2):
        a, b = clouds[first], clouds[second]
        grid = window_distances(a, b, window, by)
        for i, j in by.inner_minima(grid, threshold**2):
            if first == second and j - i < window:  # both ways come from one half of the grid
                continue
            points, others = (cloud[at : at + window].reshape(-1, 3) for cloud, at in ((a, i), (b, j)))
            angle = float(by.best_angle(points, others))
            there = (angle, *map(float, by.best_shift(points, others, angle)))
            back = map(float, by.undo(*there))
            cost = float(np.sqrt(grid[i, j]))
            found.append(Transition(first, int(i), second, int(j), cost, PlanarTransform(*there)))
            found.append(Transition(second, int(j), first, int(i), cost, PlanarTransform(*back)))
    return found


class OwnEdge(NamedTuple):
    """An edge: a stretch of clip, or a transition if there is a `match`.

    `track` is the root on the ground before the edge and in each of its frames, in the coordinates of the
    clip that it leaves; `turn` and `move` lay the clip that it enters on this one.
    """

    start: OwnNode
    end: OwnNode
    match: Transition | None
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
    points = []
    for number, clip in enumerate(clips):
        leaves = [match.leave for match in matches if match.source == number]
        enters = [match.enter for match in matches if match.target == number]
        points.append(by.choice_points(len(clip), leaves, enters, window))
    played = [
        ((clip, here), (clip, there), there - here)
        for clip, frames in enumerate(points)
        for here, there in pairwise(frames)
    ]
    following = by.successors_of(points, [match[:4] for match in matches], window)
    with ExitStack() as after:  # a search that calls itself goes as deep as a clip has nodes
        after.callback(sys.setrecursionlimit, sys.getrecursionlimit())
        sys.setrecursionlimit(sys.getrecursionlimit() + 4 * len(following))
        components = by.tarjan(following)
    kept = by.component_to_keep(components, played)
    if len(kept) < 2:
        raise MocapError(f"No walk goes on for ever with transitions below {threshold} m: allow more.")
    edges: dict[OwnNode, list[OwnEdge]] = {node: [] for node in sorted(kept)}
    for edge in _edges(clips, window, played, matches, by):
        if edge.start in kept and edge.end in kept:
            edges[edge.start].append(edge)
    return OwnGraph(tuple(clips), window, edges)


def _edges(
    clips: Sequence[Motion],
    window: int,
    played: Sequence[tuple[OwnNode, OwnNode, int]],
    matches: Sequence[Transition],
    by: Tools,
) -> list[OwnEdge]:
    """Make stretches of clip and transitions, with the root's track along each."""
    roots = [on_ground(clip.root_positions) for clip in clips]
    edges = [
        OwnEdge(start, end, None, roots[start[0]][np.maximum(start[1] + np.arange(-1, frames), 0)], 1, 0)
        for start, end, frames in played
    ]
    alpha = np.append(1.0, by.quintic(window))  # the frame before the window is the source's
    steps = np.arange(-1, window)
    for match in matches:
        turn, move = complex(match.transform.turn), complex(match.transform.move)
        here = roots[match.source][np.maximum(match.leave + steps, 0)]
        there = turn * roots[match.target][np.maximum(match.enter + steps, 0)] + move
        start, end = (match.source, match.leave), (match.target, match.enter + window)
        edges.append(OwnEdge(start, end, match, alpha * here + (1 - alpha) * there, turn, move))
    return edges
