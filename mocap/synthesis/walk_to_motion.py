"""Out of the graph: random walks, and the motions that walks stand for."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from mocap._shared.arrays import Array, Indices, Mask
from mocap.body import rotations
from mocap.body.motion import Motion, gather_marks
from mocap.body.planar import IDENTITY, PlanarTransform
from mocap.feet.footplants import mark_plants
from mocap.feet.footskate import clean_up
from mocap.graphs.edge_tables import Edge, EdgeTable, edge_table, frame_table
from mocap.graphs.motion_graph import MotionGraph
from mocap.synthesis.walks import require_walk


def to_motion(
    motion_graph: MotionGraph,
    walk: Sequence[Edge],
    *,
    name: str = "walk",
    place: PlanarTransform = IDENTITY,
    clean: bool = False,
) -> Motion:
    """Play a walk: stretches of clip as they are, transitions blended, each placed where the last one led.

    Every frame is moved by the product of the transforms of the transitions passed so far [KGP02, 4.1]. All
    frames are gathered, placed and blended at once, so the time is linear in the walk's length. A walk that
    passes no transition repeats its clip bit for bit.

    Parameters
    ----------
    motion_graph : the graph.
    walk : edges, each starting where the one before ends.
    name : the new motion's name.
    place : moves the whole motion; by default it starts where its first clip is.
    clean : whether to make planted feet stand still, by `feet.clean_up`; where no clip tells when its
        feet stand, that is found out first.

    Returns
    -------
    As many frames as the edges have together; labels and contacts are those of the clips, in a transition
    those of the clip with the larger weight.

    Raises
    ------
    NoWalk : for an empty walk, an edge that the graph lacks, or one that starts elsewhere.

    Notebook: 07-walks-and-search
    """
    require_walk(motion_graph, walk)
    if clean:
        motion_graph = with_plants(motion_graph)
    edges = edge_table(motion_graph, walk)
    table = frame_table(edges, motion_graph.window)
    before = places(edges, place)
    roots, turns = _placed(motion_graph, table.here, before, table.edge)
    mixed = edges.blended[table.edge]
    # The clip that a transition enters stays, from its blend on, where the transition put it.
    there, turned = _placed(motion_graph, table.there[mixed], before, table.edge[mixed] + 1)
    alpha = table.alpha[mixed, None]
    roots[mixed] = alpha * roots[mixed] + (1 - alpha) * there
    turns[mixed] = rotations.slerp(turned, turns[mixed], alpha)
    labels, contacts = (_marks(motion_graph, table.owner, kind) for kind in ("labels", "contacts"))
    clip = motion_graph.clips[0]
    motion = Motion(clip.skeleton, roots, turns, clip.fps, name, labels, contacts)
    return clean_up(motion) if clean else motion


def with_plants(motion_graph: MotionGraph) -> MotionGraph:
    """Find out when feet stand, where no clip tells."""
    if any(clip.contacts for clip in motion_graph.clips):
        return motion_graph
    return replace(motion_graph, clips=tuple(map(mark_plants, motion_graph.clips)))


def places(edges: EdgeTable, place: PlanarTransform = IDENTITY) -> PlanarTransform:
    """Multiply up the transforms along a walk of n edges: n + 1 places, the last where it ends.

    Angles add up, and so do the steps t_i, each turned by the angles before it: with a ground point as the
    complex number z + ix, a turn by θ is a product with exp(iθ), and both are running sums.

    Notebook: 07-walks-and-search
    """
    angle = np.cumsum(np.concatenate([[place.angle], np.asarray(edges.transform.angle)]))
    steps = edges.transform.move * np.exp(1j * angle[:-1])
    moved = np.cumsum([place.move, *steps])
    return PlanarTransform(angle, moved.imag, moved.real)


def _placed(
    motion_graph: MotionGraph, frames: Indices, places: PlanarTransform, chosen: Indices
) -> tuple[Array, Array]:
    """Gather frames (F, 2) and move each by one of the places: root positions and rotations."""
    joints = len(motion_graph.clips[0].skeleton)
    roots, turns = np.empty((len(frames), 3)), np.empty((len(frames), joints, 4))
    for clip in np.unique(frames[:, 0]):
        of_clip = frames[:, 0] == clip
        roots[of_clip] = motion_graph.clips[clip].root_positions[frames[of_clip, 1]]
        turns[of_clip] = motion_graph.clips[clip].rotations[frames[of_clip, 1]]
    place = PlanarTransform(*(np.asarray(numbers)[chosen] for numbers in places))
    turned = place.angle != 0  # what is not turned keeps its last digits
    turns[turned, 0] = rotations.multiply(rotations.about_y(place.angle)[turned], turns[turned, 0])
    return place.apply_points(roots), turns


def _marks(motion_graph: MotionGraph, owner: Indices, kind: str) -> dict[str, Mask]:
    """Take over the labels or the contacts of the clips that the frames (F, 2) come from."""
    visited, number = np.unique(owner[:, 0], return_inverse=True)
    sources = [getattr(motion_graph.clips[clip], kind) for clip in visited]
    return gather_marks(sources, np.stack([number, owner[:, 1]], axis=1))
