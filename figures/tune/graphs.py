"""Trials of the constants of graphs: `python figures/tune/graphs.py [--quick] [--clips FOLDER ...]`.

Graphs have windows of 10 frames and a threshold of 4 cm. Walks are searched along an s-curve and a circle.
Off and worst: the mean and the largest distance of the walks from their paths; good walks have less than 4
and 15 cm. Seams: transitions per second. Takes: the duration of a walk.

- `longest_macro_edge`: the number of macro-edges, and what a search with them finds, in which time.
- `ahead`, `least_speed`, `velocity_time`, `standing`: what a search reads of each node; the same measures.
- `largest_component`: the threshold that is proposed, and the percentage of the frames that the largest
  component then plays.
"""

import numpy as np
from _trials import CAPTURED_WALKS, STOP_AND_GO, Clips, Row, Study, Trial
from _walks import WINDOW, followed, graph_of, measures

from mocap.graphs import compile_graph, threshold_curve, tuned
from mocap.matching import find_transitions

THRESHOLDS = np.linspace(0.01, 0.08, 29)  # metres, among which one is proposed


def along_paths(clips: Clips) -> Row:
    """Compile the graph, and follow the paths."""
    compiled = compile_graph(graph_of(clips))
    return {"macro-edges": len(compiled.macro_edges.frames)} | measures(followed(compiled))


def proposal(clips: Clips) -> Row:
    """Propose a threshold, and measure the largest component at it."""
    transitions = find_transitions(clips, window=WINDOW, below=THRESHOLDS[-1])
    curve = threshold_curve(clips, transitions, window=WINDOW, thresholds=THRESHOLDS)
    proposed = curve.suggest()
    played = int(curve.frames[curve.threshold == proposed][0])
    return {"threshold, cm": 100 * proposed, "frames, %": 100 * played / sum(map(len, clips))}


# reads: statement: a table
TRIALS = {
    "longest_macro_edge": Trial(along_paths, (0.5, 1 / 30, 1 / 12, 1 / 4)),
    "ahead": Trial(along_paths, ((1 / 8, 1 / 4, 3 / 8), (1 / 12, 1 / 6, 1 / 4), (1 / 2, 1.0, 3 / 2))),
    "least_speed": Trial(along_paths, (0.0, 0.1, 0.6)),
    "velocity_time": Trial(along_paths, (1 / 30, 1 / 12, 1 / 2)),
    "standing": Trial(along_paths, (0.0, 0.03, 0.3)),
    "largest_component": Trial(proposal, (0.99, 0.5, 0.7, 0.8, 0.95)),
}
STUDY = Study(tuned, TRIALS, {}, (STOP_AND_GO, CAPTURED_WALKS))

if __name__ == "__main__":
    STUDY.main(__doc__)
