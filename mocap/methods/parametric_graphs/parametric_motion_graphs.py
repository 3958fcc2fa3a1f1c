"""Parametric motion graphs: nodes are spaces of motions, edges say which targets may follow [HG07]."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import networkx as nx

from mocap.errors import MocapError, NoWalk
from mocap.methods.parametric_graphs.parametric_edges import ParametricEdge, Sampling, build_edge
from mocap.methods.parametric_graphs.stride_spaces import Space, said


@dataclass(frozen=True, eq=False)
class ParametricGraph:
    """Spaces of motions as nodes, under names; `build_parametric` shows an example.

    `graph` is a `networkx.DiGraph`, with `space` on its nodes and `edge` on its edges.
    """

    graph: nx.DiGraph

    @property
    def fps(self) -> float:
        """Frames per second, the same for all spaces."""
        return float(self.space(next(iter(self.graph))).examples.fps)

    def space(self, node: str) -> Space:
        """Give the space of a node."""
        found: Space = self.graph.nodes[node]["space"]
        return found

    def edge(self, node: str, other: str) -> ParametricEdge:
        """Give the edge from a node to another one, or to itself."""
        found: ParametricEdge = self.graph.edges[node, other]["edge"]
        return found

    def report(self) -> str:
        """Say in one line per edge how wide its boxes are and which cost it needs."""
        lines = []
        for node, other, data in self.graph.edges(data=True):
            edge: ParametricEdge = data["edge"]
            wide = (edge.high - edge.low).mean(axis=0)
            names = self.space(other).parameters
            boxes = " and ".join(map("{} of {}".format, map(said, names, wide), names))
            lines.append(f"{node} → {other}: boxes of {boxes}, from {100 * edge.least:.1f} cm on")
        return "\n".join(lines)


def build_parametric(
    spaces: Mapping[str, Space],
    edges: Sequence[tuple[str, str]] | None = None,
    *,
    good: float,
    sampling: Sampling | None = None,
) -> ParametricGraph:
    """Build a parametric motion graph [HG07, graph]: an author names the spaces, and which may follow which.

    Parameters
    ----------
    spaces : by name, of one skeleton and rate.
    edges : pairs of names. By default all pairs that can be had: where some source has no good target, there
        is no edge.
    good, sampling : as for `build_edge`.

    Returns
    -------
    The graph.

    Raises
    ------
    NoWalk : for a named edge that cannot be had, with what would help, and a node that nothing leaves.
    MocapError : as `build_edge`, and for unknown names.

    Examples
    --------
    A stride of the left foot follows itself:

    >>> from mocap import body, datasets
    >>> from mocap.methods.parametric_graphs.stride_spaces import make_space
    >>> from mocap.methods.parametric_graphs.strides import cut_strides
    >>> strides = cut_strides([body.resample(datasets.sample("walk_curve_2"), 30)])
    >>> space = make_space(strides, 0.4, -0.8, 0.8)
    >>> graph = build_parametric({"walk": space}, good=0.05)
    >>> list(graph.graph.edges)
    [('walk', 'walk')]

    Notebook: 17-parametric-graphs
    """
    asked = [(a, b) for a in spaces for b in spaces] if edges is None else list(edges)
    if unknown := [name for pair in asked for name in pair if name not in spaces]:
        raise MocapError(f"There is no space '{unknown[0]}'; there are: {', '.join(spaces)}.")
    for space in spaces.values():  # before any edge takes its seconds
        next(iter(spaces.values())).examples.require_joinable(space.examples)
    graph = nx.DiGraph()
    graph.add_nodes_from((name, {"space": space}) for name, space in spaces.items())
    for name, other in asked:
        try:
            edge = build_edge(spaces[name], spaces[other], good=good, sampling=sampling)
            graph.add_edge(name, other, edge=edge)
        except NoWalk as error:
            if edges is not None:
                raise NoWalk(f"{name} → {other}: {error}") from error
    if stuck := [name for name in spaces if not graph.out_degree(name)]:
        raise NoWalk(f"Nothing follows '{stuck[0]}' below {100 * good:.1f} cm: raise T_GOOD, or add spaces.")
    return ParametricGraph(graph)
