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
from typing import Any

import matplotlib.pyplot as plt
import networkx as nx
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.image import AxesImage
from matplotlib.lines import Line2D
from matplotlib.patches import Rectangle
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
from mocap.methods.motion_matching.pose_database import PoseDatabase
from mocap.plotting import ASKED, COLOURS, CURVES, MARK, SOURCES
from mocap.plotting.bodies import bodies_along
from mocap.plotting.picture import legible, small_png

Array = NDArray[np.float64]
Edge = tuple[Hashable, Hashable, int]

DENSE = ("skeleton", "segments", "motion_file", "components")  # with no room for larger names: on no slide
TITLE = (1168, 400)  # pixels of a picture on the first slide of a deck
WINDOW = 10  # frames at 30 Hz
WARPED = 238  # frame at 120 Hz: the key of the picture of warping


@cache
def _graph() -> graphs.MotionGraph:
    clips = [resample(datasets.sample(name), 30) for name in datasets.SAMPLES]
    return graphs.prune(graphs.build(clips, window=WINDOW, threshold=0.04))


def draw_walk() -> Figure:
    """Draw a new walk as bodies along its path, in the colours of the clips that it comes from."""
    graph = _graph()
    edges = synthesis.random_walk(graph, seconds=9, seed=3515)
    walk = synthesis.to_motion(graph, edges)
    seams = [seam.frame for seam in synthesis.seams(graph, edges)]
    return bodies_along(walk, sources=synthesis.sources(graph, edges), seams=seams)


def draw_skeleton() -> Figure:
    """Draw the bundled clips' body from the front, arms and toes spread, with the names of its joints."""
    body = datasets.sample("walk_straight").skeleton
    turns = np.tile(rotations.IDENTITY, (1, len(body), 1))
    for side, sign in (("l", 1), ("r", -1)):
        turns[0, body.index(f"{side}humerus")] = rotations.from_rotvec([0, 0, 1.75 * sign])
        turns[0, body.index(f"{side}femur")] = rotations.about_y(1.2 * sign)
        turns[0, body.index(f"{side}thumb")] = rotations.from_rotvec([0, 0, -0.8 * sign])
    points = joint_positions(Motion(body, np.array([[0, 0.96, 0]]), turns, 1.0))[0, :, :2]
    figure = plt.figure(figsize=(8, 6.4), layout="constrained")
    ax = figure.add_subplot()
    for start, end, side in zip(*plotting.bones(body), strict=True):
        ax.plot(*points[[start, end]].T, "o-", color=COLOURS[side], linewidth=3, markersize=5)
    for place in np.unique(points.round(6), axis=0):
        here = np.flatnonzero(np.abs(points - place).max(axis=1) < 1e-5)
        _name_joints(ax, place, ", ".join(body.names[int(joint)] for joint in here))
    ax.set(aspect="equal", xlim=(-1.2, 1.2))
    ax.set_axis_off()
    return figure


def _name_joints(ax: Axes, place: Array, names: str) -> None:
    """Write names beside a place: slanted above the arms and below the toes, level elsewhere."""
    x, y = place
    away = 1 if x > -0.01 else -1
    up, slant = -9 * names.startswith("lowerneck"), 0
    if names.endswith("humerus"):
        up = -8
    elif abs(x) > 0.15:
        above = 1 if y > 1 and not names.endswith("thumb_end") else -1
        up, slant = 8 * above, 60 * above * away
    ax.annotate(
        names,
        (x, y),
        (4 * away if slant else 9 * away, up),
        textcoords="offset points",
        fontsize=9,
        ha="left" if away > 0 else "right",
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
    nodes, wide, high = dict(graph.nodes(data=True)), 0.9, 0.42
    firsts = {part["clip"]: node for node, part in reversed(nodes.items())}
    at = {node: (node - firsts[part["clip"]], -2 * part["clip"]) for node, part in nodes.items()}
    figure, ax = plt.subplots(figsize=(9, 4), layout="constrained")
    for node, (x, y) in at.items():
        colour = SOURCES[nodes[node]["clip"]]
        ax.add_patch(Rectangle((x, y - high), wide, 2 * high, facecolor=colour, edgecolor="white", lw=0.5))
        ax.text(x + wide / 2, y, str(node), ha="center", va="center", fontsize=7, color="white", zorder=4)
    for _, there, kind in graph.out_edges(15, data="kind"):
        if kind == "transition":
            (x, y), (to, below) = at[15], at[there]
            down = 1 if below < y else -1
            ends = [(x + wide, y - down * high), (to + 0.1, below + down * high)]
            ax.plot(*zip(*ends, strict=True), color=MARK, linewidth=1.8, zorder=0.5)
            ax.plot(*ends[1], "v" if down > 0 else "^", color=MARK, markersize=6, zorder=3)
    ax.set_yticks([0, -2, -4], [clip.name for clip in clips])
    ax.set(xlim=(-0.5, max(x for x, _ in at.values()) + 1.5), ylim=(-5, 1))
    ax.set(xlabel="segment of the clip, in order")
    ax.spines[["top", "right", "left"]].set_visible(False)
    ax.tick_params(left=False)
    return figure


def draw_motion_file() -> Figure:
    """Draw a small BVH file, coloured by its parts, beside the leg that it describes."""
    skeleton = Skeleton(
        ["hip", "knee", "knee_end"],
        [-1, 0, 1],
        [[0, 0, 0], [0, -0.45, 0], [0, -0.4, 0]],
        dofs=["xyz", "x", ""],
    )
    turns = np.tile(rotations.IDENTITY, (3, 3, 1))
    turns[:, 0] = from_euler("x", np.radians([[-15], [-25], [-35]]))
    turns[:, 1] = from_euler("x", np.radians([[0], [30], [60]]))
    leg = Motion(skeleton, np.array([[0, 0.9, 0], [0, 0.9, 0.3], [0, 0.89, 0.6]]), turns, 30.0, "leg")
    with TemporaryDirectory() as folder:
        save(leg, Path(folder) / "leg.bvh", precision=0)
        lines = (Path(folder) / "leg.bvh").read_text().splitlines()
    figure = plt.figure(figsize=(9.5, 4.2))
    text, ax = figure.add_axes((0.01, 0, 0.55, 1)), figure.add_axes((0.64, 0.12, 0.35, 0.82))
    text.set_axis_off()
    for number, line in enumerate(lines):
        colour = CURVES[1] if number > lines.index("MOTION") else COLOURS["middle"]
        colour = CURVES[0] if "CHANNELS" in line else colour
        place = (0, 0.95 - 0.9 * number / (len(lines) - 1))
        text.text(
            *place, line.replace("\t", "   "), family="monospace", fontsize=8.5, color=colour, va="center"
        )
    for number, points in enumerate(joint_positions(leg)):
        ax.plot(points[:, 2], points[:, 1], "o-", color=CURVES[1], alpha=(0.35, 0.6, 1)[number], linewidth=3)
        ax.text(points[0, 2], points[0, 1] + 0.05, f"frame {number + 1}", ha="center", fontsize=10)
    for name, (z, y) in zip(skeleton.names, joint_positions(leg)[-1][:, [2, 1]], strict=True):
        ax.text(z + 0.06, y, name, va="center", fontsize=10)
    ax.set(aspect="equal", xlabel="z (m)", ylabel="y (m)", xlim=(-0.15, 1.15), ylim=(0, 1.05))
    ax.spines[["top", "right"]].set_visible(False)
    return figure


def draw_nodes() -> Figure:
    """Draw two clips with nodes inserted where transitions leave and enter."""
    clips = [resample(datasets.sample(name), 30)[:240] for name in ("walk_circle", "walk_curve_1")]
    found = matching.find_transitions(clips, window=WINDOW, below=0.04)
    best = sorted((t for t in found if t.source != t.target), key=lambda t: t.cost)[:8]
    figure = plt.figure(figsize=(8, 2.4), layout="constrained")
    graph = graphs.from_transitions(clips, best, window=WINDOW)
    arcs = plotting.timeline(graph, ax=figure.add_subplot())
    arcs.set(alpha=1, linewidths=1.6)
    for t in best:  # a transition enters after its window
        marker = "v" if t.source < t.target else "^"
        height = -t.target + (0.13 if t.source < t.target else -0.13)
        arcs.axes.plot((t.enter + WINDOW) / 30, height, marker, color=MARK, markersize=8)
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
    points = [matching.point_cloud(clip) for clip in clips]
    rows = []
    for each in points:
        windows = sliding_window_view(each, WINDOW, axis=0)[::8].transpose(0, 3, 1, 2)
        ground = windows[..., [0, 2]]
        radii = np.linalg.norm(ground - ground.mean(axis=(1, 2), keepdims=True), axis=-1)
        numbers = np.stack([windows[..., 1], radii]).reshape(2, len(windows), -1)
        rows.append(np.hstack([*numbers]) / np.sqrt(radii[0].size))
    bound = 100 * np.linalg.norm(rows[0][:, None] - rows[1], axis=-1)
    rms = 100 * np.sqrt(matching.distance_grid(*points, window=WINDOW)[::8, ::8])
    figure = plt.figure(figsize=(6, 4), layout="constrained")
    ax = figure.add_subplot()
    for looked_at, colour in ((bound > 4, plotting.QUIET), (bound <= 4, CURVES[0])):
        ax.plot(rms[looked_at], bound[looked_at], ".", color=colour, markersize=4)
    ax.axline((0, 0), slope=1, color=ASKED, linewidth=1)
    ax.axhline(4, color=CURVES[1])
    ax.axvline(4, color=CURVES[1], linestyle=":")
    ax.set(xlabel="RMS distance (cm)", ylabel="lower bound (cm)", xlim=(0, None), ylim=(0, None))
    return figure


def draw_pruning() -> Figure:
    """Draw the graph of eight nodes before and after pruning."""
    graph, places = graphs.notes_example(), EIGHT_PLACES
    figure = plt.figure(figsize=(8, 3.4), layout="constrained")
    before, after = figure.subplots(1, 2)
    plotting.node_link(graph, places=places, ax=before)
    plotting.node_link(graph, places=places, kept=graphs.prune_graph(graph).graph, ax=after)
    before.set_title("before pruning", y=0.94)
    after.set_title("after: 4 is a sink, 5 a dead end", y=0.94)
    return figure


def draw_components() -> Figure:
    """Draw a graph of four clips before and after pruning, where the threshold is low."""
    clips = [resample(datasets.sample(name), 30) for name in datasets.SAMPLES[3:]]
    whole = graphs.build(clips, window=WINDOW, threshold=0.018)
    figure, axes = plt.subplots(2, 1, figsize=(7, 7.2), sharex=True, layout="constrained")
    for ax, graph, when in zip(axes, (whole, graphs.prune(whole)), ("before", "after"), strict=True):
        plotting.timeline(graph, ax=ax).set(alpha=0.8, linewidths=1.0)
        ax.set_title(f"{when}: {len(graph.graph)} nodes, {graph.count('transition')} transitions")
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
    first, second = (datasets.sample(name)[:720] for name in ("walk_curve_1", "walk_curve_2"))
    joined = blending.join(first, 553, second, 407, 40)[393:813]
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
    ground.xaxis.set_inverted(True)
    ground.margins(0.15)
    speed.set(xlim=(-0.8, 1.2), ylim=(0, 80), xlabel="seconds from the start of the seam")
    speed.set(ylabel="speed (cm/s)", title="the toes over time")
    speed.legend(frameon=False, loc="upper left")
    return figure


def draw_match() -> Figure:
    """Draw one pose of two clips: as they are, and the second aligned with the first."""
    clips = [resample(datasets.sample(name), 30) for name in ("walk_circle", "walk_curve_1")]
    first, second = clips[0][300:450], clips[1][450:600]
    grid = matching.distance_grid(first, second, window=WINDOW)
    i, j = np.unravel_index(grid.argmin(), grid.shape)
    windows = first[int(i) : int(i) + WINDOW], second[int(j) : int(j) + WINDOW]
    fit = matching.align(*(joint_positions(window).reshape(-1, 3) for window in windows))
    figure = plt.figure(figsize=(8, 4.2))
    for panel, moving in enumerate((windows[1], fit.apply_motion(windows[1]))):
        poses = [joint_positions(motion)[WINDOW // 2] for motion in (windows[0], moving)]
        ax: Axes3D = figure.add_axes((panel / 2, 0, 0.5, 0.92), projection="3d")
        reach = 2.6 - 1.7 * panel
        plotting.ground_axes(np.mean([pose[0, [0, 2]] for pose in poses], axis=0), reach, ax=ax)
        ax.set_box_aspect((2 * reach, 2 * reach, 1.9), zoom=1.3)
        for pose, colour in zip(poses, SOURCES, strict=False):
            plotting.StickFigure(first.skeleton, ax, 0.8, colour).pose(pose)
        ax.set_title(("as the clips are", "aligned")[panel])
    return figure


def draw_angles() -> Figure:
    """Draw the short turn between two headings, and the turn by the means of their angles."""
    figure = Figure(figsize=(7, 3.7), layout="constrained")
    ways = {"slerp": (20.0, CURVES[0]), "mean of the angles": (-340.0, CURVES[1])}
    for (name, (turn, colour)), ax in zip(ways.items(), figure.subplots(1, 2), strict=True):
        for share in np.linspace(0, 1, 11):
            tip = 1j * np.exp(1j * np.radians(170 + share * turn))
            pens.arrow(ax, 0j, tip, COLOURS["middle"] if share in (0, 1) else colour)
        for place, word in ((1.2j, "0°"), (-1.2j, "±180°"), (-1.25 + 0j, "90°"), (1.25 + 0j, "−90°")):
            pens.say(ax, place, word, color=COLOURS["middle"], fontsize=9)
        ax.set(xlim=(-1.5, 1.5), ylim=(-1.4, 1.4), aspect="equal")
        ax.set_axis_off()
        ax.set_title(f"{name}: {abs(turn):.0f}° to the {'left' if turn >= 0 else 'right'}", fontsize=11)
    return figure


def draw_dying_walks() -> Figure:
    """Draw random walks on the homework's graph as rows; at the threshold 185, more than half of them die."""
    graph = homework_graph.segment_graph(
        [datasets.sample(name) for name in datasets.SAMPLES[:3]], threshold=185
    )
    odds = nx.to_numpy_array(graph, weight="probability")
    costs = np.zeros_like(odds)
    for leave, enter, cost in graph.edges(data="cost", default=0):
        costs[leave, enter] = cost
    rows = walk_costs(odds, costs)
    ax = plt.figure(figsize=(8, 3.6), layout="constrained").add_subplot()
    image = plotting.walk_rows(rows, highest=185, ax=ax)
    ax.figure.colorbar(image, ax=ax, label="D of a transition")
    return plt.gcf()


def draw_added() -> Figure:
    """Draw what a short blend of two windows that hardly match adds to the jolts of their clips."""
    clips = [resample(datasets.sample(name), 30) for name in ("sneak", "stop_and_go")]
    found = matching.find_transitions(clips, window=WINDOW, below=0.09)
    (match,) = choose_matches(clips, found, (0.08, 0.09), count=1)
    return diagrams.added_by_blend()(passage(clips, match, 6))[0].figure


def _steps(*, price: Callable[[complex, int, int], float], count: int) -> synthesis.Problem:
    """Make a search for steps that turn by -30°, 0° or 30°; `price` gets the place, steps made, and turn."""
    graph = nx.MultiDiGraph([("left", "right")] * 3 + [("right", "left")] * 3)
    nx.set_edge_attributes(graph, 18, "frames")

    def step(state: tuple[complex, float, int], edge: Edge) -> tuple[float, Any]:
        at, heading, made = state
        heading += np.pi / 6 * (edge[2] - 1)
        at += 0.7 * np.exp(1j * heading)
        return price(at, made + 1, edge[2] - 1), (at, heading, made + 1)

    return synthesis.Problem(graph, step, lambda state: state[2] == count)


def draw_search() -> Figure:
    """Draw the eight nodes, the best walk from 6 to 2, and the tree of all walks that the search has met."""
    return diagrams.search_steps(graphs.notes_example(), 6, 2)(99)[0].figure


def draw_bound() -> Figure:
    """Draw a search for a goal behind the start, without a lower bound and with one."""
    goal, count = -2 + 2j, 6
    plain = _steps(price=lambda *_: 0.0, count=count)

    def draw(bounded: bool, ax: Axes) -> None:
        tried: list[Any] = []

        def ahead(at: complex, made: int) -> float:
            return max(0.0, abs(at - goal) - 0.7 * (count - made)) ** 2 * (bounded and made < count)

        def step(state: tuple[complex, float, int], edge: Edge) -> tuple[float, Any]:
            _, after = plain.step(state, edge)
            left = abs(after[0] - goal) ** 2 if after[2] == count else 0.0
            turning = 0.02 * abs(edge[2] - 1)
            tried.append(np.array([state[0], after[0]]))
            return turning + left + ahead(after[0], after[2]) - ahead(state[0], state[2]), after

        start = (0j, 0.0, 0)
        found = synthesis.branch_and_bound(synthesis.Problem(plain.graph, step, plain.done), "left", start)
        states = [start]
        for edge in found.walk:
            states.append(plain.step(states[-1], edge)[1])
        diagrams.from_above([np.array([at for at, *_ in states])], tried=tried, goal=goal, ax=ax)
        how = "with a lower bound" if bounded else "without a lower bound"
        ax.set_title(f"{how}:\n{found.expanded} walks expanded", fontsize=11)

    figure = plt.figure(figsize=(10, 4.6), layout="constrained")
    axes = figure.subplots(1, 2)
    for ax, bounded in zip(axes, (False, True), strict=True):
        draw(bounded, ax)
    figure.legend(*axes[1].get_legend_handles_labels(), loc="outside lower center", ncols=3, frameon=False)
    return figure


def draw_steered() -> Figure:
    """Draw the path of a steered walk, with an arrow wherever a new heading was commanded."""
    headings = np.repeat([0.0, np.pi / 2, np.pi / 6, np.pi, np.pi / 2], 105)
    steered = steering.steer(steering.Controller(_graph()), headings).motion
    figure = plt.figure(figsize=(8, 4.2), layout="constrained")
    ax = figure.add_subplot()
    plotting.path_from_above(steered, ax=ax)
    for frame in range(0, len(headings), 105):
        x, _, z = steered.root_positions[frame]
        way = np.array([np.sin(headings[frame]), np.cos(headings[frame])])
        ax.annotate("", (x, z) + 0.9 * way, (x, z), arrowprops={"color": ASKED, "width": 2, "headwidth": 9})
        ax.plot(*np.array([(x, z), (x, z) + 0.9 * way]).T, color=ASKED, linewidth=0)
    return figure


def draw_bent() -> Figure:
    """Draw a walk that was straight, laid on a line that winds."""
    walk = resample(datasets.sample("walk_straight"), 30)[:210]
    line = editing.start_at(spline([[0, 0], [0, 1], [1.6, 3], [-0.4, 5], [0.6, 7]]), editing.ride_of(walk))
    return bodies_along(editing.bend(walk, line).motion, path=line.points)


def draw_levels() -> Figure:
    """Draw a walk over a stone, before and after the edit, and what each level of splines leaves."""
    walk = datasets.sample("walk_straight")[100:600]
    start, stop = feet.runs(walk.contacts["ltoes"])[1].tolist()
    names, pins = walk.skeleton.names, editing.plant_pins(walk)
    left = np.array([names[joint] in ("lfoot", "ltoes") for joint in pins.joints])
    up = np.zeros(pins.low.shape)
    up[start:stop, left, 1] = 0.3
    pins = editing.Pins(pins.joints, pins.low + up, pins.high + up)
    figure = plt.figure(figsize=(9, 3.2), layout="constrained")
    side, curve = figure.subplots(1, 2, width_ratios=[1.6, 1])
    frames = range(start - 80, stop + 90, 60)
    plotting.flat_bodies(walk, frames, alpha=0.25, ax=side)
    plotting.flat_bodies(editing.edit(walk, pins), frames, ax=side)
    toes = joint_positions(walk)[start:stop, names.index("ltoes"), 2].mean()
    side.add_patch(Rectangle((toes - 0.22, 0), 0.36, 0.3, color=plotting.FLOOR, zorder=0))
    _, levels = editing.hierarchy(walk, pins)
    curve.semilogy(range(1, 1 + len(levels)), [1000 * level.rms for level in levels], "o-", color=CURVES[0])
    curve.set(xlabel="level", ylabel="left to the pins (mm)", title="from coarse to fine")
    curve.set_xticks(range(1, 1 + len(levels)))
    return figure


def draw_registration() -> Figure:
    """Draw the path of time through a grid, and a walk to the left and one to the right with their blend."""
    figure = plt.figure(figsize=(9, 3.9), layout="constrained")
    grid_axes, ground = figure.subplots(1, 2)
    slow, brisk = (generate_walk([[0, 0], [0, 5]], speed=speed, seed=1) for speed in (0.8, 1.4))
    grid = np.sqrt(matching.distance_grid(resample(slow, 30), resample(brisk, 30), window=5))
    found, names = blending.register([slow, brisk]), ("slow walk", "brisk walk")
    path, moments = matching.time_path(grid, slack=36), np.linspace(*found.span, 200)
    plotting.distance_image(grid**2, fps=30, minima=path, names=names, ax=grid_axes)
    for colour, wide in (
        ("black", 4),
        ("white", 2),
    ):  # 0.05 s: the axes show starts of windows, S their middles
        grid_axes.plot(found.times[1](moments) - 0.05, moments - 0.05, color=colour, linewidth=wide)
    grid_axes.set_title("which frame belongs to which")
    turns = [arcs((0.0, 0.0), 0.0, [(5.0, np.radians(turn))]).points[::20] for turn in (120, -120)]
    both = blending.register([generate_walk(path, speed=1.1, seed=1) for path in turns])
    blends = [blending.mix(both, [1 - share, share]) for share in np.linspace(0, 1, 5)]
    placed = [planar.place(blend, 0.0, [0, 0]) for blend in blends]
    for way, colour in zip(placed, [SOURCES[0], *[plotting.PATH] * 3, SOURCES[1]], strict=True):
        plotting.path_from_above(way, colour=colour, ax=ground)
    ground.set(title="left, right, and three blends of them")
    return figure


def draw_match_webs() -> Figure:
    """Draw paths along the valleys of two walks, and a space of walking cycles with three wishes."""
    figure = plt.figure(figsize=(9.4, 3.9), layout="constrained")
    left, right = figure.subplots(1, 2)
    walks = [
        generate_walk(arcs((0, 0), 0, [(6, np.radians(turn))]).points, speed=speed, seed=seed)
        for seed, (speed, turn) in enumerate(itertools.product((0.8, 1.1, 1.4), (-150, 0, 150)))
    ]
    slow, brisk = (resample(walks[n], 30)[:130] for n in (1, 8))
    grid = np.sqrt(matching.distance_grid(slow, brisk, window=5))
    costs = grid - 0.12 + np.where(match_webs.minima_1d(grid), 0, 0.06)
    paths = apart(match_webs.local_paths(costs, least=9), near=3)
    plotting.distance_image(grid**2, fps=30, ax=left)
    for way in paths:
        left.plot(*(way[:, ::-1].T + 0.5) / 30, color=plotting.PATH, linewidth=2)
    left.set(xlabel="brisk walk (s)", ylabel="slow walk (s)", title="paths of similar frames")
    web = match_webs.build_web(walks, below=0.08)
    start, stop = feet.runs(walks[4].contacts["lfoot"])[1:3, 0].tolist()
    found = match_webs.search(web, 4, slice(start, stop), lengths=(0.6, 1.6))
    cycles = blending.register([match_webs.cut_out(web, match) for match in found], slack=0)

    def gait(motion: Motion) -> tuple[float, float]:
        return np.degrees(match_webs.turn(motion)), match_webs.mean_speed(motion)

    space = match_webs.sample_space(cycles, gait, scale=(10, 0.1))
    wishes = [(20, 1.0), (-25, 1.3), (60, 1.5)]
    got = [gait(match_webs.blend_of(cycles, match_webs.weights_for(space, wish))) for wish in wishes]
    across, up = np.asarray(space.values).T
    right.scatter(across[len(found) :], up[len(found) :], s=8, color=plotting.QUIET)
    right.scatter(across[: len(found)], up[: len(found)], s=42, color=plotting.COLOURS["middle"])
    asked, given = np.transpose(wishes), np.transpose(got)
    right.scatter(*asked, s=70, color=plotting.ASKED, marker="+", zorder=3)
    right.quiver(
        *asked, *(given - asked), color=plotting.PATH, angles="xy", scale_units="xy", scale=1, width=0.008
    )
    right.scatter(*given, s=26, color=plotting.PATH, zorder=3)
    right.set(xlabel="turn of a cycle (degrees)", ylabel="speed (m/s)", title="asked and got")
    return figure


def draw_parametric_graph() -> Figure:
    """Draw the costs of one stride after another, the boxes, and what may follow a straight stride."""
    names = ("walk_circle", "walk_curve_1", "walk_curve_2", "walk_straight")
    strides = parametric_graphs.cut_strides([resample(datasets.sample(name), 30) for name in names])
    space = parametric_graphs.make_space(strides, np.radians(14), -np.radians(75), np.radians(75))
    edge = parametric_graphs.build_edge(space, space, good=0.03)
    turns = np.radians(np.linspace(-75, 75, 61))[:, None]
    costs = 100 * parametric_graphs.optimal_transitions(space, space, turns, turns)[0]
    ways = [edge.look_up(turn) for turn in turns]
    boxes = np.degrees([(way.low[0], way.high[0]) for way in ways])
    figure, (left, right) = plt.subplots(1, 2, figsize=(9.4, 3.9), layout="constrained")
    look = {"cmap": "cividis", "interpolation": "nearest", "aspect": "auto", "origin": "lower"}
    image = left.imshow(costs.T, extent=(-75, 75, -75, 75), **look)
    left.plot(np.degrees(turns), boxes, color=MARK, linewidth=2)
    figure.colorbar(image, ax=left, label="cost (cm)", shrink=0.9)
    left.set(xlabel="turn of a stride (degrees)", ylabel="turn of the next one (degrees)")
    straight = edge.look_up(np.zeros(1))
    first, last = strides.ends
    follow = np.linspace(straight.low[0], straight.high[0], 7)[:, None]
    ground, _ = parametric_graphs.mixed_way(
        strides, match_webs.weights_for(space, np.concatenate([[[0.0]], follow]))
    )
    ground = ground[:, first : last + 1]
    right.plot(-ground[0].imag, ground[0].real, color=ASKED, linewidth=3, label="a straight stride")
    for number, way in enumerate(ground[1:] + ground[0, -1]):
        label = "may follow it" if not number else None
        right.plot(-way.imag, way.real, color=CURVES[0], linewidth=2, label=label)
    right.set(aspect="equal", xlabel="to the right (m)", ylabel="ahead (m)", xlim=(-1.3, 1.1))
    right.legend(frameon=False, loc="lower center", bbox_to_anchor=(0.5, 1))
    return figure


def draw_motion_matching() -> Figure:
    """Draw the futures of the frames that fit best, and a walk in the colours of its clips, with its cuts."""
    names = ("walk_circle", "walk_curve_1", "walk_curve_2", "walk_straight")
    clips = [resample(datasets.sample(name), 30) for name in names]
    table = motion_matching.tabulate(clips)
    clip_of = np.repeat(np.arange(len(clips)), [len(clip) for clip in clips])
    figure, (ahead, ground) = plt.subplots(
        1, 2, figsize=(9, 3.6), width_ratios=(1, 1.8), layout="constrained"
    )
    _draw_futures(ahead, table, clip_of)
    headings = np.repeat([-1.6, -0.5, -2.6, -0.6, -2.0], 75)
    character, frames = motion_matching.MotionMatcher(table), []
    for heading in headings:
        pose = character.step(heading, 0.8)
        frames.append((*pose.root_position[[0, 2]], character.frame))
    x, z, played = np.array(frames).T
    for number, name in enumerate(names):
        for first, stop in feet.runs(clip_of[played.astype(int)] == number):
            ground.plot(x[first : stop + 1], z[first : stop + 1], color=SOURCES[number], linewidth=3)
        ground.plot([], [], color=SOURCES[number], linewidth=3, label=name)
    ground.plot(x[character.cuts], z[character.cuts], "D", color=MARK, markersize=4, label="cuts")
    for frame in range(0, len(headings), 75):
        tip = (x[frame] + 0.8 * np.sin(headings[frame]), z[frame] + 0.8 * np.cos(headings[frame]))
        arrow = {"color": ASKED, "width": 1.5, "headwidth": 8}
        ground.annotate("", tip, (x[frame], z[frame]), arrowprops=arrow)
    ground.set(aspect="equal", xlabel="x (m)", ylabel="z (m)")
    ground.xaxis.set_inverted(True)
    ground.legend(frameon=False, fontsize=8, loc="upper center", bbox_to_anchor=(0.5, 1.5), ncols=3)
    return figure


def _draw_futures(ax: Axes, table: PoseDatabase, clip_of: Array) -> None:
    """Draw the future asked for, a turn to the left, and those of the five frames that fit best."""
    now, future = 600, slice(15, 27)
    query = table.values[now].copy()
    query[future] = foresee(table, now, 0.8 * np.exp(1j * np.pi / 3), 0.27)
    costs = np.where(table.usable, ((table.values - query) ** 2).sum(axis=1), np.inf)
    rows = [(now, plotting.QUIET, "--")]
    costs[now - 5 : now + 6] = np.inf
    for _ in range(5):
        best = int(costs.argmin())
        rows.append((best, SOURCES[clip_of[best]], "o-"))
        costs[max(best - 5, 0) : best + 6] = np.inf
    for row, colour, style in rows:
        places = (table.values[row] * table.scale + table.mean)[15:21].reshape(3, 2)
        ax.plot(*np.vstack([[0, 0], places]).T, style, color=colour, markersize=4)
    ax.plot(*((query * table.scale + table.mean)[15:21].reshape(3, 2)).T, "o", color=ASKED, label="asked for")
    ax.set(aspect="equal", xlabel="to the left (m)", ylabel="ahead (m)", xlim=(0.7, -0.5), ylim=(-0.1, 0.95))
    ax.legend(frameon=False, fontsize=8)


def draw_groups() -> Figure:
    """Draw who stands for whom in two groups; and a group that was planned beside one that is steered."""
    figure, (match, plan, steered) = plt.subplots(1, 3, figsize=(10, 4.4), width_ratios=(1.2, 1, 1))
    figure.set_layout_engine("constrained")
    graph = groups.build_group(12)
    one, other = (graph.nodes[node].places[:7] for node in (0, 3))
    order = groups.compare(*(groups.Configuration(some, np.ones(7, complex)) for some in (one, other))).order
    for a, b in zip(one, other[order], strict=True):
        match.plot([a.imag, b.imag], [a.real, b.real], color=SOURCES[0], linewidth=2, zorder=1)
    match.plot(one.imag, one.real, "o", color=SOURCES[0], markersize=10)
    match.plot(other.imag, other.real, "o", color=ASKED, markerfacecolor="white", markersize=10)
    rocks = [(rock, 1.3) for rock in (12 - 2.5j, 12, 12 + 2.5j, 9.5 - 3.6j, 9.5 + 3.6j)]
    scene = groups.Scene((20 + 0j,), tuple(rocks))
    found = groups.plan_group(graph, scene)
    way = groups.play_group(graph, found.clips).places[: round(found.seconds * groups.RATE) + 1]
    stays = groups.steer_group(graph.nodes[0], scene, limit=20)[0].places
    for ax, places in ((plan, way), (steered, stays)):
        plotting.draw_group_plan(places, scene.points, scene.discs, ax=ax)
        ax.set(xlim=(10, -10), ylim=(-3, 23), ylabel="")
    match.set(aspect="equal", xlabel="x (m)", ylabel="z (m)", title="who stands for whom?")
    match.xaxis.set_inverted(True)
    plan.set_title("planned")
    steered.set_title("steered")
    return figure


def draw_warping() -> Figure:
    """Draw a hand that reaches for a post by one key, and a jump that is 20 cm higher."""
    walk, jump = datasets.sample("walk_straight")[:480], datasets.sample("jump")
    place = joint_positions(walk)[WARPED, walk.skeleton.index("rhand")] + [-0.15, 0.30, 0.15]
    pose = editing.posed(walk, WARPED, {"rhand": place})
    keys = editing.keys_around(walk, [editing.Key(WARPED, pose)])
    reaching = editing.displaced(walk, editing.offsets(walk, keys))
    apex = int(jump.root_positions[:, 1].argmax())
    lifted = replace(
        jump[apex : apex + 1], root_positions=jump.root_positions[apex] + np.array([[0, 0.2, 0]])
    )
    keys = [editing.Key(208, flat=True), editing.Key(apex, lifted), editing.Key(267, flat=True)]
    higher = editing.displaced(jump, editing.offsets(jump, keys))
    figure, axes = plt.subplots(2, 1, figsize=(8.4, 5.2), layout="constrained")
    for ax, pair, frames in (
        (axes[0], (walk, reaching), range(WARPED - 80, WARPED + 81, 20)),
        (axes[1], (jump, higher), (60, 150, 190, 208, 222, 238, 253, 267, 290, 400)),
    ):
        for motion, alpha in zip(pair, (0.25, 1.0), strict=True):
            plotting.flat_bodies(_side_by_side(motion, frames, 0.9), range(len(frames)), alpha=alpha, ax=ax)
        ax.axhline(0, color=plotting.QUIET, linewidth=1)
        ax.set_axis_off()
    middle = 0.9 * 4 + place[2] - walk.root_positions[WARPED, 2]  # of the fifth body
    axes[0].plot(middle, place[1], "o", color=ASKED, markersize=8)
    return figure


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
    worn = editing.retarget(walk, child, adult)
    naive = replace(walk, skeleton=child.skeleton)
    figure = plt.figure(figsize=(9, 3.6), layout="constrained")
    bodies, strays = figure.subplots(1, 2, width_ratios=[1.5, 1])
    for motion, up in ((walk, 0.0), (worn, -1.35)):
        lifted = replace(motion, root_positions=motion.root_positions + np.array([0, up, 0]))
        plotting.flat_bodies(lifted, range(20, 360, 45), ax=bodies)
        bodies.axhline(up, color=plotting.QUIET, linewidth=1)
    bodies.set(xlim=(-0.5, 3.7), ylim=(-1.45, 1.8), yticks=[], ylabel="", title="one walk, two bodies")
    ball = child.skeleton.index("ltoes")
    first, last = feet.runs(walk.contacts["ltoes"])[1]
    seconds = np.arange(first, last) / walk.fps
    for motion, name, colour in ((worn, "retargeted", CURVES[0]), (naive, "the same numbers", CURVES[1])):
        places = joint_positions(motion)[first:last, ball]
        away = 100 * np.linalg.norm(places - places.mean(axis=0), axis=1)
        strays.plot(seconds, away, color=colour, label=name)
    strays.set(xlabel="seconds", ylabel="cm from its mean place", title="the child's standing left ball")
    strays.set_ylim(-1, 16)
    strays.legend(frameon=False)
    return figure


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
    readings: dict[type, Callable[[Any], Any]] = {
        Line2D: lambda line: [line.get_xydata()],
        LineCollection: lambda lines: lines.get_segments(),
        Line3DCollection: lambda lines: lines._segments3d,
        AxesImage: lambda image: [image.get_array()],
    }
    sums = {}
    artists = [artist for axes in figure.axes for artist in axes.get_children()]
    for kind, read in readings.items():
        drawn = [np.ravel(part) for artist in artists if type(artist) is kind for part in read(artist)]
        numbers = np.concatenate([*drawn, np.zeros(0)])
        if numbers.size:
            sums[kind.__name__] = [len(numbers), *np.round([numbers.mean(), numbers.std()], 4).tolist()]
    return sums


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
