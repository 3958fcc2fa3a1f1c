"""Directed walks, measured: `python figures/directed_walks.py [GRAPH.npz ...]`.

For each graph, by default that of the bundled clips, eight directions: a straight stop with a heading to
the side, a corner, an S, a wait before a turn, two times, a time that no walk keeps, a disc on the line, and
three discs. Each row shows the distance of the last frame from the wish (cm), its error of the heading
(degrees), the largest delay where a time is asked for (s), how deep the root enters a disc (cm), the
correction that is spread over the steps (cm and degrees), and the time of `direct` divided by that of
`follow_path` along the same points in the same run, on prepared graphs, the least processor time of three.
"""

import sys
import time
import warnings
from collections.abc import Callable

import numpy as np

from mocap import graphs, steering
from mocap.body import resample
from mocap.datasets import SAMPLES, sample
from mocap.errors import MocapWarning, NoWalk
from mocap.files import DirectedPoint, Direction
from mocap.graphs import MotionGraph
from mocap.steering import Directed, StandingGraph
from mocap.steering.anchoring import headings_in

P = DirectedPoint
LEFT = np.pi / 2
# reads: statement: a table
DIRECTIONS = {
    "straight": Direction([P(0, 0), P(0, 5)], "stand", "stand", facing=LEFT),
    "corner": Direction([P(0, 0), P(0, 4), P(3, 6)], "stand", "stand", facing=0.0),
    "S": Direction([P(0, 0), P(1, 3), P(-1, 6)], "stand", "stand", facing=-LEFT),
    "wait": Direction([P(0, 0, heading=LEFT), P(0, 4, heading=0.0, wait=2.0), P(4, 5)], "stand", "stand"),
    "times": Direction([P(0, 0, t=0), P(0, 4, t=6), P(4, 5, t=11)], "stand", "stand"),
    "too fast": Direction([P(0, 0, t=0), P(0, 8, t=3)], "stand", "stand"),
    "disc": Direction([P(0, 0), P(0, 6)], "stand", "stand", around=[(0.1, 3, 0.6)]),
    "discs": Direction([P(0, 0), P(4, 6)], "stand", "stand", 0.0, [(1, 2, 0.5), (3, 4, 0.7), (2, 3, 0.3)]),
}
HEADS = ("off, cm", "turned", "late, s", "disc, cm", "spread, cm", "degrees", "ratio")
REPEATS = 3


def bundled() -> MotionGraph:
    """Build the graph of the bundled clips."""
    clips = [resample(sample(name), 30) for name in SAMPLES]
    return graphs.prune(graphs.build(clips, window=10, threshold=0.04))


def fastest(run: Callable[[], object]) -> float:
    """Return the shortest processor time of three calls, seconds."""
    times = []
    for _ in range(REPEATS):
        start = time.process_time()
        run()
        times.append(time.process_time() - start)
    return min(times)


def row(
    standing: StandingGraph, compiled: graphs.compiled_graph.CompiledGraph, direction: Direction
) -> list[str]:
    """Measure one direction."""
    points = [(point.x, point.z) for point in direction.points]
    directed = steering.direct(standing, direction)
    directing = fastest(lambda: steering.direct(standing, direction))
    ratio = directing / fastest(lambda: steering.follow_path(compiled, points))
    return [*errors(directed, direction), f"{ratio:.1f}"]


def errors(directed: Directed, direction: Direction) -> list[str]:
    """Return the errors of the last frame, of times and discs, and the corrections."""
    motion = directed.motion()
    last = direction.points[-1]
    distance = np.hypot(*(motion.root_positions[-1, [0, 2]] - (last.x, last.z)))
    wished = last.heading if direction.facing is None else direction.facing
    heading = np.nan if wished is None else headings_in(motion)[-1] - wished
    missed = np.remainder(heading + np.pi, 2 * np.pi)
    delays = [abs(arrival.late) for arrival in directed.arrivals if arrival.point.t]
    late = max(delays, default=np.nan)
    spread = max(part.metres for part in directed.corrections)
    angle = max(abs(part.radians) for part in directed.corrections)
    values = (100 * distance, np.degrees(missed - np.pi), late, 100 * directed.entered, 100 * spread)
    return [*(f"{value:.1f}" for value in values), f"{np.degrees(angle):.0f}"]


def main() -> None:
    """Print a table for each graph."""
    warnings.simplefilter("ignore", MocapWarning)
    loaded = {path: graphs.load(path) for path in sys.argv[1:]} or {"bundled clips": bundled()}
    for name, graph in loaded.items():
        standing = steering.with_standing(graph)
        compiled = graphs.compile_graph(graph)
        print(f"\n{name:<12}" + "".join(f"{head:>12}" for head in HEADS))
        for title, direction in DIRECTIONS.items():
            try:
                cells = row(standing, compiled, direction)
            except NoWalk as error:
                cells = [str(error)]
            print(f"{title:<12}" + "".join(f"{cell:>12}" for cell in cells), flush=True)


if __name__ == "__main__":
    main()
