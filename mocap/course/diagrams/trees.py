"""Forward kinematics joint by joint: the loop of `mocap.plain`, and what it has placed."""

import re
from collections.abc import Callable

import numpy as np
from matplotlib.artist import Artist
from matplotlib.figure import Figure

from mocap.body import Motion
from mocap.course.diagrams.pens import arrow, show_program, strokes
from mocap.course.notebooks import shown_source
from mocap.plain import joint_positions
from mocap.plotting import COLOURS, MARK, QUIET, bones


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
    names, parents = motion.skeleton.names, (0, *motion.skeleton.parents[1:])
    points = joint_positions(motion[frame : frame + 1])[0][:, [2, 1]]  # z to the right, y upwards
    figure = Figure(figsize=(9.8, 4))
    code, ax = figure.add_axes((0.01, 0, 0.79, 0.9)), figure.add_axes((0.84, 0.15, 0.15, 0.83))
    program = re.sub(r"  #.*", "", shown_source("plain.joint_positions"))  # on a slide it would be too wide
    marked = show_program(code, program.replace(" + rotate", f"\n{' ' * 12}+ rotate").splitlines(), 0)
    starts, ends, sides = map(np.asarray, bones(motion.skeleton))
    limbs = strokes(ax, linewidth=2.4)
    (dots,) = ax.plot([], [], "o", color=QUIET, markersize=4)
    (last,) = ax.plot([], [], "o", color=MARK, markersize=8)
    bone = arrow(ax, 0j, 0j, MARK)
    low, high = points[:, 0].min() - 0.2, points[:, 0].max() + 0.2
    ax.set(
        aspect="equal", xlabel="z (m)", ylabel="y (m)", xlim=(low, high), ylim=(-0.05, 1.85), yticks=[0, 1]
    )

    def placed(joint: int) -> list[Artist]:
        parent = parents[joint]
        marked.set(y=2.5 if joint else 0.5, height=4 if joint else 1)
        limbs.set_segments(points[np.stack([starts, ends], 1)[ends <= joint]])
        limbs.set_color([COLOURS[side] for side in sides[ends <= joint]])
        dots.set_data(points[: joint + 1].T)
        last.set_data(points[[joint]].T)
        bone.xy, bone.xyann = points[joint], points[parent]
        bone.set_visible(bool(abs(points[joint] - points[parent]).max() > 1e-6))
        told = f"its parent is {parent}, {names[parent]}" if joint else "it has no parent"
        code.title.set(text=f"joint {joint}, {names[joint]}: {told}")
        return [marked, limbs, dots, last, bone, code.title]

    return placed
