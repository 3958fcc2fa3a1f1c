"""The walks ahead of a controlled character: all of them grow by one hop per round, and the best stay.

The cost of a walk is the sum of ‖v - v'‖² Δt over its hops: v is the mean velocity of the root over the hop,
v' the velocity of the command, and Δt the hop's duration. Each transition adds `SEAM`; each second without
the label of the command adds `LABEL`.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from mocap._shared.arrays import Array, Indices, Points
from mocap.graphs.compiled_graph import CompiledGraph

SEAM = 0.1  # m²/s, as all costs here
LABEL = 4.0  # m²/s per second


class Command(NamedTuple):
    """A wish: a velocity on the ground as complex z + ix, metres per second, and a label's number or -1.

    Examples
    --------
    Go in the direction of +x with 1.2 m/s, in any kind of motion:

    >>> Command(1.2j, -1).velocity
    1.2j
    """

    velocity: complex
    label: int


class WalksAhead(NamedTuple):
    """N walks from the end of the hop that the character plays, shape (N,) each."""

    first: Indices  # the first hop of each, -1 for a walk without hops
    node: Indices  # the node at its end
    turn: Points  # turns the clip of that node
    frames: Indices
    cost: Array


class LookAhead:
    """How a controlled character looks ahead on a compiled graph, with H hops and L labels.

    Parameters
    ----------
    graph : the compiled graph.
    seconds : to look ahead.
    width : walks that stay in each round.
    """

    def __init__(self, graph: CompiledGraph, seconds: float, width: int) -> None:
        hops, bears = graph.hops, graph.labels.bears
        self.graph, self.horizon, self.width = graph, seconds * graph.fps, width
        # The root's way on the ground over each hop (H,), in the coordinates of the clip that it leaves.
        leaves = np.repeat(np.arange(len(graph.nodes)), np.diff(hops.first))
        end = graph.turn[hops.last] * graph.at[graph.target[hops.last]] + graph.move[hops.last]
        self.moved = end - graph.at[leaves]
        self.seconds: Array = hops.frames / graph.fps
        self.price = np.where(graph.blended[hops.last], SEAM, 0.0)
        without = np.pad(np.cumsum(~bears, axis=1), ((0, 0), (1, 0)))  # (L, T + 1), frames
        played: Indices = without[:, hops.starts + hops.counts] - without[:, hops.starts]  # (L, H, 2)
        self.lacks: Array = played.sum(axis=-1) / graph.fps

    def start(self, node: int, turn: complex) -> WalksAhead:
        """Start with one walk without hops, at a node whose clip is turned by `turn`."""
        none = np.zeros(1, np.intp)
        return WalksAhead(none - 1, none + node, np.array([turn]), none, np.zeros(1))

    def longer(self, walks: WalksAhead, command: Command) -> WalksAhead | None:
        """Lengthen every walk below the horizon by every hop that leaves its node; keep the best walks.

        Returns
        -------
        The `width` walks with the lowest cost per frame, the best first; None where no walk can be longer.
        """
        graph, hops = self.graph, self.graph.hops
        short = walks.frames < self.horizon
        of, hop = hops.leaving(walks.node[short])
        if not len(hop):
            return None
        of, last = np.flatnonzero(short)[of], hops.last[hop]
        off = walks.turn[of] * self.moved[hop] - command.velocity * self.seconds[hop]
        cost = (off.real**2 + off.imag**2) / self.seconds[hop] + self.price[hop]
        if command.label >= 0:
            cost += LABEL * self.lacks[command.label, hop]
        longer = WalksAhead(
            np.where(walks.first[of] < 0, hop, walks.first[of]),
            graph.target[last],
            walks.turn[of] * graph.turn[last],
            walks.frames[of] + hops.frames[hop],
            walks.cost[of] + cost,
        )
        both = [np.concatenate([old[~short], new]) for old, new in zip(walks, longer, strict=True)]
        walks = WalksAhead._make(both)
        best = np.argsort(walks.cost / walks.frames)[: self.width]
        return WalksAhead._make(values[best] for values in walks)
