"""Turns and poses: what a quaternion does, turns whose order matters, and forward kinematics by joint."""

import re
from collections.abc import Callable

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d import Axes3D

from mocap import plain
from mocap._shared.arrays import Array
from mocap.body import Motion, Skeleton, joint_positions, rotations
from mocap.course.diagrams.pens import arrow, say, show_program, strokes, trace
from mocap.course.notebooks import shown_source
from mocap.plotting import COLOURS, CURVES, MARK, QUIET, StickFigure, bones, ground_axes
from mocap.plotting.stick_figures import to_picture

ALONG = 0.8  # the part along the axis of the vector that `half_turns` turns
ACROSS = 0.8  # its part across the axis
CORNER = np.array([-1.0, 0, -0.5])  # where `turns_in_order` draws the axes of the world
NAMES = ("v", "q v", "q v q̄")


def half_turns(step: int = 2, angle: float = 60) -> Figure:
    """Draw how q v q̄ turns a vector v: q does one half of the turn, q̄ the other.

    The left panel shows the part of v across the axis, seen along the axis. The right panel shows the part
    along the axis, beside the number in front, w: it must be 0 for a vector.

    Parameters
    ----------
    step : 0 shows v, 1 also q v, 2 also q v q̄.
    angle : of the turn, degrees.

    Examples
    --------
    >>> from mocap import plotting
    >>> plotting.show(half_turns(step=1), alt="Both parts of v turned by 30 degrees.")
    Picture('Both parts of v turned by 30 degrees.')

    Notebook: 01-skeletons-and-clips
    """
    figure, axes = plt.subplots(1, 2, figsize=(9, 3.9), layout="constrained")
    half = np.radians(angle) / 2
    across = ACROSS * np.exp(1j * half * np.arange(step + 1))
    turned = half * np.array([0, 1, 0])
    along = ALONG * np.exp(1j * (np.pi / 2 + turned))[: step + 1]
    labels = (("across", "x", "y"), ("along", "w, the number in front", "z, along the axis"))
    for ax, points, (part, x, y) in zip(axes, (across, along), labels, strict=True):
        _draw_turning(ax, points)
        ax.set(title=f"the part {part} the axis", xlabel=x, ylabel=y)
    vector = np.array([0, across[0].real, 0, ALONG])
    q = np.array([np.cos(half), 0, 0, np.sin(half)])
    shown = [vector, rotations.multiply(q, vector), rotations.rotate(q, vector[1:])]
    values = (", ".join(f"{number:.2f}" for number in np.round(values, 2) + 0.0) for values in shown)
    lines = [f"{name} = ({value})" for name, value in zip(NAMES, values, strict=True)]
    figure.suptitle("      ".join(lines[: step + 1]))
    return figure


def _draw_turning(ax: Axes, points: Array) -> None:
    """Draw a part of v, and where q and then q̄ bring it: the last one solid, those before it pale."""
    for number, point in enumerate(points):
        at_point = [name for name, p in zip(NAMES, points, strict=False) if abs(p - point) < 1e-9]
        last = number == len(points) - 1
        colour = CURVES[0] if last else QUIET
        arrow(ax, 0j, point, colour, 1.4 + last, shrinkA=2)
        say(ax, 1.2 * point, ", ".join(at_point), color=colour)
    places = (0.7, 1.2, 0.5), (0.4, 0.6, 2.1)  # radius of the arc; of its number, and how many turns on
    for first, second, (radius, out, turns) in zip(points, points[1:], places, strict=False):
        start = first / abs(first)
        turn = np.angle(second / first)
        arc = radius * start * np.exp(1j * np.linspace(0, turn, 30))
        trace(ax, arc, color=MARK, linewidth=1.5)
        degrees = f"{np.degrees(turn):+.0f}°".replace("-", "−")
        say(ax, out * start * np.exp(1j * turns * turn), degrees)
    ax.axhline(0, color=QUIET, linewidth=0.6)
    ax.axvline(0, color=QUIET, linewidth=0.6)
    ax.set(xlim=(-1.4, 1.4), ylim=(-1.4, 1.4), aspect="equal", xticks=[-1, 0, 1], yticks=[-1, 0, 1])


def turns_in_order(body: Skeleton, multiply: Callable[[Array, Array], Array]) -> Figure:
    """Draw a body that is turned forwards and to the left, above, or to the left and forwards, below.

    Parameters
    ----------
    body : of the stick figure, which stands with its arms spread.
    multiply : the product of two quaternions; it puts together two turns of 90° about axes of the world.

    Examples
    --------
    >>> from mocap import datasets, plotting
    >>> figure = turns_in_order(datasets.sample("walk_straight").skeleton, rotations.multiply)
    >>> plotting.show(figure, alt="A body turned twice, in two orders: it ends in two different poses.")
    Picture('A body turned twice, in two orders: it ends in two different poses.')

    Notebook: 01-skeletons-and-clips
    """
    turns = {"forwards": [90, 0, 0], "to the left": [0, 90, 0]}
    figure = plt.figure(figsize=(7, 4.9))
    for row, names in enumerate((["forwards", "to the left"], ["to the left", "forwards"])):
        turn = rotations.IDENTITY
        for shown, name in enumerate(["at rest", *names]):
            if shown:
                turn = multiply(rotations.from_rotvec(np.radians(turns[name])), turn)
            ax = figure.add_axes((shown / 3, 0.53 - 0.49 * row, 1 / 3, 0.42), projection="3d")
            _draw_body(ax, body, turn)
            ax.set_title(f"{shown}. {name}" if shown else name, y=1)
    return figure


def _draw_body(ax: Axes3D, body: Skeleton, turn: Array) -> None:
    """Draw a body with spread arms, turned about its root, and the axes of the world."""
    pose = np.tile(rotations.IDENTITY, (1, len(body), 1))
    for joint, name in enumerate(body.names):
        if name.endswith("humerus"):
            pose[0, joint] = rotations.from_rotvec([0, 0, 1.4 if body.side(joint) == "left" else -1.4])
    pose[0, 0] = turn
    ground_axes(reach=1.1, tall=1.9, ax=ax)
    StickFigure(body, ax).pose(joint_positions(Motion(body, np.array([[0, 0.95, 0]]), pose, 1.0))[0])
    for name, axis in zip("xyz", 0.45 * np.eye(3), strict=True):
        line = to_picture([CORNER, CORNER + axis, CORNER + 1.3 * axis])
        ax.plot(*line[:2].T, color=COLOURS["middle"], linewidth=1, zorder=2)
        ax.text(*line[2], name, color=COLOURS["middle"])


def down_the_tree(motion: Motion, frame: int = 0) -> Callable[[int], list[Artist]]:
    """Draw a pose joint after joint: the lines of the loop that have just run, and the bones placed so far.

    Parameters
    ----------
    motion : a walk along z, which is seen from the side.
    frame : which of its poses.

    Returns
    -------
    A function for `explore`: it takes the last joint that has its place, and gives what it moved.

    Examples
    --------
    >>> from mocap import datasets
    >>> down_the_tree(datasets.sample("walk_straight"))(3)[-1].get_text()
    'joint 3, ltibia: its parent is 2, lfemur'

    Notebook: 01-skeletons-and-clips
    """
    names = motion.skeleton.names
    parents = (0, *motion.skeleton.parents[1:])
    points = plain.joint_positions(motion[frame : frame + 1])[0][:, [2, 1]]  # z to the right, y upwards
    figure = Figure(figsize=(9.8, 4))
    code = figure.add_axes((0.01, 0, 0.79, 0.9))
    ax = figure.add_axes((0.84, 0.15, 0.15, 0.83))
    program = re.sub(r"  #.*", "", shown_source("plain.joint_positions"))  # on a slide it would be too wide
    lines = program.replace(" + rotate", f"\n{' ' * 12}+ rotate").splitlines()
    marked = show_program(code, lines, 0)
    loop = next(number for number, line in enumerate(lines) if line.lstrip().startswith("for "))
    steps = len(lines) - loop - 2  # of the loop, without its head and the return
    starts, ends, sides = map(np.asarray, bones(motion.skeleton))
    limbs = strokes(ax, linewidth=2.4)
    (dots,) = ax.plot([], [], "o", color=QUIET, markersize=4)
    (last,) = ax.plot([], [], "o", color=MARK, markersize=8)
    bone = arrow(ax, 0j, 0j, MARK)
    low = points[:, 0].min() - 0.2
    high = points[:, 0].max() + 0.2
    ax.set(
        aspect="equal", xlabel="z (m)", ylabel="y (m)", xlim=(low, high), ylim=(-0.05, 1.85), yticks=[0, 1]
    )

    def placed(joint: int) -> list[Artist]:
        parent = parents[joint]
        if joint:
            marked.set(y=loop + 0.5, height=steps)
        else:
            marked.set(y=0.5, height=loop - 1)
        limbs.set_segments(points[np.stack([starts, ends], 1)[ends <= joint]])  # type: ignore[operator]
        limbs.set_color([COLOURS[side] for side in sides[ends <= joint]])  # type: ignore[operator]
        dots.set_data(points[: joint + 1].T)
        last.set_data(points[[joint]].T)
        bone.xy = points[joint]
        bone.xyann = points[parent]
        bone.set_visible(bool(abs(points[joint] - points[parent]).max() > 1e-6))
        relation = f"its parent is {parent}, {names[parent]}" if joint else "it has no parent"
        code.title.set(text=f"joint {joint}, {names[joint]}: {relation}")
        return [marked, limbs, dots, last, bone, code.title]

    return placed
