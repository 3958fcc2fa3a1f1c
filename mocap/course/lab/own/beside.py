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
from mocap.course.lab.own.building import PARTS, Tools, build_own, packages, tools
from mocap.course.lab.own.walking import follow_own, play_own
from mocap.errors import MocapWarning
from mocap.graphs import build, prune
from mocap.plotting import Picture, bodies_along, stack
from mocap.steering import follow_path
from mocap.synthesis import seams

WINDOW, THRESHOLD = 10, 0.05  # of the transitions: frames, and metres


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
    """A line of the table: an exercise, whose function ran, how often, and both's seconds."""

    name: str
    yours: bool
    calls: int
    seconds: float
    package_seconds: float

    def cells(self, *, timed: bool) -> str:
        """Write it as cells of a table."""
        whose = "yours" if self.yours else "the package's"
        if self.name in PARTS and not self.yours:
            whose = f"made of <code>{PARTS[self.name]}</code>"
        row = f"<td><code>{self.name}</code> ({notebook_of(self.name)})</td><td>{whose}</td>"
        times = f"<td>{self.seconds:.2f}</td><td>{self.package_seconds:.2f}</td>"
        return f"{row}<td>{self.calls}</td>{times if timed else ''}"


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
        text = self.report()
        bundle["text/html"] += f"<pre>{html.escape(text)}</pre>{self._table()}"
        bundle["text/plain"] = text
        return bundle, metadata

    def picture(self) -> Picture:
        """Draw both walks as bodies along the path."""
        titles = {"my walk": self.own, "the package's walk, by steering.follow_path": self.package}
        figures = []
        for title, walked in titles.items():
            figure = bodies_along(walked.motion, seams=walked.seams, path=self.path.points)
            figure.suptitle(title, fontsize=11)
            figures.append(figure)
        alt = f"Bodies walk along a black path, above in my walk, below in the package's. {self.report()}"
        return stack(figures, alt)

    def _table(self) -> str:
        """Make the table; it has times where some function is one's own; else nothing is compared."""
        timed = any(line.yours for line in self.lines)
        head = "<th>exercise</th><th>whose</th><th>calls</th>"
        rows = [head, *(line.cells(timed=timed) for line in self.lines)]
        if timed:
            rows[0] += "<th>seconds, mine</th><th>seconds, the package's</th>"
            both = (f"<td>{walked.seconds:.1f}</td>" for walked in (self.own, self.stand_ins))
            rows.append(f"<td>the whole walk</td><td></td><td></td>{''.join(both)}")
        return f"<table>{''.join(f'<tr>{row}</tr>' for row in rows)}</table>"


def walk_beside(clips: Sequence[Motion], path: ArrayLike) -> Beside:
    """Walk along a path by the functions of the exercises, and by the package: windows of 10 frames, 5 cm.

    Parameters
    ----------
    clips : motions of one skeleton and one frame rate, some hundred frames in all: one's own code is slow.
    path : corners on the ground (x, z), shape (N, 2), metres, as from a canvas.

    Returns
    -------
    Both walks and a table; the last line of a cell shows them.

    Raises
    ------
    NoWalk, MocapError : as for `build_own` and `follow_own`.

    Notebook: 08-path-synthesis
    """
    line, ours = GroundPath(np.asarray(path, float)), tools()
    for slot in vars(ours).values():
        slot.calls, slot.seconds = 0, 0.0
    own = _own_walk(clips, line, ours)
    stand_ins, theirs = own, ours
    if any(slot.yours for slot in vars(ours).values()):
        theirs = packages()
        stand_ins = _own_walk(clips, line, theirs)
    lines = tuple(
        Line(name, slot.yours, slot.calls, slot.seconds, vars(theirs)[name].seconds)
        for name, slot in vars(ours).items()
        if name != "next_edge"  # it steers
    )
    begun = time.perf_counter()
    graph = prune(build(clips, window=WINDOW, threshold=THRESHOLD))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", MocapWarning)  # the report says how far it is off
        followed = follow_path(graph, line)
    at = tuple(seam.frame for seam in seams(graph, followed.walk))
    package = Walked(followed.motion(), at, time.perf_counter() - begun)
    return Beside(line, own, stand_ins, package, lines)


def _own_walk(clips: Sequence[Motion], path: GroundPath, by: Tools) -> Walked:
    begun = time.perf_counter()
    graph = build_own(clips, WINDOW, THRESHOLD, by)
    walk = follow_own(graph, path.points, by)
    ends = np.cumsum([0, *(len(edge.track) - 1 for edge in walk.edges)])
    at = tuple(int(frame) for frame, edge in zip(ends, walk.edges, strict=False) if edge.match)
    return Walked(play_own(graph, walk, by), at, time.perf_counter() - begun)
