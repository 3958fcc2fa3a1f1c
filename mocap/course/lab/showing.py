"""The widget itself: what a notebook shows of it, live, as a picture or as a sentence."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property, partial
from pathlib import Path
from typing import Any

import numpy as np

from mocap import plotting
from mocap._shared.arrays import Array
from mocap.body.motion import Motion
from mocap.course.lab.choices import EACH, MOST, Choices, of_clips, of_graph, of_walk
from mocap.course.lab.scenes import scene
from mocap.errors import MocapError
from mocap.graphs.motion_graph import MotionGraph
from mocap.plotting.picture import small_png
from mocap.plotting.storyboards import Shot, storyboard
from mocap.steering.followed import Followed
from mocap.widgets.embedding import SHARED, TOUCH, Embedded

TABS = ("windows", "turn", "weights", "seam")  # in the order in which the course meets them
PARTS = ("", "_maths", "_maps", "_stage", "_views", "_page")
OWN = [Path(__file__).with_name(f"inspector{part}.js") for part in PARTS]
NOWHERE = np.empty((0, 2))


def inspector(
    *what: Motion | MotionGraph | Followed,
    at: tuple[int, int] | None = None,
    show: Sequence[str] = TABS,
    window: int | None = None,
) -> Inspector:
    """Show the two windows of a transition, to point at, turn, mix and play.

    Best turn and distance are those of [KGP02, Eqs. 1-4], weights and mix those of [KGP02, Eqs. 5-7].

    Parameters
    ----------
    what : one clip or two (their distance grid is shown), a graph (its transitions along time), or what
        `steering.follow_path` found (its walk from above as well).
    at : the first frames of both windows of clips, (i, j), that are looked at first. By default it is what
        costs least, as in a graph; of a walk it is the seam that costs most.
    show : what the page explains, in this order: "windows", "turn", "weights", "seam", or the first of these.
    window : frames of a window of clips; a third of a second by default. A graph has its own.

    Returns
    -------
    The inspector; a notebook shows it as the last line of a cell.

    Raises
    ------
    SkeletonMismatch, NoWalk, MocapError : for anything else than the above, clips that do not go together,
        and a place that is not there.

    Examples
    --------
    >>> from mocap import datasets, resample
    >>> walks = [resample(datasets.sample(f"walk_curve_{n}"), 30)[:120] for n in (1, 2)]
    >>> inspector(*walks, at=(56, 20), show=["windows"])
    Inspector('Frames 56 to 65 of walk_curve_1 and 20 to 29 of walk_curve_2: RMS distance 1.9 cm, aligned.')

    Notebook: 02-matching

    """
    tabs = tuple(show) if isinstance(show, Sequence) else ()
    if not tabs or tabs != TABS[: len(tabs)]:
        raise MocapError(f"An inspector shows {', '.join(TABS)}, or the first of these, not {show!r:.80}.")
    found = what[0] if len(what) == 1 else None
    if isinstance(found, Followed | MotionGraph) and (at or window):
        raise MocapError("A graph and a walk bring windows of their own: leave out at= and window=.")
    if isinstance(found, Followed):
        choices = of_walk(found.graph, found.walk)
        return Inspector(choices, tabs, found.track, found.path.points)
    if isinstance(found, MotionGraph):
        return Inspector(of_graph(found), tabs)
    clips = [clip for clip in what if isinstance(clip, Motion)]
    if not 0 < len(clips) == len(what) <= 2:
        raise MocapError("An inspector takes one or two clips, a graph, or what follow_path found.")
    return Inspector(of_clips(clips, round(clips[0].fps / 3) if window is None else window, at), tabs)


@dataclass(frozen=True, eq=False, repr=False)
class Inspector(Embedded):
    """What `inspector` returns; a notebook shows it live, as a picture of its panels, or as a sentence.

    Examples
    --------
    >>> from mocap import datasets, resample
    >>> walk = resample(datasets.sample("walk_straight"), 30)[:90]
    >>> inspector(walk, at=(10, 45), show=["windows"]).scene["pick"]["j"]
    45
    """

    choices: Choices
    show: tuple[str, ...]
    track: Array = field(default_factory=lambda: NOWHERE)
    asked: Array = field(default_factory=lambda: NOWHERE)
    scripts = (*SHARED, TOUCH, *OWN)

    @cached_property
    def alt(self) -> str:
        """Which windows are looked at, how far apart they are, and at which turn."""
        shot, (first, second) = self.shot, self.shot.windows
        frames, others = (f"{start} to {start + shot.window - 1}" for start in (shot.i, shot.j))
        turn = f" at θ = {np.degrees(shot.fit.angle):.0f}°".replace("-", "−")
        apart = f"RMS distance {100 * shot.distance:.1f} cm{turn if 'turn' in self.show else ', aligned'}"
        return f"Frames {frames} of {first.name} and {others} of {second.name}: {apart}."

    @cached_property
    def shot(self) -> Shot:
        """The two windows that the picture shows."""
        clips, window, pick, *_ = self.choices
        first, second = clips[pick.first], clips[pick.second]
        after = min(pick.after, len(second) - pick.j - window)
        return Shot(first, pick.i, second, pick.j, window, pick.before, after, partial(draw_where, self))

    @cached_property
    def scene(self) -> dict[str, Any]:
        """What the scripts draw."""
        return scene(self.choices, self.show, self.track, self.asked, self.alt)

    @cached_property
    def picture(self) -> bytes:
        """Panels as a PNG, for places where no script runs."""
        return small_png(storyboard(self.shot, self.show))


def draw_where(shown: Inspector, ax: Any) -> None:  # noqa: ANN401 (axes)
    """Draw what can be pointed at: the walk from above, or the graph along time, or the distance grid."""
    choices, pick = shown.choices, shown.choices.pick
    fps = choices.clips[0].fps
    if choices.seams:
        ax.plot(*shown.asked.T, color=plotting.ASKED, linewidth=5, alpha=0.6)
        ax.plot(*shown.track.T, color=plotting.PATH, linewidth=2)
        for seam in choices.seams:
            chosen = seam.seam == pick.seam  # which is larger
            look = {"markersize": 11 if chosen else 6, "markeredgecolor": "black" if chosen else "white"}
            ax.plot(*shown.track[seam.frame], "D", color=plotting.MARK, **look)
        ax.set(xlabel="x (m)", ylabel="z (m)", aspect="equal")
        ax.invert_xaxis()
    elif choices.graph is not None:
        plotting.timeline(choices.graph, each=EACH, most=MOST, ax=ax)
        ends = [(pick.i / fps, -pick.first), ((pick.j + choices.window) / fps, -pick.second)]
        ax.plot(*zip(*ends, strict=True), "o-", color=plotting.MARK, markeredgecolor="black", linewidth=2.5)
    elif choices.grid is not None:
        names = [clip.name for clip in choices.clips]
        plotting.distance_image(choices.grid, fps=fps, minima=choices.minima, names=names, ax=ax)
        at = (pick.j + 0.5) / fps, (pick.i + 0.5) / fps
        ax.plot(*at, "o", color="none", markeredgecolor="black", markersize=13, markeredgewidth=3)
        ax.plot(*at, "o", color="none", markeredgecolor="white", markersize=13, markeredgewidth=1.5)
