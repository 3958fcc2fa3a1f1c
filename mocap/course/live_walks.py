"""Small experiments on graphs and walks that run on the pages of the course without Python.

Each function computes what one experiment shows, and each name that ends in `_data` is what its page is
filled with. `live.js` computes the same numbers, and draws them.
"""

from collections.abc import Hashable
from typing import Any

import networkx as nx
import numpy as np

from mocap import graphs
from mocap.body.ground_path import GroundPath, arcs
from mocap.course import diagrams
from mocap.course.diagrams.branching import edge_lengths, search_events
from mocap.course.diagrams.ground import MOMENTS, nearest_points
from mocap.course.diagrams.small_graphs import EIGHT_PLACES

NODES = range(1, 9)  # of the graph of Figure 4 [KGP02]
START = 6  # the node at which walks of the search begin
GOAL = 2
LONGEST = 8  # edges of a walk


def tarjan(step: int) -> dict[str, Any]:
    """Return the state of Tarjan's algorithm on the eight nodes after some steps.

    Returns
    -------
    The message and the node of the step, and the number, low link and component of each node, -1 for none.
    The stack is padded by -1.

    Examples
    --------
    >>> tarjan(step=0)["message"], tarjan(step=0)["stack"]
    ('enter 1', [1, -1, -1, -1, -1, -1, -1, -1])
    """
    states = diagrams.tarjan_states(_successors(graphs.notes_example()))
    state = states[min(int(step), len(states) - 1)]
    component = {node: number for number, part in enumerate(state.components) for node in part}
    state_of_nodes: dict[str, Any] = {"message": state.message, "node": state.node}
    state_of_nodes["numbers"] = [state.number.get(node, -1) for node in NODES]
    state_of_nodes["lows"] = [state.low.get(node, -1) for node in NODES]
    state_of_nodes["stack"] = [*state.stack, *[-1] * (len(NODES) - len(state.stack))]
    state_of_nodes["components"] = [component.get(node, -1) for node in NODES]
    return state_of_nodes


def eight_nodes(step: int) -> dict[str, Any]:
    """Return the walks that branch and bound has looked at after some steps, from node 6 to node 2.

    Returns
    -------
    The costs of the walks, the best walk so far, the last walk, and a message.

    Examples
    --------
    >>> eight_nodes(step=1)["message"]
    '6 (0.0): expanded'
    """
    events = search_events(edge_lengths(_graph_of_search()), START, GOAL, LONGEST)[: int(step)]
    complete = [event for event in events if event.fate == "complete"]
    best = min(complete, key=lambda event: event.cost).walk if complete else ()
    costs = [event.cost for event in events]
    if not events:
        return {"costs": costs, "best": best, "walk": (START,), "message": "start at 6"}
    path = " → ".join(map(str, events[-1].walk))
    message = f"{path} ({events[-1].cost:.1f}): {events[-1].fate}"
    return {"costs": costs, "best": best, "walk": events[-1].walk, "message": message}


def distances(step: float) -> dict[str, Any]:
    """Return moments of a walk that rounds a corner, metres, and their distances from its path, centimetres.

    Parameters
    ----------
    step : the last moment, 0 to 8.

    Returns
    -------
    The places (x, z) of the moments; the points of the path at equal arc length; the distances from these
    points [KGP02, Eq. 9], and from the nearest points of the path.

    Examples
    --------
    >>> equal, nearest = distances(step=8)["distances"].round()
    >>> float(equal[-1]), float(nearest[-1])
    (64.0, 0.0)
    """
    path = _corner()
    walk = _rounded_corner()
    arc_lengths = np.linspace(0, walk.length, MOMENTS)[: int(step) + 1]
    positions = walk.at(arc_lengths)
    points = np.array([path.at(arc_lengths), nearest_points(path, positions)])
    return {
        "here": positions,
        "equal": points[0],
        "distances": 100 * np.linalg.norm(positions - points, axis=-1),
    }


def tarjan_data() -> dict[str, Any]:
    """Return the eight nodes of the paper's figure."""
    return _data_of(graphs.notes_example())


def search_data() -> dict[str, Any]:
    """Return the eight nodes of the search, with one more edge."""
    return _data_of(_graph_of_search())


def distances_data() -> dict[str, Any]:
    """Return the points of the path and of the walk, (x, z) in metres, and the number of moments."""
    points = {"path": _corner().points.tolist(), "walk": _rounded_corner().points.tolist()}
    return points | {"moments": MOMENTS}


def _graph_of_search() -> nx.MultiDiGraph:
    """Return the eight nodes with one more arrow, by which the search finds a first walk and a better one."""
    graph = graphs.notes_example()
    graph.add_edge(7, 3)
    return graph


def _successors(graph: nx.MultiDiGraph) -> dict[Hashable, list[Hashable]]:
    """Return the successors of each node, in order."""
    return {node: sorted(graph.successors(node)) for node in sorted(graph)}


def _data_of(graph: nx.MultiDiGraph) -> dict[str, Any]:
    """Return the places and the successors of eight nodes, with the lengths of the edges."""
    lengths = edge_lengths(graph)
    places = [[float(value) for value in EIGHT_PLACES[node]] for node in NODES]
    rows = [[[child, length] for child, length in lengths[node].items()] for node in NODES]
    return {"places": places, "successors": list(_successors(graph).values()), "lengths": rows}


def _corner() -> GroundPath:
    """Return a path with a right angle."""
    return GroundPath([[0, 0], [0, 3], [3, 3]])


def _rounded_corner() -> GroundPath:
    """Return a walk along the same path that rounds its corner."""
    return arcs((0, 0), heading=0.0, pieces=[(1.5, 0), (0.75 * np.pi, np.pi / 2), (1.5, 0)])
