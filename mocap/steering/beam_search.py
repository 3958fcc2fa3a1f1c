"""The best walk along a line on the ground: a beam search in layers of path.

A depth-first search, as in the paper, drowns in a dense graph: of dozens of choices per second it has tried
few when the time is over. But what a walk can still do depends only on where it stands: at which node, in
which place, turned which way. So here all walks advance together, a few centimetres of path at a time:

1. Of the walks in a layer that stand alike only the best goes on (dominance).
2. Of these only the `width` most promising go on (the beam).
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
    """How thoroughly to search, and what counts beside the squared distance from the path.

    Parameters
    ----------
    width : walks that go on in a layer; by default 100, or 50 where nothing but the path is wished for.
    layer : metres of path that a layer is long.
    place, turn : walks nearer than this, metres and radians, at the same node stand alike.
    rescue : the most that is expected to be lost where a walk is about to leave the path, m².
    seconds : time to search; when it is over, the best walk so far is taken.
    progress : wraps the layers, to show a bar.
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

    `edges` are numbers in the compiled graph, and the first one's clip is placed by p ↦ turn · p + move.
    `along` says how far along the path each frame counts; `expanded` states were lengthened, `cut` were
    dropped as no better or less promising; `stopped` is "" or says what ended the search before its end.
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
    """Find a walk from one of some starts to the end of a route.

    Parameters
    ----------
    graph, route : where to walk, and what is wished for.
    starts : from `start_states`.
    beam, prices : how thoroughly to search, and what counts.

    Returns
    -------
    The best walk; after Ctrl-C or when the time is over, the best so far.

    Raises
    ------
    NoWalk : where every walk ends before the route does.
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
    """A search under way: the walks that wait in each layer, all that were lengthened, and the best one."""

    space: SearchSpace
    beam: Beam
    waiting: dict[int, list[States]]
    history: list[States] = field(default_factory=list)
    expanded: int = 0
    cut: int = 0
    best: States | None = None

    def to_the_end(self, deadline: float) -> str:
        """Work through the layers; say what stopped it before the last one."""
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
        """Choose the walks that go on, and remember them."""
        scores = score(self.space, states, self.beam.rescue)
        cells = standing(self.space, states, self.beam.place, self.beam.turn)
        chosen = prune(states, scores, cells, self.beam.width_on(self.space.route))
        self.history.append(chosen)
        self.expanded += len(chosen.node)
        self.cut += len(states.node) - len(chosen.node)
        return chosen

    def put_into_layers(self, new: States, earliest: int) -> None:
        """Put walks into the layers they have reached; those at the end compete for the best."""
        done = new.along >= self.space.route.length
        if done.any():
            arrived = new.take(done)
            first = int(arrived.cost.argmin())
            if self.best is None or arrived.cost[first] < self.best.cost[0]:
                self.best = arrived.take(slice(first, first + 1))
            # No cost is below 0, so what costs as much as the best walk cannot become better.
            new = new.take(~done & (new.cost < self.best.cost[0]))
        layer = np.maximum((new.along / self.beam.layer).astype(np.intp), earliest)
        for reached in set(layer.tolist()):
            self.waiting.setdefault(reached, []).append(new.take(layer == reached))

    def found(self, stopped: str) -> Found:
        """Trace the best walk back to its start; where none has arrived, the best of those under way."""
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
