"""Save a motion graph to one file: nodes and edges as arrays in an `.npz`, clips by name and fingerprint.

The file holds no frames of the clips and no code: it is safe to read a file from a stranger.
"""

import itertools
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any, NamedTuple

import networkx as nx
import numpy as np
from numpy.typing import ArrayLike

from mocap._shared.archives import Arrays, Member, open_archive, pack
from mocap._shared.progress import Progress
from mocap.body.fingerprints import fingerprint
from mocap.body.motion import Motion, require_alike, resample
from mocap.body.planar import PlanarTransform
from mocap.datasets.clip_origins import Origin, find_again, is_origin
from mocap.datasets.samples import FPS, FRAMES_IN_0_1, SAMPLES, sample
from mocap.editing.mirroring import mirror
from mocap.errors import FormatError, MocapError, Remedy, shortened, warn
from mocap.files.conversion import is_clip
from mocap.files.load_save import load as load_motion
from mocap.graphs.motion_graph import MotionGraph

KIND = "mocap: a motion graph"
FIRST_KIND = "mocap motion graph"  # as the first files say
VERSION = 2  # in version 1 fingerprints were of all digits
OURS = "a motion graph saved by mocap, version 1 or 2"
FRAMES = 3  # column of `edges`
MOST = 2**31  # frames
FASTEST = 1e6  # frames per second
# The arrays of the file, with C clips, O origins, N nodes, E edges, T transitions and L labels.
# reads: statement: a table
ARRAYS: dict[str, tuple[type, tuple[int | str, ...]]] = {
    "fps": (float, ()),
    "window": (int, ()),
    "names": (str, ("C",)),
    "frames": (int, ("C",)),  # of each clip
    "fingerprints": (str, ("C",)),
    "origins": (str, ("O",)),
    "nodes": (int, ("N", 2)),  # clip, frame
    "edges": (int, ("E", 4)),  # start and end, as rows of nodes; key; frames
    "is_transition": (bool, ("E",)),
    "costs": (float, ("T",)),
    "transforms": (float, ("T", 3)),
    "labels": (str, ("L",)),
    "labelled": (bool, ("E", "L")),
}


class GraphFile(NamedTuple):
    """The content of a file: the rate, names, lengths and fingerprints of the clips, and the graph."""

    fps: float
    window: int
    names: list[str]
    frames: list[int]
    fingerprints: list[str]
    origins: list[str]
    graph: nx.MultiDiGraph


def save(motion_graph: MotionGraph, path: str | Path, origins: Sequence[Origin] = ()) -> None:
    """Write a motion graph to an `.npz` file; an old file is replaced when the new one is complete.

    Parameters
    ----------
    motion_graph : as from `graphs.build` or `prune`.
    path : the file.
    origins : where the clips were read from, so that `load` finds them again; one for each, or none.
        Each place is kept twice: from the file's own folder, and from the root.

    Raises
    ------
    MocapError : for another suffix, and where the file cannot be written.

    Examples
    --------
    >>> import tempfile
    >>> from mocap import graphs
    >>> clips = [sample("walk_circle")]
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     save(graphs.from_transitions(clips, [], window=10), f"{folder}/walks.npz")
    ...     load(f"{folder}/walks.npz", clips)
    MotionGraph(1 clips, 2 nodes, 1 edges, 0 of them transitions)

    Notebook: 05b-choice-points
    """
    if Path(path).suffix.lower() != ".npz":
        raise MocapError(f"This is written as .npz, got '{path}'.")
    arrays = {
        "fps": motion_graph.fps,
        "window": motion_graph.window,
        "origins": [origin.text(Path(path).parent) for origin in origins],
    }
    arrays |= _arrays_of_clips(motion_graph.clips)
    arrays |= _arrays_of_graph(motion_graph.graph)
    whole: Arrays = {key: np.asarray(arrays[key], kind) for key, (kind, _) in ARRAYS.items()}
    pack(path, {"format": np.array(KIND), "version": np.array(VERSION), **whole})


def _arrays_of_clips(clips: Sequence[Motion]) -> dict[str, Any]:
    """Arrays by which the clips are known again."""
    return {
        "names": [clip.name for clip in clips],
        "frames": [len(clip) for clip in clips],
        "fingerprints": [fingerprint(clip) for clip in clips],
    }


def _arrays_of_graph(graph: nx.MultiDiGraph) -> dict[str, Any]:
    """Arrays of nodes, edges, transitions and labels."""
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
    """Read a motion graph, and join it with its clips, at its frame rate; `save` shows an example.

    Parameters
    ----------
    path : a file from `save`.
    clips : the motions that it was built of, in any order; other motions are ignored. By default they are
        bundled samples, or the files that the graph remembers, or files of their names beside it.
    skeleton : the `.asf` file of `.amc` clips; by default the one that the graph remembers, or one that fits.
    progress : wraps the files of the clips, to show a bar.

    Returns
    -------
    The same graph, bit for bit.

    Raises
    ------
    FormatError : for a file that is no motion graph, is damaged, or has a newer version.
    MocapError : for a clip that is missing, cannot be read, or has changed.

    Warns
    -----
    MocapWarning : for a file of version 1, which knows its clips by digits that differ between machines, so
        that only their names and lengths are compared.

    Notebook: 05b-choice-points
    """
    content = read(path)
    if clips is None:
        clips = _load_clips(path, content, skeleton, progress)
    by_name = {clip.name: resample(clip, content.fps) for clip in clips}
    with suppress(KeyError, MocapError):  # one end sites for all; what does not go together is named below
        alike = require_alike([by_name[name] for name in content.names])
        by_name.update(zip(content.names, alike, strict=True))
    for name, length, digest in zip(content.names, content.frames, content.fingerprints, strict=True):
        if name not in by_name:
            names = shortened(", ".join(by_name) or "none")
            raise MocapError(f"{path} needs the clip '{shortened(name)}'; given are: {names}.")
        _require_same(path, by_name[name], length, digest)
    if not any(content.fingerprints):
        warn(f"An older mocap saved {path}: it cannot tell whether its clips have changed; save it anew.")
    return MotionGraph(tuple(by_name[name] for name in content.names), content.window, content.graph)


def _load_clips(
    path: str | Path, content: GraphFile, skeleton: Path | None, progress: Progress
) -> list[Motion]:
    """Load the clips of a file from where they were, or take the bundled ones."""
    origins = find_origins(path)
    if not origins:
        return [sample(name) for name in content.names]
    clips = []
    for origin in progress(origins):
        clip = load_motion(origin.path, skeleton=skeleton or origin.skeleton, scale=origin.scale)
        clips.append(mirror(clip) if origin.mirrored else clip)
    return clips


def _require_same(path: str | Path, clip: Motion, length: int, digest: str) -> None:
    """Refuse a clip that has not the length, in frames, or the fingerprint of the one in the file."""
    if len(clip) == length and (not digest or fingerprint(clip) == digest):
        return
    if _was_bundled_in_0_1(clip.name, length, clip.fps):
        raise MocapError(
            f"{path} was built of the clips of mocap 0.1, which later versions do not have. "
            "Build it anew, or load it with mocap 0.1."
        )
    difference = "other poses, bones or units"
    if len(clip) != length:
        difference = f"{length} frames then, {len(clip)} now"
    named = f"another '{shortened(clip.name)}'"
    raise MocapError(f"{path} was built of {named}: {difference}. Take that clip, or build anew.")


def _was_bundled_in_0_1(name: str, length: int, fps: float) -> bool:
    """Tell whether a clip of so many frames is one that came with mocap 0.1."""
    intervals = FRAMES_IN_0_1.get(name, 0) - 1
    return length == int(intervals * fps / FPS) + 1


def read(path: str | Path) -> GraphFile:
    """Read a file without its clips.

    Raises
    ------
    FormatError, MocapError : as for `load`.
    """
    arrays = _unpack(path)
    return GraphFile(**{key: arrays[key].tolist() for key in GraphFile._fields[:-1]}, graph=_graph(arrays))


def _graph(arrays: Arrays) -> nx.MultiDiGraph:
    """Build the graph of the arrays of a file."""
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


def _unpack(path: str | Path) -> Arrays:
    """Unpack the arrays of a file, where they are those of a graph, and fit each other."""
    with open_archive(path, OURS) as members:
        if str(members["format"].read()) not in (KIND, FIRST_KIND):
            raise FormatError(path, None, OURS, "an .npz of another kind")
        version = int(members["version"].read())
        if version > VERSION:
            raise FormatError(path, None, OURS, f"version {version}, which a newer mocap wrote")
        _require_shapes(path, members)
        arrays = {key: members[key].read() for key in ARRAYS}
        if version < VERSION:
            arrays["fingerprints"] = np.zeros_like(arrays["fingerprints"])
        for rule, holds in _rules(arrays):
            if not np.all(holds):
                raise FormatError(path, None, f"that {rule}", "a damaged file")
    return arrays


def _require_shapes(path: str | Path, members: Mapping[str, Member]) -> None:
    """Refuse arrays that are missing, or of another kind or shape than `ARRAYS` says."""
    sizes: dict[int | str, int] = {2: 2, 3: 3, 4: 4}
    for key, (kind, shape) in ARRAYS.items():
        if key not in members:
            raise FormatError(path, None, OURS, f"one without {key}")
        member = members[key]
        fits = len(member.shape) == len(shape) and member.dtype.kind == np.dtype(kind).kind
        if fits:
            expected = [sizes.setdefault(*pair) for pair in zip(shape, member.shape, strict=True)]
            fits = expected == list(member.shape)
        if not fits:
            raise FormatError(path, None, f"'{key}' to fit the other arrays", str(member))


def find_origins(path: str | Path) -> list[Origin]:
    """Find the files of a saved graph's clips, as `load` reads them; none for bundled samples."""
    content = read(path)
    folder = Path(path).parent
    if set(content.names) <= set(SAMPLES) and not content.origins:
        return []
    neighbours = {file.stem: file for file in sorted(folder.iterdir()) if is_clip(file)}
    places: list[Origin] = []
    for name, text in itertools.zip_longest(content.names, content.origins):
        origin = find_again(text, folder) if text else None
        if origin is None and name not in neighbours:
            lost = f"The clip '{shortened(name)}' is no longer where {path} found it."
            raise MocapError(lost, remedy=Remedy("give {}", "clips"))
        places.append(origin or Origin(neighbours[name]))
    return places


def _rules(arrays: Arrays) -> Iterator[tuple[str, ArrayLike]]:
    """Yield what must hold; each rule needs those before it."""
    window = arrays["window"]
    lengths = arrays["frames"]
    nodes = arrays["nodes"]
    names = arrays["names"].tolist()
    yield "origins are one for each clip, or none", len(arrays["origins"]) in (0, len(lengths))
    yield "origins are places of files", [is_origin(text) for text in arrays["origins"].tolist()]
    yield "window and rate are above 0", 0 < window < MOST and 0 < arrays["fps"] < FASTEST
    yield "clips have frames", (lengths > 0) & (lengths < MOST)
    yield "there are clips with names of their own", 0 < len(set(names)) == len(lengths)
    yield "nodes lie in clips", (nodes[:, 0] >= 0) & (nodes[:, 0] < len(lengths))
    yield "nodes lie in their clips", (nodes[:, 1] >= 0) & (nodes[:, 1] <= lengths[nodes[:, 0]])
    yield "no node comes twice", len(np.unique(nodes, axis=0)) == len(nodes)
    yield from _rules_of_edges(arrays)
    yield "each transition has a cost", arrays["is_transition"].sum() == len(arrays["costs"])
    yield "costs are distances", (arrays["costs"] >= 0) & (arrays["costs"] < np.inf)
    yield "transforms are finite", np.isfinite(arrays["transforms"])


def _rules_of_edges(arrays: Arrays) -> Iterator[tuple[str, ArrayLike]]:
    """Yield what must hold of edges, where clips and nodes are right."""
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
