"""What the diagrams of bodies, turns, clouds and paths draw, read back from their artists."""

import numpy as np
import pytest
from matplotlib.colors import to_hex
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from mpl_toolkits.mplot3d import proj3d

from mocap import datasets, resample
from mocap.body import PlanarTransform
from mocap.body.ground_path import GroundPath, arcs
from mocap.body.kinematics import joint_positions
from mocap.body.rotations import multiply
from mocap.course import diagrams
from mocap.course.diagrams import alignment, compass, down_the_tree, poses
from mocap.course.diagrams.ground import nearest_points, two_distances
from mocap.datasets.samples import sample
from mocap.errors import MocapError
from mocap.matching import align, distinct_joints, point_cloud
from mocap.plotting import COLOURS, QUIET, SOURCES
from mocap.plotting.stick_figures import to_picture
from mocap.plotting.storyboards import draw_matched

WINDOW = 10


@pytest.fixture(scope="module")
def window():
    return resample(datasets.sample("walk_straight"), 30)[100 : 100 + WINDOW]


def dots_of(figure, colour):
    return [line for line in figure.axes[0].lines if line.get_color() == colour and line.get_marker() == "."]


def bodies(figure):
    """Count the bodies by their heads."""
    return sum(line.get_marker() == "o" for line in figure.axes[0].lines)


def test_a_cloud_is_made_in_four_steps_and_has_a_shadow_inside_the_picture(window):
    figures = [diagrams.window_cloud(window, step=step) for step in (1, 2, 3, 4)]
    assert [bodies(figure) for figure in figures] == [1, WINDOW, WINDOW, 0]
    assert [len(dots_of(figure, SOURCES[0])) for figure in figures] == [0, 0, 1, 1]
    (cloud,), (shadow,) = dots_of(figures[3], SOURCES[0]), dots_of(figures[3], QUIET)
    wanted = to_picture(point_cloud(window).reshape(-1, 3))
    assert np.transpose(cloud.get_data_3d()) == pytest.approx(wanted)
    assert np.transpose(shadow.get_data_3d()) == pytest.approx(wanted * [1, 1, 0])
    figures[3].canvas.draw()
    (ax,) = figures[3].axes
    across, up, _ = proj3d.proj_transform(*shadow.get_data_3d(), ax.get_proj())
    assert ax.bbox.contains(*ax.transData.transform(np.stack([across, up], axis=-1)).min(axis=0))


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


@pytest.fixture(scope="module")
def pair():
    first = resample(datasets.sample("walk_curve_1"), 30)[50:60]
    second = resample(datasets.sample("walk_curve_2"), 30)[20:30]
    return first, second


def means(figure):
    marks = [line.get_xydata() for line in figure.axes[0].lines if line.get_marker() == "P"]
    return np.array([places[0] for places in marks if len(places)])


def left(figure):
    return float(figure.axes[0].get_title().rpartition(": ")[2].removesuffix(" cm RMS"))


def test_the_steps_show_means_centring_angle_and_shift(pair):
    figures = [diagrams.laying_on(*pair, step=step) for step in (1, 2, 3, 4)]
    own = [point_cloud(motion).mean(axis=(0, 1))[[0, 2]] for motion in pair]
    assert means(figures[0]) == pytest.approx(np.array(own))
    for figure in figures[1:3]:
        assert means(figure) == pytest.approx(np.zeros((2, 2)), abs=1e-9)
    assert means(figures[3]) == pytest.approx(np.array([own[0], own[0]]))


def test_what_is_left_in_the_end_is_what_align_leaves(pair):
    a, b = (point_cloud(motion).reshape(-1, 3) for motion in pair)
    best = 100 * np.sqrt(((a - align(a, b).apply_points(b)) ** 2).sum(-1).mean())
    lefts = [left(diagrams.laying_on(*pair, step=step)) for step in (1, 2, 3, 4)]
    assert lefts == sorted(lefts, reverse=True)
    assert lefts[2:] == pytest.approx([best, best], abs=0.05)


def test_the_curve_over_a_turn_has_one_valley_at_the_closed_form_and_the_dot_is_on_it(pair):
    a, b = (point_cloud(motion).reshape(-1, 3) for motion in pair)
    best = np.degrees(align(a, b).angle)

    def fitted(points, angle):
        turn = PlanarTransform(angle, 0.0, 0.0)
        return turn.apply_points(points) + (a.mean(0) - turn.apply_points(b).mean(0)) * [1, 0, 1]

    shown = diagrams.turning(*pair, fitted)(60)[0].figure
    curve, dot = shown.axes[1].lines
    angles, lefts = curve.get_xydata().T
    assert abs(angles[lefts.argmin()] - best) <= 3
    rising = np.diff(np.roll(lefts[:-1], -lefts.argmin())) > 0
    assert np.count_nonzero(np.diff(rising)) == 1  # up to one highest point, then down
    at, height = dot.get_xydata()[0]
    assert (at, height) == (60, lefts[angles == 60])
    assert shown.axes[0].get_title() == f"60°: {height:.1f} cm RMS"


def test_moved_by_hand_threads_and_the_distance_follow(pair):
    (ax,) = diagrams.laid(*pair, lambda points: points + np.array([0, 0, 3])).axes
    own = [point_cloud(motion).mean(axis=(0, 1))[[0, 2]] for motion in pair]
    assert means(ax.figure) == pytest.approx(np.array([own[0], own[1] + [0, 3]]))
    a, b = (point_cloud(motion) for motion in pair)
    assert left(ax.figure) == pytest.approx(
        100 * np.sqrt(((a - b - [0, 0, 3]) ** 2).sum(-1).mean()), abs=0.05
    )


def test_the_arrow_of_the_products_is_the_best_angle(pair):
    a, b = (point_cloud(motion).reshape(-1, 3) for motion in pair)
    (ax,) = diagrams.products(*pair).axes
    assert ax.get_title() == f"the sum leads at {np.degrees(align(a, b).angle):.0f}°".replace("-", "−")


CLIP = sample("walk_circle")
TARGET, MOVING = CLIP[:200], CLIP[400:600]
TRANSFORM = PlanarTransform(2.0, 1.5, -0.7)


def dots(ax):
    return [line.get_xydata()[0] for line in ax.lines if line.get_marker() == "o"]


@pytest.mark.parametrize("shift_first", [False, True])
def test_the_order_of_turn_and_shift_decides_on_the_place(shift_first):
    panels = alignment(TARGET, MOVING, TRANSFORM, shift_first=shift_first).axes
    turn, shift = PlanarTransform(TRANSFORM.angle, 0.0, 0.0), PlanarTransform(0.0, TRANSFORM.x, TRANSFORM.z)
    first, second = (shift, turn) if shift_first else (turn, shift)
    spot = MOVING.root_positions[0]
    wanted = [spot, first.apply_points(spot), second.apply_points(first.apply_points(spot))]
    assert [dots(ax)[0] for ax in panels] == [pytest.approx(TARGET.root_positions[-1, [0, 2]])] * 3
    assert all(ax.xaxis_inverted() for ax in panels)
    assert [dots(ax)[-1] for ax in panels] == [pytest.approx(point[[0, 2]]) for point in wanted]
    assert [("turned" in ax.get_title()) for ax in panels] == [False, not shift_first, shift_first]


def test_the_turn_leads_round_the_origin():
    way = next(line for line in alignment(TARGET, MOVING, TRANSFORM).axes[1].lines if line.get_ls() == "--")
    distances = np.linalg.norm(way.get_xydata(), axis=1)
    assert distances == pytest.approx(distances[0])


def arrows(ax):
    return [complex(*text.xy) for text in ax.texts if getattr(text, "arrow_patch", None)]


def test_a_heading_points_up_the_page_at_0_and_to_the_left_at_90():
    ax = Figure().add_subplot()
    compass({"ahead": 0.0, "left": np.pi / 2}, ax)
    assert arrows(ax) == pytest.approx([1j, -1], abs=1e-12)
    assert [text.get_text() for text in ax.texts if ":" in text.get_text()] == ["ahead: 0°", "left: 90°"]


@pytest.mark.parametrize("angle", [-170, 60])
def test_q_turns_by_a_half_and_q_bar_by_the_other_half_where_it_is_needed(angle):
    across, along = (arrows(ax) for ax in poses.half_turns(angle=angle).axes)
    half = np.exp(1j * np.radians(angle / 2))
    assert across == pytest.approx([0.8, 0.8 * half, 0.8 * half**2])
    assert along == pytest.approx([0.8j, 0.8j * half, 0.8j])


def test_the_numbers_above_are_those_of_the_products():
    text = poses.half_turns().get_suptitle()
    assert text.split("      ") == [
        "v = (0.00, 0.80, 0.00, 0.80)",
        "q v = (-0.40, 0.69, 0.40, 0.69)",
        "q v q̄ = (0.40, 0.69, 0.80)",
    ]


@pytest.mark.parametrize("step", [0, 1, 2])
def test_a_step_shows_one_product_more(step):
    figure = poses.half_turns(step)
    assert [len(arrows(ax)) for ax in figure.axes] == [step + 1, step + 1]
    assert figure.get_suptitle().count("=") == step + 1


def test_two_orders_of_the_same_turns_end_in_two_poses():
    figure = poses.turns_in_order(datasets.sample("walk_straight").skeleton, multiply)
    heads = [np.ravel(ax.lines[0].get_data_3d()) for ax in figure.axes]  # matplotlib's order: z, x, y
    assert len(heads) == 6
    assert heads[0] == pytest.approx(heads[3])
    assert heads[2][1] > 0.4  # face down, the head towards x
    assert heads[5][0] > 0.4  # on its side, the head towards z


WALK = datasets.sample("walk_straight")[100:120]


@pytest.mark.parametrize("joint", [0, 5, 37])
def test_the_joints_up_to_one_stand_where_the_package_puts_them(joint):
    code, ax = down_the_tree(WALK, 7)(joint)[0].figure.axes
    (dots,) = [line for line in ax.lines if line.get_linestyle() == "None" and line.get_markersize() == 4]
    across_and_up = joint_positions(WALK)[7, : joint + 1][:, [2, 1]]
    assert np.transpose(dots.get_data()) == pytest.approx(across_and_up)
    (bones,) = ax.collections
    assert (len(bones.get_segments()) > 0) == (joint > 0)
    ((low, high),) = [patch.get_bbox().intervaly for patch in code.patches]
    marked = [text.get_text().strip() for text in code.texts if low < text.get_position()[1] < high]
    assert marked[0].startswith("parent =" if joint else "places, turns =")
    assert len(marked) == (4 if joint else 1)  # the loop's second line stands on two


CORNER = GroundPath([[0, 0], [0, 3], [3, 3]])
CUT = arcs((0, 0), 0.0, [(1.5, 0), (0.75 * np.pi, np.pi / 2), (1.5, 0)])  # a quarter circle of 1.5 m
SAVED = 6 - CUT.length


@pytest.mark.parametrize("step", [0, 4, 8])
def test_a_thread_of_each_kind_at_every_moment_so_far(step):
    ground, curves = two_distances(CORNER, CUT)(step)[0].figure.axes
    threads = [line.get_xydata().reshape(-1, 16, 2)[:, :15] for line in ground.lines[2:5:2]]
    assert [len(some) for some in threads] == [step + 1] * 2
    for moment, thread in enumerate(threads[0]):  # at equal arc length
        along = CUT.length * moment / 8
        assert thread[[0, -1]] == pytest.approx(np.vstack([CUT.at([along]), CORNER.at([along])]), abs=1e-9)
    assert curves.lines[0].get_xdata().max() == pytest.approx(CUT.length * step / 8, abs=1e-9)


def test_behind_the_corner_one_distance_is_zero_and_the_other_what_was_saved():
    figure = two_distances(CORNER, CUT)()[0].figure
    even, near = figure.axes[1].lines[:2]
    assert near.get_ydata()[-1] == pytest.approx(0, abs=0.1)
    assert even.get_ydata()[-1] == pytest.approx(100 * SAVED, abs=0.1)
    assert near.get_ydata().max() == pytest.approx(100 * 1.5 * (1 - np.sqrt(0.5)), abs=1)
    labels = [text.get_text() for text in figure.axes[1].get_legend().get_texts()]
    assert labels == ["at equal arc length (Eq. 9)", "to the nearest point"]


def test_the_nearest_point_is_the_nearest():
    rng = np.random.default_rng(0)
    points = rng.uniform(-1, 4, (50, 2))
    fine = CORNER.resampled(0.001).points
    found = np.hypot(*(points - nearest_points(CORNER, points)).T)
    truth = np.hypot(*(points[:, None] - fine).transpose(2, 0, 1)).min(axis=1)
    assert found == pytest.approx(truth, abs=0.005)
