"""Follow paths, and measure how well: `python figures/follow_paths.py [FOLDER OF CMU SUBJECT 16]`.

Writes the tables `following.md` and the pictures `following.png`, `bending.png` and `trade_off.png` beside
this script. Times are CPU seconds, the least of three runs, as shares of the motion's duration.
"""

import gc
import sys
import time
import warnings
from collections.abc import Callable, Mapping, Sequence
from itertools import combinations
from pathlib import Path
from typing import NamedTuple

import matplotlib

matplotlib.use("agg")

import matplotlib.pyplot as plt
import numpy as np
from asked_lines import random_line
from bend_paths import bending_section
from matplotlib.axes import Axes
from matplotlib.figure import Figure

import mocap
from mocap import datasets, graphs
from mocap._shared.arrays import Array
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
BUNDLED = ("walk_circle", "walk_curve_1", "walk_curve_2", "walk_straight", "stop_and_go")
CMU = (*range(11, 35), 47, 58)
PAPER = "the paper's"  # search, by branch and bound
PRICES = (0.01, 0.03, 0.1, 0.3, 1.0, 3.0)  # m², of a seam

Graphs = Mapping[str, CompiledGraph]  # by the names of their clips


def compile_graphs() -> dict[str, CompiledGraph]:
    """Build the graphs of the bundled clips and, if their folder is given, of CMU's."""
    clip_sets = {"bundled clips": [datasets.sample(name) for name in BUNDLED]}
    if len(sys.argv) > 1:
        clip_sets["CMU 16, walks"] = [mocap.load(Path(sys.argv[1], f"16_{trial:02}.amc")) for trial in CMU]
    return {name: graphs.compile_graph(_graph(clips)) for name, clips in clip_sets.items()}


def _graph(clips: list[mocap.Motion]) -> graphs.MotionGraph:
    clips = [mocap.resample(clip, 30) for clip in clips]
    return with_footplants(graphs.prune(graphs.build(clips, window=10, threshold=0.04)))


def timed(search: Callable[[], Followed], runs: int = 3) -> tuple[Followed, float]:
    """Run a search several times; return its walk and the least CPU time."""
    times = []
    for _ in range(runs):
        start = time.process_time()
        walk = search()
        times.append(time.process_time() - start)
    return walk, min(times)


def row(name: str, followed: Followed, seconds: float) -> str:
    """Write a row of the table."""
    mean = 100 * followed.off.mean()
    worst = 100 * followed.off.max()
    at_length = 100 * followed.off_at_length.mean()
    slide = foot_sliding(followed, clean=False)
    cleaned = foot_sliding(followed, clean=True)

    size = f"{followed.path.length:.1f} | {followed.seconds:.1f}"
    distances = f"{mean:.1f} | {worst:.1f} | {at_length:.1f}"
    paces = f"{followed.seams_per_second:.2f} | 1/{followed.seconds / seconds:.0f}"
    return f"| {name} | {size} | {distances} | {paces} | {slide:.1f} | {cleaned:.1f} |"


def foot_sliding(followed: Followed, *, clean: bool) -> float:
    """Average how far planted feet slide in a walk, cm."""
    motion = followed.motion(clean=clean)
    return seam_quality(motion, (0, len(motion)), spread(followed.graph.clips)).foot_sliding


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
        draw_walk(ax, followed)
        ax.set(aspect="equal", title=f"{shape}\n{name}")
        ax.invert_xaxis()
        ax.set_axis_off()
    for length in (5.0, 20.0, 80.0):
        followed, seconds = timed(lambda length=length: follow_path(graph, s_curve(length)), 1)
        lines.append(row(f"S-curve of {length:.0f} m", followed, seconds))
    return [*lines, ""]


def draw_walk(ax: Axes, followed: Followed) -> None:
    """Draw a path, the walk along it, and where the walk starts."""
    ax.plot(*followed.path.points.T, color=ASKED, linewidth=3)
    ax.plot(*followed.track.T, color=PATH, linewidth=1.5)
    ax.plot(*followed.track[0], "o", color=PATH, markersize=6)


def unseen_lines() -> dict[str, list[GroundPath]]:
    """Draw lines by which no weight was chosen."""
    random_lines = [random_line(seed) for seed in range(500, 540)]
    s_curves = [s_curve(length) for length in (7.0, 8.5, 11, 13, 15, 17, 23, 26, 28, 30)]
    circles = [circle(radius) for radius in (1.5, 1.8, 2, 2.4, 2.7, 3.3, 3.7, 4, 4.5, 5)]
    tight = [*map(circle, (0.8, 1.0, 1.2)), s_curve(5.0)]
    return {
        "40 random lines": random_lines,
        "S-curves of 7 to 30 m": s_curves,
        "circles of 1.5 to 5 m": circles,
        "tight: circles of 0.8 to 1.2 m, an S of 5 m": tight,
    }


def table_of_unseen_lines(compiled: Graphs) -> list[str]:
    """Follow lines by which no weight was chosen; count those that are followed within the bounds."""
    lines = [f"| lines | {' | '.join(compiled)} |", "|---" * (len(compiled) + 1) + "|"]
    for name, paths in unseen_lines().items():
        cells = [count_within_bounds(graph, paths) for graph in compiled.values()]
        lines.append(f"| {name} | {' | '.join(cells)} |")
    return [*lines, ""]


def count_within_bounds(graph: CompiledGraph, paths: Sequence[GroundPath]) -> str:
    """Count the paths that are followed within the bounds, as in "38 of 40"."""
    walks = [follow_path(graph, path) for path in paths]
    return f"{sum(walk.excess <= 1 for walk in walks)} of {len(walks)}"


def table_beside_the_paper(compiled: Graphs) -> list[str]:
    """Follow ten random lines in layers, as they are and with free seams, and by the paper's search."""
    lines = [
        "| clips | search | nearest, cm | nearer than the paper's | seams/s | walks expanded |",
        "|---|---|---|---|---|---|",
    ]
    paths = [GroundPath(random_line(seed).at(np.linspace(0, 7, 141))) for seed in range(500, 510)]
    for name, graph in compiled.items():
        walks_of = follow_by_each_search(graph, paths)
        distances = {search: mean_distances(walks) for search, walks in walks_of.items()}
        for search, walks in walks_of.items():
            wins = int((distances[search] < distances[PAPER]).sum())
            cells = f"{quartiles(distances[search])} | {wins} of {len(paths)} | {efforts(walks)}"
            lines.append(f"| {name} | {search} | {cells} |")
    return [*lines, ""]


def follow_by_each_search(graph: CompiledGraph, paths: Sequence[GroundPath]) -> dict[str, list[Followed]]:
    """Follow paths in layers and by the paper's search, which starts where the search in layers does."""
    layered = [follow_path(graph, path) for path in paths]
    with_free_seams = [follow_path(graph, path, settings=FREE) for path in paths]
    by_branch_and_bound = []
    for path, walk in zip(paths, layered, strict=True):
        request = PathRequest(start=walk.walk[0][0], correction=0)
        by_branch_and_bound.append(follow_as_2002(graph, path, request, look=(45, 15), budget=30_000))
    return {"layers": layered, "layers, seams are free": with_free_seams, PAPER: by_branch_and_bound}


def mean_distances(walks: Sequence[Followed]) -> Array:
    """Average each walk's distance from the nearest point of its path, cm."""
    return np.array([100 * walk.off.mean() for walk in walks])


def quartiles(values: Array) -> str:
    """Write a median and its quartiles."""
    low, middle, high = np.percentile(values, [25, 50, 75])
    return f"{middle:.1f} [{low:.1f}, {high:.1f}]"


def efforts(walks: Sequence[Followed]) -> str:
    """Write two cells: the medians of seams per second and of the partial walks that were expanded."""
    seams = np.median([walk.seams_per_second for walk in walks])
    expanded = np.median([walk.found.expanded for walk in walks])
    return f"{seams:.2f} | {expanded:.0f}"


def trade_off(compiled: Graphs) -> list[str]:
    """Draw the mean distance from the path over the seams per second, and write the table."""
    columns = " | ".join(f"{name}: seams/s, nearest, equal arc length" for name in compiled)
    lines = [f"| price of a seam, m² | {columns} |", "|---" * (len(compiled) + 1) + "|"]
    curves = {name: [_means_of_shapes(graph, price) for price in PRICES] for name, graph in compiled.items()}
    (FOLDER / "trade_off.png").write_bytes(small_png(draw_trade_off(curves)))
    for number, price in enumerate(PRICES):
        cells = ["{:.2f}, {:.1f} cm, {:.1f} cm".format(*means[number]) for means in curves.values()]
        lines.append(f"| {price} | " + " | ".join(cells) + " |")
    return [*lines, ""]


class Means(NamedTuple):
    """Means over the shapes: seams per second, and centimetres from the path in both ways."""

    seams_per_second: float
    to_nearest: float
    at_length: float


def _means_of_shapes(graph: CompiledGraph, price: float) -> Means:
    """Follow all shapes at a price of a seam, and average."""
    settings = Settings(seam=price, width=100, rescue=max(1.5, 2 * price), tries=1)
    walks = [follow_path(graph, draw(), settings=settings) for draw in SHAPES.values()]
    seams_per_second = np.mean([walk.seams_per_second for walk in walks])
    to_nearest = np.mean([100 * walk.off.mean() for walk in walks])
    at_length = np.mean([100 * walk.off_at_length.mean() for walk in walks])
    return Means(float(seams_per_second), float(to_nearest), float(at_length))


def draw_trade_off(curves: Mapping[str, list[Means]]) -> Figure:
    """Draw a curve for each graph: the distance from the nearest point over the seams per second."""
    figure, ax = plt.subplots(figsize=(5, 3.6), layout="constrained")
    for (name, means), colour in zip(curves.items(), CURVES, strict=False):
        seams = [mean.seams_per_second for mean in means]
        ax.plot(seams, [mean.to_nearest for mean in means], "o-", color=colour, label=name)
    ax.set(xlabel="seams per second", ylabel="distance from the nearest point (cm)")
    ax.set(xlim=(0, None), ylim=(0, None))
    ax.spines[["top", "right"]].set_visible(False)
    ax.legend(frameon=False)
    return figure


def control_row(name: str, graph: CompiledGraph) -> str:
    """Measure the delay of control, and the distances in a crowd whose paths cross."""
    gc.freeze()  # so that the collector does not visit older objects in the middle of a step
    delay = measure_delay(Controller(graph))
    paths = [GroundPath(ends) for ends in ([[0, 0], [0, 8]], [[4, 4], [-4, 4]], [[0.2, 8], [0.2, 0]])]
    passing = least_distance([follow_path(graph, path) for path in paths])
    crowd = walk_crowd(graph, paths)
    response = f"{delay.mean:.1f} s, {delay.slowest:.1f} s | {delay.waiting:.1f} s, {delay.blending:.1f} s"
    step = f"{delay.step:.2f} ms, {delay.worst:.1f} ms"
    distances = f"{passing:.2f} m | {crowd.nearest.min():.2f} m"
    return f"| {name} | {response} | {step} | {distances} | {max(crowd.waits):.0f} s |"


def least_distance(walks: Sequence[Followed]) -> float:
    """Measure how near two of several walks come to one another while all of them last, metres."""
    frames = min(len(walk.track) for walk in walks)
    tracks = [walk.track[:frames] for walk in walks]
    return float(min(np.hypot(*(first - second).T).min() for first, second in combinations(tracks, 2)))


def tables_of_shapes(compiled: Graphs) -> list[str]:
    """Follow every shape in every graph, and draw the walks into `following.png`."""
    figure, axes = plt.subplots(
        len(compiled), len(SHAPES), figsize=(12, 3 * len(compiled)), squeeze=False, layout="constrained"
    )
    lines = []
    for (name, graph), row_of_axes in zip(compiled.items(), axes, strict=True):
        lines += table_of_shapes(name, graph, list(row_of_axes))
    (FOLDER / "following.png").write_bytes(small_png(figure))
    return lines


INTRODUCTION = [
    "# How well walks keep to their paths",
    "",
    "Written by `python figures/follow_paths.py`. Distances are given in two ways: to the nearest point",
    "of the path, on average and at worst, and at equal arc length, on average, as in the paper's Eq. 9.",
    "Times are CPU seconds over the motion's. Slide: how far a planted foot strays from its place, on",
    "average over its plants, as it is and cleaned.",
    "",
]
BESIDE_THE_PAPER = [
    "## Against the paper's search at its best: n, m = 45, 15, 30 000 walks for each stretch",
    "",
    "Ten random lines of 7 m; medians [quartiles]. `search_of_2002.md` has more budgets and graphs.",
    "",
]
UNSEEN = ["## Other lines: within 4 cm of the nearest point on average, 15 cm at worst, 1 seam/s", ""]
TRADE_OFF = ["## Seams against distance, the mean of the five shapes", ""]
CONTROL = [
    "## Control and crowds",
    "",
    "| clips | obeys after: mean, 95 % | of it waiting, in transitions | a step: mean, worst "
    "| three paths cross: nearest | kept apart "
    "| waits at most |",
    "|---|---|---|---|---|---|---|",
]


def main() -> None:
    """Measure, draw, write."""
    warnings.simplefilter("ignore", mocap.MocapWarning)
    compiled = compile_graphs()
    lines = [*INTRODUCTION, *tables_of_shapes(compiled)]
    lines += [*BESIDE_THE_PAPER, *table_beside_the_paper(compiled)]
    lines += [*UNSEEN, *table_of_unseen_lines(compiled)]
    lines += [*TRADE_OFF, *trade_off(compiled)]
    lines += bending_section(FOLDER, Path(sys.argv[1]) if len(sys.argv) > 1 else None)
    lines += [*CONTROL, *(control_row(name, graph) for name, graph in compiled.items()), ""]
    Path(FOLDER / "following.md").write_text("\n".join(lines), encoding="utf-8")
    print("\n".join(lines))


if __name__ == "__main__":
    main()
