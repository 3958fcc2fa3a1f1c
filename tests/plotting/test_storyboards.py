"""The panels of a transition: what they say is what the package measures."""

import numpy as np
import pytest

from mocap.body.motion import Motion, resample
from mocap.body.skeleton import Skeleton
from mocap.datasets.samples import sample
from mocap.matching.distance_grids import distance_grid
from mocap.plotting.storyboards import Shot, storyboard

WALKS = [resample(sample(f"walk_curve_{n}"), 30)[:120] for n in (1, 2)]
SHOT = Shot(WALKS[0], 56, WALKS[1], 20, 10, 20, 20, lambda ax: ax.plot(0, 0))


def test_the_distance_is_that_of_the_grid():
    assert SHOT.distance == pytest.approx(np.sqrt(distance_grid(*WALKS, window=10)[56, 20]))


@pytest.mark.parametrize("depth", [1, 2, 3, 4])
def test_panels_with_labels(depth):
    show = ["windows", "turn", "weights", "seam"][:depth]
    labels = [ax.get_title(loc="left") for ax in storyboard(SHOT, show).axes]
    assert labels[:2] == ["1  which two windows", "2  aligned, RMS distance 1.9 cm"]
    assert labels[2:] == ["3  the seam; its window is shaded"] * (depth > 2)


def test_a_body_without_legs_is_drawn():
    pair = Skeleton(["root", "tip"], [-1, 0], [[0, 0, 0], [0, 1, 0]])
    turns = np.tile([1.0, 0, 0, 0], (30, 2, 1))
    pole = Motion(pair, np.linspace(0, [0, 1, 2], 30), turns, 30.0, "pole")
    shot = Shot(pole, 0, pole, 5, 2, 0, 0, lambda ax: None)
    assert len(storyboard(shot, ["windows", "turn", "weights"]).axes) == 3
