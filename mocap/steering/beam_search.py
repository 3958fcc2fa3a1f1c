"""A beam search for the best walk along a route, in layers of path.

A depth-first search, as in the paper, is too slow for a dense graph: there are dozens of choices per second,
and it tries few of them before the time is over. But what a walk can still do depends only on its node, its
place and its direction. So here all walks advance together, a few centimetres of path at a time:

1. Of the walks in a layer that stand alike, only the best one stays (dominance).
2. Of these, only the `width` best stay (the beam).
3. Each of them is lengthened by every hop that leaves its node, and put into the layer that it reaches.

The time is linear in the path's length.
"""

from __future__ import annotations

import time
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from mocap._shared.arrays import Array, Indices
from mocap._shared.progress import Progress
from mocap.errors import NoWalk
from mocap.graphs.compiled_graph import CompiledGraph
from mocap.steering.path_objective import Prices, Route
from mocap.steering.search_states import (
    SearchSpace,
    States,
    expand,
    frames_along,
    prune,
    score,
    search_space,
    standing,
)


@dataclass(frozen=True)
class Beam:
    """How thoroughly to search.

    Parameters
    ----------
    width : walks that stay in each layer; by default 100, or 50 where the path is the only wish.
    layer : the length of a layer, metres of path.
    place, turn : walks at one node and in one cell of this size, metres and radians, stand alike.
    rescue : the largest expected cost of a walk that is about to leave the path, m².
    seconds : time to search; after it the best walk so far is taken.
    progress : wraps the layers, to show a bar.

    Examples
    --------
    >>> Beam(width=200).layer
    0.15
    """

    width: int | None = None
    layer: float = 0.15
    place: float = 0.1
    turn: float = 0.1
    rescue: float = 1.5
    seconds: float = np.inf
    progress: Progress = iter

    def width_on(self, route: Route) -> int:
        """Give the width, or its default for a route."""
        return self.width or (50 if route.bare else 100)


class Found(NamedTuple):
    """The best walk found.

    `edges` are numbers in the compiled graph; the first one's clip is placed by p ↦ turn · p + move. `along`
    gives each frame's progress along the path, metres. `expanded` counts the walks that were lengthened,
    `cut` those that were dropped. `stopped` is "", or the reason why the search ended early.
    """

    edges: Indices
    turn: complex
    move: complex
    along: Array
    cost: float
    expanded: int
    cut: int
    stopped: str


def find_walk(graph: CompiledGraph, route: Route, starts: States, beam: Beam, prices: Prices) -> Found:
    """Find the best walk from one of the starts to the end of a route.

    Parameters
    ----------
    graph, route : the graph, and the path with its wishes.
    starts : from `start_states`.
    beam, prices : how thoroughly to search, and what deviations cost.

    Returns
    -------
    The best walk; after Ctrl-C or when the time is over, the best so far.

    Raises
    ------
    NoWalk : where every walk ends before the route does, or the time is over before the first step.

    Examples
    --------
    >>> from mocap import body, datasets, graphs
    >>> from mocap.steering import Wishes, make_route, start_states
    >>> clips = [body.resample(datasets.sample("walk_circle"), 30)]
    >>> graph = graphs.compile_graph(graphs.prune(graphs.build(clips, window=10, threshold=0.04)))
    >>> route = make_route(graph, body.GroundPath([[0, 0], [0, 3]]), Wishes())
    >>> starts = start_states(graph, np.arange(len(graph.nodes)), 0j, 0.0)
    >>> found = find_walk(graph, route, starts, Beam(), Prices())
    >>> bool(found.along[-1] >= 3), found.stopped
    (True, '')
    """
    search = _Search(search_space(graph, route, prices), beam, {0: [starts]})
    stopped = ""
    try:
        stopped = search.to_the_end(time.monotonic() + beam.seconds)
    except KeyboardInterrupt:
        stopped = "interrupted"
    return search.found(stopped)


@dataclass(eq=False)
class _Search:
    """The state of a search: the walks in each layer, all that were lengthened, and the best complete one."""

    space: SearchSpace
    beam: Beam
    waiting: dict[int, list[States]]
    history: list[States] = field(default_factory=list)
    expanded: int = 0
    cut: int = 0
    best: States | None = None

    def to_the_end(self, deadline: float) -> str:
        """Work through the layers; return "", or the reason to stop before the last one."""
        route, beam = self.space.route, self.beam
        for layer in beam.progress(range(int(route.length / beam.layer) + 1)):
            while parts := self.waiting.pop(layer, []):
                if time.monotonic() > deadline:
                    return "out of time"
                states = self.select(States.join(parts))
                longer = expand(self.space, states, self.expanded - len(states.node))
                # A walk that has not left the layer goes on in it, or it would compete with those ahead.
                self.put_into_layers(longer, layer)
        return ""

    def select(self, states: States) -> States:
        """Choose the walks that stay, and add them to the history."""
        scores = score(self.space, states, self.beam.rescue)
        cells = standing(self.space, states, self.beam.place, self.beam.turn)
        chosen = prune(states, scores, cells, self.beam.width_on(self.space.route))
        self.history.append(chosen)
        self.expanded += len(chosen.node)
        self.cut += len(states.node) - len(chosen.node)
        return chosen

    def put_into_layers(self, new: States, earliest: int) -> None:
        """Put walks into the layers they have reached; of those at the end of the route keep the best."""
        done = new.along >= self.space.route.length
        if done.any():
            arrived = new.take(done)
            first = int(arrived.cost.argmin())
            if self.best is None or arrived.cost[first] < self.best.cost[0]:
                self.best = arrived.take(slice(first, first + 1))
            # No cost is below 0, so a walk that costs as much as the best one cannot become better.
            new = new.take(~done & (new.cost < self.best.cost[0]))
        layer = np.maximum((new.along / self.beam.layer).astype(np.intp), earliest)
        for reached in set(layer.tolist()):
            self.waiting.setdefault(reached, []).append(new.take(layer == reached))

    def found(self, stopped: str) -> Found:
        """Trace the best walk back to its start; where none has arrived, the best walk of the last layer."""
        if self.best is None and not stopped:
            reached = max(float(states.along.max()) for states in self.history)
            raise NoWalk(f"Every walk ends after {reached:.1f} m of the path: prune the graph first.")
        if not self.history:
            raise NoWalk(f"The search was {stopped} before its first step.")
        last = self.history[-1]
        best = last.take(last.cost.argsort(kind="stable")[:1]) if self.best is None else self.best
        history, passed = States.join(self.history), []
        state, hop = int(best.trail[0]), int(best.hop[0])
        while hop >= 0:
            passed.append((state, hop))
            state, hop = int(history.trail[state]), int(history.hop[state])
        if not passed:
            raise NoWalk(f"The search was {stopped} before its first step.")
        states, hops = np.array(passed[::-1]).T
        _, _, along = frames_along(self.space, hops, history.along[states])
        start = history.take(states[:1])
        edges = self.space.graph.hops.edges(hops)
        turn, move, cost = complex(start.turn[0]), complex(start.move[0]), float(best.cost[0])
        return Found(edges, turn, move, along, cost, self.expanded, self.cut, stopped)
