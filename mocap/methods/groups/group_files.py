"""Group motion graphs in `.npz` files: nodes and clips as arrays; how many clips were tried is not kept."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from mocap._shared.archives import Arrays, Kind, Layout, read_arrays, write_arrays
from mocap.methods.groups.flocking import Configuration
from mocap.methods.groups.group_clips import GroupClip
from mocap.methods.groups.group_graphs import GroupGraph

CLIP: Layout = {  # of K nodes, C clips with T frames together, and N members
    **{"starts": ("i", ("C",)), "ends": ("i", ("C",)), "places": ("c", ("T", "N"))},
    **{"velocities": ("c", ("T", "N")), "orders": ("i", ("C", "N"))},
    **{"turns": ("c", ("C",)), "moves": ("c", ("C",))},
}
NODE: Layout = {"node_places": ("c", ("K", "N")), "node_velocities": ("c", ("K", "N"))}


def save_group(graph: GroupGraph, path: str | Path) -> None:
    """Save a group graph as `.npz`.

    Raises
    ------
    MocapError : for another suffix, and where the file cannot be written.
    """
    rows = [
        (c.start, c.end, c.places, c.velocities, c.order, complex(c.turn), complex(c.move))
        for c in graph.clips
    ]
    arrays = dict(zip(CLIP, map(list, zip(*rows, strict=True)), strict=True))
    nodes = {f"node_{name}": [getattr(node, name) for node in graph.nodes] for name in Configuration._fields}
    whole = {name: np.concatenate(arrays[name]) for name in ("places", "velocities")}
    lengths = [len(clip.places) for clip in graph.clips]
    write_arrays(path, GROUP, arrays | nodes | whole | {"lengths": lengths})


def load_group(path: str | Path) -> GroupGraph:
    """Load a group graph that `save_group` wrote.

    Raises
    ------
    FormatError, MocapError : for a file that is missing, is another kind of file, or contradicts itself.
    """
    arrays = read_arrays(path, GROUP)
    stops = np.cumsum(arrays["lengths"])[:-1]
    parts = [
        np.split(arrays[name], stops) if shape[0] == "T" else arrays[name]
        for name, (_, shape) in CLIP.items()
    ]
    clips = tuple(
        GroupClip(int(start), int(end), places, velocities, order, complex(turn), complex(move))
        for start, end, places, velocities, order, turn, move in zip(*parts, strict=True)
    )
    nodes = map(Configuration, arrays["node_places"], arrays["node_velocities"])
    return GroupGraph(tuple(nodes), clips, len(clips))


def _rules(arrays: Arrays) -> Iterator[tuple[str, ArrayLike]]:
    nodes, members = arrays["node_places"].shape
    lengths, frames = arrays["lengths"], len(arrays["places"])
    numbers = (part for part in arrays.values() if part.dtype.kind in "fc")
    yield "all numbers are finite, and below a million", [(np.abs(part) < 1e6).all() for part in numbers]
    yield "it has nodes, members and clips", nodes > 0 and members > 1 and len(lengths) > 0
    yield "clips have frames", (lengths > 1) & (lengths <= frames)
    yield "clips fill the frames", lengths.sum() == frames
    for key in ("starts", "ends"):
        yield "clips join nodes", (arrays[key] >= 0) & (arrays[key] < nodes)
    yield "a clip leaves each node", np.isin(np.arange(nodes), arrays["starts"])
    yield "clips renumber everybody", np.sort(arrays["orders"], axis=-1) == np.arange(members)
    yield "clips only turn the group", np.abs(np.abs(arrays["turns"]) - 1) < 1e-6


GROUP = Kind("a group motion graph", 1, {**NODE, **CLIP, "lengths": ("i", ("C",))}, _rules)
