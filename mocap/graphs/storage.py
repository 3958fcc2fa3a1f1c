"""Motion graphs in `.npz` files: nodes and edges as arrays, clips by name and fingerprint.

A file contains no code, and frames of clips only if it was packed. Files from untrusted sources are safe to
read.
"""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import networkx as nx
import numpy as np

from mocap._shared.archives import (
    Arrays,
    Kind,
    Layout,
    Rules,
    kind_of,
    open_archive,
    read_archive,
    write_archive,
)
from mocap._shared.progress import Progress
from mocap._shared.records import NamedTuple
from mocap.body.motion import Motion
from mocap.body.planar import PlanarTransform
from mocap.datasets import clip_references, packed_clips
from mocap.datasets.clip_origins import NOWHERE, Origin, stored_options
from mocap.datasets.clip_references import MOST_FRAMES, ClipReferences
from mocap.errors import MocapError, Remedy, warn
from mocap.files.load_save import require_path
from mocap.graphs.motion_graph import MotionGraph, require_graph

FRAMES = 3  # column of `edges`
# The arrays of the file, with C clips, N nodes, E edges, T transitions and L labels.
# reads: statement: a table
ARRAYS: Layout = {
    **clip_references.LAYOUT,
    "window": (int, ()),
    "nodes": (int, ("N", 2)),  # clip, frame
    "edges": (int, ("E", 4)),  # start and end (rows of nodes), key, frames
    "is_transition": (bool, ("E",)),
    "costs": (float, ("T",)),
    "transforms": (float, ("T", 3)),
    "labels": (str, ("L",)),
    "labelled": (bool, ("E", "L")),
}


class GraphFile(NamedTuple):
    """The content of a file: the rate, names, lengths, fingerprints and roles of the clips, and the graph.

    `packed` are the arrays of a file that carries its clips, as of `datasets.packed_clips`.
    """

    fps: float
    window: int
    names: list[str]
    frames: list[int]
    fingerprints: list[str]
    origins: list[str]
    roles: list[str]
    graph: nx.MultiDiGraph
    packed: Arrays | None = None


def save(
    motion_graph: MotionGraph, path: str | Path, origins: Sequence[Origin] = (), *, pack: bool = False
) -> None:
    """Write a motion graph to an `.npz` file. An existing file is replaced once the new one is complete.

    Parameters
    ----------
    motion_graph : from `graphs.build` or `prune`.
    path : the file.
    origins : the file of each clip, by which `load` finds it again, by default none. Each path is stored
        relative to the folder of the graph, and absolute.
    pack : whether the file carries its clips, with 16 bits for each number of a quaternion, so that it can be
        given away. It then stores no paths. `datasets.packed_clips.packing_error` measures the loss.

    Raises
    ------
    MocapError : for another suffix, an object that is not a motion graph, and a file that cannot be written.

    Examples
    --------
    >>> import tempfile
    >>> from mocap import datasets, graphs
    >>> clips = [datasets.sample("walk_circle")]
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     save(graphs.from_transitions(clips, [], window=10), f"{folder}/walks.npz")
    ...     load(f"{folder}/walks.npz", clips)
    MotionGraph(1 clips, 2 nodes, 1 edges, 0 of them transitions)

    Notebook: 05b-choice-points
    """
    if isinstance(path, MotionGraph):
        raise MocapError("The graph comes first: graphs.save(graph, 'graph.npz').")
    require_graph(motion_graph)
    require_path(path)
    of_graph = {"window": motion_graph.window} | _arrays_of_graph(motion_graph.graph)
    if pack:
        clips = packed_clips.as_packed(motion_graph.clips)
        named = [origin._replace(path=NOWHERE, skeleton=None, labels=()) for origin in origins]
        arrays = clip_references.arrays_of_clips(clips, named, path) | packed_clips.pack(motion_graph.clips)
        write_archive(path, PACKED, arrays | of_graph)
    else:
        arrays = clip_references.arrays_of_clips(motion_graph.clips, origins, path)
        write_archive(path, GRAPH, arrays | of_graph)


def _arrays_of_graph(graph: nx.MultiDiGraph) -> dict[str, Any]:
    """Convert a graph to arrays of nodes, edges, transitions and labels."""
    number = {node: row for row, node in enumerate(graph)}
    edges = list(graph.edges(keys=True, data=True))
    attributes = [edge for *_, edge in edges]
    transitions = [edge for edge in attributes if edge["kind"] == "transition"]
    labels = sorted({label for edge in attributes for label in edge["labels"]})
    rows = [(number[start], number[end], key, edge["frames"]) for start, end, key, edge in edges]
    labelled = [label in edge["labels"] for edge in attributes for label in labels]
    transforms = [edge["transform"] for edge in transitions]
    is_transition = [edge["kind"] == "transition" for edge in attributes]
    of_edges = {
        "edges": np.reshape(rows, (-1, 4)),
        "is_transition": is_transition,
        "labelled": np.reshape(labelled, (len(edges), len(labels))),
    }
    of_transitions = {
        "costs": [edge["cost"] for edge in transitions],
        "transforms": np.reshape(transforms, (-1, 3)),
    }
    of_nodes = {"nodes": np.reshape(list(graph), (-1, 2)), "labels": labels}
    return of_nodes | of_edges | of_transitions


def load(
    path: str | Path,
    clips: Sequence[Motion] | None = None,
    *,
    skeleton: Path | None = None,
    progress: Progress = iter,
) -> MotionGraph:
    """Read a motion graph and its clips, resampled to its frame rate; `save` shows an example.

    Parameters
    ----------
    path : a file from `save`.
    clips : the motions from which it was built, in any order. Other motions are ignored. By default they are
        bundled samples, or the files that the graph stores, or files of their names in its folder. A file
        that carries its clips needs none.
    skeleton : the `.asf` file of `.amc` clips, by default the one that the graph stores, or one that fits.
    progress : wraps the iterable of files of clips, to show a progress bar.

    Returns
    -------
    The same graph, bit for bit. The joints of its clips have the roles that they had when it was saved.

    Raises
    ------
    FormatError : for a file that is not a motion graph, is damaged, or has a newer version.
    MocapError : for a clip that is missing, cannot be read, or has changed.

    Warns
    -----
    MocapWarning : for a file of version 1, whose fingerprints depend on the machine. Only names and lengths
        of its clips are compared.

    Notebook: 05b-choice-points
    """
    content = read(path)
    if content.packed is not None:
        return MotionGraph(tuple(_unpacked(path, content, clips)), content.window, content.graph)
    references = _references(content)
    clips = clip_references.load_references(references, path, clips, skeleton, progress)
    if not any(content.fingerprints):
        warn(f"An older mocap saved {path}: it cannot tell whether its clips have changed; save it anew.")
    return MotionGraph(tuple(clips), content.window, content.graph)


def _unpacked(path: str | Path, content: GraphFile, clips: Sequence[Motion] | None) -> list[Motion]:
    """Return the clips that a file carries."""
    if clips is not None:
        raise MocapError(f"{path} carries its clips.", remedy=Remedy("leave out {}", "clips"))
    assert content.packed is not None
    packed = packed_clips.unpack(content.packed, content.fps, content.names, content.frames)
    return clip_references.with_stored_roles(packed, _references(content))


def _references(content: GraphFile) -> ClipReferences:
    """Return the references to the clips in a file."""
    return ClipReferences._make(getattr(content, key) for key in ClipReferences._fields)


def read(path: str | Path) -> GraphFile:
    """Read the content of a file, without its clips.

    Raises
    ------
    FormatError, MocapError : as for `load`.
    """
    with open_archive(path, GRAPH.wanted) as members:
        is_packed = kind_of(members) == PACKED.name
    arrays = read_archive(path, PACKED if is_packed else GRAPH)
    if not is_packed and arrays["version"] < PORTABLE_FINGERPRINTS:
        arrays["fingerprints"] = np.zeros_like(arrays["fingerprints"])
    arrays.setdefault("roles", np.array([], str))
    values = {key: arrays[key].tolist() for key in GraphFile._fields if key not in ("graph", "packed")}
    return GraphFile(**values, graph=_graph(arrays), packed=arrays if is_packed else None)


def _graph(arrays: Arrays) -> nx.MultiDiGraph:
    """Build the graph from the arrays of a file."""
    nodes = [(clip, frame) for clip, frame in arrays["nodes"].tolist()]
    labels = np.array(arrays["labels"], object)
    transitions = zip(arrays["costs"].tolist(), arrays["transforms"].tolist(), strict=True)
    graph = nx.MultiDiGraph()
    graph.add_nodes_from(nodes)
    rows = zip(arrays["edges"].tolist(), arrays["is_transition"].tolist(), arrays["labelled"], strict=True)
    for (start, end, key, length), is_transition, marks in rows:
        edge: dict[str, Any] = {"kind": "clip", "frames": length, "labels": frozenset(labels[marks])}
        if is_transition:
            cost, transform = next(transitions)
            edge |= {"kind": "transition", "cost": cost, "transform": PlanarTransform(*transform)}
        graph.add_edge(nodes[start], nodes[end], key, **edge)
    return graph


def find_origins(path: str | Path) -> list[Origin]:
    """Find the files of the clips of a saved graph, as `load` does; none for bundled and for packed clips."""
    content = read(path)
    return [] if content.packed is not None else clip_references.find_files_of(_references(content), path)


def licences_in(path: str | Path) -> dict[str, str]:
    """Return the licences of the clips of a saved graph, by their names; empty if none is known.

    Raises
    ------
    FormatError, MocapError : as for `load`.
    """
    content = read(path)
    licences = {
        name: stored_options(text).licence for name, text in zip(content.names, content.origins, strict=False)
    }
    return licences if any(licences.values()) else {}


def _rules(arrays: Arrays) -> Rules:
    """Yield the validity rules of a file. Each rule assumes those before it."""
    window = arrays["window"]
    lengths = arrays["frames"]
    nodes = arrays["nodes"]
    yield from clip_references.rules_of_clips(arrays)
    yield "clips have names of their own", len(set(arrays["names"].tolist())) == len(lengths)
    yield "the window is above 0", 0 < window < MOST_FRAMES
    yield "nodes lie in clips", (nodes[:, 0] >= 0) & (nodes[:, 0] < len(lengths))
    yield "nodes lie in their clips", (nodes[:, 1] >= 0) & (nodes[:, 1] <= lengths[nodes[:, 0]])
    yield "no node comes twice", len(np.unique(nodes, axis=0)) == len(nodes)
    yield from _rules_of_edges(arrays)
    yield "each transition has a cost", arrays["is_transition"].sum() == len(arrays["costs"])
    yield "costs are distances", (arrays["costs"] >= 0) & (arrays["costs"] < np.inf)
    yield "transforms are finite", np.isfinite(arrays["transforms"])


def _rules_of_edges(arrays: Arrays) -> Rules:
    """Yield the validity rules of edges, given valid clips and nodes."""
    window = arrays["window"]
    edges = arrays["edges"]
    nodes = arrays["nodes"]
    yield "edges join nodes", (edges >= 0).all() and (edges[:, :2] < len(nodes)).all()
    yield "no edge comes twice", len(np.unique(edges[:, :FRAMES], axis=0)) == len(edges)
    start_clip, start = nodes[edges[:, 0]].T
    end_clip, end = nodes[edges[:, 1]].T
    frames = edges[:, FRAMES]
    plays_on = (start_clip == end_clip) & (start < end) & (frames == end - start)
    fits = (start + window <= arrays["frames"][start_clip]) & (end >= window)
    blends = fits & (frames == window)
    yield "edges play what lies between their ends", np.where(arrays["is_transition"], blends, plays_on)


PORTABLE_FINGERPRINTS = 2  # the version since which fingerprints are not computed from all digits


def _rules_of_packed(arrays: Arrays) -> Rules:
    """Yield the validity rules of a file that carries its clips."""
    yield from _rules(arrays)
    yield from packed_clips.rules_of_packed(arrays)


PACKED = Kind("a packed motion graph", {**ARRAYS, **packed_clips.LAYOUT}, _rules_of_packed)
GRAPH = Kind("a motion graph", ARRAYS, _rules, version=3, added={"roles": 3})
