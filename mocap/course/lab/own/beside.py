"""One's own walk beside the package's: the same path, the same clips, two pictures and a table."""

from __future__ import annotations

import html
import time
import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from mocap._shared.arrays import Array
from mocap.body.ground_path import GroundPath
from mocap.body.motion import Motion
from mocap.course.lab.adopting import notebook_of
from mocap.course.lab.guarding import Slot
from mocap.course.lab.own.by_hand import PARTS
from mocap.course.lab.own.pieces import build_own
from mocap.course.lab.own.playing import play_own
from mocap.course.lab.own.searching import follow_own
from mocap.course.lab.own.tools import Tools, packages, tools
from mocap.errors import MocapWarning
from mocap.graphs import build, prune
from mocap.plotting import Picture, bodies_along, stack
from mocap.steering import follow_path
from mocap.synthesis import seams


class Walked(NamedTuple):
    """A walk along a path: its motion, the frames of its seams, and the seconds that it took to make."""

    motion: Motion
    seams: tuple[int, ...]
    seconds: float

    def off(self, path: GroundPath) -> Array:
        """Measure how far the root is from the nearest point of a path in each frame, shape (F,), metres."""
        ground = self.motion.root_positions[:, None, [0, 2]]
        points = path.resampled(0.02).points
        return np.asarray(np.linalg.norm(ground - points, axis=-1).min(axis=1))


class Line(NamedTuple):
    """A line of the table: an exercise, its notebook, whose function ran, how often, and both's seconds."""

    name: str
    notebook: str
    yours: bool
    calls: int
    seconds: float
    package_seconds: float


@dataclass(frozen=True, eq=False)
class Beside:
    """Two walks along one path; a notebook shows them, with a table of whose functions ran.

    Parameters
    ----------
    path : the path that was asked for.
    own : the walk of the functions in their places.
    stand_ins : the same steps with the package's functions in all places.
    package : the walk of `steering.follow_path`.
    lines : the table.
    """

    path: GroundPath
    own: Walked
    stand_ins: Walked
    package: Walked
    lines: tuple[Line, ...]

    @property
    def motion(self) -> Motion:
        """The walk of the functions in their places; `mocap.save` writes it as BVH."""
        return self.own.motion

    @property
    def apart(self) -> float:
        """The largest distance of the root from that of the same steps by the package's functions, metres.

        Infinite where the two walks do not play the same number of frames.
        """
        ours, theirs = (walked.motion.root_positions for walked in (self.own, self.stand_ins))
        return float(np.linalg.norm(ours - theirs, axis=1).max()) if len(ours) == len(theirs) else np.inf

    def report(self) -> str:
        """Say how many functions are one's own, how near the walks are, and how long they took."""
        count = sum(line.yours for line in self.lines)
        apart = f"{100 * self.apart:.1f} cm" if np.isfinite(self.apart) else "another walk"
        lines = [f"{count} of {len(self.lines)} functions are yours, the others the package's."]
        for name, walked in (("my walk", self.own), ("the package's", self.package)):
            off = 100 * walked.off(self.path)
            long = f"{len(walked.motion) / walked.motion.fps:.1f} s long, {len(walked.seams)} seams"
            where = f"{off.mean():.1f} cm off on average, {off.max():.0f} cm at worst"
            lines.append(f"{name + ':':15}{long}, {where}")
        lines.append(f"My walk, and the same steps by the package's functions alone: {apart} apart at most.")
        return "\n".join(lines)

    def _repr_mimebundle_(self, **_: object) -> tuple[dict[str, str], dict[str, Any]]:
        bundle, metadata = self.picture()._repr_mimebundle_()
        text = html.escape(self.report())
        bundle["text/html"] += f"<pre>{text}</pre>{self._table()}"
        bundle["text/plain"] = self.report()
        return bundle, metadata

    def picture(self) -> Picture:
        """Draw both walks as bodies along the path."""
        titles = {"my walk": self.own, "the package's walk, by steering.follow_path": self.package}
        figures = []
        for title, walked in titles.items():
            figure = bodies_along(walked.motion, seams=walked.seams, path=self.path.points)
            figure.suptitle(title, fontsize=11)
            figures.append(figure)
        return stack(
            figures,
            f"Bodies walk along a black path, above in my walk, below in the package's. {self.report()}",
        )

    def _table(self) -> str:
        """Make the table; it has times where some function is one's own; else nothing is compared."""
        timed = any(line.yours for line in self.lines)
        head = "<th>exercise</th><th>whose</th><th>calls</th>"
        head += "<th>seconds, mine</th><th>seconds, the package's</th>" * timed
        rows = [head, *(_row(line, timed) for line in self.lines)]
        if timed:
            both = (f"<td>{walked.seconds:.1f}</td>" for walked in (self.own, self.stand_ins))
            rows.append(f"<td>the whole walk</td><td></td><td></td>{''.join(both)}")
        return f"<table>{''.join(f'<tr>{row}</tr>' for row in rows)}</table>"


def _row(line: Line, timed: bool) -> str:
    whose = "yours" if line.yours else "the package's"
    if line.name in PARTS and not line.yours:
        whose = f"made of <code>{PARTS[line.name]}</code>"
    row = f"<td><code>{line.name}</code> ({line.notebook})</td><td>{whose}</td><td>{line.calls}</td>"
    return row + f"<td>{line.seconds:.2f}</td><td>{line.package_seconds:.2f}</td>" * timed


def walk_beside(
    clips: Sequence[Motion], path: ArrayLike, *, window: int = 10, threshold: float = 0.05
) -> Beside:
    """Walk along a path by the functions of the exercises, and by the package.

    Parameters
    ----------
    clips : motions of one skeleton and one frame rate, some hundred frames in all: one's own code is slow.
    path : corners on the ground (x, z), shape (N, 2), metres, as from a canvas.
    window, threshold : of the transitions: frames, and metres.

    Returns
    -------
    Both walks and a table; the last line of a cell shows them.

    Raises
    ------
    NoWalk, MocapError : as for `build_own` and `follow_own`.

    Notebook: 08-path-synthesis
    """
    line = GroundPath(np.asarray(path, float))
    ours, theirs = tools(), packages()
    for slot in vars(ours).values():
        slot.calls, slot.seconds = 0, 0.0
    own = _own_walk(clips, line, (window, threshold), ours)
    any_own = any(slot.yours for slot in vars(ours).values())
    stand_ins = _own_walk(clips, line, (window, threshold), theirs) if any_own else own
    pairs = zip(vars(ours).values(), vars(theirs if any_own else ours).values(), strict=True)
    lines = tuple(_line(slot, other) for slot, other in pairs if slot.name != "next_edge")  # it steers
    return Beside(line, own, stand_ins, _package_walk(clips, line, (window, threshold)), lines)


def _line(slot: Slot, other: Slot) -> Line:
    return Line(slot.name, notebook_of(slot.name), slot.yours, slot.calls, slot.seconds, other.seconds)


def _own_walk(clips: Sequence[Motion], path: GroundPath, settings: tuple[int, float], by: Tools) -> Walked:
    begun = time.perf_counter()
    graph = build_own(clips, *settings, by)
    walk = follow_own(graph, path.points, by)
    motion = play_own(graph, walk, by)
    ends = np.cumsum([0, *(len(edge.track) - 1 for edge in walk.edges)])
    at = tuple(int(frame) for frame, edge in zip(ends, walk.edges, strict=False) if edge.match)
    return Walked(motion, at, time.perf_counter() - begun)


def _package_walk(clips: Sequence[Motion], path: GroundPath, settings: tuple[int, float]) -> Walked:
    begun = time.perf_counter()
    graph = prune(build(clips, window=settings[0], threshold=settings[1]))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", MocapWarning)  # the report says how far it is off
        followed = follow_path(graph, path)
    at = tuple(seam.frame for seam in seams(graph, followed.walk))
    return Walked(followed.motion(), at, time.perf_counter() - begun)
