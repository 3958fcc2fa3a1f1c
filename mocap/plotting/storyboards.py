"""A transition in four panels: where it is, the two windows, the turn and the weights, and the seam."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure

from mocap._shared.arrays import Array
from mocap.blending.joining import join
from mocap.blending.weights import cubic_weights
from mocap.body.kinematics import joint_positions
from mocap.body.limbs import find_legs
from mocap.body.motion import Motion
from mocap.body.planar import PlanarTransform, heading
from mocap.errors import MocapError
from mocap.matching.point_clouds import align, distinct_joints, point_cloud, rms_distance
from mocap.plotting.bodies import draw_body
from mocap.plotting.style import COLOURS, CURVES, MARK, PATH, QUIET
from mocap.quality.seam_measures import jumps

DASHED = (0, (3, 2))
OFF = 60  # degrees that a turn is too small, to show what it costs


@dataclass(frozen=True, eq=False)
class Shot:
    """Two windows, and the stretches of clip around them.

    Parameters
    ----------
    first, i, second, j : the window of the second clip from frame j on follows the first one's from frame i.
    window, before, after : frames of the window, and of clip to show before and after it.
    where : draws on given axes where the windows are, such as a distance grid.

    Examples
    --------
    >>> from mocap import datasets
    >>> walk = datasets.sample("walk_straight")[:240]
    >>> shot = Shot(walk, 80, walk, 80, 40, 20, 20, lambda ax: None)
    >>> round(shot.distance(shot.angle), 6), round(shot.distance(shot.angle + np.pi), 2)
    (0.0, 0.44)
    """

    first: Motion
    i: int
    second: Motion
    j: int
    window: int
    before: int
    after: int
    where: Callable[[Axes], object]

    @cached_property
    def windows(self) -> tuple[Motion, Motion]:
        """Both windows where they are in their clips."""
        return self.first[self.i : self.i + self.window], self.second[self.j : self.j + self.window]

    @cached_property
    def clouds(self) -> tuple[Array, Array]:
        """The points of both windows, shape (window · P, 3) each."""
        first, second = (point_cloud(motion).reshape(-1, 3) for motion in self.windows)
        return first, second

    @cached_property
    def angle(self) -> float:
        """The best turn of the second window, radians."""
        return float(align(*self.clouds).angle)

    def turned(self, angle: float) -> PlanarTransform:
        """Turn the second window by an angle, and shift the mean of its points to the first's."""
        first, second = (cloud.mean(axis=0) for cloud in self.clouds)
        x, _, z = first - PlanarTransform(angle, 0.0, 0.0).apply_points(second)
        return PlanarTransform(angle, float(x), float(z))

    def distance(self, angle: float) -> float:
        """Measure the RMS distance at a turn, metres."""
        return rms_distance(self.windows[0], self.turned(angle).apply_motion(self.windows[1]))

    @cached_property
    def level(self) -> PlanarTransform:
        """Turns the first window so that its middle heads along z, from the left to the right of a panel."""
        facing = float(heading(self.first.rotations[self.i + self.window // 2, 0]))
        return PlanarTransform(-facing, 0.0, 0.0)

    @cached_property
    def seam(self) -> Motion:
        """The blend by the paper's weights, with the frames around it."""
        joined = join(self.first, self.i, self.second, self.j, self.window)
        return joined[max(0, self.i - self.before) : self.i + self.window + self.after]


def storyboard(shot: Shot, show: Sequence[str]) -> Figure:
    """Draw a transition in four panels with labels, as far as a course has come.

    Parameters
    ----------
    shot : the two windows.
    show : what has been explained: "windows", "turn", "weights", "seam", or the first of these.

    Examples
    --------
    >>> from mocap import datasets
    >>> walk = datasets.sample("walk_straight")[:240]
    >>> shot = Shot(walk, 80, walk, 80, 40, 20, 20, lambda ax: None)
    >>> [ax.get_title(loc="left")[:20].strip() for ax in storyboard(shot, ["windows"]).axes]
    ['1  which two windows', '2  the first, walk_s', '3  the second, walk_', '4  aligned, RMS dist']
    """
    figure = Figure(figsize=(9.2, 6.4), layout="constrained")
    grid = figure.add_gridspec(2, 2)
    panels = [figure.add_subplot(cell) for cell in (grid[0, 0], grid[0, 1], grid[1, 0])]
    shot.where(panels[0])
    label(panels[0], 1, "which two windows")
    if "turn" not in show:
        for number, (ax, motion) in enumerate(zip(panels[1:], shot.windows, strict=True), start=2):
            turned = PlanarTransform(-_facing(motion), 0.0, 0.0).apply_motion(motion)
            _strip(ax, [turned], dashed=[number == 3])
            label(ax, number, f"the {'second' if number == 3 else 'first'}, {motion.name}")
        _aligned(figure.add_subplot(grid[1, 1]), shot, 4)
        return figure
    _aligned(panels[1], shot, 2)
    if "weights" not in show:
        _from_above(panels[2], shot)
        _turns(figure.add_subplot(grid[1, 1]), shot)
        return figure
    _weights(panels[2], shot)
    rows = grid[1, 1].subgridspec(2, 1, height_ratios=(2, 1))
    _seam(figure.add_subplot(rows[0] if "seam" in show else grid[1, 1]), shot)
    if "seam" in show:
        _jolts(figure.add_subplot(rows[1]), shot)
    return figure


def label(ax: Axes, number: int, words: str) -> None:
    """Write a panel's number and what it shows above it."""
    ax.set_title(f"{number}  {words}".replace("-", "−"), loc="left", fontsize=11)


def _facing(motion: Motion) -> float:
    return float(heading(motion.rotations[len(motion) // 2, 0]))


def _body(ax: Axes, points: Array, motion: Motion, *, alpha: float = 1.0, dashed: bool = False) -> None:
    """Draw a pose, shape (J, 2), in the colours of left and right."""
    ink = COLOURS["middle"]
    head = {"color": "none" if dashed else ink, "markeredgecolor": ink, "markersize": 8, "alpha": alpha}
    line: dict[str, Any] = {"linestyles": [DASHED if dashed else "-"], "linewidths": 1.8 if dashed else 2.4}
    draw_body(ax, motion.skeleton, points, head=head, alpha=alpha, **line)


def _bare(ax: Axes) -> None:
    """Show as much as is drawn, at the same scale on both axes, and no ticks."""
    ax.autoscale_view()
    ax.set_aspect("equal", adjustable="datalim")
    ax.set(xticks=[], yticks=[])
    ax.spines[:].set_visible(False)


def _strip(ax: Axes, motions: Sequence[Motion], *, dashed: Sequence[bool]) -> None:
    """Draw the first, middle and last frame of windows from the side, with threads between two of them."""
    last = len(motions[0]) - 1
    joints = distinct_joints(motions[0].skeleton)
    points = [joint_positions(motion)[..., [2, 1]] for motion in motions]
    for place, (frame, words) in enumerate([(0, "first frame"), (last // 2, "middle"), (last, "last frame")]):
        shift = np.array([1.1 * place - points[0][frame, 0, 0], 0.0])
        poses = [places[frame] + shift for places in points]
        for pose, motion, line in zip(poses, motions, dashed, strict=True):
            _body(ax, pose, motion, dashed=line)
        if len(poses) == 2:
            threads = list(np.stack([pose[joints] for pose in poses], axis=1))
            ax.add_collection(LineCollection(threads, colors="#000000", linewidths=1.2, zorder=3))
        ax.annotate(words, (1.1 * place, -0.12), ha="center", va="top", fontsize=9)
    ax.axhline(0, color=QUIET, linewidth=0.8, zorder=0)
    ax.plot([-0.7, 2.9], [-0.3, -0.3], alpha=0)  # room for the words
    _bare(ax)


def _aligned(ax: Axes, shot: Shot, number: int) -> None:
    """Draw both windows, aligned, with a thread from each point to its partner."""
    first, second = shot.windows
    pair = [first, shot.turned(shot.angle).apply_motion(second)]
    _strip(ax, [shot.level.apply_motion(motion) for motion in pair], dashed=[False, True])
    for motion, style in zip((first, second), ("-", DASHED), strict=True):
        ax.plot([], [], color=COLOURS["middle"], linestyle=style, label=motion.name)
    ax.legend(loc="upper center", bbox_to_anchor=(0.5, 0.04), ncols=2, frameon=False, fontsize=9)
    label(ax, number, f"aligned, RMS distance {100 * shot.distance(shot.angle):.1f} cm")


def _from_above(ax: Axes, shot: Shot) -> None:
    """Draw the middle of both windows from above, the second one turned too little."""
    angle = shot.angle - np.radians(OFF)
    pair = [shot.windows[0], shot.turned(angle).apply_motion(shot.windows[1])]
    places = []
    for motion, dashed in zip(pair, (False, True), strict=True):
        flat = joint_positions(shot.level.apply_motion(motion))[shot.window // 2][:, [2, 0]]
        _body(ax, flat, motion, dashed=dashed)
        places.append(flat[distinct_joints(motion.skeleton)])
    ax.add_collection(LineCollection(list(np.stack(places, axis=1)), colors="#000000", linewidths=1.0))
    _bare(ax)
    label(ax, 3, f"from above, turned {OFF}° less: {100 * shot.distance(angle):.1f} cm")


def _turns(ax: Axes, shot: Shot) -> None:
    """Draw the distance at all turns, with the best one."""
    degrees = np.arange(-180, 181, 5)
    ax.plot(degrees, [100 * shot.distance(np.radians(d)) for d in degrees], color=CURVES[0])
    best, least = np.degrees(shot.angle), 100 * shot.distance(shot.angle)
    ax.plot([best], [least], "o", color=COLOURS["middle"])
    ax.set(xlabel="θ (degrees)", ylabel="RMS distance (cm)", ylim=(0, None), xticks=range(-180, 181, 90))
    label(ax, 4, f"the best turn, {best:.0f}°: {least:.1f} cm")


def _weights(ax: Axes, shot: Shot) -> None:
    """Draw the weights of the first clip over the window."""
    frames, weights = np.arange(1, shot.window + 1), cubic_weights(shot.window)
    ax.fill_between(frames, weights, color=MARK, alpha=0.3)
    ax.plot(frames, weights, color=CURVES[0])
    ax.set(xlabel="frame of the window", ylabel=f"α: how much of {shot.first.name}", ylim=(0, 1.05))
    label(ax, 3, f"weights α, after a turn of {np.degrees(shot.angle):.0f}°")


def _seam(ax: Axes, shot: Shot) -> None:
    """Draw the seam from the side, with the tracks of the balls of the feet."""
    seam, begin = shot.level.apply_motion(shot.seam), min(shot.before, shot.i)
    end = begin + shot.window - 1
    points = joint_positions(seam)[..., [2, 1]]
    for frame in dict.fromkeys([0, begin // 2, begin, end, (end + len(seam)) // 2, len(seam) - 1]):
        _body(ax, points[frame], seam, alpha=1.0 if begin <= frame <= end else 0.4)
    ax.plot(points[:, 0, 0], 0 * points[:, 0, 0], color=PATH, linewidth=2)
    for joint in _balls(seam):
        ax.plot(*points[:, joint].T, color=COLOURS[seam.skeleton.side(joint)], linewidth=1)
    ax.axvspan(*points[[begin, end], 0, 0], color=MARK, alpha=0.3, zorder=0)
    _bare(ax)
    label(ax, 4, "the seam; its window is shaded")


def _jolts(ax: Axes, shot: Shot) -> None:
    """Draw the jolts of the seam, on the window's clock."""
    seam, begin = shot.seam, min(shot.before, shot.i)
    changes = jumps(seam)[0][1:-1] if len(seam) >= 4 else np.zeros(len(seam))[1:-1]
    clock = (np.arange(1, len(seam) - 1) - begin) / seam.fps
    ax.plot(clock, changes, color=CURVES[0])
    ax.axvspan(0, (shot.window - 1) / seam.fps, color=MARK, alpha=0.3)
    ax.set(xlabel="seconds from the start of the window", ylabel="jolt (m/s)", ylim=(0, None))


def _balls(motion: Motion) -> list[int]:
    """List the balls of the feet, where the skeleton's legs are known."""
    try:
        return [leg.ball for leg in find_legs(motion.skeleton)]
    except MocapError:
        return []
