"""Clips, labels and truths that the tests of match webs share."""

from itertools import pairwise
from types import SimpleNamespace

import numpy as np
import pytest

from mocap import datasets, resample
from mocap.methods.match_webs import build_web
from tests.blending.registered import strikes

BUNDLED = ("walk_straight", "walk_circle", "sneak", "jog", "stop_and_go")


def cycles(motion, shortest, longest):
    """Strike to strike of the left foot, by the motion's own marks, as slices of so many seconds."""
    frames = np.round(strikes(motion)[0] * motion.fps).astype(int).tolist()
    found = (slice(a, b) for a, b in pairwise(frames))
    return [part for part in found if shortest <= (part.stop - part.start) / motion.fps <= longest]


def common(match, clip, part):
    """Give what a match and a stretch have in common, as a share of their union."""
    if match.clip != clip:
        return 0.0
    both = min(match.stop, part.stop) - max(match.start, part.start)
    return max(both, 0) / (max(match.stop, part.stop) - min(match.start, part.start))


def judge(found, truth, share=0.5, forgiven=lambda match: False):
    """Count the true stretches (clip, slice) that were found, and the matches that are none of them."""
    hit = sum(any(common(match, *true) > share for match in found) for true in truth)
    wrong = sum(not forgiven(match) and all(common(match, *t) <= share for t in truth) for match in found)
    return hit, wrong


@pytest.fixture(scope="session")
def bundled():
    """Five generated clips with a web below 8 cm, and the walking cycles in them by labels and plants."""
    clips = [datasets.sample(name) for name in BUNDLED]
    truth = [
        (number, part)
        for number, clip in enumerate(clips)
        for part in cycles(clip, 2 / 3, 13 / 6)
        if clip.labels["walk"][part].all()
    ]
    return SimpleNamespace(clips=clips, web=build_web(clips, below=0.08), truth=truth)


@pytest.fixture(scope="session")
def low(bundled):
    """The five clips at the web's rate."""
    return [resample(clip, 30) for clip in bundled.clips]
