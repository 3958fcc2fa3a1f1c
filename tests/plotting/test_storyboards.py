"""The four panels of a transition: what they say is what the package measures."""

import numpy as np
import pytest

from mocap.blending.joining import join
from mocap.body.motion import Motion, resample
from mocap.body.skeleton import Skeleton
from mocap.datasets.samples import sample
from mocap.matching.distance_grids import distance_grid
from mocap.plotting.storyboards import Shot, storyboard

WALKS = [resample(sample(f"walk_curve_{n}"), 30)[:120] for n in (1, 2)]
SHOT = Shot(WALKS[0], 56, WALKS[1], 20, 10, 20, 20, lambda ax: ax.plot(0, 0))


def test_the_distance_is_that_of_the_grid_and_least_at_the_best_turn():
    exact = np.sqrt(distance_grid(*WALKS, window=10)[56, 20])
    assert SHOT.distance(SHOT.angle) == pytest.approx(exact)
    assert all(SHOT.distance(SHOT.angle + off) > exact for off in (-1.0, -0.01, 0.01, 3.0))


def test_the_seam_is_the_packages_blend():
    joined = join(WALKS[0], 56, WALKS[1], 20, 10)[36:86]
    assert np.allclose(SHOT.seam.root_positions, joined.root_positions)


@pytest.mark.parametrize(
    ("show", "titles"),
    [
        (["windows"], ["which two", "the first, walk_curve_1", "the second, walk_curve_2", "aligned, RMS"]),
        (["windows", "turn"], ["which two", "aligned, RMS", "from above", "the best turn, 81°"]),
        (["windows", "turn", "weights"], ["which two", "aligned", "weights α, after a turn of 81°", "seam"]),
        (["windows", "turn", "weights", "seam"], ["which two", "aligned", "weights α", "the seam", ""]),
    ],
)
def test_four_panels_with_labels(show, titles):
    labels = [ax.get_title(loc="left") for ax in storyboard(SHOT, show).axes]
    assert len(labels) == len(titles)
    assert all(title in label for title, label in zip(titles, labels, strict=True))


def test_left_and_right_keep_their_colours_and_a_body_without_legs_is_drawn():
    pair = Skeleton(["root", "tip"], [-1, 0], [[0, 0, 0], [0, 1, 0]])
    turns = np.tile([1.0, 0, 0, 0], (30, 2, 1))
    pole = Motion(pair, np.linspace(0, [0, 1, 2], 30), turns, 30.0, "pole")
    shot = Shot(pole, 0, pole, 5, 2, 0, 0, lambda ax: None)
    assert len(storyboard(shot, ["windows", "turn", "weights", "seam"]).axes) == 5
