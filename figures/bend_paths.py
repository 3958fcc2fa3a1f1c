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

import mocap
from mocap import datasets, graphs
from mocap._shared.arrays import Array, runs
from mocap.body import GroundPath, joint_positions
from mocap.editing import LIMIT
from mocap.editing.path_editing import plants_kept
from mocap.graphs.compiled_graph import CompiledGraph
from mocap.plotting import ASKED, CURVES, PATH
from mocap.plotting.picture import small_png
from mocap.steering import follow_path
from mocap.steering.followed import Followed
from mocap.synthesis import to_motion

OWN = ("walk_circle", "walk_curve_1", "walk_curve_2", "walk_straight", "stop_and_go")
CMU = (*range(11, 35), 47, 58)
STRAIGHT = (15, 16, 21, 22, 31, 32, 47)
TITLE = "## With and without bending"
HEAD = [
    "| line | not bent: cm off, worst | seams/s | bent: cm off, worst | rounded, by at most | seams/s "
    "| slide, mm | acc | plants | time |",
    "|---|---|---|---|---|---|---|---|---|---|",
]


class Row(NamedTuple):
    """What is measured of one line: centimetres, seams per second, millimetres, ratios and shares."""

    plain: float
    plain_worst: float
    plain_seams: float
    off: float
    worst: float
    rounded: float
    moved: float
    seams: float
    slide: float
    acceleration: float
    kept: float
    speed: float

    def line(self, name: str) -> str:
        """Write a row of the table."""
        return (
            f"| {name} | {self.plain:.1f}, {self.plain_worst:.0f} | {self.plain_seams:.2f} "
            f"| {self.off:.1f}, {self.worst:.1f} | {self.rounded:.0%}, {self.moved:.0f} cm "
            f"| {self.seams:.2f} | {self.slide:.3f} | × {self.acceleration:.2f} | {self.kept:.0%} "
            f"| 1/{self.speed:.0f} |"
        )


def compiled(folder: Path | None) -> dict[str, CompiledGraph]:
    """Build the graphs of the bundled clips and, where their folder is given, of CMU's."""
    clips = {"bundled clips": [datasets.sample(name) for name in OWN]}
    if folder:
        walks = {trial: mocap.load(folder / f"16_{trial:02}.amc") for trial in CMU}
        clips["seven straight walks of CMU 16"] = [walks[trial] for trial in STRAIGHT]
        clips["all walks of CMU 16"] = list(walks.values())
        second = folder.parent / "02"
        clips["walks of CMU 02"] = [mocap.load(second / f"02_{trial:02}.amc") for trial in (1, 2, 3)]
    return {name: _graph(found, 0.06 if "02" in name else 0.04) for name, found in clips.items()}


def _graph(clips: Sequence[mocap.Motion], threshold: float) -> CompiledGraph:
    clips = [mocap.resample(clip, 30) for clip in clips]
    return graphs.compile_graph(graphs.prune(graphs.build(clips, window=10, threshold=threshold)))


def measure(graph: CompiledGraph, path: GroundPath) -> tuple[Row, Followed, Followed]:
    """Follow a line in both ways, and measure both walks."""
    plain = follow_unbent(graph, path)
    took = []
    for _ in range(3):
        begun = time.process_time()
        bent = follow_path(graph, path, bend=LIMIT)
        took.append(time.process_time() - begun)
    assert bent.bent
    as_asked = ~bent.bent.rounded if not bent.bent.rounded.all() else bent.bent.rounded
    before = to_motion(bent.graph, bent.walk)
    row = Row(
        100 * float(plain.off.mean()),
        100 * float(plain.off.max()),
        plain.seams_per_second,
        100 * float(bent.off[as_asked].mean()),
        100 * float(bent.off[as_asked].max()),
        float(bent.bent.rounded.mean()),
        100 * max((worst for _, _, worst in bent.bent.line.roundings), default=0.0),
        bent.seams_per_second,
        1000 * slide(bent.motion()),
        accelerations(bent.motion()) / accelerations(before),
        plants_kept(bent.bent.motion, bent.bent.laid),
        bent.seconds / min(took),
    )
    return row, plain, bent


def slide(motion: mocap.Motion) -> float:
    """Measure how far a planted joint strays from its mean place at most, metres."""
    positions = joint_positions(motion)
    plants = [
        positions[start:stop, motion.skeleton.index(name)]
        for name, mark in motion.contacts.items()
        for start, stop in runs(mark)
    ]
    return float(max(np.linalg.norm(plant - plant.mean(axis=0), axis=-1).max() for plant in plants))


def accelerations(motion: mocap.Motion) -> float:
    """Give the 99th percentile of the joints' accelerations, without hands and end sites."""
    names = motion.skeleton.names
    own = [j for j, name in enumerate(names) if not re.search("hand|finger|thumb|_end", name.lower())]
    second: Array = np.diff(joint_positions(motion)[:, own], 2, axis=0)
    return float(np.percentile(np.linalg.norm(second, axis=-1), 99))


def beside(target: Path, folder: Path | None) -> list[str]:
    """Write the section about bending, and draw both walks along each line."""
    found, lines = compiled(folder), [TITLE, ""]
    lines += [
        "Bent: by up to 100° per second. Off and worst: of the root, where the line is not rounded. Rounded:",
        "the part of the frames there, and by how much the line is moved at most. Acc: the 99th percentile",
        "of accelerations, over that of the walk before it was bent. The last row of each table has the",
        "worst of 40 random lines, and the median time.",
        "",
    ]
    figure, axes = plt.subplots(
        len(found), len(LINES), figsize=(12, 3.2 * len(found)), squeeze=False, layout="constrained"
    )
    for (name, graph), row_of_axes in zip(found.items(), axes, strict=True):
        lines += [f"### {name[0].upper()}{name[1:]}", "", *HEAD]
        for (line, draw), ax in zip(LINES.items(), row_of_axes, strict=True):
            row, plain, bent = measure(graph, draw())
            lines.append(row.line(line))
            for walk, colour in ((plain.path.points, ASKED), (plain.track, CURVES[1]), (bent.track, PATH)):
                ax.plot(*walk.T, color=colour, linewidth=3 if colour == ASKED else 1.5)
            low, high = plain.path.points.min(axis=0) - 1, plain.path.points.max(axis=0) + 1
            ax.set(aspect="equal", title=f"{line}\n{name}", xlim=(high[0], low[0]), ylim=(low[1], high[1]))
            ax.set_axis_off()
        rows = np.array([measure(graph, random_line(seed))[0] for seed in range(500, 540)])
        worst = rows.max(axis=0)
        worst[-2:] = rows[:, -2].min(), np.median(rows[:, -1])
        lines += [Row(*worst).line("40 random lines"), ""]
    (target / "bending.png").write_bytes(small_png(figure))
    return lines


def main() -> None:
    """Measure, draw, and put the section into `following.md`."""
    warnings.simplefilter("ignore", mocap.MocapWarning)
    here = Path(__file__).parent
    section = "\n".join(beside(here, Path(sys.argv[1]) if len(sys.argv) > 1 else None))
    table = here / "following.md"
    before, control, after = table.read_text("utf-8").partition("## Control and crowds")
    table.write_text(before.partition(TITLE)[0] + section + "\n" + control + after, encoding="utf-8")
    print(section)


if __name__ == "__main__":
    main()
