"""Storage of a group motion graph in one file: its configurations and clips as arrays in an `.npz`.

The file contains no code, so that reading an untrusted file is safe.
"""

from pathlib import Path

import numpy as np

from mocap._shared.archives import Arrays, Kind, Layout, Rules, read_archive, write_archive
from mocap._shared.arrays import Mask, Points
from mocap.methods.groups.flocking import Configuration
from mocap.methods.groups.group_clips import GroupClip
from mocap.methods.groups.group_graphs import GroupGraph
from mocap.methods.groups.tuned import TUNED

FARTHEST = 1e6  # metres, and metres per second
ROUNDING = 1e-6  # metres, tolerance of the distance between the end of a clip and its node
UNIT = 1e-9  # tolerance of the length of a rotation, 1
# The arrays of the file, with K nodes, C clips, F + 1 frames of each (here F), and N members.
# Positions and velocities are complex, as in `Configuration`. Ends, orders and transforms are as in
# `GroupClip`. The keys keep their first names: "places" are positions, "turns" rotations, "moves"
# translations.
# reads: statement: a table
ARRAYS: Layout = {
    "node_places": (complex, ("K", "N")),
    "node_velocities": (complex, ("K", "N")),
    "starts": (int, ("C",)),
    "ends": (int, ("C",)),
    "places": (complex, ("C", "F", "N")),
    "velocities": (complex, ("C", "F", "N")),
    "orders": (int, ("C", "N")),
    "turns": (complex, ("C",)),
    "moves": (complex, ("C",)),
    "tried": (int, ()),
}


def save_group(graph: GroupGraph, path: str | Path) -> None:
    """Save a group motion graph to an `.npz` file, which is replaced only when the new one is complete.

    A graph of twelve members takes 6 s to build, and 0.3 s to load from 30 MB.

    Parameters
    ----------
    graph : as from `build_group`.
    path : the file.

    Raises
    ------
    MocapError : for another suffix, for clips that do not lead from node to node, and if the file cannot be
        written.

    Examples
    --------
    >>> import tempfile
    >>> from mocap.methods.groups import build_group, random_group_walk
    >>> graph = build_group(3, nodes=2, corridors=(), simulated=40.0, reach=0.4)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     save_group(graph, f"{folder}/three.npz")
    ...     again = load_group(f"{folder}/three.npz")
    >>> random_group_walk(again, 5) == random_group_walk(graph, 5)
    True
    """
    clips = graph.clips
    nodes = Configuration(*(np.array(field) for field in zip(*graph.nodes, strict=True)))
    arrays = {"node_places": nodes.positions, "node_velocities": nodes.velocities, "tried": graph.tried}
    arrays |= {"starts": [clip.start for clip in clips], "ends": [clip.end for clip in clips]}
    arrays |= {"turns": [clip.rotation for clip in clips], "moves": [clip.translation for clip in clips]}
    for key, field in (("places", "positions"), ("velocities", "velocities"), ("orders", "order")):
        arrays[key] = np.array([getattr(clip, field) for clip in clips])
    write_archive(path, GROUP, arrays)


def load_group(path: str | Path) -> GroupGraph:
    """Load a group motion graph from a file. `save_group` has an example.

    Parameters
    ----------
    path : a file from `save_group`.

    Returns
    -------
    The same graph, bit for bit.

    Raises
    ------
    MocapError : for a file that cannot be read.
    FormatError : for a file that is no group motion graph, is damaged, or has a newer version.
    """
    arrays = read_archive(path, GROUP)
    nodes = tuple(map(Configuration, arrays["node_places"], arrays["node_velocities"]))
    columns = [arrays[key].tolist() for key in ("starts", "ends", "turns", "moves")]
    clips = []
    for number, (start, end, rotation, translation) in enumerate(zip(*columns, strict=True)):
        positions, velocities, order = (arrays[key][number] for key in ("places", "velocities", "orders"))
        clips.append(GroupClip(start, end, positions, velocities, order, rotation, translation))
    return GroupGraph(nodes, tuple(clips), int(arrays["tried"]))


def _rules(arrays: Arrays) -> Rules:
    """Yield the rules of a valid file and their results. Each rule requires those before it."""
    positions = arrays["node_places"]
    velocities = arrays["node_velocities"]
    clips, frames, members = arrays["places"].shape
    numbers = (array for array in arrays.values() if array.dtype.kind == "c")
    yield "numbers are finite and not above a million", [_is_near(array) for array in numbers]
    yield "there are nodes and clips, of two members or more", len(positions) and clips and members >= 2
    yield "clips have frames", frames > 1
    yield "nodes go somewhere", np.abs(velocities.mean(axis=1)) >= TUNED.slowest
    yield "as many clips were tried or more", arrays["tried"] >= clips
    ends = np.stack([arrays["starts"], arrays["ends"]])
    yield "clips lead from node to node", (ends >= 0) & (ends < len(positions))
    yield "members keep their numbers apart", np.sort(arrays["orders"]) == np.arange(members)
    yield "rotations have length 1", np.abs(np.abs(arrays["turns"]) - 1) < UNIT
    first = arrays["places"][:, 0] - positions[arrays["starts"]]
    yield "clips begin at their nodes", np.abs(first) < ROUNDING
    goals = np.take_along_axis(positions[arrays["ends"]], arrays["orders"], axis=1)
    aligned = arrays["turns"][:, None] * goals + arrays["moves"][:, None]
    yield "clips end at their nodes", np.abs(arrays["places"][:, -1] - aligned) < ROUNDING


def _is_near(array: Points) -> bool:
    """Return whether all numbers are finite and at most `FARTHEST` from 0."""
    is_near: Mask = np.abs(array) <= FARTHEST
    return bool(is_near.all())


GROUP = Kind("a group motion graph", ARRAYS, _rules)
