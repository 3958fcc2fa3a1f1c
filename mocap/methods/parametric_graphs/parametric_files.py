"""Parametric motion graphs in `.npz` files: spaces, strides and edges, all that a character needs."""

from collections.abc import Iterator
from operator import attrgetter
from pathlib import Path
from typing import Any

import networkx as nx
import numpy as np
from numpy.typing import ArrayLike

from mocap._shared.archives import Arrays, Kind, Layout, read_arrays, write_arrays
from mocap.body.skeleton import Skeleton
from mocap.methods.parametric_graphs.parametric_edges import ParametricEdge
from mocap.methods.parametric_graphs.parametric_motion_graphs import ParametricGraph
from mocap.methods.parametric_graphs.stride_spaces import PARAMETERS, StrideSpace
from mocap.methods.parametric_graphs.strides import Strides

Table = dict[str, tuple[str, tuple[int | str, ...], str]]
"""For each array its kind, its shape, and where it is found; sizes in small letters are one node's own."""
HEAD: Layout = {"nodes": ("U", ("K",)), "sources": ("i", ("E",)), "targets": ("i", ("E",))}
BODY: Table = {
    "fps": ("f", (), "fps"),
    "joints": ("U", ("J",), "skeleton.names"),
    "parents": ("i", ("J",), "skeleton.parents"),
    "offsets": ("f", ("J", 3), "skeleton.offsets"),
    "contact_names": ("U", ("C",), "contact_names"),
}
NODE: Table = {  # n strides on g phases, s samples of d parameters
    "grid": ("f", ("g",), "strides.grid"),
    "speeds": ("c", ("n", "g"), "strides.speeds"),
    **{key: ("f", ("n", "g"), f"strides.{key}") for key in ("seconds", "turning", "heights")},
    "poses": ("f", ("n", "g", "J", 4), "strides.poses"),
    "contacts": ("b", ("n", "g", "C"), "strides.contacts"),
    "facts": ("f", ("n", 2), "strides.values"),
    "numbers": ("f", (3,), "strides.sway strides.offset strides.dropped"),
    "values": ("f", ("s", "d"), "values"),
    "mixes": ("f", ("s", "n"), "mixes"),
    "low": ("f", ("d",), "low"),
    "high": ("f", ("d",), "high"),
    "parameters": ("U", ("d",), "parameters"),
}
EDGE: Table = {  # s sources of d parameters, boxes of t parameters
    "at": ("f", ("s", "d"), "at"),
    **{f"box_{side}": ("f", ("s", "t"), side) for side in ("low", "high")},
    **{key: ("f", ("s",), key) for key in ("leave", "enter")},
    "unit": ("f", ("d",), "scale"),
    "least": ("f", (), "least"),
}


def _kind(nodes: int, edges: int) -> Kind:
    """Say which arrays a file has: a node or edge has its own."""
    own = [(f"_of_{number}", NODE) for number in range(nodes)]
    own += [(f"_of_edge_{number}", EDGE) for number in range(edges)]
    parts = {
        f"{key}{end}": (kind, tuple(f"{n}{end}" if str(n).islower() else n for n in shape))
        for end, table in own
        for key, (kind, shape, _) in table.items()
    }
    body = {key: row[:2] for key, row in BODY.items()}
    return Kind("a parametric motion graph", 1, {**HEAD, **body, **parts}, _rules if nodes else lambda _: ())


def _rules(arrays: Arrays) -> Iterator[tuple[str, ArrayLike]]:
    """Yield what must hold."""
    nodes, ends = arrays["nodes"], np.concatenate([arrays["sources"], arrays["targets"]])
    yield "nodes have names of their own", len(nodes) == len(set(nodes.tolist()))
    yield "there are edges between its nodes", (ends >= 0) & (ends < len(nodes))
    names = (part for key, part in arrays.items() if key.startswith("parameters"))
    yield "spaces are asked by turn and speed", [set(part.tolist()) <= set(PARAMETERS) for part in names]


def _taken(one: object, table: Table, end: str = "") -> dict[str, Any]:
    return {f"{key}{end}": attrgetter(*where.split())(one) for key, (_, _, where) in table.items()}


def save_parametric(graph: ParametricGraph, path: str | Path) -> None:
    """Save a parametric graph as `.npz`; it holds the strides, so that no clip is needed to walk again.

    Raises
    ------
    MocapError : for another suffix, and where the file cannot be written.
    """
    nodes, edges = list(graph.graph), list(graph.graph.edges)
    ends = {
        key: [nodes.index(pair[side]) for pair in edges] for side, key in enumerate(("sources", "targets"))
    }
    arrays = {"nodes": nodes, **ends, **_taken(graph.space(nodes[0]).strides, BODY)}
    for number, node in enumerate(nodes):
        arrays |= _taken(graph.space(node), NODE, f"_of_{number}")
    for number, pair in enumerate(edges):
        arrays |= _taken(graph.edge(*pair), EDGE, f"_of_edge_{number}")
    write_arrays(path, _kind(len(nodes), len(edges)), arrays)


def load_parametric(path: str | Path) -> ParametricGraph:
    """Load a parametric graph that `save_parametric` wrote.

    Raises
    ------
    FormatError, MocapError : for a file that is missing, is another kind of file, or contradicts itself.
    """
    head = read_arrays(path, _kind(0, 0))
    nodes, ends = head["nodes"].tolist(), np.stack([head["sources"], head["targets"]], axis=-1).tolist()
    arrays = read_arrays(path, _kind(len(nodes), len(ends)))
    skeleton = Skeleton(arrays["joints"].tolist(), arrays["parents"], arrays["offsets"])
    marks = tuple(arrays["contact_names"].tolist())
    graph = nx.DiGraph()
    for number, node in enumerate(nodes):
        own: dict[str, Any] = {where: arrays[f"{key}_of_{number}"] for key, (_, _, where) in NODE.items()}
        sway, offset, dropped = own.pop(NODE["numbers"][2]).tolist()
        parts = {where.partition(".")[2]: own.pop(where) for where in list(own) if "." in where}
        parts |= {"contact_names": marks, "sway": sway, "offset": offset, "dropped": int(dropped)}
        own["parameters"] = tuple(own["parameters"].tolist())
        strides = Strides(skeleton=skeleton, fps=float(arrays["fps"]), **parts)
        graph.add_node(node, space=StrideSpace(strides=strides, **own))
    for number, (a, b) in enumerate(ends):
        own = {where: arrays[f"{key}_of_edge_{number}"] for key, (_, _, where) in EDGE.items()}
        own["least"] = float(own["least"])
        graph.add_edge(nodes[a], nodes[b], edge=ParametricEdge(**own))
    return ParametricGraph(graph)
