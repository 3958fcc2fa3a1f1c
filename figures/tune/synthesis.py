"""Trials of the constants of long walks: `python figures/tune/synthesis.py [--quick] [--clips FOLDER ...]`.

A random walk of 90 s is cleaned of foot sliding, once as a whole and once in pieces. Off: the largest
distance of a joint between both; with a margin that is long enough it is hardly more than 0, as the cuts then
do not show. Memory: what the walk in pieces takes at most. Shorter pieces are cleaned more often, at both
ends.
"""

import tracemalloc

import numpy as np
from _trials import BUNDLED_WALKS, CAPTURED_WALKS, Clips, Row, Study, Trial
from _walks import graph_of

from mocap.body.concatenation import concatenate
from mocap.body.kinematics import joint_positions
from mocap.feet import clean_up
from mocap.synthesis import tuned
from mocap.synthesis.random_walks import cleaned, stream

SECONDS = 90.0


def in_pieces(clips: Clips) -> Row:
    """Compare a walk that is cleaned in pieces with one that is cleaned as a whole."""
    graph = graph_of(clips)
    tracemalloc.start()
    frames = 0
    for piece in cleaned(stream(graph, seconds=SECONDS)):
        frames += len(piece)
    memory = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    whole = joint_positions(clean_up(concatenate(list(stream(graph, seconds=SECONDS)))))
    parts = joint_positions(concatenate(list(cleaned(stream(graph, seconds=SECONDS)))))
    distances = np.linalg.norm(whole - parts, axis=-1)
    return {"off, mm": 1000 * float(distances.max()), "memory, MB": memory / 1e6}


TRIALS = {
    "margin": Trial(in_pieces, (0.5, 1.0, 2.0, 10.0)),
    "piece": Trial(in_pieces, (5.0, 15.0, 60.0)),
}
STUDY = Study(tuned, TRIALS, {}, (BUNDLED_WALKS, CAPTURED_WALKS))

if __name__ == "__main__":
    STUDY.main(__doc__)
