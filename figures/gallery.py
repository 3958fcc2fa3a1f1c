"""Draw the pictures of the README and of the notebooks' headers, all from the bundled clips.

`python figures/gallery.py` writes them as PNG files beside this script, from whichever folder it is run.

Each function draws one picture and returns its figure. `draw_all` writes them, and stores in each file what
was drawn as numbers, so that a test finds a stale picture, whichever version of matplotlib drew it.
"""

from __future__ import annotations

import itertools
import json
from collections.abc import Callable, Hashable, Sequence
from dataclasses import replace
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple

import matplotlib.pyplot as plt
import networkx as nx
import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.image import AxesImage
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle
from mpl_toolkits.mplot3d import Axes3D
from mpl_toolkits.mplot3d.art3d import Line3DCollection
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray
from PIL import Image
from walking import generate_walk

from mocap import (
    MocapError,
    Motion,
    Skeleton,
    blending,
    datasets,
    editing,
    feet,
    graphs,
    matching,
    plotting,
    resample,
    save,
    steering,
    synthesis,
)
from mocap.body import SHAPES, arcs, joint_positions, planar, rotations, spline, velocities
from mocap.body.euler import from_euler
from mocap.course import diagrams
from mocap.course.diagrams import pens
from mocap.course.diagrams.small_graphs import EIGHT_PLACES
from mocap.course.seam_trials import choose_matches, passage, walk_costs
from mocap.graphs import homework_graph
from mocap.methods import groups, match_webs, motion_matching, parametric_graphs
from mocap.methods.match_webs.local_alignment import apart
from mocap.methods.motion_matching.nearest_frames import foresee
from mocap.methods.motion_matching.pose_database import FUTURE, GROUPS, PoseDatabase
from mocap.methods.parametric_graphs.parametric_edges import ParametricEdge
from mocap.methods.parametric_graphs.stride_spaces import Space
from mocap.plotting import ASKED, COLOURS, CURVES, MARK, SOURCES
from mocap.plotting.bodies import bodies_along
from mocap.plotting.picture import legible, small_png
from mocap.synthesis.bounded_search import SearchResult

Array = NDArray[np.float64]
Indices = NDArray[np.intp]
Points = NDArray[np.complex128]  # z + ix, metres
Edge = tuple[Hashable, Hashable, int]
Place = tuple[float, float]

DENSE = ("skeleton", "segments", "motion_file", "components")  # with no room for larger names: on no slide
TITLE = (1168, 400)  # pixels of a picture on the first slide of a deck
WINDOW = 10  # frames at 30 Hz
WARPED = 238  # frame at 120 Hz: the key of the picture of warping
GOAL = -2 + 2j  # of the search with and without a lower bound, metres z + ix
STEPS = 6  # that it may take
STRIDE = 0.7  # metres
WALKS = ("walk_circle", "walk_curve_1", "walk_curve_2", "walk_straight")
SPEED = 1.0  # m/s, asked of motion matching
SEGMENT = 15  # whose transitions are drawn
BOX = 0.9  # width of the box of a segment; they are 1 apart
HALF_BOX = 0.42  # half its height


@cache
def _graph() -> graphs.MotionGraph:
    clips = [resample(datasets.sample(name), 30) for name in datasets.SAMPLES]
    return graphs.prune(graphs.build(clips, window=WINDOW, threshold=0.04))


def draw_walk() -> Figure:
    """Draw a new walk as bodies along its path, in the colours of the clips that it comes from."""
    graph = _graph()
    edges = synthesis.random_walk(graph, seconds=9, seed=1578)
    walk = synthesis.to_motion(graph, edges)
    seams = [seam.frame for seam in synthesis.seams(graph, edges)]
    return bodies_along(walk, sources=synthesis.sources(graph, edges), seams=seams)


def draw_skeleton() -> Figure:
    """Draw the bundled clips' body from the front, arms and toes spread, with the names of its joints."""
    body = datasets.sample("walk_straight").skeleton
    points = _spread_body(body)
    figure = plt.figure(figsize=(8, 6.4), layout="constrained")
    ax = figure.add_subplot()
    for start, end, side in zip(*plotting.bones(body), strict=True):
        ax.plot(*points[[start, end]].T, "o-", color=COLOURS[side], linewidth=3, markersize=5)
    for position in np.unique(points.round(6), axis=0):
        distances = np.abs(points - position).max(axis=1)
        names = [body.names[int(joint)] for joint in np.flatnonzero(distances < 1e-5)]
        _name_joints(ax, position, ", ".join(names))
    ax.set(aspect="equal", xlim=(-1.2, 1.2))
    ax.set_axis_off()
    return figure


def _spread_body(body: Skeleton) -> Array:
    """Compute where the joints are from the front, shape (J, 2), with arms and toes spread."""
    turns = np.tile(rotations.IDENTITY, (1, len(body), 1))
    for side, sign in (("l", 1), ("r", -1)):
        turns[0, body.index(f"{side}humerus")] = rotations.from_rotvec([0, 0, 1.75 * sign])
        turns[0, body.index(f"{side}femur")] = rotations.about_y(1.2 * sign)
        turns[0, body.index(f"{side}thumb")] = rotations.from_rotvec([0, 0, -0.8 * sign])
    pose = Motion(body, np.array([[0, 0.96, 0]]), turns, 1.0)
    return joint_positions(pose)[0, :, :2]


def _name_joints(ax: Axes, position: Array, names: str) -> None:
    """Write names beside a position: slanted above the arms and below the toes, level elsewhere."""
    x, y = position
    outward = 1 if x > -0.01 else -1
    across = 9  # points outwards
    lift = 0  # points upwards
    slant = 0  # degrees
    if names.endswith("humerus"):
        lift = -8
    elif abs(x) > 0.15:
        upward = 1 if y > 1 and not names.endswith("thumb_end") else -1
        across = 4
        lift = 8 * upward
        slant = 60 * upward * outward
    elif names.startswith("lowerneck"):
        lift = -9
    offset = (across * outward, lift)
    ax.annotate(
        names,
        (x, y),
        offset,
        textcoords="offset points",
        fontsize=9,
        ha="left" if outward > 0 else "right",
        va="center",
        rotation=slant,
        rotation_mode="anchor",
    )


def draw_segments() -> Figure:
    """Draw the homework's segments, a row of numbered boxes per clip, and the transitions of one of them.

    A transition leaves the end of a box and enters the start of another.
    """
    clips = [datasets.sample(name) for name in datasets.SAMPLES[:3]]
    graph = homework_graph.segment_graph(clips, threshold=250)
    clip_of = dict(graph.nodes(data="clip"))
    firsts = {clip: segment for segment, clip in reversed(clip_of.items())}
    places = {segment: (segment - firsts[clip], -2 * clip) for segment, clip in clip_of.items()}
    figure, ax = plt.subplots(figsize=(9, 4), layout="constrained")
    for segment, place in places.items():
        _draw_box(ax, place, str(segment), SOURCES[clip_of[segment]])
    for _, target, kind in graph.out_edges(SEGMENT, data="kind"):
        if kind == "transition":
            _draw_transition(ax, places[SEGMENT], places[target])
    ax.set_yticks([0, -2, -4], [clip.name for clip in clips])
    ax.set(xlim=(-0.5, max(x for x, _ in places.values()) + 1.5), ylim=(-5, 1))
    ax.set(xlabel="segment of the clip, in order")
    ax.spines[["top", "right", "left"]].set_visible(False)
    ax.tick_params(left=False)
    return figure


def _draw_box(ax: Axes, place: Place, number: str, colour: str) -> None:
    """Draw a numbered box; its place is the middle of its left side."""
    x, y = place
    corner = (x, y - HALF_BOX)
    box = Rectangle(corner, BOX, 2 * HALF_BOX, facecolor=colour, edgecolor="white", lw=0.5)
    ax.add_patch(box)
    ax.text(x + BOX / 2, y, number, ha="center", va="center", fontsize=9, color="white", zorder=4)


def _draw_transition(ax: Axes, source: Place, target: Place) -> None:
    """Draw an arrow from the end of a box to the start of another one above or below it."""
    x, y = source
    target_x, target_y = target
    down = 1 if target_y < y else -1
    tail = (x + BOX, y - down * HALF_BOX)
    tip = (target_x + 0.1, target_y + down * HALF_BOX)
    ax.plot(*zip(tail, tip, strict=True), color=MARK, linewidth=1.8, zorder=0.5)
    ax.plot(*tip, "v" if down > 0 else "^", color=MARK, markersize=6, zorder=3)


def draw_motion_file() -> Figure:
    """Draw a small BVH file, coloured by its parts, beside the leg that it describes."""
    leg = _swinging_leg()
    with TemporaryDirectory() as folder:
        path = Path(folder) / "leg.bvh"
        save(leg, path, precision=0)
        lines = path.read_text().splitlines()
    figure = plt.figure(figsize=(9.5, 4.2))
    _write_lines(figure.add_axes((0.01, 0, 0.55, 1)), lines)
    _draw_leg(figure.add_axes((0.69, 0.12, 0.30, 0.82)), leg)
    return figure


def _swinging_leg() -> Motion:
    """Make a leg of two bones that swings for three frames."""
    skeleton = Skeleton(
        ["hip", "knee", "knee_end"],
        [-1, 0, 1],
        [[0, 0, 0], [0, -0.45, 0], [0, -0.4, 0]],
        dofs=["xyz", "x", ""],
    )
    turns = np.tile(rotations.IDENTITY, (3, 3, 1))
    turns[:, 0] = from_euler("x", np.radians([[-15], [-25], [-35]]))
    turns[:, 1] = from_euler("x", np.radians([[0], [30], [60]]))
    hips = np.array([[0, 0.9, 0], [0, 0.9, 0.3], [0, 0.89, 0.6]])
    return Motion(skeleton, hips, turns, 30.0, "leg")


def _write_lines(ax: Axes, lines: list[str]) -> None:
    """Write the lines of a BVH file from top to bottom, channels and numbers in colours."""
    ax.set_axis_off()
    for number, line in enumerate(lines):
        colour = CURVES[1] if number > lines.index("MOTION") else COLOURS["middle"]
        colour = CURVES[0] if "CHANNELS" in line else colour
        height = 0.95 - 0.9 * number / (len(lines) - 1)
        spaced = line.replace("\t", "   ")
        ax.text(0, height, spaced, family="monospace", fontsize=9.4, color=colour, va="center")


def _draw_leg(ax: Axes, leg: Motion) -> None:
    """Draw the three frames of the leg from the side, and name its joints in the last one."""
    frames = joint_positions(leg)
    for number, (points, alpha) in enumerate(zip(frames, (0.35, 0.6, 1), strict=True), start=1):
        _, y, z = points.T
        ax.plot(z, y, "o-", color=CURVES[1], alpha=alpha, linewidth=3)
        ax.text(z[0], y[0] + 0.05, f"frame {number}", ha="center", fontsize=10)
    for name, (_, y, z) in zip(leg.skeleton.names, frames[-1], strict=True):
        ax.text(z + 0.06, y, name, va="center", fontsize=10)
    ax.set(aspect="equal", xlabel="z (m)", ylabel="y (m)", xlim=(-0.15, 1.15), ylim=(0, 1.05))
    ax.spines[["top", "right"]].set_visible(False)


def draw_nodes() -> Figure:
    """Draw two clips with nodes inserted where transitions leave and enter."""
    clips = [resample(datasets.sample(name), 30)[:240] for name in ("walk_circle", "walk_curve_1")]
    transitions = matching.find_transitions(clips, window=WINDOW, below=0.04)
    between_clips = [transition for transition in transitions if transition.source != transition.target]
    best = sorted(between_clips, key=lambda transition: transition.cost)[:8]
    figure = plt.figure(figsize=(8, 2.4), layout="constrained")
    ax = figure.add_subplot()
    graph = graphs.from_transitions(clips, best, window=WINDOW)
    plotting.timeline(graph, ax=ax).set(alpha=1, linewidths=1.6)
    for transition in best:
        goes_down = transition.source < transition.target
        seconds = (transition.enter + WINDOW) / 30  # it enters after its window
        height = -transition.target + (0.13 if goes_down else -0.13)
        ax.plot(seconds, height, "v" if goes_down else "^", color=MARK, markersize=8)
    return figure


def draw_clouds() -> Figure:
    """Draw a window of ten frames, with a point on each joint of each frame."""
    clip = resample(datasets.sample("walk_curve_1"), 30)
    figure = diagrams.window_cloud(clip[100 : 100 + WINDOW], step=3)
    figure.axes[0].set_title("")
    return figure


def draw_distances() -> Figure:
    """Draw the distance image of two clips with its minima."""
    first, second = (resample(datasets.sample(name), 30)[:300] for name in ("walk_curve_1", "walk_curve_2"))
    grid = matching.distance_grid(first, second, window=WINDOW)
    minima = matching.local_minima(grid, 0.05**2)
    names = (first.name, second.name)
    plotting.distance_image(grid, fps=30, minima=minima, names=names)
    return plt.gcf()


def draw_most_pairs() -> Figure:
    """Draw the lower bound of pairs of windows against their RMS distance, and the few below 4 cm."""
    clips = [resample(datasets.sample(name), 30)[:300] for name in ("walk_curve_1", "walk_curve_2")]
    clouds = [matching.point_cloud(clip) for clip in clips]
    first, second = (_heights_and_radii(cloud) for cloud in clouds)
    bound = 100 * np.linalg.norm(first[:, None] - second, axis=-1)
    rms = 100 * np.sqrt(matching.distance_grid(*clouds, window=WINDOW)[::8, ::8])
    figure = plt.figure(figsize=(6, 4), layout="constrained")
    ax = figure.add_subplot()
    for pairs, colour in ((bound > 4, plotting.QUIET), (bound <= 4, CURVES[0])):
        ax.plot(rms[pairs], bound[pairs], ".", color=colour, markersize=4)
    ax.axline((0, 0), slope=1, color=ASKED, linewidth=1)
    ax.axhline(4, color=CURVES[1])
    ax.axvline(4, color=CURVES[1], linestyle=":")
    ax.set(xlabel="RMS distance (cm)", ylabel="lower bound (cm)", xlim=(0, None), ylim=(0, None))
    return figure


def _heights_and_radii(cloud: Array) -> Array:
    """List what no rigid transform of the ground changes, a row for every eighth window of a clip's points.

    These are the points' heights and their distances from the vertical axis through their mean, divided so
    that the distance between two rows is a lower bound of the windows' RMS distance.
    """
    windows = sliding_window_view(cloud, WINDOW, axis=0)[::8].transpose(0, 3, 1, 2)
    ground = windows[..., [0, 2]]
    radii = np.linalg.norm(ground - ground.mean(axis=(1, 2), keepdims=True), axis=-1)
    heights = windows[..., 1]
    heights, radii = np.stack([heights, radii]).reshape(2, len(windows), -1)
    return np.hstack([heights, radii]) / np.sqrt(radii.shape[1])


def draw_pruning() -> Figure:
    """Draw the graph of eight nodes before and after pruning."""
    graph = graphs.notes_example()
    pruned = graphs.prune_graph(graph).graph
    figure = plt.figure(figsize=(8, 3.4), layout="constrained")
    whole_axes, pruned_axes = figure.subplots(1, 2)
    plotting.node_link(graph, positions=EIGHT_PLACES, ax=whole_axes)
    plotting.node_link(graph, positions=EIGHT_PLACES, kept=pruned, ax=pruned_axes)
    whole_axes.set_title("before pruning", y=0.94)
    pruned_axes.set_title("after: 4 is a sink, 5 a dead end", y=0.94)
    return figure


def draw_components() -> Figure:
    """Draw a graph of four clips before and after pruning, where the threshold is low."""
    clips = [resample(datasets.sample(name), 30) for name in datasets.SAMPLES[3:]]
    whole = graphs.build(clips, window=WINDOW, threshold=0.012)
    stages = {"before": whole, "after": graphs.prune(whole)}
    figure, axes = plt.subplots(2, 1, figsize=(7, 7.2), sharex=True, layout="constrained")
    for ax, (stage, graph) in zip(axes, stages.items(), strict=True):
        plotting.timeline(graph, ax=ax).set(alpha=0.8, linewidths=1.0)
        ax.set_title(f"{stage}: {len(graph.graph)} nodes, {graph.count('transition')} transitions")
    return figure


def draw_path() -> Figure:
    """Draw a path that was asked for, black, and the walk that follows it, yellow, with its footprints."""
    path = SHAPES["figure of eight"]()
    walk = steering.follow_path(_graph(), path).motion()
    walked, _ = plotting.path_from_above(walk)
    walked.set_label("walked")
    plt.plot(*path.points.T, color=plotting.ASKED, linewidth=5, alpha=0.85, zorder=1, label="asked for")
    plt.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2, frameon=False)
    for step in feet.find_footprints(walk):
        size = 12 + 40 * (1 - np.exp(-(step.end - step.start) / 60))
        look = {"facecolors": COLOURS[step.side], "alpha": 0.6, "linewidths": 0, "zorder": 3}
        plt.scatter(step.x, step.z, s=size, **look)
    return plt.gcf()


def draw_seam() -> Figure:
    """Draw the feet's heights across the seams of a walk."""
    graph = _graph()
    edges = synthesis.random_walk(graph, seconds=6, seed=3)
    walk = synthesis.to_motion(graph, edges)
    ankles = [walk.skeleton.index(name) for name in ("lfoot", "rfoot")]
    heights = 100 * joint_positions(walk)[:, ankles, 1]
    seams = [(seam.frame, seam.frame + WINDOW) for seam in synthesis.seams(graph, edges)]
    curves = plotting.joint_curve(heights, fps=30)
    for curve, side in zip(curves, ("left", "right"), strict=True):
        curve.set(color=COLOURS[side], label=f"{side} ankle")
    ax = curves[0].axes
    for start, end in np.array(seams) / 30:
        ax.axvspan(start, end, color=MARK, alpha=0.25, linewidth=1)
    ax.set_ylabel("height (cm)")
    ax.legend(frameon=False, loc="lower center", bbox_to_anchor=(0.5, 1), ncols=2)
    return plt.gcf()


def draw_feet() -> Figure:
    """Draw the toes across a seam, blended and cleaned up: over the ground, and their speed."""
    first, second = (datasets.sample(name) for name in ("walk_curve_1", "walk_curve_2"))
    joined = blending.join(first, 1908, second, 874, 40)[1748:2168]
    toes = joined.skeleton.index("rtoes")
    figure = plt.figure(figsize=(9, 3.2), layout="constrained")
    ground, speed = figure.subplots(1, 2, width_ratios=[1, 1.6])
    speed.axvspan(0, 40 / 120, color=MARK, alpha=0.15)
    for motion, name, colour in (
        (joined, "blended", CURVES[1]),
        (feet.clean_up(joined), "cleaned up", CURVES[0]),
    ):
        places = 100 * joint_positions(motion)[:, toes, [0, 2]]
        seconds = (np.arange(len(places)) - 160) / 120
        stands = motion.contacts["rtoes"]
        standing = (seconds > -0.2) & (seconds < 0.6) & stands
        centre = places[standing].mean(axis=0)
        ground.plot(*(places[standing] - centre).T, ".-", color=colour, label=name)
        speed.plot(seconds, np.linalg.norm(velocities(places, 120), axis=1), color=colour, label=name)
    ground.set(xlabel="x (cm)", ylabel="z (cm)", aspect="equal", title="the standing toes, from above")
    ground.margins(0.15)
    ground.set_xlim(2, -2)
    speed.set(xlim=(-0.8, 1.2), ylim=(0, 80), xlabel="seconds from the start of the seam")
    speed.set(ylabel="speed (cm/s)", title="the toes over time")
    speed.legend(frameon=False, loc="upper left")
    return figure


def draw_match() -> Figure:
    """Draw one pose of two clips: as they are, and the second aligned with the first."""
    circle, curve = (resample(datasets.sample(name), 30) for name in ("walk_circle", "walk_curve_1"))
    first = circle[300:450]
    second = curve[450:600]
    grid = matching.distance_grid(first, second, window=WINDOW)
    i, j = (int(start) for start in np.unravel_index(grid.argmin(), grid.shape))
    still = first[i : i + WINDOW]
    moving = second[j : j + WINDOW]
    fit = matching.align(*(joint_positions(window).reshape(-1, 3) for window in (still, moving)))
    figure = plt.figure(figsize=(8, 4.2))
    _draw_two_poses(figure, 0, (still, moving), 2.6).set_title("as the clips are")
    _draw_two_poses(figure, 1, (still, fit.apply_motion(moving)), 0.9).set_title("aligned")
    return figure


def _draw_two_poses(figure: Figure, panel: int, windows: tuple[Motion, Motion], reach: float) -> Axes3D:
    """Draw the middle poses of two windows in panel 0 or 1, with the ground `reach` metres around them."""
    poses = [joint_positions(window)[WINDOW // 2] for window in windows]
    ax: Axes3D = figure.add_axes((panel / 2, 0, 0.5, 0.92), projection="3d")
    middle = np.mean([pose[0, [0, 2]] for pose in poses], axis=0)
    plotting.ground_axes(middle, reach, ax=ax)
    ax.set_box_aspect((2 * reach, 2 * reach, 1.9), zoom=1.3)
    for window, pose, colour in zip(windows, poses, SOURCES, strict=False):
        plotting.StickFigure(window.skeleton, ax, 0.8, colour).pose(pose)
    return ax


def draw_angles() -> Figure:
    """Draw the short turn between two headings, and the turn by the means of their angles."""
    figure = Figure(figsize=(7, 4.4), layout="constrained")
    slerp_axes, mean_axes = figure.subplots(1, 2)
    _draw_turn(slerp_axes, 20.0, CURVES[0])
    _draw_turn(mean_axes, -340.0, CURVES[1])
    slerp_axes.set_title("slerp:\n20° to the left")
    mean_axes.set_title("mean of the angles:\n340° to the right")
    return figure


def _draw_turn(ax: Axes, turn: float, colour: str) -> None:
    """Draw arrows that turn from the heading 170° by some degrees, in ten steps."""
    for share in np.linspace(0, 1, 11):
        tip = 1j * np.exp(1j * np.radians(170 + share * turn))
        pens.arrow(ax, 0j, tip, COLOURS["middle"] if share in (0, 1) else colour)
    for place, heading in ((1.2j, "0°"), (-1.2j, "±180°"), (-1.25 + 0j, "90°"), (1.25 + 0j, "−90°")):
        pens.say(ax, place, heading, color=COLOURS["middle"], fontsize=9)
    ax.set(xlim=(-1.5, 1.5), ylim=(-1.4, 1.4), aspect="equal")
    ax.set_axis_off()


def draw_dying_walks() -> Figure:
    """Draw random walks on the homework's graph as rows; at the threshold 185, most of them die."""
    clips = [datasets.sample(name) for name in datasets.SAMPLES[3:]]
    graph = homework_graph.segment_graph(clips, threshold=185)
    odds = nx.to_numpy_array(graph, weight="probability")
    costs = np.zeros_like(odds)
    for leave, enter, cost in graph.edges(data="cost", default=0):
        costs[leave, enter] = cost
    rows = walk_costs(odds, costs)
    ax = plt.figure(figsize=(8, 3.6), layout="constrained").add_subplot()
    image = plotting.walk_rows(rows, highest=185, ax=ax)
    ax.figure.colorbar(image, ax=ax, label="D of a transition")
    played_on = Patch(color=plotting.FLOOR, label="the clip goes on")
    ended = Patch(facecolor="white", edgecolor=plotting.QUIET, label="the walk has ended")
    ax.legend(handles=[played_on, ended], frameon=False, loc="lower center", bbox_to_anchor=(0.5, 1), ncols=2)
    return plt.gcf()


def draw_added() -> Figure:
    """Draw what a short blend of two windows that hardly match adds to the jolts of their clips."""
    clips = [resample(datasets.sample(name), 30) for name in ("sneak", "stop_and_go")]
    transitions = matching.find_transitions(clips, window=WINDOW, below=0.09)
    (match,) = choose_matches(clips, transitions, (0.08, 0.09), count=1)
    return diagrams.added_by_blend()(passage(clips, match, 6))[0].figure


def draw_search() -> Figure:
    """Draw the eight nodes, the best walk from 6 to 2, and the tree of all walks that the search has met."""
    return diagrams.search_steps(graphs.notes_example(), 6, 2)(99)[0].figure


def draw_bound() -> Figure:
    """Draw a search for a goal behind the start, without a lower bound and with one."""
    figure = plt.figure(figsize=(10, 4.6), layout="constrained")
    plain_axes, bounded_axes = figure.subplots(1, 2)
    plain = _draw_goal_search(plain_axes, lambda walker: 0.0)
    bounded = _draw_goal_search(bounded_axes, _least_residual)
    plain_axes.set_title(f"without a lower bound:\n{plain.expanded} walks expanded", fontsize=11)
    bounded_axes.set_title(f"with a lower bound:\n{bounded.expanded} walks expanded", fontsize=11)
    handles, labels = bounded_axes.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=3, frameon=False)
    return figure


class Walker(NamedTuple):
    """A walker's position z + ix, heading in radians, and number of steps so far."""

    position: complex
    heading: float
    steps: int


def _take_step(walker: Walker, edge: Edge) -> Walker:
    """Turn by -30°, 0° or 30°, for the edge's key 0, 1 or 2, and make a step."""
    heading = walker.heading + np.pi / 6 * (edge[2] - 1)
    position = walker.position + STRIDE * np.exp(1j * heading)
    return Walker(position, heading, walker.steps + 1)


def _step_cost(edge: Edge, walker: Walker) -> float:
    """Compute the cost of a step that ends here: for a turn, and after the last step for the residual."""
    turning = 0.02 * abs(edge[2] - 1)
    residual = abs(walker.position - GOAL) ** 2 if walker.steps == STEPS else 0.0
    return turning + residual


def _least_residual(walker: Walker) -> float:
    """Bound the last step's residual from below: all steps that remain go straight to the goal."""
    remaining = STEPS - walker.steps
    if not remaining:
        return 0.0
    return max(0.0, abs(walker.position - GOAL) - STRIDE * remaining) ** 2


def _draw_goal_search(ax: Axes, bound: Callable[[Walker], float]) -> SearchResult:
    """Search for the best walk to the goal; draw it from above, and all steps that were tried."""
    tried: list[Any] = []

    def step(walker: Walker, edge: Edge) -> tuple[float, Walker]:
        stepped = _take_step(walker, edge)
        tried.append(np.array([walker.position, stepped.position]))
        cost = _step_cost(edge, stepped) + bound(stepped) - bound(walker)
        return cost, stepped

    graph = nx.MultiDiGraph([("left", "right")] * 3 + [("right", "left")] * 3)
    nx.set_edge_attributes(graph, 18, "frames")
    problem = synthesis.Problem(graph, step, lambda walker: walker.steps == STEPS)
    start = Walker(0j, 0.0, 0)
    result = synthesis.branch_and_bound(problem, "left", start)
    walkers = itertools.accumulate(result.walk, _take_step, initial=start)
    walk = np.array([walker.position for walker in walkers])
    diagrams.from_above([walk], tried=tried, goal=GOAL, ax=ax)
    return result


def draw_steered() -> Figure:
    """Draw the path of a steered walk, with an arrow wherever a new heading was commanded."""
    headings = np.repeat([0.0, np.pi / 2, np.pi / 6, np.pi, np.pi / 2], 105)
    steered = steering.steer(steering.Controller(_graph()), headings).motion
    figure = plt.figure(figsize=(8, 4.2), layout="constrained")
    ax = figure.add_subplot()
    plotting.path_from_above(steered, ax=ax)
    arrow = {"color": ASKED, "width": 2, "headwidth": 9}
    for frame in range(0, len(headings), 105):
        x, _, z = steered.root_positions[frame]
        tip = _ahead((x, z), headings[frame], 0.9)
        ax.annotate("", tip, (x, z), arrowprops=arrow)
        ax.plot(*zip((x, z), tip, strict=True), color=ASKED, linewidth=0)  # the axes make room for lines only
    ax.plot([], [], color=ASKED, linewidth=3, label="a heading that\nis commanded")
    ax.legend(frameon=False, loc="center left", bbox_to_anchor=(1, 0.5))
    return figure


def _ahead(start: Place, heading: float, metres: float) -> Place:
    """Go straight from a place (x, z) in the direction of a heading, and return where that ends."""
    x, z = start
    return x + metres * np.sin(heading), z + metres * np.cos(heading)


def draw_bent() -> Figure:
    """Draw a walk that was straight, laid on a line that winds."""
    walk = resample(datasets.sample("walk_straight"), 30)[:210]
    line = editing.start_at(spline([[0, 0], [0, 1], [1.6, 3], [-0.4, 5], [0.6, 7]]), editing.ride_of(walk))
    return bodies_along(editing.bend(walk, line).motion, path=line.points)


def draw_levels() -> Figure:
    """Draw a walk over a stone, before and after the edit, and what each level of splines leaves."""
    walk = datasets.sample("walk_straight")[100:600]
    start, stop = feet.runs(walk.contacts["ltoes"])[1].tolist()
    pins = _raised_step(walk, start, stop)
    figure = plt.figure(figsize=(9, 3.2), layout="constrained")
    side, curve = figure.subplots(1, 2, width_ratios=[1.6, 1])
    frames = range(start - 80, stop + 90, 60)
    plotting.flat_bodies(walk, frames, alpha=0.25, ax=side)
    plotting.flat_bodies(editing.edit(walk, pins), frames, ax=side)
    toes = joint_positions(walk)[start:stop, walk.skeleton.index("ltoes"), 2].mean()
    side.add_patch(Rectangle((toes - 0.22, 0), 0.36, 0.3, color=plotting.FLOOR, zorder=0))
    _, levels = editing.hierarchy(walk, pins)
    numbers = range(1, 1 + len(levels))
    curve.semilogy(numbers, [1000 * level.rms for level in levels], "o-", color=CURVES[0])
    curve.set(xlabel="level", ylabel="left to the pins (mm)", title="from coarse to fine")
    curve.set_xticks(numbers)
    return figure


def _raised_step(walk: Motion, start: int, stop: int) -> editing.Pins:
    """Hold the planted feet of a walk, the left one in the frames [start, stop) 30 cm higher."""
    pins = editing.plant_pins(walk)
    names = [walk.skeleton.names[joint] for joint in pins.joints]
    is_left = np.isin(names, ("lfoot", "ltoes"))
    up = np.zeros(pins.low.shape)
    up[start:stop, is_left, 1] = 0.3
    return editing.Pins(pins.joints, pins.low + up, pins.high + up)


def draw_registration() -> Figure:
    """Draw the path of time through a grid, and a walk to the left and one to the right with their blend."""
    figure = plt.figure(figsize=(9, 3.9), layout="constrained")
    grid_axes, ground = figure.subplots(1, 2)
    _draw_time_path(grid_axes)
    _draw_blends(ground)
    return figure


def _draw_time_path(ax: Axes) -> None:
    """Draw how the frames of a slow and a brisk walk belong together, over the grid of their distances."""
    slow, brisk = (generate_walk([[0, 0], [0, 5]], speed=speed, seed=1) for speed in (0.8, 1.4))
    grid = np.sqrt(matching.distance_grid(resample(slow, 30), resample(brisk, 30), window=5))
    path = matching.time_path(grid, slack=36)
    plotting.distance_image(grid**2, fps=30, minima=path, names=("slow walk", "brisk walk"), ax=ax)
    registered = blending.register([slow, brisk])
    moments = np.linspace(*registered.span, 200)
    half_window = 0.05  # seconds: the axes show starts of windows, the curve their middles
    slow_times = moments - half_window
    brisk_times = registered.times[1](moments) - half_window
    ax.plot(brisk_times, slow_times, color="black", linewidth=4)
    ax.plot(brisk_times, slow_times, color="white", linewidth=2)
    ax.set_title("which frame belongs to which")


def _draw_blends(ax: Axes) -> None:
    """Draw from above a walk to the left, one to the right, and three blends of them."""
    lines = [arcs((0.0, 0.0), 0.0, [(5.0, np.radians(turn))]).points[::20] for turn in (120, -120)]
    registered = blending.register([generate_walk(line, speed=1.1, seed=1) for line in lines])
    colours = [SOURCES[0], *[plotting.PATH] * 3, SOURCES[1]]
    for share, colour in zip(np.linspace(0, 1, 5), colours, strict=True):
        blend = blending.mix(registered, [1 - share, share])
        plotting.path_from_above(planar.place(blend, 0.0, [0, 0]), colour=colour, ax=ax)
    ax.set(title="left, right, and three blends of them")


def draw_match_webs() -> Figure:
    """Draw paths along the valleys of two walks, and a space of walking cycles with three targets."""
    figure = plt.figure(figsize=(9.4, 3.9), layout="constrained")
    valleys, cycles = figure.subplots(1, 2)
    walks = []
    for speed, turn in itertools.product((0.8, 1.1, 1.4), (-150, 0, 150)):
        line = arcs((0, 0), 0, [(6, np.radians(turn))]).points
        walks.append(generate_walk(line, speed=speed, seed=len(walks)))
    _draw_valleys(valleys, slow=walks[1], brisk=walks[-1])
    _draw_cycles(cycles, walks)
    return figure


def _draw_valleys(ax: Axes, *, slow: Motion, brisk: Motion) -> None:
    """Draw the grid of two walks with the paths along its valleys."""
    slow_start, brisk_start = (resample(walk, 30)[:130] for walk in (slow, brisk))
    grid = np.sqrt(matching.distance_grid(slow_start, brisk_start, window=5))
    costs = grid - 0.12 + np.where(match_webs.minima_1d(grid), 0, 0.06)
    paths = apart(match_webs.local_paths(costs, least=9), near=3)
    plotting.distance_image(grid**2, fps=30, ax=ax)
    for path in paths:
        rows, columns = path.T
        ax.plot((columns + 0.5) / 30, (rows + 0.5) / 30, color=plotting.PATH, linewidth=2)
    ax.set(xlabel="brisk walk (s)", ylabel="slow walk (s)", title="paths of similar frames")


def _draw_cycles(ax: Axes, walks: list[Motion]) -> None:
    """Draw the turns and speeds of walking cycles and of their blends, and three targets with their results.

    The cycles are the matches of one from the middle walk.
    """
    middle = len(walks) // 2
    web = match_webs.build_web(walks, below=0.08)
    start, stop = feet.runs(walks[middle].contacts["lfoot"])[1:3, 0].tolist()
    matches = match_webs.search(web, middle, slice(start, stop), lengths=(0.6, 1.6))
    cycles = blending.register([match_webs.cut_out(web, match) for match in matches], slack=0)
    space = match_webs.sample_space(cycles, _turn_and_speed, scale=(10, 0.1))
    examples, blends = np.split(np.asarray(space.values), [len(matches)])
    ax.scatter(*blends.T, s=8, color=plotting.QUIET)
    ax.scatter(*examples.T, s=42, color=plotting.COLOURS["middle"])
    targets = [(20, 1.0), (-25, 1.3), (60, 1.5)]
    weights = [match_webs.weights_for(space, target) for target in targets]
    results = [_turn_and_speed(match_webs.blend_of(cycles, row)) for row in weights]
    _draw_errors(ax, np.array(targets), np.array(results))
    ax.set(xlabel="turn of a cycle (degrees)", ylabel="speed (m/s)", title="asked and got")


def _turn_and_speed(cycle: Motion) -> tuple[float, float]:
    """Measure by how many degrees a cycle turns to the left, and its mean speed in m/s."""
    return np.degrees(match_webs.heading_change(cycle)), match_webs.mean_speed(cycle)


def _draw_errors(ax: Axes, targets: Array, results: Array) -> None:
    """Draw targets as crosses, results as dots, both shape (N, 2), and arrows from targets to results."""
    ax.scatter(*targets.T, s=70, color=plotting.ASKED, marker="+", zorder=3)
    units = {"angles": "xy", "scale_units": "xy", "scale": 1}  # arrows end where they point to
    ax.quiver(*targets.T, *(results - targets).T, color=plotting.PATH, width=0.008, **units)
    ax.scatter(*results.T, s=26, color=plotting.PATH, zorder=3)


def draw_parametric_graph() -> Figure:
    """Draw the costs of one stride after another, the boxes, and what may follow a straight stride."""
    clips = [resample(datasets.sample(name), 30) for name in WALKS]
    strides = parametric_graphs.cut_strides(clips)
    space = parametric_graphs.make_space(strides, np.radians(14), -np.radians(75), np.radians(75))
    edge = parametric_graphs.build_edge(space, space, good=0.03)
    figure, (costs, ground) = plt.subplots(1, 2, figsize=(9.4, 3.9), layout="constrained")
    _draw_stride_costs(costs, space, edge)
    _draw_next_strides(ground, space, edge)
    return figure


def _draw_stride_costs(ax: Axes, space: Space, edge: ParametricEdge) -> None:
    """Draw the cost of each stride after each other one, by their turns, and the boxes of an edge."""
    turns = np.radians(np.linspace(-75, 75, 61))[:, None]
    costs = 100 * parametric_graphs.optimal_transitions(space, space, turns, turns)[0]
    look = {"cmap": "cividis", "interpolation": "nearest", "aspect": "auto", "origin": "lower"}
    image = ax.imshow(costs.T, extent=(-75, 75, -75, 75), **look)
    boxes = [edge.look_up(turn) for turn in turns]
    sides = np.degrees([(box.low[0], box.high[0]) for box in boxes])
    ax.plot(np.degrees(turns), sides, color=MARK, linewidth=2)
    ax.figure.colorbar(image, ax=ax, label="cost (cm)", shrink=0.9)
    ax.set(xlabel="turn of a stride (degrees)", ylabel="turn of the next one (degrees)")


def _draw_next_strides(ax: Axes, space: Space, edge: ParametricEdge) -> None:
    """Draw from above a straight stride, and seven that may follow it."""
    box = edge.look_up(np.zeros(1))
    turns = np.array([0.0, *np.linspace(box.low[0], box.high[0], 7)])
    weights = match_webs.weights_for(space, turns[:, None])
    ground, _ = parametric_graphs.mixed_trajectory(space.examples, weights)
    first, last = space.examples.ends
    straight, *followers = ground[:, first : last + 1]
    ax.plot(-straight.imag, straight.real, color=ASKED, linewidth=3, label="a straight stride")
    for number, follower in enumerate(followers):
        path = follower + straight[-1]
        label = None if number else "may follow it"
        ax.plot(-path.imag, path.real, color=CURVES[0], linewidth=2, label=label)
    ax.set(aspect="equal", xlabel="to the right (m)", ylabel="ahead (m)", xlim=(-1.3, 1.1))
    ax.legend(frameon=False, loc="lower center", bbox_to_anchor=(0.5, 1))


def draw_motion_matching() -> Figure:
    """Draw the futures of the frames that fit best, and a walk in the colours of its clips, with its cuts."""
    clips = [resample(datasets.sample(name), 30) for name in WALKS]
    table = motion_matching.tabulate(clips)
    clip_of = np.repeat(np.arange(len(clips)), [len(clip) for clip in clips])
    figure = plt.figure(figsize=(9, 3.6), layout="constrained")
    futures, ground = figure.subplots(1, 2, width_ratios=(1, 1.8))
    _draw_futures(futures, table, clip_of)
    _draw_matched_walk(ground, table, clip_of)
    return figure


def _draw_matched_walk(ax: Axes, table: PoseDatabase, clip_of: Indices) -> None:
    """Draw from above a walk with five commanded headings, in the colours of its clips, with its cuts."""
    headings = np.repeat([-1.6, -0.5, -2.6, -0.6, -2.0], 75)
    matcher = motion_matching.MotionMatcher(table)
    roots = []
    clips_played = []
    for heading in headings:
        pose = matcher.step(heading, SPEED)
        roots.append(pose.root_position)
        clips_played.append(clip_of[matcher.frame])
    x, _, z = np.array(roots).T
    for clip, name in enumerate(WALKS):
        for first, stop in feet.runs(np.array(clips_played) == clip):
            stretch = slice(first, stop + 1)
            ax.plot(x[stretch], z[stretch], color=SOURCES[clip], linewidth=3)
        ax.plot([], [], color=SOURCES[clip], linewidth=3, label=name)
    ax.plot(x[matcher.cuts], z[matcher.cuts], "D", color=MARK, markersize=4, label="cuts")
    arrow = {"color": ASKED, "width": 1.5, "headwidth": 8}
    for frame in range(0, len(headings), 75):
        start = (x[frame], z[frame])
        ax.annotate("", _ahead(start, headings[frame], 0.8), start, arrowprops=arrow)
    ax.set(aspect="equal", xlabel="x (m)", ylabel="z (m)")
    ax.xaxis.set_inverted(True)
    ax.legend(frameon=False, fontsize=8, loc="upper center", bbox_to_anchor=(0.5, 1.5), ncols=3)


def _draw_futures(ax: Axes, table: PoseDatabase, clip_of: Indices) -> None:
    """Draw the future asked for, a turn to the left, and those of the five frames that fit best."""
    playing = 600  # a frame
    query = table.values[playing].copy()
    query[FUTURE] = foresee(table, playing, SPEED * np.exp(1j * np.pi / 3), 0.27)
    ax.plot(*_path_ahead(table, table.values[playing]).T, "--", color=plotting.QUIET, markersize=4)
    for frame in _nearest_frames(table, query, playing):
        path = _path_ahead(table, table.values[frame])
        ax.plot(*path.T, "o-", color=SOURCES[clip_of[frame]], markersize=4)
    ax.plot(*_path_ahead(table, query)[1:].T, "o", color=ASKED, label="asked for")
    ax.set(xticks=[0.5, 0, -0.5], yticks=[0, 0.5])
    ax.set(aspect="equal", xlabel="to the left (m)", ylabel="ahead (m)", xlim=(0.7, -0.5), ylim=(-0.1, 0.95))
    ax.legend(frameon=False, fontsize=8)


def _nearest_frames(table: PoseDatabase, query: Array, playing: int) -> list[int]:
    """Find the five frames nearest to a query, more than five frames from each other and from `playing`."""
    distances = ((table.values - query) ** 2).sum(axis=1)
    costs = np.where(table.usable, distances, np.inf)
    frames = [playing]
    for _ in range(5):
        neighbours = slice(max(frames[-1] - 5, 0), frames[-1] + 6)
        costs[neighbours] = np.inf
        frames.append(int(costs.argmin()))
    return frames[1:]


def _path_ahead(table: PoseDatabase, row: Array) -> Array:
    """Compute from a row of features where the body is now and after 1/3, 2/3 and 1 s, shape (4, 2)."""
    metres = row * table.scale + table.mean
    places = metres[GROUPS["places ahead"]].reshape(-1, 2)
    return np.vstack([[0, 0], places])


def draw_groups() -> Figure:
    """Draw who stands for whom in two groups; and a group that was planned beside one that is steered."""
    figure, (match, plan, steered) = plt.subplots(1, 3, figsize=(10, 4.4), width_ratios=(1.2, 1, 1))
    figure.set_layout_engine("constrained")
    graph = groups.build_group(12)
    first, second = (graph.nodes[node].positions[:7] for node in (0, 3))
    _draw_group_match(match, first, second)
    rocks = [(rock, 1.3) for rock in (12 - 2.5j, 12, 12 + 2.5j, 9.5 - 3.6j, 9.5 + 3.6j)]
    scene = groups.Scene((20 + 0j,), tuple(rocks))
    walk = groups.plan_group(graph, scene)
    frames = round(walk.seconds * groups.RATE) + 1
    planned_paths = groups.play_group(graph, walk.clips).positions[:frames]
    steered_paths = groups.steer_group(graph.nodes[0], scene, limit=20)[0].positions
    for ax, paths in ((plan, planned_paths), (steered, steered_paths)):
        plotting.draw_group_plan(paths, scene.points, scene.discs, ax=ax)
        ax.set(xlim=(10, -10), ylim=(-3, 23), ylabel="")
    plan.set_title("planned to goal 1")
    steered.set_title("steered to goal 1")
    return figure


def _draw_group_match(ax: Axes, first: Points, second: Points) -> None:
    """Draw two groups of members at z + ix, with a line between any two that match."""
    velocities = np.ones(len(first), complex)
    pair = [groups.Configuration(places, velocities) for places in (first, second)]
    order = groups.compare(*pair).order
    for member, partner in zip(first, second[order], strict=True):
        x = [member.imag, partner.imag]
        z = [member.real, partner.real]
        ax.plot(x, z, color=SOURCES[0], linewidth=2, zorder=1)
    ax.plot(first.imag, first.real, "o", color=SOURCES[0], markersize=10)
    ax.plot(second.imag, second.real, "o", color=ASKED, markerfacecolor="white", markersize=10)
    ax.set(aspect="equal", xlabel="x (m)", ylabel="z (m)", title="who stands for whom?")
    ax.xaxis.set_inverted(True)


def draw_warping() -> Figure:
    """Draw a hand that reaches for a post by one key, and a jump that is 20 cm higher."""
    walk = datasets.sample("walk_straight")[:480]
    jump = datasets.sample("jump")
    post = joint_positions(walk)[WARPED, walk.skeleton.index("rhand")] + [-0.15, 0.30, 0.15]
    figure, (walk_axes, jump_axes) = plt.subplots(2, 1, figsize=(8.4, 5.2), layout="constrained")
    walk_frames = range(WARPED - 80, WARPED + 81, 20)
    _draw_edit(walk_axes, walk, _reaching(walk, post), walk_frames)
    _draw_edit(jump_axes, jump, _higher(jump), (60, 150, 190, 208, 222, 238, 253, 267, 290, 400))
    column = walk_frames.index(WARPED)
    across = 0.9 * column + post[2] - walk.root_positions[WARPED, 2]
    walk_axes.plot(across, post[1], "o", color=ASKED, markersize=8)
    return figure


def _reaching(walk: Motion, post: Array) -> Motion:
    """Edit a walk so that its right hand reaches a post, shape (3,)."""
    pose = editing.posed(walk, WARPED, {"rhand": post})
    keys = editing.keys_around(walk, [editing.Key(WARPED, pose)])
    return editing.displaced(walk, editing.offsets(walk, keys))


def _higher(jump: Motion) -> Motion:
    """Raise a jump's highest frame by 20 cm, and keep the frames before take-off and after landing."""
    apex = int(jump.root_positions[:, 1].argmax())
    pose = jump[apex : apex + 1]
    raised = replace(pose, root_positions=pose.root_positions + np.array([[0, 0.2, 0]]))
    keys = [editing.Key(208, flat=True), editing.Key(apex, raised), editing.Key(267, flat=True)]
    return editing.displaced(jump, editing.offsets(jump, keys))


def _draw_edit(ax: Axes, motion: Motion, edited: Motion, frames: Sequence[int]) -> None:
    """Draw frames of a motion as ghosts behind those of the edited motion, in a row."""
    columns = range(len(frames))
    plotting.flat_bodies(_side_by_side(motion, frames, 0.9), columns, alpha=0.25, ax=ax)
    plotting.flat_bodies(_side_by_side(edited, frames, 0.9), columns, alpha=1.0, ax=ax)
    ax.axhline(0, color=plotting.QUIET, linewidth=1)
    ax.set_axis_off()


def _side_by_side(motion: Motion, frames: Sequence[int], metres: float) -> Motion:
    """Put some poses of a motion in a row along z."""
    roots = motion.root_positions[list(frames)].copy()
    roots[:, 2] += metres * np.arange(len(frames)) - roots[:, 2]
    turned = motion.rotations[list(frames)]
    return Motion(motion.skeleton, roots, turned, motion.fps)


def draw_retargeted() -> Figure:
    """Draw an adult's walk, the same walk on a child, and how far the child's standing ball strays."""
    walk = datasets.sample("walk_straight")[:360]
    adult = editing.stance_of(walk)
    child = editing.proportioned(adult, legs=0.55, trunk=0.62, arms=0.58, head=0.85)
    retargeted = editing.retarget(walk, child, adult)
    naive = replace(walk, skeleton=child.skeleton)
    figure = plt.figure(figsize=(9, 3.6), layout="constrained")
    bodies, errors = figure.subplots(1, 2, width_ratios=[1.5, 1])
    for motion, up in ((walk, 0.0), (retargeted, -1.35)):
        lifted = replace(motion, root_positions=motion.root_positions + np.array([0, up, 0]))
        plotting.flat_bodies(lifted, range(20, 360, 45), ax=bodies)
        bodies.axhline(up, color=plotting.QUIET, linewidth=1)
    bodies.set(xlim=(-0.5, 4.4), ylim=(-1.45, 1.8), yticks=[], ylabel="", title="one walk, two bodies")
    first, stop = feet.runs(walk.contacts["ltoes"])[1]
    seconds = np.arange(first, stop) / walk.fps
    errors.plot(seconds, _strays(retargeted[first:stop]), color=CURVES[0], label="retargeted")
    errors.plot(seconds, _strays(naive[first:stop]), color=CURVES[1], label="the same numbers")
    errors.set(xlabel="seconds", ylabel="cm from its mean place", title="the child's standing left ball")
    errors.set_ylim(-1, 16)
    errors.legend(frameon=False)
    return figure


def _strays(motion: Motion) -> Array:
    """Measure in each frame how far the left ball is from its mean place, in cm."""
    positions = joint_positions(motion)[:, motion.skeleton.index("ltoes")]
    return 100 * np.linalg.norm(positions - positions.mean(axis=0), axis=1)


# reads: statement: a table of the pictures' names and functions
PICTURES: dict[str, Callable[[], Figure]] = {
    "walk": draw_walk,
    "skeleton": draw_skeleton,
    "segments": draw_segments,
    "motion_file": draw_motion_file,
    "nodes": draw_nodes,
    "clouds": draw_clouds,
    "distances": draw_distances,
    "most_pairs": draw_most_pairs,
    "pruning": draw_pruning,
    "components": draw_components,
    "path": draw_path,
    "steered": draw_steered,
    "bent": draw_bent,
    "search": draw_search,
    "bound": draw_bound,
    "seam": draw_seam,
    "feet": draw_feet,
    "match": draw_match,
    "angles": draw_angles,
    "retargeted": draw_retargeted,
    "dying_walks": draw_dying_walks,
    "added": draw_added,
    "warping": draw_warping,
    "levels": draw_levels,
    "registration": draw_registration,
    "match_webs": draw_match_webs,
    "groups": draw_groups,
    "parametric_graph": draw_parametric_graph,
    "motion_matching": draw_motion_matching,
}


def draw_all(folder: Path) -> list[Path]:
    """Draw every picture anew, as a PNG with its `fingerprint` inside.

    Parameters
    ----------
    folder : where to write; it must exist.

    Returns
    -------
    The files.
    """
    written = []
    with plt.rc_context({"figure.dpi": 110}):
        for name, draw in PICTURES.items():
            figure = draw() if name in DENSE else legible(draw(), TITLE)
            written.append(folder / f"{name}.png")
            written[-1].write_bytes(small_png(figure, Description=json.dumps(fingerprint(figure))))
            plt.close(figure)
    return written


def fingerprint(figure: Figure) -> dict[str, list[float]]:
    """Sum up what a figure's lines and images show: how many numbers, their mean, their deviation."""
    sums = {}
    artists = [artist for axes in figure.axes for artist in axes.get_children()]
    for kind in (Line2D, LineCollection, Line3DCollection, AxesImage):
        drawn = [np.ravel(part) for artist in artists if type(artist) is kind for part in _parts(artist)]
        numbers = np.concatenate([*drawn, np.zeros(0)])
        if numbers.size:
            mean_and_deviation = np.round([numbers.mean(), numbers.std()], 4)
            sums[kind.__name__] = [len(numbers), *mean_and_deviation.tolist()]
    return sums


def _parts(artist: Artist) -> Sequence[Any]:
    """List the arrays that a line, a collection of lines, or an image draws."""
    match artist:
        case Line2D():
            return [artist.get_xydata()]
        case Line3DCollection():
            return artist._segments3d
        case LineCollection():
            return artist.get_segments()
        case AxesImage():
            return [artist.get_array()]
    return []


def drawn_in(path: Path) -> dict[str, list[float]]:
    """Read the fingerprint from a picture that `draw_all` wrote.

    Raises
    ------
    MocapError : for a file that is missing or has no fingerprint.
    """
    try:
        with Image.open(path) as picture:
            text = picture.info["Description"]
    except (OSError, KeyError) as error:
        raise MocapError(f"{path} is no picture of `python figures/gallery.py`.") from error
    return dict(json.loads(text))


if __name__ == "__main__":
    for picture in draw_all(Path(__file__).parent):
        print(f"wrote {picture}")
