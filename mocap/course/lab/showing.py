"""The widget itself: what a notebook shows of it, live, as a picture or as a sentence, and what a page needs.

A clip is sent as its root's places and its joints' rotations, so that the page can blend them. All numbers
are multiples of 5e-6 (metres, or parts of a quaternion), as second differences over time: these are small.
Their bytes go in four planes, the lowest bytes first; the upper planes are almost empty, and compress well.
"""

from __future__ import annotations

import zlib
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from mocap._shared.arrays import Array, Indices, Mask
from mocap.body import rotations
from mocap.body.limbs import find_legs
from mocap.body.motion import Motion
from mocap.body.skeleton import Skeleton
from mocap.course.diagrams.windows import storyboard
from mocap.course.lab.choices import (
    CELLS,
    EACH,
    MOST,
    Choices,
    Pick,
    margin_frames,
    of_clips,
    of_graph,
    of_walk,
)
from mocap.errors import MocapError
from mocap.graphs.motion_graph import MotionGraph
from mocap.matching.point_clouds import distinct_joints, rms_distance
from mocap.plotting import ASKED, COLOURS, CURVES, MARK, PATH, QUIET, SOURCES, distance_image, timeline
from mocap.plotting.picture import small_png
from mocap.steering.followed import Followed
from mocap.widgets.embedding import SHARED, TOUCH, Embedded
from mocap.widgets.player import SIDES, packed, packed_body, with_contacts

TABS = ("windows", "turn", "weights", "seam")  # in the order in which the course meets them
PARTS = ("", "_maths", "_maps", "_stage", "_views", "_page")
OWN = [Path(__file__).with_name(f"inspector{part}.js") for part in PARTS]
NOWHERE = np.empty((0, 2))
STEP = 5e-6  # what a unit of a number means: a clip at 120 Hz needs it so fine, or its jolts would tremble
KEY = "Solid lines: the first clip. Dashed: the second. Blue is left, orange-red is right."
WIDEST = 600  # rows and columns of a grid's picture; of more, blocks of cells become one
LOOK: dict[str, Any] = {"sides": [COLOURS[side] for side in ("middle", "left", "right")]}
LOOK |= {"curves": list(CURVES), "sources": list(SOURCES)}
LOOK |= {"seam": MARK, "path": PATH, "asked": ASKED, "quiet": QUIET}


# reads: name: notebooks use `at`
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
    >>> inspector(*walks, at=(50, 18), show=["windows"])
    Inspector('Frames 50 to 59 of walk_curve_1 and 18 to 27 of walk_curve_2: RMS distance 2.1 cm, aligned.')

    Notebook: 02-matching

    """
    tabs = tuple(show) if isinstance(show, Sequence) else ()
    if not tabs or tabs != TABS[: len(tabs)]:
        raise MocapError(f"An inspector shows {', '.join(TABS)}, or the first of these, not {show!r:.80}.")
    single = what[0] if len(what) == 1 else None
    if isinstance(single, Followed | MotionGraph) and (at or window):
        raise MocapError("A graph and a walk bring windows of their own: leave out at= and window=.")
    if isinstance(single, Followed):
        choices = of_walk(single.graph, single.walk)
        return Inspector(choices, tabs, single.track, single.path.points)
    if isinstance(single, MotionGraph):
        return Inspector(of_graph(single), tabs)
    clips = [clip for clip in what if isinstance(clip, Motion)]
    if not 0 < len(clips) == len(what) <= 2:
        raise MocapError("An inspector takes one or two clips, a graph, or what follow_path found.")
    return Inspector(of_clips(clips, round(clips[0].fps / 3) if window is None else window, at), tabs)


@dataclass(frozen=True, eq=False, repr=False)
class Inspector(Embedded):
    """The result of `inspector`; a notebook shows it live, as a picture of its panels, or as a sentence.

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
    path: Array = field(default_factory=lambda: NOWHERE)
    scripts = (*SHARED, TOUCH, *OWN)

    @cached_property
    def alt(self) -> str:
        """Which windows are looked at, how far apart they are, and at which turn."""
        choices = self.choices
        first, second = choices.windows
        starts = choices.pick.i, choices.pick.j
        frames, second_frames = (f"{start} to {start + choices.window - 1}" for start in starts)
        turn = f" at θ = {np.degrees(choices.fit.angle):.0f}°".replace("-", "−")
        laid = turn if "turn" in self.show else ", aligned"
        distance = f"RMS distance {100 * rms_distance(*choices.pair):.1f} cm{laid}"
        return f"Frames {frames} of {first.name} and {second_frames} of {second.name}: {distance}."

    @cached_property
    def scene(self) -> dict[str, Any]:
        """The scene of the scripts; `data` holds the clips' numbers and the grid's shades, compressed."""
        choices = self.choices
        fps = choices.clips[0].fps
        descriptions = []
        data = b""
        for number, clip in enumerate(choices.clips):
            description, block = packed_clip(clip, len(data), choices.needed(number))
            descriptions.append(description)
            data += block
        grid, shades = _shades(choices, len(data))
        scene: dict[str, Any] = {"alt": self.alt, "fps": fps, "window": choices.window}
        scene["around"] = margin_frames(fps)
        scene["cells"] = CELLS
        scene["tabs"] = list(self.show)
        scene["tab"] = self.show[0] if self.show[-1] == "seam" else self.show[-1]
        scene["skeleton"] = packed_skeleton(choices.clips[0].skeleton)
        scene["clips"] = descriptions
        scene["colours"] = LOOK
        scene["pick"] = _pick(choices.pick)
        scene["grid"] = grid
        scene["graph"] = _graph(choices)
        scene["walk"] = self._walk()
        scene["key"] = f"{KEY} The grid by {choices.by}." if choices.by else KEY
        scene["data"] = zlib.compress(data + shades, 9)
        return scene

    def _walk(self) -> dict[str, Any] | None:
        """Return a walk from above with its seams, if there is one."""
        if not self.choices.seams:
            return None
        seams = []
        for seam in self.choices.seams:
            pick = _pick(seam)
            cell = [pick[name] for name in ("first", "i", "second", "j")]
            seams.append({"pick": cell} | {name: pick[name] for name in ("before", "after", "frame")})
        return {"path": self.track.round(3).tolist(), "asked": self.path.round(3).tolist(), "seams": seams}

    @cached_property
    def picture(self) -> bytes:
        """Panels as a PNG, for places where no script runs."""
        return small_png(storyboard(self._draw_where, self.choices.pair, self.choices.seam, self.show))

    def _draw_where(self, ax: Any) -> None:  # noqa: ANN401 (axes)
        """Draw what can be pointed at: the walk from above, or the graph along time, or the distance grid."""
        choices = self.choices
        pick = choices.pick
        fps = choices.clips[0].fps
        if choices.seams:
            ax.plot(*self.path.T, color=ASKED, linewidth=5, alpha=0.6)
            ax.plot(*self.track.T, color=PATH, linewidth=2)
            for seam in choices.seams:
                chosen = seam.seam == pick.seam  # which is larger
                look = {"markersize": 11 if chosen else 6, "markeredgecolor": "black" if chosen else "white"}
                ax.plot(*self.track[seam.frame], "D", color=MARK, **look)
            ax.set(xlabel="x (m)", ylabel="z (m)", aspect="equal")
            ax.invert_xaxis()
        elif choices.graph is not None:
            timeline(choices.graph, each=EACH, most=MOST, ax=ax)
            times = [pick.i / fps, (pick.j + choices.window) / fps]
            ax.plot(
                times, [-pick.first, -pick.second], "o-", color=MARK, markeredgecolor="black", linewidth=2.5
            )
        elif choices.grid is not None:
            names = [clip.name for clip in choices.clips]
            distance_image(choices.grid, fps=fps, minima=choices.minima, names=names, ax=ax)
            cell = (pick.j + 0.5) / fps, (pick.i + 0.5) / fps
            ax.plot(*cell, "o", color="none", markeredgecolor="black", markersize=13, markeredgewidth=3)
            ax.plot(*cell, "o", color="none", markeredgecolor="white", markersize=13, markeredgewidth=1.5)


def _shades(choices: Choices, offset: int) -> tuple[dict[str, Any] | None, bytes]:
    """Turn a grid into shades from 0, the lowest distance, to 255; a block of cells has its lowest shade."""
    if choices.grid is None:
        return None, b""
    distances = np.sqrt(choices.grid)
    size = -(-max(distances.shape) // WIDEST)  # rows and columns of a block
    rows, columns = (-(-count // size) for count in distances.shape)
    missing = [(0, -count % size) for count in distances.shape]
    blocks = np.pad(distances, missing, "edge").reshape(rows, size, columns, size)
    lowest = blocks.min(axis=(1, 3))
    span = max(float(np.ptp(lowest)), 1e-9)
    shades = np.round(255 * (lowest - lowest.min()) / span).astype(np.uint8)
    description = {"rows": rows, "columns": columns, "every": size, "offset": offset}
    return description | {"minima": choices.minima}, shades.tobytes()


def _pick(pick: Pick) -> dict[str, int]:
    """Return two windows as the scripts name their parts."""
    values = {name: int(value) for name, value in pick._asdict().items()}
    return {name.removeprefix("margin_"): value for name, value in values.items()}


def _graph(choices: Choices) -> dict[str, Any] | None:
    """List a graph's transitions, and the stretches of its clips that it plays."""
    if choices.graph is None:
        return None
    spans: list[list[int]] = []
    for (clip, start), (_, end), kind in sorted(choices.graph.graph.edges(data="kind")):
        if kind == "clip" and spans and spans[-1][::2] == [clip, start]:
            spans[-1][2] = int(end)
        elif kind == "clip":
            spans.append([int(clip), int(start), int(end)])
    offered = zip(choices.transitions, choices.costs, strict=True)
    return {"transitions": [[*map(int, p[:4]), round(100 * cost, 2)] for p, cost in offered], "spans": spans}


def packed_clip(motion: Motion, offset: int, needed: Mask) -> tuple[dict[str, Any], bytes]:
    """Pack a clip.

    Parameters
    ----------
    motion : F frames.
    offset : where its bytes will start.
    needed : shape (F,), the frames that count; the others repeat the last one that does, and take no room.

    Returns
    -------
    What the numbers mean, and the numbers: 3 + 4 J of each frame, 4 bytes each. Of `plants`, a digit per
    frame says which feet stand: 2 the left, 4 the right, 6 both, 0 none.

    Examples
    --------
    >>> from mocap.datasets.samples import sample
    >>> about, block = packed_clip(sample("walk_straight")[:60], 0, np.ones(60, bool))
    >>> about["frames"], about["channels"], len(block) == 4 * 60 * about["channels"], about["plants"][:3]
    (60, 155, True, '444')
    """
    origin = motion.root_positions[0] * [1, 0, 1]
    turns = rotations.continuous(motion.rotations).reshape(len(motion), -1)
    numbers = np.concatenate([motion.root_positions - origin, turns], axis=1)
    kept = numbers[np.maximum.accumulate(np.where(needed, np.arange(len(needed)), 0))]
    planes = np.frombuffer(packed(kept, 0.0, STEP, "<i4"), np.uint8).reshape(-1, 4).T
    standing = np.zeros((len(SIDES), len(motion)), int)
    for name, marks in with_contacts(motion).contacts.items():
        standing[SIDES.index(motion.skeleton.side(motion.skeleton.index(name)))] |= marks
    _, left_foot, right_foot = standing
    description: dict[str, Any] = {"name": motion.name, "frames": len(motion)}
    description |= {"channels": numbers.shape[1], "offset": offset, "origin": origin[[0, 2]].tolist()}
    description["plants"] = "".join(map(str, 2 * left_foot + 4 * right_foot))
    return description, planes.tobytes()


def packed_skeleton(skeleton: Skeleton) -> dict[str, Any]:
    """List what draws and measures a body: parents, offsets, points, bones, head and balls of the feet.

    Examples
    --------
    >>> from mocap.datasets.samples import SKELETON
    >>> body = packed_skeleton(SKELETON)
    >>> [(SKELETON.names[joint], SIDES[side]) for joint, side in body["feet"]]
    [('ltoes', 'left'), ('rtoes', 'right')]
    """
    joints, body = packed_body(skeleton)
    try:
        balls = [leg.ball for leg in find_legs(skeleton)]
    except MocapError:
        balls = []
    drawn: dict[str, Any] = {"parents": skeleton.parents.tolist(), "offsets": skeleton.offsets.tolist()}
    drawn["points"] = list(map(int, distinct_joints(skeleton)))
    drawn["bones"] = [_bone(joints, bone) for bone in body["bones"]]
    drawn["head"] = None if body["head"] is None else int(joints[body["head"]])
    drawn["feet"] = [[int(ball), SIDES.index(skeleton.side(ball))] for ball in balls]
    return drawn


def _bone(joints: Indices, bone: Sequence[int]) -> list[int]:
    """Return the joints at both ends of a bone, and its side."""
    start, end, side = bone
    return [int(joints[start]), int(joints[end]), side]
