"""Follow lines with and without bending: `python figures/bend_paths.py [FOLDER OF CMU SUBJECT 16]`.

Writes the section of `following.md` about it, and the picture `bending.png`, beside this script.
`follow_paths.py` writes the whole table.
"""

import re
import sys
import time
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import matplotlib

matplotlib.use("agg")

import matplotlib.pyplot as plt
import numpy as np
from asked_lines import LINES, follow_unbent, random_line
from matplotlib.axes import Axes

import mocap
from mocap import datasets, graphs
from mocap._shared.arrays import Array, runs
from mocap.body import GroundPath, joint_positions
from mocap.editing import LIMIT
from mocap.editing.bending import Bent
from mocap.editing.path_editing import plants_kept
from mocap.graphs.compiled_graph import CompiledGraph
from mocap.plotting import ASKED, CURVES, PATH
from mocap.plotting.picture import small_png
from mocap.steering import follow_path
from mocap.steering.followed import Followed
from mocap.synthesis import to_motion

BUNDLED = ("walk_circle", "walk_curve_1", "walk_curve_2", "walk_straight", "stop_and_go")
CMU = (*range(11, 35), 47, 58)
STRAIGHT = (15, 16, 21, 22, 31, 32, 47)
TITLE = "## With and without bending"
HEAD = [
    "| line | not bent: cm off, worst | seams/s | bent: cm off, worst | rounded, by at most | seams/s "
    "| slide, mm | acc | plants | time |",
    "|---|---|---|---|---|---|---|---|---|---|",
]


class Distances(NamedTuple):
    """The mean and the largest distance of a walk from its line, cm, and its seams per second."""

    mean: float
    worst: float
    seams: float


class Rounding(NamedTuple):
    """The fraction of frames where a line is rounded, and its largest distance there from the request, cm."""

    fraction: float
    largest: float


class Quality(NamedTuple):
    """Foot sliding, mm; the ratio of accelerations; the fraction of plants kept; seconds per CPU second."""

    slide: float
    acceleration: float
    kept: float
    speed: float


class Row(NamedTuple):
    """What is measured of one line."""

    unbent: Distances
    bent: Distances
    rounding: Rounding
    quality: Quality

    def line(self, name: str) -> str:
        """Write a row of the table."""
        mean, worst, seams = self.unbent
        unbent = f"{mean:.1f}, {worst:.0f} | {seams:.2f}"
        mean, worst, seams = self.bent
        rounding = f"{self.rounding.fraction:.0%}, {self.rounding.largest:.0f} cm"
        bent = f"{mean:.1f}, {worst:.1f} | {rounding} | {seams:.2f}"
        slide, acceleration, kept, speed = self.quality
        quality = f"{slide:.3f} | × {acceleration:.2f} | {kept:.0%} | 1/{speed:.0f}"
        return f"| {name} | {unbent} | {bent} | {quality} |"


def compile_graphs(folder: Path | None) -> dict[str, CompiledGraph]:
    """Build the graphs of the bundled clips and, if their folder is given, of CMU's."""
    clip_sets = {"bundled clips": [datasets.sample(name) for name in BUNDLED]}
    if folder:
        walks = {trial: mocap.load(folder / f"16_{trial:02}.amc") for trial in CMU}
        clip_sets["seven straight walks of CMU 16"] = [walks[trial] for trial in STRAIGHT]
        clip_sets["all walks of CMU 16"] = list(walks.values())
        second = folder.parent / "02"
        clip_sets["walks of CMU 02"] = [mocap.load(second / f"02_{trial:02}.amc") for trial in (1, 2, 3)]
    return {name: _graph(clips, 0.06 if "02" in name else 0.04) for name, clips in clip_sets.items()}


def _graph(clips: Sequence[mocap.Motion], threshold: float) -> CompiledGraph:
    clips = [mocap.resample(clip, 30) for clip in clips]
    return graphs.compile_graph(graphs.prune(graphs.build(clips, window=10, threshold=threshold)))


def measure(graph: CompiledGraph, path: GroundPath) -> tuple[Row, Followed, Followed]:
    """Follow a line without and with bending, and measure both walks."""
    unbent = follow_unbent(graph, path)
    bent, cpu_seconds = follow_bent(graph, path)
    assert bent.bent
    is_rounded = bent.bent.rounded
    metres = bent.off if is_rounded.all() else bent.off[~is_rounded]
    row = Row(
        distances(unbent, unbent.off),
        distances(bent, metres),
        rounding_of(bent.bent),
        quality_of(bent, bent.bent, cpu_seconds),
    )
    return row, unbent, bent


def distances(walk: Followed, metres: Array) -> Distances:
    """Average the distances of a walk's frames from its line, and count its seams."""
    return Distances(100 * float(metres.mean()), 100 * float(metres.max()), walk.seams_per_second)


def rounding_of(bent: Bent) -> Rounding:
    """Measure how much of a line is rounded, and how far it is moved there."""
    metres = [largest for _, _, largest in bent.line.roundings]
    return Rounding(float(bent.rounded.mean()), 100 * max(metres, default=0.0))


def quality_of(walk: Followed, bent: Bent, cpu_seconds: float) -> Quality:
    """Measure a bent walk, and compare its accelerations with those before it was bent."""
    motion = walk.motion()
    before_bending = to_motion(walk.graph, walk.walk)
    acceleration = accelerations(motion) / accelerations(before_bending)
    kept = plants_kept(bent.motion, bent.laid)
    return Quality(1000 * slide(motion), acceleration, kept, walk.seconds / cpu_seconds)


def follow_bent(graph: CompiledGraph, path: GroundPath) -> tuple[Followed, float]:
    """Follow a line with bending; return the walk, and the least CPU time of three runs."""
    times = []
    for _ in range(3):
        start = time.process_time()
        walk = follow_path(graph, path, bend=LIMIT)
        times.append(time.process_time() - start)
    return walk, min(times)


def slide(motion: mocap.Motion) -> float:
    """Measure how far a planted joint strays from its mean place at most, metres."""
    positions = joint_positions(motion)
    distances = []
    for name, is_planted in motion.contacts.items():
        joint = positions[:, motion.skeleton.index(name)]
        for start, stop in runs(is_planted):
            plant = joint[start:stop]
            distances.append(np.linalg.norm(plant - plant.mean(axis=0), axis=-1).max())
    return float(max(distances))


def accelerations(motion: mocap.Motion) -> float:
    """Return the 99th percentile of the joints' accelerations, without hands and end sites."""
    names = motion.skeleton.names
    joints = [j for j, name in enumerate(names) if not re.search("hand|finger|thumb|_end", name.lower())]
    differences: Array = np.diff(joint_positions(motion)[:, joints], 2, axis=0)
    return float(np.percentile(np.linalg.norm(differences, axis=-1), 99))


INTRODUCTION = [
    TITLE,
    "",
    "Bent: by up to 100° per second. Off and worst: of the root, where the line is not rounded. Rounded:",
    "the part of the frames there, and by how much the line is moved at most. Acc: the 99th percentile",
    "of accelerations, over that of the walk before it was bent. The last row of each table has the",
    "worst of 40 random lines, and the median time.",
    "",
]


def bending_section(target: Path, folder: Path | None) -> list[str]:
    """Write the section about bending, and draw both walks along each line into the folder `target`."""
    compiled = compile_graphs(folder)
    figure, axes = plt.subplots(
        len(compiled), len(LINES), figsize=(12, 3.2 * len(compiled)), squeeze=False, layout="constrained"
    )
    lines = [*INTRODUCTION]
    for (name, graph), row_of_axes in zip(compiled.items(), axes, strict=True):
        lines += [f"### {name[0].upper()}{name[1:]}", "", *HEAD]
        for (line, draw), ax in zip(LINES.items(), row_of_axes, strict=True):
            row, unbent, bent = measure(graph, draw())
            lines.append(row.line(line))
            draw_walks(ax, unbent, bent)
            ax.set_title(f"{line}\n{name}")
        lines += [worst_of_random_lines(graph).line("40 random lines"), ""]
    (target / "bending.png").write_bytes(small_png(figure))
    return lines


def draw_walks(ax: Axes, unbent: Followed, bent: Followed) -> None:
    """Draw a line and both walks along it, from above: +x points to the left."""
    points = unbent.path.points
    ax.plot(*points.T, color=ASKED, linewidth=3)
    ax.plot(*unbent.track.T, color=CURVES[1], linewidth=1.5)
    ax.plot(*bent.track.T, color=PATH, linewidth=1.5)
    low = points.min(axis=0) - 1
    high = points.max(axis=0) + 1
    ax.set(aspect="equal", xlim=(high[0], low[0]), ylim=(low[1], high[1]))
    ax.set_axis_off()


def worst_of_random_lines(graph: CompiledGraph) -> Row:
    """Measure 40 random lines; return the worst of each column, and the median speed."""
    rows = [measure(graph, random_line(seed))[0] for seed in range(500, 540)]
    unbent = Distances(*np.max([row.unbent for row in rows], axis=0))
    bent = Distances(*np.max([row.bent for row in rows], axis=0))
    rounding = Rounding(*np.max([row.rounding for row in rows], axis=0))
    quality = Quality(*np.max([row.quality for row in rows], axis=0))
    least_kept = min(row.quality.kept for row in rows)
    usual_speed = float(np.median([row.quality.speed for row in rows]))
    return Row(unbent, bent, rounding, quality._replace(kept=least_kept, speed=usual_speed))


def main() -> None:
    """Measure, draw, and put the section into `following.md`."""
    warnings.simplefilter("ignore", mocap.MocapWarning)
    folder = Path(__file__).parent
    section = "\n".join(bending_section(folder, Path(sys.argv[1]) if len(sys.argv) > 1 else None))
    page = folder / "following.md"
    first_sections, control_title, control = page.read_text("utf-8").partition("## Control and crowds")
    first_sections = first_sections.partition(TITLE)[0]
    page.write_text(first_sections + section + "\n" + control_title + control, encoding="utf-8")
    print(section)


if __name__ == "__main__":
    main()
