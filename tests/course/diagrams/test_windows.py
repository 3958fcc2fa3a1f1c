"""What the diagrams of windows draw: the right points, the right sums, and left and right told apart."""

import numpy as np
import pytest
from matplotlib.colors import to_hex
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from mpl_toolkits.mplot3d import proj3d

from mocap import datasets, resample
from mocap.body import PlanarTransform
from mocap.course import diagrams
from mocap.errors import MocapError
from mocap.matching import distinct_joints, point_cloud
from mocap.plotting import COLOURS, QUIET, SOURCES
from mocap.plotting.stick_figures import to_picture
from mocap.plotting.storyboards import draw_matched

WINDOW = 10


@pytest.fixture(scope="module")
def window():
    return resample(datasets.sample("walk_straight"), 30)[100 : 100 + WINDOW]


def dots(figure, colour):
    return [line for line in figure.axes[0].lines if line.get_color() == colour and line.get_marker() == "."]


def bodies(figure):
    """Count the bodies by their heads."""
    return sum(line.get_marker() == "o" for line in figure.axes[0].lines)


def test_a_cloud_is_made_in_four_steps_and_has_a_shadow_inside_the_picture(window):
    figures = [diagrams.window_cloud(window, step=step) for step in (1, 2, 3, 4)]
    assert [bodies(figure) for figure in figures] == [1, WINDOW, WINDOW, 0]
    assert [len(dots(figure, SOURCES[0])) for figure in figures] == [0, 0, 1, 1]
    (cloud,), (shadow,) = dots(figures[3], SOURCES[0]), dots(figures[3], QUIET)
    wanted = to_picture(point_cloud(window).reshape(-1, 3))
    assert np.transpose(cloud.get_data_3d()) == pytest.approx(wanted)
    assert np.transpose(shadow.get_data_3d()) == pytest.approx(wanted * [1, 1, 0])
    figures[3].canvas.draw()
    (ax,) = figures[3].axes
    across, up, _ = proj3d.proj_transform(*shadow.get_data_3d(), ax.get_proj())
    assert ax.bbox.contains(*ax.transData.transform(np.stack([across, up], axis=-1)).min(axis=0))


@pytest.mark.parametrize(
    ("draw", "last", "step"),
    [
        (diagrams.window_cloud, 4, 0),
        (lambda window, step: diagrams.laying_on(window, window, step=step), 4, 5),
        (lambda window, step: diagrams.radius_gaps(window, window, ["head"], step=step), 3, 4),
    ],
)
def test_a_step_that_is_not_there_is_named(window, draw, last, step):
    with pytest.raises(MocapError, match=f"steps 1 to {last}, got {step}"):
        draw(window, step=step)


def test_threads_lead_from_each_joint_to_its_partner_and_left_and_right_keep_their_colours(window):
    moved = PlanarTransform(0.0, 0.0, 0.4).apply_motion(window)  # ahead
    ax = Figure().add_subplot()
    draw_matched(ax, window, moved)
    for solid, dashed, threads in zip(*[iter(ax.collections)] * 3, strict=True):
        ends = np.diff(threads.get_segments(), axis=1)
        assert len(ends) == len(distinct_joints(window.skeleton))
        assert np.allclose(np.hypot(*ends[:, 0].T), 0.4, atol=0.01)
        assert np.array_equal(solid.get_colors(), dashed.get_colors())
        assert {to_hex(colour).upper() for colour in solid.get_colors()} == set(COLOURS.values())
        assert solid.get_linestyle()[0][1] is None and dashed.get_linestyle()[0][1] is not None


def test_sums_along_diagonals_are_those_of_the_formula():
    products = np.random.default_rng(0).integers(0, 10, (7, 9))
    for step in (1, 2, 3, 4):
        frames, sums = diagrams.diagonal_sums(products, window=4, step=step).axes
        wanted = sum(products[f : f + 4, f : f + 6] for f in range(step))
        assert [int(text.get_text()) for text in sums.texts] == wanted.ravel().tolist()
        boxes = [patch for patch in frames.patches if isinstance(patch, Rectangle) and not patch.get_fill()]
        assert [(box.get_x(), box.get_y(), box.get_width(), box.get_height()) for box in boxes] == [
            (step - 1.5, step - 1.5, 6, 4)
        ]
        marked = [patch for patch in frames.patches if to_hex(patch.get_facecolor()) == SOURCES[4].lower()]
        assert [patch.get_x() + 0.5 for patch in marked] == list(range(step))


def test_windows_that_do_not_fit_are_refused():
    with pytest.raises(MocapError, match=r"Windows of 4 frames do not fit into an array of shape \(3, 3\)"):
        diagrams.diagonal_sums(np.ones((3, 3)), window=4, step=1)


def test_the_gaps_between_circles_are_the_same_however_a_window_is_turned():
    first, second = (resample(datasets.sample(name), 30)[60:70] for name in ("walk_curve_1", "jog"))
    moved = PlanarTransform(-2.5, 3.0, -1.0).apply_motion(second)
    names = ["lfoot", "head"]
    titles = [diagrams.radius_gaps(first, other, names).axes[0].get_title() for other in (moved, second)]
    assert titles[0] == titles[1] != "what no turn can remove:\nlfoot 0 cm, head 0 cm"
    drawn = [diagrams.radius_gaps(first, first, ["lfoot", "head"], step=step).axes[0] for step in (1, 2, 3)]
    assert [len(ax.patches) for ax in drawn] == [0, 4, 4]
    assert [len(ax.lines) for ax in drawn] == [3, 3, 5]
    assert drawn[2].get_title() == "what no turn can remove:\nlfoot 0 cm, head 0 cm"
