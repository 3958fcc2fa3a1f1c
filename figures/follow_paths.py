"""Follow paths, and measure how well: `python figures/follow_paths.py [FOLDER OF CMU SUBJECT 16]`.

Writes the tables `following.md` and the pictures `following.png`, `bending.png` and `trade_off.png` beside
this script. Times are CPU seconds, the least of three runs, as shares of the motion's duration.
"""

import gc
import sys
import time
import warnings
from collections.abc import Callable
from itertools import combinations
from pathlib import Path

import matplotlib

matplotlib.use("agg")

import matplotlib.pyplot as plt
import numpy as np
from asked_lines import random_line
from bend_paths import beside
from matplotlib.axes import Axes

import mocap
from mocap import datasets, graphs
from mocap.body import SHAPES, GroundPath, circle, s_curve
from mocap.graphs.compiled_graph import CompiledGraph
from mocap.plotting import ASKED, CURVES, PATH
from mocap.plotting.picture import small_png
from mocap.quality import seam_quality, spread
from mocap.steering import (
    Controller,
    PathRequest,
    Settings,
    follow_as_2002,
    follow_path,
    measure_delay,
    walk_crowd,
)
from mocap.steering.followed import Followed
from mocap.synthesis.walk_to_motion import with_footplants

FOLDER = Path(__file__).parent
FREE = Settings(seam=0, match=0, width=200, tries=1)
OWN = ("walk_circle", "walk_curve_1", "walk_curve_2", "walk_straight", "stop_and_go")
CMU = (*range(11, 35), 47, 58)
OFFS = ("off", "off_at_length")


def compiled() -> dict[str, CompiledGraph]:
    """Build the graphs of the bundled clips and, where their folder is given, of CMU's."""
    clips = {"bundled clips": [datasets.sample(name) for name in OWN]}
    if len(sys.argv) > 1:
        clips["CMU 16, walks"] = [mocap.load(Path(sys.argv[1], f"16_{trial:02}.amc")) for trial in CMU]
    return {name: graphs.compile_graph(_graph(found)) for name, found in clips.items()}


def _graph(clips: list[mocap.Motion]) -> graphs.MotionGraph:
    clips = [mocap.resample(clip, 30) for clip in clips]
    return with_footplants(graphs.prune(graphs.build(clips, window=10, threshold=0.04)))


def timed(work: Callable[[], Followed], runs: int = 3) -> tuple[Followed, float]:
    """Do the work a few times; return its result and the least CPU time."""
    times = []
    for _ in range(runs):
        start = time.process_time()
        found = work()
        times.append(time.process_time() - start)
    return found, min(times)


def row(name: str, followed: Followed, seconds: float) -> str:
    """Write a row of the table."""
    usual, motions = spread(followed.graph.clips), [followed.motion(clean=clean) for clean in (False, True)]
    slides = [seam_quality(motion, (0, len(motion)), usual).foot_sliding for motion in motions]
    return (
        f"| {name} | {followed.path.length:.1f} | {followed.seconds:.1f} "
        f"| {100 * followed.off.mean():.1f} | {100 * followed.off.max():.1f} "
        f"| {100 * followed.off_at_length.mean():.1f} | {followed.seams_per_second:.2f} "
        f"| 1/{followed.seconds / seconds:.0f} "
        f"| {slides[0]:.1f} | {slides[1]:.1f} |"
    )


HEAD = [
    "| path | m | s | nearest, cm | worst, cm | at equal arc length, cm "
    "| seams/s | time | slide, cm | cleaned |",
    "|---|---|---|---|---|---|---|---|---|---|",
]


def table_of_shapes(name: str, graph: CompiledGraph, axes: list[Axes]) -> list[str]:
    """Follow every shape, and draw it: the path that was asked for in black, the walk in orange."""
    lines = [f"## {name}", "", *HEAD]
    for (shape, draw), ax in zip(SHAPES.items(), axes, strict=True):
        followed, seconds = timed(lambda draw=draw: follow_path(graph, draw()))
        lines.append(row(shape, followed, seconds))
        ax.plot(*followed.path.points.T, color=ASKED, linewidth=3)
        ax.plot(*followed.track.T, color=PATH, linewidth=1.5)
        ax.plot(*followed.track[0], "o", color=PATH, markersize=6)
        ax.set(aspect="equal", title=f"{shape}\n{name}")
        ax.invert_xaxis()
        ax.set_axis_off()
    for length in (5.0, 20.0, 80.0):
        followed, seconds = timed(lambda length=length: follow_path(graph, s_curve(length)), 1)
        lines.append(row(f"S-curve of {length:.0f} m", followed, seconds))
    return [*lines, ""]


def unseen(found: dict[str, CompiledGraph]) -> list[str]:
    """Follow lines by which no weight was chosen; count those that are followed within the bounds."""
    sets = {
        "40 random lines": [random_line(seed) for seed in range(500, 540)],
        "S-curves of 7 to 30 m": [s_curve(length) for length in (7.0, 8.5, 11, 13, 15, 17, 23, 26, 28, 30)],
        "circles of 1.5 to 5 m": [circle(radius) for radius in (1.5, 1.8, 2, 2.4, 2.7, 3.3, 3.7, 4, 4.5, 5)],
        "tight: circles of 0.8 to 1.2 m, an S of 5 m": [*map(circle, (0.8, 1.0, 1.2)), s_curve(5.0)],
    }
    lines = [f"| lines | {' | '.join(found)} |", "|---" * (len(found) + 1) + "|"]
    for name, paths in sets.items():
        walks = {graph: [follow_path(compiled, path) for path in paths] for graph, compiled in found.items()}
        cells = [f"{sum(walk.excess <= 1 for walk in some)} of {len(some)}" for some in walks.values()]
        lines.append(f"| {name} | {' | '.join(cells)} |")
    return [*lines, ""]


def against_the_paper(found: dict[str, CompiledGraph]) -> list[str]:
    """Follow ten random lines in layers, as they are and with free seams, and by the paper's search."""
    lines = [
        "| clips | search | nearest, cm | nearer than the paper's | seams/s | walks expanded |",
        "|---|---|---|---|---|---|",
    ]
    paths = [GroundPath(random_line(seed).at(np.linspace(0, 7, 141))) for seed in range(500, 510)]
    for name, graph in found.items():
        ours = [follow_path(graph, path) for path in paths]
        starts = [PathRequest(start=walk.walk[0][0], correction=0) for walk in ours]
        best = {"look": (45, 15), "budget": 30_000}
        walks = {
            "layers": ours,
            "layers, seams are free": [follow_path(graph, path, settings=FREE) for path in paths],
            "the paper's": [follow_as_2002(graph, *pair, **best) for pair in zip(paths, starts, strict=True)],
        }
        offs = {search: np.array([100 * walk.off.mean() for walk in some]) for search, some in walks.items()}
        for search, some in walks.items():
            low, middle, high = np.percentile(offs[search], [25, 50, 75])
            nearer = int((offs[search] < offs["the paper's"]).sum())
            lines.append(
                f"| {name} | {search} | {middle:.1f} [{low:.1f}, {high:.1f}] "
                f"| {nearer} of {len(paths)} "
                f"| {np.median([walk.seams_per_second for walk in some]):.2f} "
                f"| {np.median([walk.found.expanded for walk in some]):.0f} |"
            )
    return [*lines, ""]


def trade_off(found: dict[str, CompiledGraph]) -> list[str]:
    """Draw how far from the path walks are when they have fewer seams, and write the table."""
    figure, ax = plt.subplots(figsize=(5, 3.6), layout="constrained")
    lines = [
        "| price of a seam, m² | "
        + " | ".join(f"{name}: seams/s, nearest, equal arc length" for name in found)
        + " |"
    ]
    lines.append("|---" * (len(found) + 1) + "|")
    prices = (0.01, 0.03, 0.1, 0.3, 1.0, 3.0)
    points = {name: [_mean(graph, price) for price in prices] for name, graph in found.items()}
    for (name, curve), colour in zip(points.items(), CURVES, strict=False):
        ax.plot(*np.transpose(curve)[:2], "o-", color=colour, label=name)
    for place, price in enumerate(prices):
        cells = ["{:.2f}, {:.1f} cm, {:.1f} cm".format(*curve[place]) for curve in points.values()]
        lines.append(f"| {price} | " + " | ".join(cells) + " |")
    ax.set(xlabel="seams per second", ylabel="distance from the nearest point (cm)")
    ax.set(xlim=(0, None), ylim=(0, None))
    ax.spines[["top", "right"]].set_visible(False)
    ax.legend(frameon=False)
    (FOLDER / "trade_off.png").write_bytes(small_png(figure))
    return [*lines, ""]


def _mean(graph: CompiledGraph, price: float) -> tuple[float, float, float]:
    """Average seams per second, and centimetres from the path in both ways, over the shapes."""
    settings = Settings(seam=price, width=100, rescue=max(1.5, 2 * price), tries=1)
    walks = [follow_path(graph, draw(), settings=settings) for draw in SHAPES.values()]
    near, equal = (np.mean([100 * getattr(walk, name).mean() for walk in walks]) for name in OFFS)
    return float(np.mean([w.seams_per_second for w in walks])), float(near), float(equal)


def others(name: str, graph: CompiledGraph) -> str:
    """Measure control and a crowd."""
    gc.freeze()  # so that the collector does not visit older objects in the middle of a step
    delay = measure_delay(Controller(graph))
    paths = [GroundPath(ends) for ends in ([[0, 0], [0, 8]], [[4, 4], [-4, 4]], [[0.2, 8], [0.2, 0]])]
    alone = [follow_path(graph, path) for path in paths]
    crowd = walk_crowd(graph, paths)
    tracks = [walk.track[: min(len(walk.track) for walk in alone)] for walk in alone]
    passing = min(np.hypot(*(a - b).T).min() for a, b in combinations(tracks, 2))
    return (
        f"| {name} | {delay.mean:.1f} s, {delay.slowest:.1f} s "
        f"| {delay.waiting:.1f} s, {delay.blending:.1f} s "
        f"| {delay.step:.2f} ms, {delay.worst:.1f} ms "
        f"| {passing:.2f} m | {crowd.nearest.min():.2f} m | {max(crowd.waits):.0f} s |"
    )


def main() -> None:
    """Measure, draw, write."""
    warnings.simplefilter("ignore", mocap.MocapWarning)
    found = compiled()
    figure, axes = plt.subplots(
        len(found), len(SHAPES), figsize=(12, 3 * len(found)), squeeze=False, layout="constrained"
    )
    lines = ["# How well walks keep to their paths", ""]
    lines += [
        "Written by `python figures/follow_paths.py`. Distances are given in two ways: to the nearest point",
        "of the path, on average and at worst, and at equal arc length, on average, as in the paper's Eq. 9.",
        "Times are CPU seconds over the motion's. Slide: how far a planted foot strays from its place, on",
        "average over its plants, as it is and cleaned.",
        "",
    ]
    for (name, graph), ax in zip(found.items(), axes, strict=True):
        lines += table_of_shapes(name, graph, list(ax))
    (FOLDER / "following.png").write_bytes(small_png(figure))
    lines += ["## Against the paper's search at its best: n, m = 45, 15, 30 000 walks for each stretch", ""]
    lines += [
        "Ten random lines of 7 m; medians [quartiles]. `search_of_2002.md` has more budgets and graphs."
    ]
    lines += ["", *against_the_paper(found)]
    lines += [
        "## Other lines: within 4 cm of the nearest point on average, 15 cm at worst, 1 seam/s",
        "",
        *unseen(found),
    ]
    lines += ["## Seams against distance, the mean of the five shapes", "", *trade_off(found)]
    lines += beside(FOLDER, Path(sys.argv[1]) if len(sys.argv) > 1 else None)
    lines += ["## Control and crowds", ""]
    lines += [
        "| clips | obeys after: mean, 95 % | of it waiting, in transitions | a step: mean, worst "
        "| three paths cross: nearest | kept apart "
        "| waits at most |"
    ]
    lines += ["|---|---|---|---|---|---|---|", *(others(*item) for item in found.items()), ""]
    Path(FOLDER / "following.md").write_text("\n".join(lines), encoding="utf-8")
    print("\n".join(lines))


if __name__ == "__main__":
    main()
