"""Group motion graphs in `.npz` files."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from mocap._shared.archives import Arrays, Kind, Layout, read_arrays, write_arrays
from mocap.methods.groups.configurations import Configuration
from mocap.methods.groups.group_clips import Drawn, GroupClip
from mocap.methods.groups.group_graphs import GroupGraph

_ARRAYS: Layout = {  # of K nodes, C clips with T frames together, N members, and D clips drawn
    "node_places": ("c", ("K", "N")),
    "node_velocities": ("c", ("K", "N")),
    **dict.fromkeys(("starts", "ends", "lengths"), ("i", ("C",))),
    "places": ("c", ("T", "N")),
    "velocities": ("c", ("T", "N")),
    "orders": ("i", ("C", "N")),
    **dict.fromkeys(("turns", "moves", "centres"), ("c", ("C",))),
    "radii": ("f", ("C",)),
    "bent": ("f", ("D",)),
    "collided": ("b", ("D", 2)),
    "hardest": ("f", ("D",)),
}


def save_group(graph: GroupGraph, path: str | Path) -> None:
    """Save a group graph as `.npz`.

    Raises
    ------
    MocapError : for another suffix, and where the file cannot be written.
    """
    clips = graph.clips
    arrays = {
        "node_places": [node.places for node in graph.nodes],
        "node_velocities": [node.velocities for node in graph.nodes],
        "starts": [clip.start for clip in clips],
        "ends": [clip.end for clip in clips],
        "lengths": [len(clip.places) for clip in clips],
        "places": np.concatenate([clip.places for clip in clips]),
        "velocities": np.concatenate([clip.velocities for clip in clips]),
        "orders": [clip.order for clip in clips],
        "turns": [clip.turn for clip in clips],
        "moves": [clip.move for clip in clips],
        "centres": [clip.disc[0] for clip in clips],
        "radii": [clip.disc[1] for clip in clips],
        **graph.drawn._asdict(),
    }
    write_arrays(path, _KIND, arrays)


def load_group(path: str | Path) -> GroupGraph:
    """Load a group graph that `save_group` wrote.

    Raises
    ------
    FormatError, MocapError : for a file that is missing, is another kind of file, or contradicts itself.
    """
    arrays = read_arrays(path, _KIND)
    stops = np.cumsum(arrays["lengths"])
    frames = (np.split(arrays[key], stops[:-1]) for key in ("places", "velocities"))
    rows = zip(
        *(arrays[key].tolist() for key in ("starts", "ends")),
        *frames,
        arrays["orders"],
        *(arrays[key].tolist() for key in ("turns", "moves")),
        zip(arrays["centres"].tolist(), arrays["radii"].tolist(), strict=True),
        strict=True,
    )
    nodes = map(Configuration, arrays["node_places"], arrays["node_velocities"])
    drawn = Drawn(*(arrays[key] for key in Drawn._fields))
    return GroupGraph(tuple(nodes), tuple(GroupClip(*row) for row in rows), drawn)


def _rules(arrays: Arrays) -> Iterator[tuple[str, ArrayLike]]:
    lengths, nodes = arrays["lengths"], len(arrays["node_places"])
    yield "all numbers are finite", [np.isfinite(part).all() for part in arrays.values()]
    yield "clips have frames", len(lengths) and lengths.min() > 1
    yield "clips fill the frames", lengths.sum() == len(arrays["places"])
    for key in ("starts", "ends"):
        yield "clips join nodes", (arrays[key] >= 0) & (arrays[key] < nodes)
    everybody = np.arange(arrays["node_places"].shape[-1])
    yield "clips renumber everybody", np.sort(arrays["orders"], axis=-1) == everybody


_KIND = Kind("a group motion graph", 1, _ARRAYS, _rules)
