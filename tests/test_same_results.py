"""Build, prune, walk and follow give what they gave before the package was put into rooms: the same numbers.

All that is compared is whole numbers, so that the last digits of another processor do not matter. Where a
number is to change, a commit says why.
"""

import hashlib

import numpy as np
import pytest

import mocap
from mocap import body, datasets, graphs, steering, synthesis
from tests.bundled import walks_of_16
from tests.refusals import quietly

EXPECTED = {
    "bundled": {
        "transitions": 10088,
        "whole": (5118, 15199),
        "pruned": (5029, 14790),
        "random": (1317, "c3d342f2a5966841"),
        "S-curve": (466, "a5041f4e4fda1e25"),
        "square": (642, "ddbde0ce81723d71"),
    },
    "CMU 16": {
        "transitions": 3688,
        "whole": (1848, 5510),
        "pruned": (1471, 3905),
        "random": (1062, "22c774aef647a8a2"),
        "S-curve": (440, "4c9ca974b0de5883"),
        "square": (371, "76902fed47f5b378"),
    },
}


def fingerprint(walk: list) -> tuple[int, str]:
    """Count a walk's edges, and sum them up as the start of a SHA-256."""
    numbers = np.array([(*start, *end, key) for start, end, key in walk], np.int64)
    return len(walk), hashlib.sha256(numbers.tobytes()).hexdigest()[:16]


@pytest.fixture(params=EXPECTED)
def results(request):
    """Give the graphs of some clips, and what is expected of them."""
    if request.param == "bundled":
        clips = [datasets.sample(name) for name in datasets.SAMPLES]
    else:
        clips = walks_of_16(request.getfixturevalue("real_data"))
    whole = graphs.build([mocap.resample(clip, 30) for clip in clips], window=10, threshold=0.04)
    return whole, graphs.prune(whole), EXPECTED[request.param]


def sizes(graph):
    return graph.graph.number_of_nodes(), graph.graph.number_of_edges()


def test_results_are_the_same(results):
    whole, pruned, expected = results
    assert whole.count("transition") == expected["transitions"]
    assert sizes(whole) == expected["whole"]
    assert sizes(pruned) == expected["pruned"]
    assert fingerprint(synthesis.random_walk(pruned, seconds=60, seed=1)) == expected["random"]
    for shape in ("S-curve", "square"):
        followed = quietly(steering.follow_path, pruned, body.SHAPES[shape]())
        assert fingerprint(followed.walk) == expected[shape], shape
