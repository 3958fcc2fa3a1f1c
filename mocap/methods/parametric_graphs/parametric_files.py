"""Parametric motion graphs in `.npz` files: spaces, examples and edges, all that a character needs."""

from collections.abc import Iterator
from operator import attrgetter
from pathlib import Path
from typing import Any

import networkx as nx
import numpy as np
from numpy.typing import ArrayLike

from mocap._shared.archives import Arrays, Kind, Layout, read_arrays, write_arrays
from mocap._shared.arrays import Indices
from mocap.body.skeleton import Skeleton
from mocap.errors import FormatError, MocapError
from mocap.methods.match_webs.motion_spaces import MotionSpace
from mocap.methods.parametric_graphs.examples import Examples
from mocap.methods.parametric_graphs.parametric_edges import ParametricEdge
from mocap.methods.parametric_graphs.parametric_motion_graphs import ParametricGraph

Table = dict[str, tuple[str, tuple[int | str, ...], str]]
"""For each array its kind, its shape, and where it is found; a star is the number of a node or an edge."""
HEAD: Layout = {"nodes": ("U", ("K",)), "sources": ("i", ("E",)), "targets": ("i", ("E",))}
BODY: Table = {
    "fps": ("f", (), "fps"),
    "joints": ("U", ("J",), "skeleton.names"),
    "parents": ("i", ("J",), "skeleton.parents"),
    "offsets": ("f", ("J", 3), "skeleton.offsets"),
    "contact_names": ("U", ("C",), "contact_names"),
}
NODE: Table = {  # n examples on g phases, s samples of d parameters
    "grid": ("f", ("g*",), "examples.grid"),
    "speeds": ("c", ("n*", "g*"), "examples.speeds"),
    **{key: ("f", ("n*", "g*"), f"examples.{key}") for key in ("seconds", "turning", "heights")},
    "poses": ("f", ("n*", "g*", "J", 4), "examples.poses"),
    "contacts": ("b", ("n*", "g*", "C"), "examples.contacts"),
    "facts": ("f", ("n*", 2), "examples.values"),
    "numbers": ("f", (3,), "examples.sway examples.offset examples.dropped"),
    "values": ("f", ("s*", "d*"), "values"),
    "mixes": ("f", ("s*", "n*"), "weights"),
    "low": ("f", ("d*",), "low"),
    "high": ("f", ("d*",), "high"),
    "parameters": ("U", ("d*",), "parameters"),
}
EDGE: Table = {  # a sources of p parameters, boxes of t parameters
    "at": ("f", ("a*", "p*"), "at"),
    **{f"box_{side}": ("f", ("a*", "t*"), side) for side in ("low", "high")},
    **{key: ("f", ("a*",), key) for key in ("leave", "enter")},
    "unit": ("f", ("p*",), "scale"),
    "least": ("f", (), "least"),
}


def _rules(arrays: Arrays) -> Iterator[tuple[str, ArrayLike]]:
    """Yield what must hold; each rule needs those before it."""
    nodes, sources, targets = arrays["nodes"], arrays["sources"], arrays["targets"]
    ends = np.stack([sources, targets])
    parts = (part for part in arrays.values() if part.dtype.kind in "fc")
    yield "numbers are finite, and below a million", [(np.abs(part) < 1e6).all() for part in parts]
    yield "it has a rate from 1 to 1000 Hz", 1 <= arrays["fps"] <= 1000
    yield "nodes have names of their own", 0 < len(nodes) == len(set(nodes.tolist()))
    yield "there are edges between its nodes", (ends >= 0) & (ends < len(nodes))
    yield "an edge leaves each node", np.isin(np.arange(len(nodes)), sources)
    yield "no edge comes twice", len(np.unique(ends, axis=1).T) == len(sources)
    yield "contacts are those of joints", np.isin(arrays["contact_names"], arrays["joints"])
    yield from _rules_of_nodes(arrays)
    yield from _rules_of_edges(arrays, ends)


def _rules_of_nodes(arrays: Arrays) -> Iterator[tuple[str, ArrayLike]]:
    for number in range(len(arrays["nodes"])):
        own = {key: arrays[f"{key}_of_{number}"] for key in NODE}
        names, grid, times = own["parameters"].tolist(), own["grid"], own["seconds"]
        yield "parameters have names of their own", 0 < len(set(names)) == len(names)
        yield "phases grow from before 0 to after 1", len(grid) > 1 and grid[0] < 0 and grid[-1] > 1
        yield "phases are even", np.abs(np.diff(grid) - (grid[1] - grid[0])) < 1e-6
        zero = int(np.abs(grid).argmin())
        yield "time goes on, by seconds", (np.diff(times, axis=1) >= 0).all() and np.abs(times) < 10
        counts = (np.abs(times[:, zero]) < 1e-6) & (times[:, -1] > 1 / arrays["fps"])
        yield "it counts from the strike", counts
        yield "turns have length 1", np.abs((own["poses"] ** 2).sum(axis=-1) - 1) < 1e-5
        yield "a range has ends", own["low"] <= own["high"]
        yield "samples are enough", len(own["values"]) >= len(names) + 2
        yield "samples are mixes", (own["mixes"] >= -1).all() and np.abs(own["mixes"].sum(axis=1) - 1) < 1e-6


def _rules_of_edges(arrays: Arrays, ends: Indices) -> Iterator[tuple[str, ArrayLike]]:
    for edge, (a, b) in enumerate(ends.T.tolist()):
        at, low = arrays[f"at_of_edge_{edge}"], arrays[f"box_low_of_edge_{edge}"]
        sizes = [part.shape[1] for part in (at, low)]
        wanted = [len(arrays[f"low_of_{node}"]) for node in (a, b)]
        yield "edges have their nodes' parameters", sizes == wanted
        yield "sources are enough", len(at) >= sizes[0] + 2
        leave, enter = arrays[f"leave_of_edge_{edge}"], arrays[f"enter_of_edge_{edge}"]
        yield "motions are left late, and entered early", (np.abs(leave - 1) < 0.5) & (np.abs(enter) < 0.5)
        yield "units are above 0", arrays[f"unit_of_edge_{edge}"] > 0


def _numbered(table: Table, end: str) -> Layout:
    return {f"{key}{end}": row[:2] for key, row in table.items()}


PARTS = {**HEAD, **_numbered(BODY, ""), **_numbered(NODE, "_of_*K"), **_numbered(EDGE, "_of_edge_*E")}
PARAMETRIC = Kind("a parametric motion graph", 1, PARTS, _rules)


def _taken(one: object, table: Table, end: str = "") -> dict[str, Any]:
    return {f"{key}{end}": attrgetter(*where.split())(one) for key, (_, _, where) in table.items()}


def save_parametric(graph: ParametricGraph, path: str | Path) -> None:
    """Save a parametric graph as `.npz`; it holds the examples, so that no clip is needed to walk again.

    Raises
    ------
    MocapError : for another suffix, and where the file cannot be written.
    """
    nodes, edges = list(graph.graph), list(graph.graph.edges)
    sources, targets = ([nodes.index(pair[side]) for pair in edges] for side in (0, 1))
    arrays = {"nodes": nodes, "sources": sources, "targets": targets}
    arrays |= _taken(graph.space(nodes[0]).examples, BODY)
    for number, node in enumerate(nodes):
        arrays |= _taken(graph.space(node), NODE, f"_of_{number}")
    for number, pair in enumerate(edges):
        arrays |= _taken(graph.edge(*pair), EDGE, f"_of_edge_{number}")
    write_arrays(path, PARAMETRIC, arrays)


def load_parametric(path: str | Path) -> ParametricGraph:
    """Load a parametric graph that `save_parametric` wrote.

    Raises
    ------
    FormatError, MocapError : for a file that is missing, is another kind of file, or contradicts itself.
    """
    arrays = read_arrays(path, PARAMETRIC)
    nodes, ends = arrays["nodes"].tolist(), np.stack([arrays["sources"], arrays["targets"]], axis=-1).tolist()
    try:
        skeleton = Skeleton(arrays["joints"].tolist(), arrays["parents"], arrays["offsets"])
    except MocapError as error:
        raise FormatError(path, None, "a tree of joints", f"'{error}'") from error
    marks = tuple(arrays["contact_names"].tolist())
    graph = nx.DiGraph()
    for number, node in enumerate(nodes):
        own: dict[str, Any] = {where: arrays[f"{key}_of_{number}"] for key, (_, _, where) in NODE.items()}
        sway, offset, dropped = own.pop(NODE["numbers"][2]).tolist()
        parts = {where.partition(".")[2]: own.pop(where) for where in list(own) if "." in where}
        parts |= {"contact_names": marks, "sway": sway, "offset": offset, "dropped": int(dropped)}
        own["parameters"] = tuple(own["parameters"].tolist())
        own["scale"] = np.maximum((own["high"] - own["low"]) / 2, 1e-9)
        examples = Examples(skeleton=skeleton, fps=float(arrays["fps"]), **parts)
        graph.add_node(node, space=MotionSpace(examples, **own))
    for number, (a, b) in enumerate(ends):
        own = {where: arrays[f"{key}_of_edge_{number}"] for key, (_, _, where) in EDGE.items()}
        own["least"] = float(own["least"])
        graph.add_edge(nodes[a], nodes[b], edge=ParametricEdge(**own))
    return ParametricGraph(graph)
