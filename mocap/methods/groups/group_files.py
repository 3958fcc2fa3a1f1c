"""Group motion graphs in `.npz` files."""

from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from mocap._shared.archives import Arrays, Kind, read_arrays, write_arrays
from mocap.methods.groups.flocking import Configuration
from mocap.methods.groups.group_clips import Drawn, GroupClip
from mocap.methods.groups.group_graphs import GroupGraph

# Of K nodes, C clips with T frames together, N members, and D clips drawn: kind, shape, and what is in it.
ARRAYS: dict[str, tuple[str, tuple[int | str, ...], Callable[[GroupGraph], object]]] = {
    "node_places": ("c", ("K", "N"), lambda graph: [node.places for node in graph.nodes]),
    "node_velocities": ("c", ("K", "N"), lambda graph: [node.velocities for node in graph.nodes]),
    "starts": ("i", ("C",), lambda graph: [clip.start for clip in graph.clips]),
    "ends": ("i", ("C",), lambda graph: [clip.end for clip in graph.clips]),
    "lengths": ("i", ("C",), lambda graph: [len(clip.places) for clip in graph.clips]),
    "places": ("c", ("T", "N"), lambda graph: np.concatenate([clip.places for clip in graph.clips])),
    "velocities": ("c", ("T", "N"), lambda graph: np.concatenate([clip.velocities for clip in graph.clips])),
    "orders": ("i", ("C", "N"), lambda graph: [clip.order for clip in graph.clips]),
    "turns": ("c", ("C",), lambda graph: [clip.turn for clip in graph.clips]),
    "moves": ("c", ("C",), lambda graph: [clip.move for clip in graph.clips]),
    "centres": ("c", ("C",), lambda graph: [clip.disc[0] for clip in graph.clips]),
    "radii": ("f", ("C",), lambda graph: [clip.disc[1] for clip in graph.clips]),
    "bent": ("f", ("D",), lambda graph: graph.drawn.bent),
    "collided": ("b", ("D", 2), lambda graph: graph.drawn.collided),
    "hardest": ("f", ("D",), lambda graph: graph.drawn.hardest),
}


def save_group(graph: GroupGraph, path: str | Path) -> None:
    """Save a group graph as `.npz`.

    Raises
    ------
    MocapError : for another suffix, and where the file cannot be written.
    """
    write_arrays(path, GROUP, {key: take(graph) for key, (_, _, take) in ARRAYS.items()})


def load_group(path: str | Path) -> GroupGraph:
    """Load a group graph that `save_group` wrote.

    Raises
    ------
    FormatError, MocapError : for a file that is missing, is another kind of file, or contradicts itself.
    """
    arrays = read_arrays(path, GROUP)
    stops = np.cumsum(arrays["lengths"])[:-1]
    rows = zip(
        *(arrays[key].tolist() for key in ("starts", "ends")),
        *(np.split(arrays[key], stops) for key in ("places", "velocities")),
        arrays["orders"],
        *(arrays[key].tolist() for key in ("turns", "moves")),
        zip(arrays["centres"].tolist(), arrays["radii"].tolist(), strict=True),
        strict=True,
    )
    nodes = map(Configuration, arrays["node_places"], arrays["node_velocities"])
    drawn = Drawn(*(arrays[key] for key in Drawn._fields))
    return GroupGraph(tuple(nodes), tuple(GroupClip(*row) for row in rows), drawn)


def _rules(arrays: Arrays) -> Iterator[tuple[str, ArrayLike]]:
    nodes, members = arrays["node_places"].shape
    lengths, frames = arrays["lengths"], len(arrays["places"])
    yield "all numbers are finite", [np.isfinite(part).all() for part in arrays.values()]
    yield "it has nodes, and members", nodes > 0 and members > 1
    yield "clips have frames, all as many", len(lengths) and np.ptp(lengths) == 0 and 1 < lengths[0] <= frames
    yield "clips fill the frames", lengths.sum() == frames
    for key in ("starts", "ends"):
        yield "clips join nodes", (arrays[key] >= 0) & (arrays[key] < nodes)
    yield "clips renumber everybody", np.sort(arrays["orders"], axis=-1) == np.arange(members)
    yield "clips only turn the group", np.abs(np.abs(arrays["turns"]) - 1) < 1e-6
    yield "discs have radii", arrays["radii"] >= 0


GROUP = Kind("a group motion graph", 1, {key: row[:2] for key, row in ARRAYS.items()}, _rules)
