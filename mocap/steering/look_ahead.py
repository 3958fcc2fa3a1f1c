"""The look-ahead of control on a motion graph: walks grow by one macro-edge per round, and the best stay.

The cost of a walk is the sum of ‖v - v'‖² Δt over its macro-edges: v is the mean velocity of the root over
the macro-edge, v' the velocity of the command, and Δt the macro-edge's duration. Each transition adds `SEAM`;
each second without the label of the command adds `LABEL`. Walks of different durations are compared by their
costs per frame. Only the first macro-edge of the best walk is played. Therefore the choice is clear as soon
as all walks have the same first macro-edge.
"""

from __future__ import annotations

import cmath

import numpy as np

from mocap._shared.arrays import Array, Indices, Mask, Points
from mocap._shared.records import NamedTuple
from mocap._shared.ties import first_in_order
from mocap.graphs.compiled_graph import CompiledGraph
from mocap.steering.layered_search import EQUAL
from mocap.steering.tuned import TUNED

SEAM = 0.1  # m²/s, as all costs here
LABEL = 4.0  # m²/s per second
AHEAD = 3.0  # seconds to look ahead
WIDTH = 64  # walks that stay in each round


class Request(NamedTuple):
    """A command as the look-ahead sees it: velocity z + ix in m/s, and a label's number, -1 for any.

    The figure is turned in addition by up to `rotation_rate`, radians per second. `waiting` are the seconds
    until the macro-edge under way ends.

    Examples
    --------
    >>> Request(velocity=1j, label=-1, rotation_rate=0.0, waiting=0.5).velocity
    1j
    """

    velocity: complex
    label: int
    rotation_rate: float
    waiting: float


class Walks(NamedTuple):
    """N walks from the end of the macro-edge under way. Each field has shape (N,).

    Examples
    --------
    >>> zero = np.zeros(2, np.intp)
    >>> walks = Walks(zero, zero + 0j, zero + 3, zero + 0.5, np.array([7, 4]))
    >>> walks.take(np.array([1])).first
    array([4])
    """

    node: Indices  # where it ends
    rotation: Points  # of the clip there
    frames: Indices
    cost: Array
    first: Indices  # its first macro-edge, -1 without any

    def take(self, chosen: Indices | Mask) -> Walks:
        """Select some of the walks."""
        return Walks._make(values[chosen] for values in self)


class LookAhead:
    """The walks ahead of a character, from the node where its macro-edge under way ends.

    Parameters
    ----------
    graph : the compiled graph.

    Examples
    --------
    >>> from mocap import body, datasets, graphs
    >>> clips = [body.resample(datasets.sample("walk_circle"), 30)]
    >>> graph = graphs.compile_graph(graphs.prune(graphs.build(clips, window=10, threshold=0.04)))
    >>> ahead = LookAhead(graph)
    >>> ahead.restart(node=0, rotation=1 + 0j)
    >>> while not ahead.decided:
    ...     ahead.grow(Request(velocity=1 + 0j, label=-1, rotation_rate=0.0, waiting=0.0))
    >>> ahead.best in range(*graph.macro_edges.first[:2])
    True
    """

    def __init__(self, graph: CompiledGraph) -> None:
        self.graph = graph
        macro_edges = graph.macro_edges
        displacements = _displacements(graph)
        self.distances = np.abs(displacements)  # metres, of each macro-edge
        self.directions = np.angle(displacements)  # in coordinates of the clip that it leaves, radians
        self.seconds = macro_edges.frames / graph.fps
        self.seconds_without = _seconds_without(graph)
        # Of each macro-edge: the node to which it leads, the rotation of the clip there, and its seam cost.
        self.target = graph.target[macro_edges.last]
        self.rotation = graph.rotation[macro_edges.last]
        self.seam = np.where(graph.blended, SEAM, 0.0)[macro_edges.last]
        self.restart(0, 1 + 0j)

    def restart(self, node: int, rotation: complex) -> None:
        """Begin anew at a node, where the clip is rotated, with one walk without macro-edges."""
        no_frames = np.zeros(1, np.intp)
        no_macro_edge = np.full(1, -1, np.intp)
        self.walks = Walks(np.array([node]), np.array([rotation]), no_frames, np.zeros(1), no_macro_edge)
        self.decided = False

    @property
    def best(self) -> int:
        """The first macro-edge of the best walk, or -1 where no macro-edge leaves the node."""
        return int(self.walks.first[0])

    def rotate(self, rotation: complex) -> None:
        """Rotate the walks by a complex number of length 1."""
        self.walks = self.walks._replace(rotation=rotation * self.walks.rotation)

    def grow(self, request: Request) -> None:
        """Lengthen every walk below the horizon by every macro-edge that leaves its node.

        The `WIDTH` walks with the lowest cost per frame stay. The choice is clear if no walk is longer, or if
        all have the same first macro-edge.
        """
        horizon = TUNED.turned_ahead if request.rotation_rate else AHEAD
        is_short = self.walks.frames < horizon * self.graph.fps
        short = self.walks.take(is_short)
        row, macro_edge = self.graph.macro_edges.leaving(short.node)
        if not len(macro_edge):
            self.decided = True
            return
        walks = self._longer(short, row, macro_edge, request)
        if not is_short.all():
            finished = self.walks.take(~is_short)
            walks = Walks._make(np.concatenate(values) for values in zip(finished, walks, strict=True))
        self.walks = walks.take(first_in_order(walks.cost / walks.frames, EQUAL, WIDTH))
        self.decided = bool((self.walks.first == self.walks.first[0]).all())

    def _longer(self, short: Walks, row: Indices, macro_edge: Indices, request: Request) -> Walks:
        """Lengthen walks by macro-edges.

        Parameters
        ----------
        short : walks below the horizon.
        row, macro_edge : the walks' numbers, and the macro-edges that continue them.
        request : the command.
        """
        missing = self._missing_angles(short.rotation, row, macro_edge, request.velocity)
        price = self.seam[macro_edge]
        rotation = short.rotation[row] * self.rotation[macro_edge]
        distance = self.distances[macro_edge]
        seconds = self.seconds[macro_edge]
        travel = abs(request.velocity) * seconds
        first = short.first[row]
        if request.rotation_rate:
            waiting = np.where(first < 0, request.waiting, 0.0)
            start, turn = _expected_turns(missing, waiting, seconds, request.rotation_rate)
            missing = missing - (start + turn) / 2
            effort = _correction_cost(distance - travel, turn, waiting + seconds, seconds)
            price = TUNED.turned_seam * price + effort
            rotation = rotation * np.exp(1j * turn)
        # |v - v'|² Δt by the law of cosines
        error = (distance - travel) ** 2 + 2 * distance * travel * (1 - np.cos(missing))
        price = error / seconds + price
        if request.label >= 0:
            price += LABEL * self.seconds_without[request.label, macro_edge]
        node = self.target[macro_edge]
        frames = short.frames[row] + self.graph.macro_edges.frames[macro_edge]
        first = np.where(first < 0, macro_edge, first)
        return Walks(node, rotation, frames, short.cost[row] + price, first)

    def _missing_angles(
        self, rotation: Points, row: Indices, macro_edge: Indices, velocity: complex
    ) -> Array:
        """Return the angles from the directions of macro-edges to the command's, in [-π, π); 0 if it stands.

        Parameters
        ----------
        rotation : of the walks ahead (N,).
        row, macro_edge : the walks' numbers, and the macro-edges that continue them.
        velocity : of the command.
        """
        if not velocity:
            return np.zeros(len(row))
        ahead = cmath.phase(velocity) - np.angle(rotation)
        missing = ahead[row] - self.directions[macro_edge]
        return np.asarray((missing + np.pi) % (2 * np.pi) - np.pi)


def _expected_turns(missing: Array, waiting: Array, seconds: Array, rate: float) -> tuple[Array, Array]:
    """Return the angles by which the figure will have been turned towards the command, radians.

    Parameters
    ----------
    missing : the angle of each macro-edge from the command, if the figure is not turned; radians.
    waiting, seconds : the time until a macro-edge begins, and its duration.
    rate : radians per second, of the figure.

    Returns
    -------
    The angles at the start and at the end of each macro-edge.
    """
    earlier = rate * waiting
    largest = earlier + rate * seconds
    at_start = np.minimum(np.maximum(missing, -earlier), earlier)
    return at_start, np.minimum(np.maximum(missing, -largest), largest)


def _correction_cost(lead: Array, turn: Array, turning: Array, seconds: Array) -> Array:
    """Return the cost of macro-edges whose direction and pace must be corrected, m²/s.

    A figure that can be turned obeys on any clip. Without this cost it might walk along a clip that turns all
    the time, and be turned back all the time.

    Parameters
    ----------
    lead : the distance by which each macro-edge is longer than the command asks for, metres.
    turn, turning : the angle by which the figure is turned for it, radians, and the time for that.
    seconds : its duration.
    """
    rotation_cost = (TUNED.rotation_price * turn) ** 2 / turning
    return np.asarray(rotation_cost + TUNED.pace_price * lead**2 / seconds)


def _displacements(graph: CompiledGraph) -> Points:
    """Compute the root's displacement over each macro-edge (H,), in coordinates of the clip it leaves."""
    macro_edges = graph.macro_edges
    starts = np.repeat(graph.at, np.diff(macro_edges.first))
    targets = graph.target[macro_edges.last]
    ends = graph.rotation[macro_edges.last] * graph.at[targets] + graph.translation[macro_edges.last]
    return ends - starts


def _seconds_without(graph: CompiledGraph) -> Array:
    """Compute the seconds of each of H macro-edges without each of L labels, (L, H)."""
    macro_edges = graph.macro_edges
    frames = np.pad(np.cumsum(~graph.bears, axis=1), ((0, 0), (1, 0)))  # without the label so far, (L, T + 1)
    stops = macro_edges.starts + macro_edges.counts
    of_edges: Indices = frames[:, stops] - frames[:, macro_edges.starts]  # (L, H, 2)
    return np.asarray(of_edges.sum(axis=-1) / graph.fps)
