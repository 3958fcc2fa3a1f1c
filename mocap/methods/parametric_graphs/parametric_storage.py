"""Storage of a parametric motion graph in one file: spaces, examples and edges as arrays in an `.npz`.

The file contains the examples, so that no clip is needed to use it. It contains no code, so that reading an
untrusted file is safe.
"""

from pathlib import Path
from typing import Any

import networkx as nx
import numpy as np

from mocap._shared.archives import Arrays, Kind, Layout, Part, Rules, numbered, read_archive, write_archive
from mocap.body.skeleton import Skeleton
from mocap.errors import FormatError, MocapError
from mocap.files.role_maps import are_packed_roles, packed_roles, unpacked_roles
from mocap.methods.match_webs.motion_spaces import MotionSpace
from mocap.methods.parametric_graphs.examples import Examples
from mocap.methods.parametric_graphs.parametric_edges import ParametricEdge
from mocap.methods.parametric_graphs.stride_spaces import Space

LARGEST = 1e6  # metres, seconds or radians, the largest number in a file
RATES = (1.0, 1000.0)  # frames per second
LONGEST = 10.0  # seconds, the longest duration of an example
UNIT = 1e-5  # tolerance of the squared length of a quaternion, 1
EVEN = 1e-6  # tolerance of a phase, a second, or a sum of weights
# The arrays of the file, with K nodes and E edges.
ARRAYS: Layout = {"names": (str, ("K",)), "sources": (int, ("E",)), "targets": (int, ("E",))}
# reads: statement: a table
SKELETON: Layout = {
    "joints": (str, ("j",)),
    "parents": (int, ("j",)),
    "offsets": (float, ("j", 3)),
    "axes": (float, ("j", 4)),
    "dofs": (str, ("j",)),
    "roles": (str, ()),  # from `packed_roles`
}
# The arrays of n examples on g phases, with c contacts.
# reads: statement: a table
EXAMPLES: Layout = {
    "fps": (float, ()),
    "grid": (float, ("g",)),
    "seconds": (float, ("n", "g")),
    "speeds": (complex, ("n", "g")),
    "turning": (float, ("n", "g")),
    "heights": (float, ("n", "g")),
    "poses": (float, ("n", "g", "j", 4)),
    "contacts": (bool, ("n", "g", "c")),
    "contact_names": (str, ("c",)),
    "values": (float, ("n", 2)),
    "sway": (float, ()),
    "offset": (float, ()),
    "dropped": (int, ()),
}
# The arrays of s samples of d parameters.
# reads: statement: a table
SPACE: Layout = {
    "sampled_weights": (float, ("s", "n")),
    "sampled_values": (float, ("s", "d")),
    "scale": (float, ("d",)),
    "parameters": (str, ("d",)),
    "low": (float, ("d",)),
    "high": (float, ("d",)),
}
# The arrays of s sources of d parameters, with a box of t parameters for each.
# reads: statement: a table
EDGE: Layout = {
    "at": (float, ("s", "d")),
    "low": (float, ("s", "t")),
    "high": (float, ("s", "t")),
    "leave": (float, ("s",)),
    "enter": (float, ("s",)),
    "scale": (float, ("d",)),
    "least": (float, ()),
}
# The fields of `ParametricEdge` that have another name in files.
FIELDS = {"at": "sources", "least": "smallest_good"}


def save_parametric(graph: nx.DiGraph, path: str | Path) -> None:
    """Save a parametric motion graph to an `.npz` file, which is replaced only when the new one is complete.

    A graph of walks, jogs and the changes between them takes 40 s to build, and 0.7 s to load from 13 MB.

    Parameters
    ----------
    graph : as from `build_parametric`.
    path : the file.

    Raises
    ------
    MocapError : for another suffix, and if the file cannot be written.

    Examples
    --------
    >>> import tempfile
    >>> from mocap import body, datasets
    >>> from mocap.methods.parametric_graphs import build_parametric, cut_strides, make_space
    >>> strides = cut_strides([body.resample(datasets.sample("walk_curve_2"), 30)])
    >>> graph = build_parametric({"walk": make_space(strides, 0.4, -0.8, 0.8)}, good=0.05)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     save_parametric(graph, f"{folder}/walk.npz")
    ...     again = load_parametric(f"{folder}/walk.npz")
    >>> again.nodes["walk"]["space"], list(again.edges)
    (MotionSpace(26 examples, 120 samples of 1 numbers), [('walk', 'walk')])
    """
    numbers = {name: number for number, name in enumerate(graph)}
    edges = list(graph.edges(data="edge"))
    arrays: dict[str, Any] = {"names": list(graph)}
    arrays["sources"] = [numbers[source] for source, _, _ in edges]
    arrays["targets"] = [numbers[target] for _, target, _ in edges]
    for number, (_, space) in enumerate(graph.nodes(data="space")):
        arrays |= numbered("node", number, _arrays_of_space(space))
    for number, (_, _, edge) in enumerate(edges):
        arrays |= numbered("edge", number, {key: getattr(edge, FIELDS.get(key, key)) for key in EDGE})
    write_archive(path, PARAMETRIC, arrays)


def _arrays_of_space(space: Space) -> dict[str, Any]:
    """Return the arrays of a node."""
    examples = space.examples
    skeleton = examples.skeleton
    arrays = {key: getattr(examples, key) for key in EXAMPLES}
    arrays |= {key: getattr(skeleton, key) for key in ("parents", "offsets", "axes", "dofs")}
    arrays |= {key: getattr(space, key) for key in ("scale", "parameters", "low", "high")}
    return arrays | {
        "joints": skeleton.names,
        "roles": packed_roles(skeleton.roles),
        "sampled_weights": space.weights,
        "sampled_values": space.values,
    }


def load_parametric(path: str | Path) -> nx.DiGraph:
    """Load a parametric motion graph from a file. `save_parametric` has an example.

    Parameters
    ----------
    path : a file from `save_parametric`.

    Returns
    -------
    The same graph, bit for bit.

    Raises
    ------
    MocapError : for a file that cannot be read.
    FormatError : for a file that is no parametric motion graph, is damaged, or has a newer version.
    """
    arrays = read_archive(path, PARAMETRIC)
    names = arrays["names"].tolist()
    graph = nx.DiGraph()
    for number, name in enumerate(names):
        try:
            graph.add_node(name, space=_space(PARAMETRIC.part(arrays, "node", number)))
        except MocapError as error:
            raise FormatError(path, None, "a tree of joints", f"'{error}'") from error
    for number, (source, target) in enumerate(zip(arrays["sources"], arrays["targets"], strict=True)):
        part = PARAMETRIC.part(arrays, "edge", number)
        fields: dict[str, Any] = {FIELDS.get(key, key): array for key, array in part.items()}
        fields["smallest_good"] = fields["smallest_good"].item()
        graph.add_edge(names[source], names[target], edge=ParametricEdge(**fields))
    return graph


def _space(arrays: Arrays) -> Space:
    """Build the space of a node from its arrays."""
    offsets = arrays["offsets"]
    joints, dofs = (arrays[key].tolist() for key in ("joints", "dofs"))
    roles = unpacked_roles(str(arrays["roles"])) if "roles" in arrays else {}
    skeleton = Skeleton(joints, arrays["parents"], offsets, arrays["axes"], dofs, roles)
    fields: dict[str, Any] = {key: arrays[key] for key in EXAMPLES}
    for key in ("fps", "sway", "offset", "dropped"):
        fields[key] = arrays[key].item()
    fields["contact_names"] = tuple(arrays["contact_names"].tolist())
    parameters = tuple(arrays["parameters"].tolist())
    return MotionSpace(
        Examples(skeleton, **fields),
        arrays["sampled_weights"],
        arrays["sampled_values"],
        arrays["scale"],
        parameters,
        arrays["low"],
        arrays["high"],
    )


def _rules(arrays: Arrays) -> Rules:
    """Yield the rules of a valid file and their results. Each rule requires those before it."""
    sources = arrays["sources"]
    targets = arrays["targets"]
    nodes = len(arrays["names"])
    ends = np.stack([sources, targets], axis=1)
    numbers = (array for array in arrays.values() if array.dtype.kind in "fc")
    yield "numbers are finite, and below a million", [(np.abs(array) < LARGEST).all() for array in numbers]
    yield "nodes have names of their own", 0 < nodes == len(set(arrays["names"].tolist()))
    yield "edges join nodes", (ends >= 0) & (ends < nodes)
    yield "an edge leaves each node", np.isin(np.arange(nodes), sources)
    yield "no edge comes twice", len(np.unique(ends, axis=0)) == len(ends)
    parts = [PARAMETRIC.part(arrays, "node", number) for number in range(nodes)]
    for node in parts:
        yield from _rules_of_examples(node)
        yield from _rules_of_samples(node)
        yield "nodes have the same joints", np.array_equal(node["joints"], parts[0]["joints"])
        yield "nodes have the same rate", node["fps"] == parts[0]["fps"]
        marks = set(node["contact_names"].tolist())
        yield "nodes have the same marks", marks == set(parts[0]["contact_names"].tolist())
    for number, (source, target) in enumerate(ends.tolist()):
        edge = PARAMETRIC.part(arrays, "edge", number)
        yield from _rules_of_edges(edge, len(parts[source]["low"]), len(parts[target]["low"]))


def _rules_of_examples(node: Arrays) -> Rules:
    """Yield the rules of the examples of a node, whose numbers are finite, and their results."""
    grid = node["grid"]
    seconds = node["seconds"]
    yield "rates are 1 to 1000 Hz", RATES[0] <= node["fps"] <= RATES[-1]
    if "roles" in node:
        yield "roles are names of joints", are_packed_roles(str(node["roles"]))
    yield "contacts are of joints", np.isin(node["contact_names"], node["joints"])
    yield "there are examples", len(seconds) > 0
    yield "phases grow from below 0 to above 1", len(grid) > 1 and grid[0] < 0 and grid[-1] > 1
    step = grid[1] - grid[0]
    yield "phases are even", np.abs(np.diff(grid) - step) < EVEN
    yield "phases go on", step > 0
    yield "time goes on, by seconds", (np.diff(seconds, axis=1) >= 0).all() and np.abs(seconds) < LONGEST
    zero = int(np.abs(grid).argmin())
    yield "time counts from phase 0", np.abs(seconds[:, zero]) < EVEN
    yield "examples take time", seconds[:, -1] > 1 / node["fps"]
    yield "rotations have length 1", np.abs((node["poses"] ** 2).sum(axis=-1) - 1) < UNIT


def _rules_of_samples(node: Arrays) -> Rules:
    """Yield the rules of the samples of a node, whose numbers are finite, and their results."""
    parameters = node["parameters"].tolist()
    weights = node["sampled_weights"]
    yield "parameters have names of their own", 0 < len(set(parameters)) == len(parameters)
    yield "a range has ends", node["low"] <= node["high"]
    yield "units are above 0", node["scale"] > 0
    yield "samples are enough", len(weights) >= len(parameters) + 2
    yield "samples are mixes", np.abs(weights.sum(axis=1) - 1) < EVEN


def _rules_of_edges(edge: Arrays, source: int, target: int) -> Rules:
    """Yield the rules of an edge between spaces of `source` and of `target` parameters, and their results."""
    yield "edges have the parameters of their source", edge["at"].shape[1] == source
    yield "edges have the parameters of their target", edge["low"].shape[1] == target
    yield "sources are enough", len(edge["at"]) >= source + 2
    yield "motions are left late", np.abs(edge["leave"] - 1) < 0.5
    yield "motions are entered early", np.abs(edge["enter"]) < 0.5
    yield "units are above 0", edge["scale"] > 0


PARTS = {"node": Part("K", {**SKELETON, **EXAMPLES, **SPACE}), "edge": Part("E", EDGE)}
PARAMETRIC = Kind("a parametric motion graph", ARRAYS, _rules, PARTS, version=2, added={"roles": 2})
