"""The diagram of what a blend adds draws the velocities and jolts that the measures give."""

import numpy as np
import pytest

from mocap.blending import cubic_weights, join, lay_window_on
from mocap.course.diagrams.jolts import added_by_blend
from mocap.datasets.samples import sample
from mocap.plotting.style import MARK
from mocap.quality import blend_jolts, jumps

WALK = sample("walk_straight")
FIRST = WALK[490:560]
SECOND = lay_window_on(WALK, 500, WALK, 233, 12)[223:293]
RESULT = join(WALK, 500, WALK, 233, 12)[490:560]


def drawn(step):
    return added_by_blend(RESULT, FIRST, SECOND, 10, cubic_weights(12), step=step).axes


def test_each_step_adds_what_it_says():
    counts = [
        [len(ax.lines) for ax in drawn(step)] + [len(drawn(step)[1].collections)] for step in range(1, 5)
    ]
    assert counts == [[2, 0, 0], [3, 0, 0], [3, 4, 0], [3, 4, 1]]


def test_the_axes_stay_the_same_from_step_to_step():
    limits = [[(*ax.get_xlim(), *ax.get_ylim()) for ax in drawn(step)] for step in range(1, 5)]
    assert all(np.allclose(limits[0], other) for other in limits[1:])


def test_outside_the_window_the_blend_has_the_velocity_of_one_clip():
    first, second, result = (line.get_ydata() for line in drawn(4)[0].lines)
    assert result[:9] == pytest.approx(first[:9])
    assert result[22:] == pytest.approx(second[22:])
    ahead = FIRST.root_positions[-1] - FIRST.root_positions[0]
    assert first.sum() / WALK.fps == pytest.approx(np.linalg.norm(ahead))


def test_the_jolts_are_the_measured_ones():
    below = drawn(4)[1]
    for line, motion in zip(below.lines, (FIRST, SECOND, RESULT), strict=False):
        assert line.get_ydata() == pytest.approx(jumps(motion)[0][1:-1])
    (area,) = below.collections
    assert np.allclose(area.get_facecolor()[0, :3], [int(MARK[n : n + 2], 16) / 255 for n in (1, 3, 5)])
    added = blend_jolts(RESULT, FIRST, SECOND, 10, cubic_weights(12)).added
    assert area.get_paths()[0].vertices[:, 1].max() == pytest.approx(added.max())


def test_the_window_is_shaded():
    for ax in drawn(1):
        (window,) = ax.patches
        ends = window.get_extents().transformed(ax.transData.inverted()).intervalx
        assert ends * WALK.fps == pytest.approx([10, 22])
