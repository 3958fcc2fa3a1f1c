"""Parametric motion graphs in `.npz` files: spaces, strides and edges, all that a character needs."""

from pathlib import Path

import networkx as nx
import numpy as np

from mocap._shared.archives import Arrays, Kind, read_arrays, write_arrays
from mocap.body.skeleton import Skeleton
from mocap.errors import FormatError
from mocap.methods.parametric_graphs.parametric_edges import ParametricEdge
from mocap.methods.parametric_graphs.parametric_motion_graphs import ParametricGraph
from mocap.methods.parametric_graphs.stride_spaces import PARAMETERS, StrideSpace
from mocap.methods.parametric_graphs.strides import Strides

NAME, VERSION = "a parametric motion graph", 1
_HEAD = {"nodes": ("U", ("K",)), "sources": ("i", ("E",)), "targets": ("i", ("E",))}
_BODY = {
    "fps": ("f", ()),
    "joints": ("U", ("J",)),
    "parents": ("i", ("J",)),
    "offsets": ("f", ("J", 3)),
    "contact_names": ("U", ("C",)),
}


def _node(number: int) -> dict[str, tuple[str, tuple[int | str, ...]]]:
    """Say which arrays a node has: N strides on G phases, S samples of d parameters."""
    n, g, s, d = (f"{letter}{number}" for letter in "NGSd")
    arrays: dict[str, tuple[str, tuple[int | str, ...]]] = {
        "grid": ("f", (g,)),
        "seconds": ("f", (n, g)),
        "speeds": ("c", (n, g)),
        "turning": ("f", (n, g)),
        "heights": ("f", (n, g)),
        "poses": ("f", (n, g, "J", 4)),
        "contacts": ("b", (n, g, "C")),
        "facts": ("f", (n, 2)),
        "numbers": ("f", (3,)),  # sway, offset, how many were left out
        "parameters": ("U", (d,)),
        "values": ("f", (s, d)),
        "mixes": ("f", (s, n)),
        "low": ("f", (d,)),
        "high": ("f", (d,)),
    }
    return {f"{key}_of_{number}": value for key, value in arrays.items()}


def _edge(number: int) -> dict[str, tuple[str, tuple[int | str, ...]]]:
    """Say which arrays an edge has: S sources of d parameters, boxes of t parameters."""
    s, d, t = (f"{letter}e{number}" for letter in "Sdt")
    arrays: dict[str, tuple[str, tuple[int | str, ...]]] = {
        "at": ("f", (s, d)),
        "box_low": ("f", (s, t)),
        "box_high": ("f", (s, t)),
        "leave": ("f", (s,)),
        "enter": ("f", (s,)),
        "unit": ("f", (d,)),
        "least": ("f", ()),
    }
    return {f"{key}_of_edge_{number}": value for key, value in arrays.items()}


def _kind(nodes: int, edges: int) -> Kind:
    parts = {**_HEAD, **_BODY}
    for number in range(nodes):
        parts |= _node(number)
    for number in range(edges):
        parts |= _edge(number)
    return Kind(NAME, VERSION, parts)


def save_parametric(graph: ParametricGraph, path: str | Path) -> None:
    """Save a parametric graph as `.npz`; it holds the strides, so that no clip is needed to walk again.

    Raises
    ------
    MocapError : for another suffix, and where the file cannot be written.
    """
    nodes, edges = list(graph.graph), list(graph.graph.edges)
    strides = graph.space(nodes[0]).strides
    arrays: dict[str, object] = {
        "nodes": np.array(nodes),
        "sources": np.array([nodes.index(a) for a, _ in edges]),
        "targets": np.array([nodes.index(b) for _, b in edges]),
        "fps": strides.fps,
        "joints": np.array(strides.skeleton.names),
        "parents": strides.skeleton.parents,
        "offsets": strides.skeleton.offsets,
        "contact_names": np.array(strides.contact_names),
    }
    for number, node in enumerate(nodes):
        arrays |= {f"{key}_of_{number}": value for key, value in _space_arrays(graph.space(node)).items()}
    for number, pair in enumerate(edges):
        edge = graph.edge(*pair)
        own = (edge.at, edge.low, edge.high, edge.leave, edge.enter, edge.scale, np.float64(edge.least))
        arrays |= dict(zip(_edge(number), own, strict=True))
    write_arrays(path, _kind(len(nodes), len(edges)), arrays)


def _space_arrays(space: StrideSpace) -> dict[str, object]:
    own = space.strides
    keys = ("grid", "seconds", "speeds", "turning", "heights", "poses", "contacts")
    return {
        **{key: getattr(own, key) for key in keys},
        "facts": own.values,
        "numbers": np.array([own.sway, own.offset, own.dropped], float),
        "parameters": np.array(space.parameters),
        **{key: getattr(space, key) for key in ("values", "mixes", "low", "high")},
    }


def load_parametric(path: str | Path) -> ParametricGraph:
    """Load a parametric graph that `save_parametric` wrote.

    Raises
    ------
    FormatError, MocapError : for a file that is missing, is another kind of file, or contradicts itself.
    """
    head = read_arrays(path, Kind(NAME, VERSION, _HEAD))
    nodes, edges = [str(node) for node in head["nodes"]], len(head["sources"])
    arrays = read_arrays(path, _kind(len(nodes), edges))
    ends = np.concatenate([arrays["sources"], arrays["targets"]])
    if not nodes or len(set(nodes)) < len(nodes) or ((ends < 0) | (ends >= len(nodes))).any():
        raise FormatError(path, None, "edges between its nodes", "numbers that contradict each other")
    skeleton = Skeleton([str(name) for name in arrays["joints"]], arrays["parents"], arrays["offsets"])
    graph = nx.DiGraph()
    for number, node in enumerate(nodes):
        graph.add_node(node, space=_space(path, arrays, number, skeleton))
    for number, (a, b) in enumerate(zip(arrays["sources"], arrays["targets"], strict=True)):
        at, low, high, leave, enter, unit, least = (arrays[key] for key in _edge(number))
        edge = ParametricEdge(at, low, high, leave, enter, unit, float(least))
        graph.add_edge(nodes[a], nodes[b], edge=edge)
    return ParametricGraph(graph)


def _space(path: str | Path, arrays: Arrays, number: int, skeleton: Skeleton) -> StrideSpace:
    """Put the space of a node together."""
    own = {key.removesuffix(f"_of_{number}"): arrays[key] for key in _node(number)}
    names = tuple(str(name) for name in own["parameters"])
    if not set(names) <= set(PARAMETERS):
        raise FormatError(path, None, "spaces asked by turn and speed", ", ".join(names))
    sway, offset, dropped = own["numbers"]
    strides = Strides(
        skeleton,
        float(arrays["fps"]),
        own["grid"],
        own["seconds"],
        own["speeds"],
        own["turning"],
        own["heights"],
        own["poses"],
        own["contacts"],
        tuple(str(name) for name in arrays["contact_names"]),
        own["facts"],
        float(sway),
        float(offset),
        int(dropped),
    )
    return StrideSpace(strides, names, own["values"], own["mixes"], own["low"], own["high"])
