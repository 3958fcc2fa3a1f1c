"""Small experiments that run on the pages of the course without Python: their controls, data, and numbers.

`live.js` computes the same numbers, and draws them.
"""

from collections.abc import Callable, Hashable
from typing import Any

import networkx as nx
import numpy as np

from mocap import graphs, plain
from mocap._shared.arrays import Array
from mocap._shared.records import NamedTuple
from mocap.body import rotations
from mocap.body.euler import from_euler
from mocap.body.kinematics import joint_positions
from mocap.body.limbs import find_legs
from mocap.body.motion import Motion
from mocap.course import diagrams
from mocap.course.diagrams.branching import edge_lengths, search_events
from mocap.course.diagrams.small_graphs import EIGHT_PLACES
from mocap.datasets.samples import sample

HIP = 0.95  # metres above the ground
FORWARD = np.array([0, 0.3, 1])  # the direction in which a knee bends
NODES = range(1, 9)  # of the graph of Figure 4 [KGP02]
START = 6  # the node at which walks of the search begin
GOAL = 2
LONGEST = 8  # edges of a walk
FIRST = np.radians([20, -60, -70])  # Euler angles z, x and y of a bone
LAST = np.radians([-60, 50, 75])


class LiveExperiment(NamedTuple):
    """Controls (lowest, highest, step, initial value), a function of their values, and data for the page."""

    controls: dict[str, tuple[float, float, float, float]]
    compute: Callable[..., dict[str, Any]]
    data: Callable[[], dict[str, Any]]


def lean(tip: float, towards: float, facing: float) -> dict[str, Any]:
    """Return the heading of a body that is tipped, by two formulas, degrees.

    Parameters
    ----------
    tip : the angle by which it is tipped, degrees.
    towards : the heading of the axis of tipping, degrees, from the x axis.
    facing : the heading before, degrees.

    Examples
    --------
    >>> upright = lean(tip=0, towards=0, facing=30)
    >>> round(upright["heading"]), round(upright["homework"])
    (30, 30)
    """
    axis = rotations.rotate(rotations.about_y(np.radians(towards)), [1.0, 0.0, 0.0])
    tipped = rotations.from_rotvec(np.radians(tip) * axis)
    root = rotations.multiply(rotations.about_y(np.radians(facing)), tipped)
    w, _, y, _ = root
    matrix = rotations.to_matrix(root)
    heading = np.degrees(np.arctan2(2 * w * y, w**2 - y**2))
    homework = np.degrees(np.arctan2(-matrix[2, 0], matrix[0, 0]))
    return {"root": root, "heading": heading, "homework": homework}


def gimbals(z: float, x: float, y: float) -> dict[str, Any]:
    """Return the angle between the rotations (0, x, 0) and (z, x, y), Euler angles in degrees.

    Examples
    --------
    >>> round(gimbals(z=0, x=40, y=30)["turned"])
    30
    """
    ghost = from_euler("ZXY", np.radians([0, x, 0]))
    solid = from_euler("ZXY", np.radians([z, x, y]))
    about_z = from_euler("ZXY", np.radians([z, 0, 0]))
    about_zx = from_euler("ZXY", np.radians([z, x, 0]))
    axes = [rotations.rotate(about_z, [1.0, 0.0, 0.0]), rotations.rotate(about_zx, [0.0, 1.0, 0.0])]
    turned = np.degrees(rotations.angle_between(ghost, solid))
    return {"ghost": ghost, "solid": solid, "carried": [[0.0, 0.0, 1.0], *axes], "turned": turned}


def interpolations(fraction: float) -> dict[str, Any]:
    """Return a bone's tip and the angle from its start for slerp, quaternions on a line and Euler angles.

    Examples
    --------
    >>> [round(angle) for angle in interpolations(0)["turned"]]
    [0, 0, 0]
    """
    start = from_euler("ZXY", FIRST)
    end = from_euler("ZXY", LAST)
    line = (1 - fraction) * start + fraction * end
    euler = from_euler("ZXY", (1 - fraction) * FIRST + fraction * LAST)
    between = [plain.slerp(start, end, fraction), line / np.linalg.norm(line), euler]
    tips = [rotations.rotate(rotation, [0.0, 0.0, 1.0]) for rotation in between]
    turned = [np.degrees(rotations.angle_between(start, rotation)) for rotation in between]
    return {"tips": tips, "turned": turned}


def leg(ahead: float, height: float) -> dict[str, Any]:
    """Return knee and ankle (z, y) of a leg that reaches for a point, metres, and its bend, degrees.

    Examples
    --------
    >>> round(leg(ahead=0.9, height=0.5)["bend"])  # out of reach
    0
    """
    thigh, shank = _leg_lengths()
    hip = np.array([0, HIP, 0])
    offset = np.array([0, height, ahead]) - hip
    distance = min(float(np.linalg.norm(offset)), thigh + shank)
    along = offset / np.linalg.norm(offset)
    cosine = (distance**2 - thigh**2 - shank**2) / (2 * thigh * shank)
    bend = np.arccos(np.clip(cosine, -1, 1))
    across = FORWARD - (FORWARD @ along) * along
    across /= np.linalg.norm(across)
    knee = (thigh + shank * np.cos(bend)) * along + shank * np.sin(bend) * across
    places = hip + np.array([thigh / distance * knee, distance * along])
    return {"knee": places[0, [2, 1]], "ankle": places[1, [2, 1]], "bend": np.degrees(bend)}


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


def _data_of_tarjan() -> dict[str, Any]:
    return _data_of(graphs.notes_example())


def _data_of_search() -> dict[str, Any]:
    return _data_of(_graph_of_search())


def _leg_lengths() -> tuple[float, float]:
    """Return the lengths of thigh and shank of the body of the samples, metres."""
    skeleton = sample("walk_straight").skeleton
    thigh, shank, _ = find_legs(skeleton)[1].lengths(skeleton)
    return float(thigh), float(shank)


def _body() -> dict[str, Any]:
    """Return the joints of a body in its rest pose, relative to the root, metres, and their parents."""
    skeleton = sample("walk_straight").skeleton
    upright = np.tile([1.0, 0, 0, 0], (1, len(skeleton.names), 1))
    positions = joint_positions(Motion(skeleton, [[0, 0, 0]], upright, 30))[0]
    return {"positions": positions.round(4).tolist(), "parents": skeleton.parents.tolist()}


def _leg_data() -> dict[str, Any]:
    """Return the lengths of a leg and the height of its hip, metres."""
    thigh, shank = _leg_lengths()
    return {"thigh": thigh, "shank": shank, "hip": HIP}


def _ways_data() -> dict[str, Any]:
    """Return the first and the last Euler angles of a bone, radians."""
    return {"first": FIRST.tolist(), "last": LAST.tolist()}


TIP = (0, 175, 5, 60)  # degrees, as all angles of controls
TOWARDS = (-180, 180, 15, 90)
FACING = (-180, 180, 10, -20)
QUARTER = (-90, 90, 5, 40)
OTHER_QUARTER = (-90, 90, 5, -40)
FRACTION = (0, 1, 0.05, 0.25)
AHEAD = (-0.5, 0.7, 0.05, 0.2)  # metres
HEIGHT = (0, 0.5, 0.05, 0.25)  # metres
STEPS_OF_TARJAN = (0, 21, 1, 9)
STEPS_OF_SEARCH = (0, 21, 1, 18)
LEAN = LiveExperiment({"tip": TIP, "towards": TOWARDS, "facing": FACING}, lean, _body)
GIMBALS = LiveExperiment({"z": QUARTER, "x": QUARTER, "y": OTHER_QUARTER}, gimbals, _body)
WAYS = LiveExperiment({"fraction": FRACTION}, interpolations, _ways_data)
LEG = LiveExperiment({"ahead": AHEAD, "height": HEIGHT}, leg, _leg_data)
TARJAN = LiveExperiment({"step": STEPS_OF_TARJAN}, tarjan, _data_of_tarjan)
EIGHT = LiveExperiment({"step": STEPS_OF_SEARCH}, eight_nodes, _data_of_search)
LIVE = {"03b-angles:lean": LEAN, "03b-angles:gimbals": GIMBALS, "04-blending:ways": WAYS, "04b-feet:leg": LEG}
LIVE |= {"06-pruning:tarjan": TARJAN, "07-walks-and-search:eight_nodes": EIGHT}
"""The experiments, by the notebook and the name of the experiment in it."""


def numbers_of(computed: dict[str, Any]) -> Array:
    """Return all numbers that an experiment computed, in the order of its entries.

    Examples
    --------
    >>> len(numbers_of(leg(ahead=0.2, height=0.25)))
    5
    """
    values = [value for value in computed.values() if not isinstance(value, str)]
    return np.concatenate([np.ravel(np.asarray(value, float)) for value in values])
