"""Parametric motion graphs in `.npz` files: spaces, strides and edges, all that a character needs."""

from collections.abc import Iterator
from pathlib import Path

import networkx as nx
import numpy as np
from numpy.typing import ArrayLike

from mocap._shared.archives import Arrays, Kind, Layout, read_arrays, write_arrays
from mocap.body.skeleton import Skeleton
from mocap.methods.parametric_graphs.parametric_edges import ParametricEdge
from mocap.methods.parametric_graphs.parametric_motion_graphs import ParametricGraph
from mocap.methods.parametric_graphs.stride_spaces import PARAMETERS, StrideSpace
from mocap.methods.parametric_graphs.strides import Strides

NAME, VERSION = "a parametric motion graph", 1
_HEAD: Layout = {"nodes": ("U", ("K",)), "sources": ("i", ("E",)), "targets": ("i", ("E",))}
_BODY: Layout = {
    "fps": ("f", ()),
    "joints": ("U", ("J",)),
    "parents": ("i", ("J",)),
    "offsets": ("f", ("J", 3)),
    "contact_names": ("U", ("C",)),
}
_STRIDES: Layout = {  # n strides on g phases
    "grid": ("f", ("g",)),
    "speeds": ("c", ("n", "g")),
    **dict.fromkeys(("seconds", "turning", "heights"), ("f", ("n", "g"))),
    "poses": ("f", ("n", "g", "J", 4)),
    "contacts": ("b", ("n", "g", "C")),
}
_SPACE: Layout = {  # s samples of d parameters
    "values": ("f", ("s", "d")),
    "mixes": ("f", ("s", "n")),
    **dict.fromkeys(("low", "high"), ("f", ("d",))),
}
_NODE: Layout = {
    **_STRIDES,
    **_SPACE,
    "facts": ("f", ("n", 2)),
    "numbers": ("f", (3,)),  # sway, offset, how many were left out
    "parameters": ("U", ("d",)),
}
_EDGE: Layout = {  # s sources of d parameters, boxes of t parameters
    "at": ("f", ("s", "d")),
    **dict.fromkeys(("box_low", "box_high"), ("f", ("s", "t"))),
    **dict.fromkeys(("leave", "enter"), ("f", ("s",))),
    "unit": ("f", ("d",)),
    "least": ("f", ()),
}


def _kind(nodes: int, edges: int) -> Kind:
    """Say which arrays a file has: a node or edge has its own, and sizes in small letters are its own."""
    own = [(f"_of_{number}", _NODE) for number in range(nodes)]
    own += [(f"_of_edge_{number}", _EDGE) for number in range(edges)]
    parts = {
        f"{key}{end}": (kind, tuple(f"{n}{end}" if str(n).islower() else n for n in shape))
        for end, arrays in own
        for key, (kind, shape) in arrays.items()
    }
    return Kind(NAME, VERSION, {**_HEAD, **_BODY, **parts}, _rules)


def _rules(arrays: Arrays) -> Iterator[tuple[str, ArrayLike]]:
    """Yield what must hold."""
    nodes, ends = arrays["nodes"], np.concatenate([arrays["sources"], arrays["targets"]])
    yield "nodes have names of their own", 0 < len(nodes) == len(set(nodes.tolist()))
    yield "there are edges between its nodes", (ends >= 0) & (ends < len(nodes))
    names = (part for key, part in arrays.items() if key.startswith("parameters"))
    yield "spaces are asked by turn and speed", [set(part.tolist()) <= set(PARAMETERS) for part in names]


def save_parametric(graph: ParametricGraph, path: str | Path) -> None:
    """Save a parametric graph as `.npz`; it holds the strides, so that no clip is needed to walk again.

    Raises
    ------
    MocapError : for another suffix, and where the file cannot be written.
    """
    nodes, edges = list(graph.graph), list(graph.graph.edges)
    first = graph.space(nodes[0]).strides
    arrays: dict[str, object] = {
        "nodes": nodes,
        "sources": [nodes.index(a) for a, _ in edges],
        "targets": [nodes.index(b) for _, b in edges],
        "fps": first.fps,
        "joints": first.skeleton.names,
        "parents": first.skeleton.parents,
        "offsets": first.skeleton.offsets,
        "contact_names": first.contact_names,
    }
    for number, node in enumerate(nodes):
        space = graph.space(node)
        strides = space.strides
        own = {key: getattr(strides, key) for key in _STRIDES} | {key: getattr(space, key) for key in _SPACE}
        own |= {"facts": strides.values, "parameters": space.parameters}
        own["numbers"] = [strides.sway, strides.offset, float(strides.dropped)]
        arrays |= {f"{key}_of_{number}": value for key, value in own.items()}
    for number, (a, b) in enumerate(edges):
        edge = graph.edge(a, b)
        parts = (edge.at, edge.low, edge.high, edge.leave, edge.enter, edge.scale, edge.least)
        arrays |= {f"{key}_of_edge_{number}": part for key, part in zip(_EDGE, parts, strict=True)}
    write_arrays(path, _kind(len(nodes), len(edges)), arrays)


def load_parametric(path: str | Path) -> ParametricGraph:
    """Load a parametric graph that `save_parametric` wrote.

    Raises
    ------
    FormatError, MocapError : for a file that is missing, is another kind of file, or contradicts itself.
    """
    head = read_arrays(path, Kind(NAME, VERSION, _HEAD))
    nodes, edges = head["nodes"].tolist(), list(zip(head["sources"], head["targets"], strict=False))
    arrays = read_arrays(path, _kind(len(nodes), len(edges)))
    graph = nx.DiGraph()
    for number, node in enumerate(nodes):
        graph.add_node(node, space=_space(arrays, f"_of_{number}"))
    for number, (a, b) in enumerate(edges):
        at, low, high, leave, enter, unit, least = (arrays[f"{key}_of_edge_{number}"] for key in _EDGE)
        edge = ParametricEdge(at, low, high, leave, enter, unit, float(least))
        graph.add_edge(nodes[a], nodes[b], edge=edge)
    return ParametricGraph(graph)


def _space(arrays: Arrays, end: str) -> StrideSpace:
    """Put the space of a node together."""
    sway, offset, dropped = arrays[f"numbers{end}"].tolist()
    strides = Strides(
        Skeleton(arrays["joints"].tolist(), arrays["parents"], arrays["offsets"]),
        float(arrays["fps"]),
        **{key: arrays[f"{key}{end}"] for key in _STRIDES},
        contact_names=tuple(arrays["contact_names"].tolist()),
        values=arrays[f"facts{end}"],
        sway=sway,
        offset=offset,
        dropped=int(dropped),
    )
    return StrideSpace(
        strides, tuple(arrays[f"parameters{end}"].tolist()), **{key: arrays[f"{key}{end}"] for key in _SPACE}
    )
