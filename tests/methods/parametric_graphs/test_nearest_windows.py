"""The products find what `matching` finds pair by pair."""

import numpy as np
import pytest
from walking import generate_walk

from mocap.body.kinematics import joint_positions
from mocap.body.motion import resample
from mocap.errors import MocapError
from mocap.matching.distance_grids import distance_grid
from mocap.methods.parametric_graphs.made_strides import make_stride
from mocap.methods.parametric_graphs.nearest_windows import (
    HALF,
    SPAN,
    WINDOW,
    near_strike,
    optimal_transitions,
)
from mocap.methods.parametric_graphs.stride_spaces import make_space
from mocap.methods.parametric_graphs.strides import cut_strides
from tests.methods.parametric_graphs.built import space


@pytest.mark.parametrize(("source", "target"), [("lrl", "lrl"), ("lr", "rl")])
def test_costs_are_those_of_a_distance_grid(source, target):
    first, second = space(source), space(target)
    at, to = np.array([[-0.2], [0.0], [0.3]]), np.array([[0.1], [-0.4]])
    found = optimal_transitions(first, second, at, to)
    for row, asked in enumerate(at):
        one = make_stride(first, asked)
        centre = int(np.round(np.interp(1.0, one.phases, np.arange(len(one.phases)))))
        for column, other in enumerate(to):
            two = make_stride(second, other)
            into = int(np.round(np.interp(0.0, two.phases, np.arange(len(two.phases)))))
            some = [
                made.motion[c - HALF - SPAN : c + HALF + SPAN + 1] for made, c in ((one, centre), (two, into))
            ]
            grid = np.sqrt(np.maximum(distance_grid(*some, window=WINDOW), 0))
            assert found.cost[row, column] == pytest.approx(grid.min(), abs=2e-4)


def test_it_leaves_near_the_last_strike_and_enters_near_the_first():
    tested = space()
    found = optimal_transitions(tested, tested, np.zeros((3, 1)), np.linspace(-0.5, 0.5, 5)[:, None])
    assert np.abs(found.leave - 1).max() < 0.2 and np.abs(found.enter).max() < 0.2


def test_only_the_frames_near_a_strike_are_made():
    tested = space()
    points, phases = near_strike(tested, np.array([[0.2]]), 0.0)
    made = make_stride(tested, np.array([0.2]))
    frames = 2 * (HALF + SPAN) + 1
    assert points.shape[:2] == phases.shape == (1, frames)
    middle = made.frame(phases[0, HALF + SPAN])
    window = joint_positions(made.motion[middle - HALF : middle + HALF + 1])[:, tested.strides.joints]
    np.testing.assert_allclose(points[0, SPAN:-SPAN], window, atol=2e-3)


def test_windows_that_run_off_the_margins_of_quick_strides_are_refused():
    """A quiet `np.interp` would hold the last frame; with half a stride beyond its strikes a jog has room."""
    jogs = [
        resample(generate_walk([[0, 0], [side, 6], [5 * side, 12]], style="jog"), 30) for side in (-2, 0, 2)
    ]
    tight, wide = (make_space(cut_strides(jogs, margin=m), 0.2, -0.3, 0.3) for m in (0.3, 0.5))
    with pytest.raises(MocapError, match=r"A window runs 0.\d+ s off a stride of 1.\d+ s, margins and all"):
        near_strike(tight, np.zeros((1, 1)), 1.0)
    assert np.ptp(near_strike(wide, np.zeros((1, 1)), 1.0)[1]) > 0.6
