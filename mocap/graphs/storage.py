"""Save a motion graph to one file: nodes and edges as arrays in an `.npz`, clips by name and fingerprint.

The file holds no frames of the clips and no code: it is safe to read a file from a stranger.
"""

import itertools
from collections.abc import Iterator, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any, NamedTuple

import networkx as nx
import numpy as np
from numpy.typing import ArrayLike

from mocap._shared.archives import Arrays, open_archive, pack
from mocap._shared.progress import Progress
from mocap.body.fingerprints import fingerprint
from mocap.body.motion import Motion, require_alike, resample
from mocap.body.planar import PlanarTransform
from mocap.datasets.clip_origins import Origin, find_again, is_origin
from mocap.datasets.samples import SAMPLES, sample
from mocap.editing.mirroring import mirror
from mocap.errors import FormatError, MocapError, shortened, warn
from mocap.files.conversion import is_clip
from mocap.files.load_save import load as load_motion
from mocap.graphs.motion_graph import MotionGraph

KIND, OURS = "mocap: a motion graph", "a motion graph saved by mocap, version 1 or 2"
# The arrays of the file, with C clips, O origins, N nodes, E edges, T transitions and L labels.
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
    clips, graph = motion_graph.clips, motion_graph.graph
    number = {node: row for row, node in enumerate(graph)}
    edges = list(graph.edges(keys=True, data=True))
    transitions = [edge for *_, edge in edges if edge["kind"] == "transition"]
    labels = sorted({label for *_, edge in edges for label in edge["labels"]})
    rows = [(number[a], number[b], key, edge["frames"]) for a, b, key, edge in edges]
    labelled = [label in edge["labels"] for *_, edge in edges for label in labels]
    arrays: dict[str, Any] = {
        "fps": motion_graph.fps,
        "window": motion_graph.window,
        "names": [clip.name for clip in clips],
        "frames": [len(clip) for clip in clips],
        "fingerprints": [fingerprint(clip) for clip in clips],
        "origins": [origin.text(Path(path).parent) for origin in origins],
        "nodes": np.reshape(list(graph), (-1, 2)),
        "edges": np.reshape(rows, (-1, 4)),
        "is_transition": [edge["kind"] == "transition" for *_, edge in edges],
        "costs": [edge["cost"] for edge in transitions],
        "transforms": np.reshape([edge["transform"] for edge in transitions], (-1, 3)),
        "labels": labels,
        "labelled": np.reshape(labelled, (len(edges), len(labels))),
    }
    whole: Arrays = {key: np.asarray(arrays[key], kind) for key, (kind, _) in ARRAYS.items()}
    pack(path, {"format": np.array(KIND), "version": np.array(2), **whole})


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
    found = read(path)
    if clips is None:
        clips = [] if (placed := find_origins(path)) else [sample(name) for name in found.names]
        for origin in progress(placed):
            clip = load_motion(origin.path, skeleton=skeleton or origin.skeleton, scale=origin.scale)
            clips.append(mirror(clip) if origin.mirrored else clip)
    by_name = {clip.name: resample(clip, found.fps) for clip in clips}
    with suppress(KeyError, MocapError):  # one end sites for all; what does not go together is named below
        by_name.update(zip(found.names, require_alike([by_name[name] for name in found.names]), strict=True))
    for name, frames, known in zip(found.names, found.frames, found.fingerprints, strict=True):
        if name not in by_name:
            given = shortened(", ".join(by_name) or "none")
            raise MocapError(f"{path} needs the clip '{shortened(name)}'; given are: {given}.")
        now = len(by_name[name])
        if now != frames or (known and fingerprint(by_name[name]) != known):
            other = f"{frames} frames then, {now} now" if now != frames else "other poses, bones or units"
            named = f"another '{shortened(name)}'"
            raise MocapError(f"{path} was built of {named}: {other}. Take that clip, or build anew.")
    if not any(found.fingerprints):
        warn(f"An older mocap saved {path}: it cannot tell whether its clips have changed; save it anew.")
    return MotionGraph(tuple(by_name[name] for name in found.names), found.window, found.graph)


def read(path: str | Path) -> GraphFile:
    """Read a file without its clips.

    Raises
    ------
    FormatError, MocapError : as for `load`.
    """
    arrays = _unpack(path)
    nodes = [(clip, frame) for clip, frame in arrays["nodes"].tolist()]
    labels = np.array(arrays["labels"], object)
    ways = zip(arrays["costs"].tolist(), arrays["transforms"].tolist(), strict=True)
    graph = nx.MultiDiGraph()
    graph.add_nodes_from(nodes)
    for (start, end, key, length), is_transition, marks in zip(
        arrays["edges"].tolist(), arrays["is_transition"].tolist(), arrays["labelled"], strict=True
    ):
        edge: dict[str, Any] = {"kind": "clip", "frames": length, "labels": frozenset(labels[marks])}
        if is_transition:
            cost, transform = next(ways)
            edge |= {"kind": "transition", "cost": cost, "transform": PlanarTransform(*transform)}
        graph.add_edge(nodes[start], nodes[end], key, **edge)
    return GraphFile(**{key: arrays[key].tolist() for key in GraphFile._fields[:-1]}, graph=graph)


def _unpack(path: str | Path) -> Arrays:
    """Unpack the arrays of a file, where they are those of a graph, and fit each other."""
    with open_archive(path, OURS) as members:
        if str(members["format"].read()) not in (KIND, "mocap motion graph"):  # as the first files say
            raise FormatError(path, None, OURS, "an .npz of another kind")
        if (version := int(members["version"].read())) > 2:
            raise FormatError(path, None, OURS, f"version {version}, which a newer mocap wrote")
        sizes: dict[int | str, int] = {2: 2, 3: 3, 4: 4}
        for key, (kind, shape) in ARRAYS.items():
            if key not in members:
                raise FormatError(path, None, OURS, f"one without {key}")
            own = members[key]
            fits = len(own.shape) == len(shape) and own.dtype.kind == np.dtype(kind).kind
            if not fits or any(
                sizes.setdefault(n, size) != size for n, size in zip(shape, own.shape, strict=True)
            ):
                raise FormatError(path, None, f"'{key}' to fit the other arrays", str(own))
        arrays = {key: members[key].read() for key in ARRAYS}
        if version == 1:  # its fingerprints are of all digits
            arrays["fingerprints"] = np.zeros_like(arrays["fingerprints"])
        for what, holds in _rules(arrays):
            if not np.all(holds):
                raise FormatError(path, None, f"that {what}", "a damaged file")
    return arrays


def find_origins(path: str | Path) -> list[Origin]:
    """Find the files of a saved graph's clips, as `load` reads them; none for bundled samples."""
    found, folder = read(path), Path(path).parent
    if set(found.names) <= set(SAMPLES) and not found.origins:
        return []
    beside = {file.stem: file for file in sorted(folder.iterdir()) if is_clip(file)}
    placed: list[Origin] = []
    for name, text in itertools.zip_longest(found.names, found.origins):
        origin = find_again(text, folder) if text else None
        if origin is None and name not in beside:
            raise MocapError(f"The clip '{shortened(name)}' is no longer where {path} found it: give clips=.")
        placed.append(origin or Origin(beside[name]))
    return placed


def _rules(arrays: Arrays) -> Iterator[tuple[str, ArrayLike]]:
    """Yield what must hold; each rule needs those before it."""
    window, lengths, nodes = arrays["window"], arrays["frames"], arrays["nodes"]
    edges, is_transition = arrays["edges"], arrays["is_transition"]
    yield "origins are one for each clip, or none", len(arrays["origins"]) in (0, len(lengths))
    yield "origins are places of files", [is_origin(text) for text in arrays["origins"].tolist()]
    yield "window and rate are above 0", 0 < window < 2**31 and 0 < arrays["fps"] < 1e6
    yield "clips have frames", (lengths > 0) & (lengths < 2**31)
    yield "there are clips with names of their own", 0 < len(set(arrays["names"].tolist())) == len(lengths)
    yield "nodes lie in clips", (nodes[:, 0] >= 0) & (nodes[:, 0] < len(lengths))
    yield "nodes lie in their clips", (nodes[:, 1] >= 0) & (nodes[:, 1] <= lengths[nodes[:, 0]])
    yield "no node comes twice", len(np.unique(nodes, axis=0)) == len(nodes)
    yield "edges join nodes", (edges >= 0).all() and (edges[:, :2] < len(nodes)).all()
    yield "no edge comes twice", len(np.unique(edges[:, :3], axis=0)) == len(edges)
    (clip, leave), (other, enter) = nodes[edges[:, 0]].T, nodes[edges[:, 1]].T
    stretch = (clip == other) & (leave < enter) & (edges[:, 3] == enter - leave)
    inside = (leave + window <= lengths[clip]) & (enter >= window) & (edges[:, 3] == window)
    yield "edges play what lies between their ends", np.where(is_transition, inside, stretch)
    yield "each transition has a cost", is_transition.sum() == len(arrays["costs"])
    yield "costs are distances", (arrays["costs"] >= 0) & (arrays["costs"] < np.inf)
    yield "transforms are finite", np.isfinite(arrays["transforms"])
