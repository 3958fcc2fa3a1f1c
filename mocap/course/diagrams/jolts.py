"""What a blend adds: the velocities of two clips and of their blend, and the jolts of all three."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import ArrayLike

from mocap.body.motion import Motion
from mocap.plotting.style import COLOURS, MARK, QUIET, SOURCES
from mocap.quality.seam_measures import blend_jolts, jumps


def added_by_blend(  # noqa: PLR0913 (the parameters of `blend_jolts`, and a step)
    result: Motion,
    first: Motion,
    second: Motion,
    start: int,
    weights: ArrayLike,
    *,
    step: int = 4,
) -> Figure:
    """Draw how a blend changes velocities, and which of the jolts are the blend's own.

    Parameters
    ----------
    result, first, second, start, weights : as for `quality.blend_jolts`.
    step : how much is drawn: 1 the root's velocities in both clips, 2 that in the blend too, 3 the jolts of
        all three, 4 the jolt that the blend adds.

    Returns
    -------
    A figure with the velocities above, the jolts below, and the window shaded in both.

    Examples
    --------
    >>> from mocap.blending import cubic_weights, join
    >>> from mocap.datasets.samples import sample
    >>> walk = sample("walk_straight")[:80]
    >>> figure = added_by_blend(join(walk, 20, walk, 20, 10), walk, walk, 20, cubic_weights(10), step=2)
    >>> [len(ax.lines) for ax in figure.axes]
    [3, 0]

    Notebook: 09b-blend-window
    """
    window = len(np.asarray(weights))
    figure = Figure(figsize=(7.5, 5.2), layout="constrained")
    above, below = figure.subplots(2, 1, sharex=True)
    for ax in (above, below):
        ax.axvspan(start / result.fps, (start + window) / result.fps, color=MARK, alpha=0.15, linewidth=0)
        ax.set_xlim(0, (len(result) - 1) / result.fps)
    _velocities(above, (first, second, result))
    if step < 2:
        above.lines[-1].remove()
    below.set(xlabel="time (s)", ylabel="jolt, RMS over joints (m/s)")
    seen = blend_jolts(result, first, second, start, weights)
    below.set_ylim(0, 1.15 * max(jumps(motion)[0].max() for motion in (result, first, second)))
    if step >= 3:
        _jolts(below, (first, second, result))
    if step >= 4:
        frames = np.arange(max(start - 1, 1), max(start - 1, 1) + len(seen.added))
        below.fill_between(frames / result.fps, seen.added, color=MARK, zorder=1, label="added by the blend")
    for ax in (above, below):
        if ax.get_legend_handles_labels()[1]:
            ax.legend(frameon=False, loc="upper left", ncols=4, fontsize=9)
    return figure


def _velocities(ax: Axes, motions: tuple[Motion, ...]) -> None:
    """Draw the root's velocity in the direction in which the first motion travels."""
    travelled = motions[0].root_positions[-1] - motions[0].root_positions[0]
    ahead, tracks = travelled / max(float(np.linalg.norm(travelled)), 1e-9), []
    for motion, look in zip(motions, _looks("first clip", "second clip, aligned", "the blend"), strict=True):
        tracks.append(np.diff(motion.root_positions, axis=0) @ ahead * motion.fps)
        ax.plot((np.arange(len(tracks[-1])) + 0.5) / motion.fps, tracks[-1], **look)
    low, high = min(map(np.min, tracks)), max(map(np.max, tracks))
    ax.set(ylabel="forward velocity of 'root' (m/s)", ylim=(low - 0.1, high + 0.35 * (high - low) + 0.1))


def _jolts(ax: Axes, motions: tuple[Motion, ...]) -> None:
    """Draw the jolts of two clips and of their blend; at the ends there are none."""
    for motion, look in zip(motions, _looks("first clip", "second clip", "the blend"), strict=True):
        ax.plot(np.arange(1, len(motion) - 1) / motion.fps, jumps(motion)[0][1:-1], **look)
    ax.axhline(0, color=QUIET, linewidth=0.8)


def _looks(*labels: str) -> list[dict[str, Any]]:
    looks = zip((*SOURCES[:2], COLOURS["middle"]), (2.6, 2.6, 1.3), labels, strict=True)
    return [{"color": colour, "linewidth": width, "label": label} for colour, width, label in looks]
