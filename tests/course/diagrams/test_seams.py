"""The diagrams of a transition and of a leg show the numbers that the package computes."""

import numpy as np
import pytest
from matplotlib.colors import to_rgb

from mocap.blending import cubic_weights, join, lay_window_on
from mocap.body import rotations
from mocap.course.diagrams import added_by_blend, blended_seam, knee_triangle, turning_paths
from mocap.course.seam_trials import Passage
from mocap.datasets.samples import sample
from mocap.matching.point_clouds import point_cloud
from mocap.plotting import MARK, SOURCES

ALPHA = 0.6


def boxes(ax, colour):
    """The height of each box of a colour in the result, by the frame at which it stands."""
    found = [patch for patch in ax.patches if patch.get_y() < 1.2 and patch.get_alpha() == ALPHA]
    found = [patch for patch in found if to_rgb(patch.get_facecolor()) == to_rgb(colour)]
    return {round(patch.get_x() + patch.get_width() / 2): patch.get_height() for patch in found}


def test_the_steps_of_a_seam_add_the_weights_then_the_mix_then_the_rest():
    steps = [blended_seam(step).axes for step in (1, 2, 3, 4)]
    assert [len(weights.lines) for _, weights in steps] == [0, 1, 1, 1]
    assert [len(boxes(rows, SOURCES[0])) for rows, _ in steps] == [0, 0, 6, 14]


def test_a_frame_of_the_result_is_filled_by_its_weight():
    rows, weights = blended_seam(step=4, window=5).axes
    first = boxes(rows, SOURCES[0])
    whole = first[-1]
    assert [first[p] / whole for p in range(5)] == pytest.approx(cubic_weights(5).tolist())
    assert weights.lines[0].get_ydata()[4:9] == pytest.approx(cubic_weights(5))
    for place, height in boxes(rows, SOURCES[1]).items():
        assert height == pytest.approx(whole - first[place])
    names = [text.get_text() for text in rows.texts]
    assert names.count("mix") == 5
    assert "$i-1$" in names
    assert "$j+5$" in names


def test_dots_are_at_the_share_of_each_way():
    even = np.linspace(0, 1, 5)
    ways = {"even": rotations.about_y(even), "late": rotations.about_y(even**2)}
    graph = turning_paths(ways, share=0.5).axes[1]
    dots = [line.get_ydata()[line.get_markevery()].item() for line in graph.lines]
    assert dots == pytest.approx(np.degrees([0.5, 0.25]).tolist())


def test_the_triangle_is_closed_and_its_bend_the_law_of_cosines():
    ax = knee_triangle(step=2, distance=0.7).axes[0]
    hip, knee, ankle = ax.lines[0].get_xydata()
    lengths = [np.linalg.norm(knee - hip), np.linalg.norm(ankle - knee), np.linalg.norm(ankle - hip)]
    assert lengths == pytest.approx([0.45, 0.41, 0.7])
    bend = np.degrees(np.pi - np.arccos((0.45**2 + 0.41**2 - 0.7**2) / (2 * 0.45 * 0.41)))
    assert ax.texts[-1].get_text() == f"bend {bend:.0f}°"
    assert len(knee_triangle(step=3).axes[0].lines) - len(ax.lines) == 3
    assert len(knee_triangle(step=1).axes[0].lines) == 2


WALK = sample("walk_straight")
FIRST = WALK[490:560]
SECOND = lay_window_on(WALK, 500, WALK, 233, 12)[223:293]
RESULT = join(WALK, 500, WALK, 233, 12)[490:560]


def test_what_a_blend_adds_is_drawn_as_measured_beside_the_terms_that_explain_it():
    blended = Passage(RESULT, FIRST, SECOND, 10, cubic_weights(12))
    above, below = added_by_blend(["term"])(blended, blended.gap[1:-1])[0].figure.axes
    ends = above.patches[0].get_extents().transformed(above.transData.inverted()).intervalx
    assert ends == pytest.approx([0, 11])
    first, second, result = (line.get_ydata() for line in above.lines)
    assert result[:9] == pytest.approx(first[:9])
    assert result[22:] == pytest.approx(second[22:])
    ahead = FIRST.root_positions[-1] - FIRST.root_positions[0]
    assert first.sum() / WALK.fps == pytest.approx(np.linalg.norm(ahead))
    (area,), (term,) = below.patches, below.lines
    assert np.allclose(area.get_facecolor()[:3], [int(MARK[n : n + 2], 16) / 255 for n in (1, 3, 5)])
    assert area.get_xy()[:, 1].max() == pytest.approx(blended.jolts.added.max())
    gaps = np.linalg.norm(point_cloud(FIRST) - point_cloud(SECOND), axis=-1)
    assert term.get_ydata() == pytest.approx(np.sqrt((gaps**2).mean(axis=1))[9:23] * WALK.fps)
