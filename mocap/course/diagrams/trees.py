"""Forward kinematics joint by joint: the loop of `mocap.plain`, and what it has placed."""

import matplotlib.pyplot as plt
from matplotlib.figure import Figure

from mocap.body import Motion
from mocap.course.diagrams.pens import arrow, trace
from mocap.course.notebooks import shown_source
from mocap.plain import joint_positions
from mocap.plotting import COLOURS, CURVES, MARK, QUIET, bones


def down_the_tree(motion: Motion, frame: int = 0, joint: int = 0) -> Figure:
    """Draw a pose after some joints: the lines of the loop that have just run, and the bones placed so far.

    Parameters
    ----------
    motion : a walk along z, which is seen from the side.
    frame : which of its poses.
    joint : the last joint that has its place.

    Examples
    --------
    >>> from mocap import datasets
    >>> figure = down_the_tree(datasets.sample("walk_straight"), joint=3)
    >>> figure.axes[1].get_title()
    'joint 3, ltibia: its parent is 2, lfemur'

    Notebook: 01-skeletons-and-clips
    """
    names, parents = motion.skeleton.names, motion.skeleton.parents
    points = joint_positions(motion[frame : frame + 1])[0] @ [0, 1j, 1]  # z to the right, y upwards
    figure, (code, ax) = plt.subplots(2, 1, figsize=(7.4, 6.4), layout="constrained", height_ratios=(2, 5))
    lines = shown_source("plain.joint_positions").splitlines()
    code.set(xlim=(0, 1), ylim=(len(lines) - 0.5, -0.5))
    code.set_axis_off()
    ran = (3, 5) if joint else (1, 1)
    code.axhspan(ran[0] - 0.5, ran[1] + 0.5, color=CURVES[0], alpha=0.25, linewidth=0)
    for number, text in enumerate(lines):
        code.text(0, number, text, va="center", family="monospace", fontsize=8)
    starts, ends, sides = bones(motion.skeleton)
    for start, end, side in zip(starts, ends, sides, strict=True):
        if end <= joint:
            trace(ax, points[[start, end]], color=COLOURS[side], linewidth=2.4)
    trace(ax, points[: joint + 1], color=QUIET, marker="o", markersize=4, linestyle="")
    trace(ax, points[joint], color=MARK, marker="o", markersize=8)
    if joint and abs(points[joint] - points[parents[joint]]) > 1e-6:
        arrow(ax, points[parents[joint]], points[joint], MARK)
    parent = f"its parent is {parents[joint]}, {names[parents[joint]]}" if joint else "it has no parent"
    ax.set_title(f"joint {joint}, {names[joint]}: {parent}", fontsize=10)
    low, high = points.real.min() - 0.2, points.real.max() + 0.2
    ax.set(aspect="equal", xlabel="z (m)", ylabel="y (m)", xlim=(low, high), ylim=(-0.05, 1.85))
    return figure
