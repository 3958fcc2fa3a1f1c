"""Conversion of a walk to a motion: gather its frames, transform them, and blend its transitions.

A walk is a list of edges (start node, end node, key), each of which starts at the end of the previous one.
The frames of a walk are those of its edges, in order. A frame is either a frame of a clip or a blend of two.
"""

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from mocap._shared.arrays import Array, Indices
from mocap._shared.quantities import described
from mocap._shared.records import NamedTuple
from mocap.body import rotations
from mocap.body.concatenation import gather_marks
from mocap.body.motion import Motion
from mocap.body.planar import IDENTITY, PlanarTransform
from mocap.editing.foot_cleaning import clean_feet
from mocap.editing.toes import lowest_heights
from mocap.errors import MocapError, NoWalk
from mocap.feet.footplants import mark_plants
from mocap.graphs.edge_tables import Edge, EdgeTable, edge_table
from mocap.graphs.motion_graph import MotionGraph, require_graph

EDGE_FIELDS = 3  # start, end and key


class Seam(NamedTuple):
    """A transition on a walk: the `frame` of the motion at which it starts, and its `cost` in metres."""

    frame: int
    cost: float


def seams(motion_graph: MotionGraph, walk: Sequence[Edge]) -> list[Seam]:
    """List the transitions of a walk.

    Examples
    --------
    A clip with a transition to an earlier frame, and a walk that takes it once:

    >>> from mocap import body, datasets, graphs, matching
    >>> clip = body.resample(datasets.sample("walk_circle"), 30)
    >>> back = matching.Transition(0, 60, 0, 10, 0.02, body.PlanarTransform(0, 0, 0))
    >>> graph = graphs.from_transitions([clip], [back], window=10)
    >>> seams(graph, [((0, 20), (0, 60), 0), ((0, 60), (0, 20), 0)])
    [Seam(frame=40, cost=0.02)]

    Notebook: 09-discussion
    """
    edges = edge_table(motion_graph, walk)
    return [Seam(int(edges.first[i]), float(edges.cost[i])) for i in np.flatnonzero(edges.blended)]


def sources(motion_graph: MotionGraph, walk: Sequence[Edge]) -> list[tuple[int, str]]:
    """List the clips of a walk, each with its first frame. The clip changes in the middle of a transition.

    Examples
    --------
    A transition of 10 frames leads from one clip to another:

    >>> from mocap import body, datasets, graphs, matching
    >>> clips = [body.resample(datasets.sample(name), 30) for name in ("walk_circle", "sneak")]
    >>> over = matching.Transition(0, 60, 1, 10, 0.02, body.PlanarTransform(0, 0, 0))
    >>> graph = graphs.from_transitions(clips, [over], window=10)
    >>> sources(graph, [((0, 0), (0, 60), 0), ((0, 60), (1, 20), 0)])
    [(0, 'walk_circle'), (65, 'sneak')]

    Notebook: 05-motion-graph
    """
    clips = edge_table(motion_graph, walk).owner[:, 0]  # of each frame
    return [(int(f), motion_graph.clips[clips[f]].name) for f in np.flatnonzero(np.diff(clips, prepend=-1))]


def require_walk(motion_graph: MotionGraph, walk: Sequence[Edge]) -> None:
    """Raise `NoWalk` for an empty walk, a missing edge, or edges that are not consecutive.

    Examples
    --------
    >>> from mocap import datasets, graphs
    >>> graph = graphs.from_transitions([datasets.sample("walk_circle")], [], window=10)
    >>> require_walk(graph, [((0, 0), (0, 99), 0)])
    Traceback (most recent call last):
    mocap.errors.NoWalk: The graph has no edge ((0, 0), (0, 99), 0).
    """
    require_graph(motion_graph)
    require_edges(walk)
    for edge in dict.fromkeys(map(tuple, walk)):
        if not motion_graph.graph.has_edge(*edge):
            raise NoWalk(f"The graph has no edge {edge}.")
    for (_, end, _), (start, _, _) in pairwise(walk):
        if end != start:
            raise NoWalk(f"The walk jumps from node {end} to node {start}.")


def require_edges(walk: object) -> None:
    """Raise unless a walk is a list of edges (start, end, key), as returned by `random_walk`.

    Examples
    --------
    >>> require_edges([10, 20])
    Traceback (most recent call last):
    mocap.errors.MocapError: A walk is a list of edges ((clip, frame), (clip, frame), key), got 10 in it:
    synthesis.random_walk makes one.
    """
    needs = "A walk is a list of edges ((clip, frame), (clip, frame), key)"
    if not isinstance(walk, Sequence):
        raise MocapError(f"{needs}, got {described(walk)}: synthesis.random_walk makes one.")
    for edge in walk:
        if not isinstance(edge, list | tuple) or len(edge) != EDGE_FIELDS:
            raise MocapError(f"{needs}, got {described(edge)} in it: synthesis.random_walk makes one.")
    if not walk:
        raise NoWalk("The walk has no edges.")


def to_motion(
    motion_graph: MotionGraph,
    walk: Sequence[Edge],
    *,
    name: str = "walk",
    start: PlanarTransform = IDENTITY,
    clean: bool = False,
) -> Motion:
    """Convert a walk to a motion: gather its frames, align each clip with the previous one, and blend.

    In the paper: [KGP02, 4.1].

    Every frame is transformed by the product of the transforms of all transitions before it [KGP02, 4.1]. All
    frames are gathered, transformed and blended at once, and the time is linear in the length of the walk. A
    walk without transitions repeats its clip bit for bit.

    Parameters
    ----------
    motion_graph : the graph.
    walk : consecutive edges.
    name : the name of the new motion.
    start : the transform of the first clip, by default the identity.
    clean : whether to remove footskate by `feet.clean_up`, and to keep the toes above the floor. Footplants
        are marked first if no clip has contacts.

    Returns
    -------
    The frames of all edges. Labels and contacts are those of the clips, and in a transition those of the clip
    with the larger weight.

    Raises
    ------
    NoWalk : for an empty walk, a missing edge, or edges that are not consecutive.

    Examples
    --------
    A clip with a transition to an earlier frame, and a walk of 40 frames of clip and 10 of blend:

    >>> from mocap import body, datasets, graphs, matching
    >>> clip = body.resample(datasets.sample("walk_circle"), 30)
    >>> back = matching.Transition(0, 60, 0, 10, 0.02, body.PlanarTransform(0, 0, 0))
    >>> graph = graphs.from_transitions([clip], [back], window=10)
    >>> motion = to_motion(graph, [((0, 20), (0, 60), 0), ((0, 60), (0, 20), 0)])
    >>> len(motion), bool((motion.rotations[:40] == clip.rotations[20:60]).all())
    (50, True)

    Notebook: 07-walks-and-search
    """
    require_walk(motion_graph, walk)
    if clean:
        motion_graph = with_footplants(motion_graph)
    edges = edge_table(motion_graph, walk)
    transforms = transforms_along(edges, start)
    roots, local_rotations = _transformed_frames(motion_graph, edges.here, transforms, edges.of)
    mixed = edges.blended[edges.of]
    # The target clip has the transition's transform, in the blend and after it.
    target_roots, target_rotations = _transformed_frames(
        motion_graph, edges.there[mixed], transforms, edges.of[mixed] + 1
    )
    alpha = edges.alpha[mixed, None]
    roots[mixed] = alpha * roots[mixed] + (1 - alpha) * target_roots
    local_rotations[mixed] = rotations.slerp(target_rotations, local_rotations[mixed], alpha)
    visited, number = np.unique(edges.owner[:, 0], return_inverse=True)
    owner = np.stack([number, edges.owner[:, 1]], axis=1)
    labels = gather_marks([motion_graph.clips[clip].labels for clip in visited], owner)
    contacts = gather_marks([motion_graph.clips[clip].contacts for clip in visited], owner)
    clip = motion_graph.clips[0]
    motion = Motion(clip.skeleton, roots, local_rotations, clip.fps, name, labels, contacts)
    return clean_feet(motion, lowest_heights(motion_graph.clips)) if clean else motion


def with_footplants(motion_graph: MotionGraph) -> MotionGraph:
    """Mark the footplants of all clips by `feet.mark_plants`, unless any clip has contacts.

    Examples
    --------
    >>> from dataclasses import replace
    >>> from mocap import datasets, graphs
    >>> clip = replace(datasets.sample("walk_curve_1"), contacts={})
    >>> sorted(with_footplants(graphs.from_transitions([clip], [], window=10)).clips[0].contacts)
    ['lfoot', 'ltoes', 'rfoot', 'rtoes']
    """
    if any(clip.contacts for clip in motion_graph.clips):
        return motion_graph
    return replace(motion_graph, clips=tuple(map(mark_plants, motion_graph.clips)))


def transforms_along(edges: EdgeTable, start: PlanarTransform = IDENTITY) -> PlanarTransform:
    """Compose the transforms along a walk of n edges: n + 1 transforms, before each edge and at the end.

    Both the angle and the translation are cumulative sums. With ground points as complex numbers z + ix, a
    rotation by θ is a multiplication by exp(iθ). The translation of an edge is rotated by the sum of the
    previous angles, then added.

    Parameters
    ----------
    edges : the edges of the walk, from `graphs.edge_tables.edge_table`.
    start : the transform of the first clip.

    Examples
    --------
    Two transitions, each of which rotates to the left by 90° and translates by 1 m forward:

    >>> from mocap import datasets, graphs, matching
    >>> back = matching.Transition(0, 60, 0, 10, 0.02, PlanarTransform(np.pi / 2, 0.0, 1.0))
    >>> graph = graphs.from_transitions([datasets.sample("walk_circle")], [back], window=10)
    >>> x, z = transforms_along(edge_table(graph, 2 * [((0, 60), (0, 20), 0)]))[1:]
    >>> x.round(6).tolist(), z.round(6).tolist()
    ([0.0, 0.0, 1.0], [0.0, 1.0, 1.0])
    """
    angle = np.cumsum([start.angle, *edges.angle])
    steps = edges.translation * np.exp(1j * angle[:-1])
    moved = np.cumsum([start.translation, *steps])
    return PlanarTransform(angle, moved.imag, moved.real)


def _transformed_frames(
    motion_graph: MotionGraph, frames: Indices, transforms: PlanarTransform, chosen: Indices
) -> tuple[Array, Array]:
    """Gather frames (F, 2), and transform them by `transforms[chosen]`: root positions and rotations."""
    joints = len(motion_graph.clips[0].skeleton)
    roots = np.empty((len(frames), 3))
    local_rotations = np.empty((len(frames), joints, 4))
    for clip in np.unique(frames[:, 0]):
        of_clip = frames[:, 0] == clip
        roots[of_clip] = motion_graph.clips[clip].root_positions[frames[of_clip, 1]]
        local_rotations[of_clip] = motion_graph.clips[clip].rotations[frames[of_clip, 1]]
    transform = PlanarTransform(*(np.asarray(field)[chosen] for field in transforms))
    # In place, because the copy in `apply_frames` would take longer than the gathering.
    local_rotations[:, 0] = rotations.multiply(rotations.about_y(transform.angle), local_rotations[:, 0])
    return transform.apply_points(roots), local_rotations
