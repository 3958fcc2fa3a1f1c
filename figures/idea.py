"""The whole idea in one short moving picture: clips, their graph, a line, and a walk along it.

`python figures/idea.py` writes idea.gif.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from PIL import Image

from mocap import body, datasets, graphs, steering, synthesis
from mocap._shared.arrays import Array
from mocap.body.kinematics import joint_positions
from mocap.graphs.motion_graph import MotionGraph
from mocap.plotting import ASKED, FLOOR, MARK, bones
from mocap.plotting.style import source_colours
from mocap.steering.followed import Followed

SHOWN = ("walk_curve_1", "walk_circle", "jog")  # the clips that are seen to move
LINE = [(-1.2, 0.2), (-0.8, 2.2), (1.2, 3.4), (3.0, 4.6), (3.4, 6.4)]  # (x, z), metres
RATE = 10  # pictures per second
CLIPS, ARCS, DRAW = 1.5, 3.0, 4.2  # seconds at which the graph, the line and the walk begin
REST = 1.0  # seconds at the end
COLOURS = 32  # of the picture
INK = "#333333"


class Picture:
    """Three parts of one picture: clips above their graph at the left, the ground at the right."""

    def __init__(self) -> None:
        names = [name for name in datasets.SAMPLES if name not in ("sneak", "stop_and_go")]
        clips = [body.resample(datasets.sample(name), 30) for name in names]
        self.graph: MotionGraph = graphs.prune(graphs.build(clips, window=10, threshold=0.04))
        self.path = body.spline(LINE)
        self.followed: Followed = steering.follow_path(self.graph, self.path)
        self.walk = self.followed.motion(clean=True)
        self.cloud = joint_positions(self.walk)
        self.colours = source_colours(list(SHOWN) + [clip.name for clip in self.graph.clips])
        self.sources = synthesis.sources(self.graph, self.followed.walk)
        self.seams = [seam.frame for seam in synthesis.seams(self.graph, self.followed.walk)]
        self.lines = bones(self.walk.skeleton)
        self.seconds = DRAW + self.walk.duration + REST

    def frames(self) -> Iterator[Image.Image]:
        """Draw the pictures, one after the other."""
        figure = Figure(figsize=(8, 4), dpi=90)
        canvas = FigureCanvasAgg(figure)
        for time in np.arange(0, self.seconds, 1 / RATE):
            figure.clear()
            self._clips(figure.add_axes((0.01, 0.5, 0.42, 0.42)), time)
            self._graph(figure.add_axes((0.01, 0.02, 0.42, 0.4)), time)
            self._ground(figure.add_axes((0.45, 0.02, 0.54, 0.9)), time)
            canvas.draw()
            yield Image.fromarray(np.asarray(canvas.buffer_rgba())).convert("RGB")

    def _body(self, ax: Axes, points: Array, colour: str, wide: float) -> None:
        """Draw a body whose joints are at `points` of the picture, shape (J, 2)."""
        starts, ends, _ = self.lines
        ax.add_collection(LineCollection(list(points[np.stack([starts, ends], 1)]), colors=colour, lw=wide))
        head = [joint for joint, name in enumerate(self.walk.skeleton.names) if "head" in name.lower()][-1]
        ax.plot(*points[head], "o", color=colour, markersize=3 * wide)

    def _clips(self, ax: Axes, time: float) -> None:
        _prepare(ax, "clips", (-0.4, 3.4), (-0.3, 1.9))
        for place, name in enumerate(SHOWN):
            clip = datasets.sample(name)
            at = round((2 + time) * clip.fps) % len(clip)
            points = joint_positions(clip[at : at + 1])[0]
            ahead = body.heading(clip.rotations[at : at + 1, 0])[0]
            along = (points - points[0]) @ [np.sin(ahead), 0, np.cos(ahead)]
            self._body(ax, np.stack([along + 0.3 + 1.2 * place, points[:, 1]], -1), self.colours[name], 2)
            ax.text(0.3 + 1.2 * place, -0.12, name, ha="center", va="top", fontsize=7, color=INK)

    def _graph(self, ax: Axes, time: float) -> None:
        """Draw each clip as a bar, some transitions as arcs, and where the walk is at the moment."""
        longest = max(len(clip) for clip in self.graph.clips)
        clips = len(self.graph.clips)
        _prepare(
            ax, "one graph: arcs lead to like moments" if time > CLIPS else "", (-0.02, 1.02), (-0.5, clips)
        )
        for row, clip in enumerate(self.graph.clips):
            ax.plot([0, len(clip) / longest], [row, row], color=self.colours[clip.name], lw=4, alpha=0.8)
        found = [(a, b) for a, b, kind in self.graph.graph.edges(data="kind") if kind == "transition"]
        chosen = [found[i] for i in np.random.default_rng(1).permutation(len(found))[:90]]
        share = np.clip((time - CLIPS) / (ARCS - CLIPS), 0, 1)
        for (clip, leave), (other, enter) in chosen[: round(share * len(chosen))]:
            ax.plot([leave / longest, enter / longest], [clip, other], color=MARK, lw=0.6, alpha=0.7)
        if time >= DRAW:
            at = min(int((time - DRAW) * self.walk.fps), len(self.walk) - 1)
            clip, frame = self._playing(at)
            ax.plot(frame / longest, clip, "o", color=INK, markersize=7)

    def _playing(self, frame: int) -> tuple[int, int]:
        """Find the clip, and its frame, that the walk plays."""
        table = graphs.frame_table(graphs.edge_table(self.graph, self.followed.walk), self.graph.window)
        clip, at = table.owner[frame]
        return int(clip), int(at)

    def _ground(self, ax: Axes, time: float) -> None:
        title = "draw a line" if time < DRAW else "a walk that nobody walked"
        _prepare(ax, title if time >= ARCS else "", (-2.3, 6.2), (-1.7, 5.4))
        for x in range(-2, 6):
            ax.plot(*_seen([(x, 0, -1), (x, 0, 8)]).T, color=FLOOR, lw=0.8)
        for z in range(-1, 9):
            ax.plot(*_seen([(-2, 0, z), (5, 0, z)]).T, color=FLOOR, lw=0.8)
        asked = np.insert(self.path.points, 1, 0, axis=-1)
        share = np.clip((time - ARCS) / (DRAW - ARCS), 0, 1)
        ax.plot(*_seen(asked[: 1 + round(share * (len(asked) - 1))]).T, color=ASKED, lw=6, alpha=0.5)
        if time < DRAW:
            return
        at = min(int((time - DRAW) * self.walk.fps), len(self.walk) - 1)
        ends = [*(start for start, _ in self.sources[1:]), len(self.walk)]
        colour = INK
        for (start, name), end in zip(self.sources, ends, strict=True):
            if start <= at:
                colour = self.colours[name]
                trail = self.cloud[start : min(end, at) + 1, 0] * [1, 0, 1]
                ax.plot(*_seen(trail).T, color=colour, lw=2)
        ax.text(1.6, -1.45, "◆ a seam: from one clip into another", fontsize=8, color=MARK, ha="center")
        seams = self.cloud[[seam for seam in self.seams if seam <= at], 0] * [1, 0, 1]
        ax.plot(*_seen(seams).T, "D", color=MARK, markersize=5)
        for ghost in range(at - 36, 0, -36):
            self._body(ax, _seen(self.cloud[ghost]), "#BBBBBB", 1)
        self._body(ax, _seen(self.cloud[at]), colour, 2.4)


def _seen(points: object) -> Array:
    """Project points, shape (..., 3), in parallel: x to the right, z up and away."""
    x, y, z = np.moveaxis(np.asarray(points, float), -1, 0)
    return np.stack([x + 0.12 * z, 0.5 * z + 0.87 * y], axis=-1)


def _prepare(ax: Axes, title: str, across: tuple[float, float], up: tuple[float, float]) -> None:
    ax.set_axis_off()
    ax.set(xlim=across, ylim=up)
    ax.set_title(title, fontsize=10, color=INK, pad=2)


def write(path: Path) -> None:
    """Write the moving picture; each frame keeps only what changed."""
    first, *rest = (frame.quantize(COLOURS, dither=Image.Dither.NONE) for frame in Picture().frames())
    first.save(path, save_all=True, append_images=rest, duration=1000 // RATE, loop=0, optimize=True)


if __name__ == "__main__":
    write(Path(__file__).with_name("idea.gif"))
