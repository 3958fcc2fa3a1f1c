"""Compare six ways of control by one protocol: `python figures/compare_control.py [FOLDER OF CLIPS]`.

Writes the table `control.md` beside this script. The folder holds `hw3` and `cmu/16`; without it the bundled
clips alone are compared. Times are CPU time of one run.
"""

import gc
import sys
import time
import warnings
from collections.abc import Callable
from pathlib import Path

import networkx as nx
import numpy as np

import mocap
from mocap import datasets, feet, graphs, quality, steering
from mocap._shared.arrays import Array
from mocap.body import SHAPES, GroundPath, heading, on_ground
from mocap.errors import MocapError, MocapWarning
from mocap.graphs.compiled_graph import CompiledGraph
from mocap.methods import motion_matching, parametric_graphs
from mocap.quality.seam_measures import Spread
from mocap.steering.characters import Character

FOLDER = Path(__file__).parent
WALKS = ("walk_circle", "walk_curve_1", "walk_curve_2", "walk_straight")
CMU = (*range(11, 35), 47, 58)
SHARE = {"lrl": 1.0, "lr": 0.55, "rl": 0.55}  # a step turns by half of what a stride does, or little more
SEEDS = range(4)  # of the commands
AHEAD, NEAR = (
    0.8,
    1.5,
)  # metres along a path: to where a character is led, and where its nearest point is looked for
LONGEST = 3.0  # times the seconds that a path takes, after which it ends
LIMITS = {"bundled clips": 75, "homework's clips": 120, "CMU 16, walks": 75}  # degrees per stride


def clip_sets() -> dict[str, tuple[list[mocap.Motion], float]]:
    """Load the clips, at 30 Hz with their plants marked, and the speed they are asked for."""
    sets = {"bundled clips": ([datasets.sample(name) for name in WALKS], 0.8)}
    if len(sys.argv) > 1:
        folder = Path(sys.argv[1])
        sets["homework's clips"] = (
            [mocap.load(path) for path in sorted((folder / "hw3").glob("*.AMC"))],
            0.8,
        )
        people = [mocap.load(folder / "cmu" / "16" / f"16_{trial:02}.amc") for trial in CMU]
        sets["CMU 16, walks"] = (people, 1.1)
    return {name: ([_marked(clip) for clip in clips], speed) for name, (clips, speed) in sets.items()}


def _marked(clip: mocap.Motion) -> mocap.Motion:
    clip = mocap.resample(clip, 30)
    return clip if clip.contacts else feet.mark_plants(clip)


def strides(clips: list[mocap.Motion], kinds: tuple[str, ...], limit: float) -> tuple[nx.DiGraph, str]:
    """Build a parametric graph of strides, or of steps, with T_GOOD from 4 cm on, as large as it must be."""
    spaces = {}
    for kind in kinds:
        cut = parametric_graphs.cut_strides(clips, feet=kind)
        high = np.radians(limit) * SHARE[kind]
        spaces[kind] = parametric_graphs.make_space(cut, np.radians(14) * SHARE[kind], -high, high)
    edges = [(kind, kinds[(number + 1) % len(kinds)]) for number, kind in enumerate(kinds)]
    for good in (0.04, 0.05, 0.06):
        try:
            return parametric_graphs.build_parametric(spaces, edges, good=good), f", {100 * good:g} cm"
        except mocap.NoWalk as error:
            refusal = error
    raise refusal


def ways(
    name: str, clips: list[mocap.Motion]
) -> tuple[dict[str, tuple[Callable[[], Character], float]], dict[str, str]]:
    """Prepare every way of control: how to make its character, what that took, s; and why some cannot be."""
    made: dict[str, tuple[Callable[[], Character], float]] = {}
    refused: dict[str, str] = {}

    def add(
        label: str,
        prepare: Callable[[], tuple[object, str]],
        *characters: tuple[str, Callable[[object], object]],
    ) -> None:
        begun = time.process_time()
        try:
            ready, by = prepare()
        except MocapError as error:
            refused[label] = str(error)
            return
        took = time.process_time() - begun
        for more, character in characters:
            made[label + by + more] = (lambda character=character: character(ready), took)

    parametric = ("", parametric_graphs.ParametricController)
    add("motion graph", lambda: graph(clips, 0.04), ("", steering.Controller), (", turned by 40°/s", turned))
    add("motion graph", lambda: graph(clips, 0.08), ("", steering.Controller))
    add("strides", lambda: strides(clips, ("lrl",), LIMITS[name]), parametric)
    add("steps", lambda: strides(clips, ("lr", "rl"), LIMITS[name]), parametric)
    add("matching", lambda: (motion_matching.tabulate(clips), ""), *map(_matcher, (1.0, 0.25)))
    return made, refused


def graph(clips: list[mocap.Motion], threshold: float) -> tuple[CompiledGraph, str]:
    """Build a motion graph."""
    found = graphs.prune(graphs.build(clips, window=10, threshold=threshold))
    return graphs.compile_graph(found), f", {100 * threshold:g} cm"


def turned(compiled: CompiledGraph) -> steering.FootTurner:
    """Make a character that turns about the foot that stands."""
    return steering.FootTurner(steering.Controller(compiled), np.radians(40))


def _matcher(future: float) -> tuple[str, Callable[[object], object]]:
    wants = motion_matching.Wants(future=future)
    return f", future × {future:g}", lambda table: motion_matching.MotionMatcher(table, wants)


def main() -> None:
    """Write the tables."""
    warnings.simplefilter("ignore", MocapWarning)
    lines = ["# Three answers to one question: how does a character obey?", "", HEAD, ""]
    for name, (clips, speed) in clip_sets().items():
        lines += [f"## {name}, asked for {speed} m/s", "", *_table(name, clips, speed), ""]
    (FOLDER / "control.md").write_text("\n".join(lines), "utf-8")


HEAD = """Written by `python figures/compare_control.py`. Sixty turns by 30 to 120 degrees, as
`steering.measure_delay` commands them: seconds until the direction of the last third of a second is
within 20 degrees, on average and for 95 %. Then a minute of such turns every two seconds
(`steering.judge_control`). Slide: how far a planted joint strays from its mean place, as it is and cleaned,
with plants carried from the clips; how many planted frames the cleaning keeps. Jolting: frames whose velocity
jumps further than 99.9 % of the clips' own. Wags: how the direction swings while a command stands. Pivots:
how far a foot turns while it stands; that is what it costs to turn about it. Strides and steps are asked for
a turn only, and go as fast as their clips. All are means of four runs with other commands, ± their standard
deviation; of the plants kept it is the least. CPU time of a step, on average and at worst, in the quickest of
the four runs, and of the preparation. The centimetres of a way are its threshold. Below each table: led along
five paths by commands alone (`lead`), metres from the path on average and at worst."""
COLUMNS = (
    "| way | obeys, s | 95 % | slide, cm | cleaned | plants kept | jolting | wags | pivots | m/s | step, ms "
    "| worst | ready, s |"
)


def _table(name: str, clips: list[mocap.Motion], speed: float) -> list[str]:
    usual = quality.spread(clips)
    rows, led = (
        [COLUMNS, "|---" * 13 + "|"],
        [f"| way | {' | '.join(SHAPES)} |", "|---" * (len(SHAPES) + 1) + "|"],
    )
    made, refused = ways(name, clips)
    for label, (make, took) in made.items():
        gc.collect()
        gc.freeze()
        rows.append(f"| {label} | {_judged(make, usual, speed)} | {took:.2f} |")
        cells = []
        for shape in SHAPES.values():
            off, walked = lead(make(), shape(), speed)
            cells.append(f"{off.mean():.2f}, {off.max():.2f}" + ("" if walked == 1 else f" ({walked:.0%})"))
        led.append(f"| {label} | {' | '.join(cells)} |")
        print(rows[-1])
    reasons = [
        line for label, reason in refused.items() for line in ("", f"No {label} from these clips: {reason}")
    ]
    return [*rows, *reasons, "", *led]


def lead(character: Character, path: GroundPath, speed: float) -> tuple[Array, float]:
    """Lead a character along a path by commands: to a point that is carried ahead of it, by pure pursuit.

    Gives how far it is off in each frame (F,), metres, and how much of the path was walked, 1 for all.
    """
    fine = path.resampled(0.02)
    line, along = on_ground(fine.points), fine.along
    pose = character.step(0.0, speed)
    # It is laid so that it faces along the path where both start.
    turn = np.exp(1j * (np.angle(on_ground(fine.at(0.1)) - line[0]) - heading(pose.rotations[0])))
    start, off, now = complex(on_ground(pose.root_position)), [0.0], 0.0
    for _ in range(round(LONGEST * path.length / speed * character.fps)):
        here = line[0] + turn * (complex(on_ground(pose.root_position)) - start)
        near = np.flatnonzero((along >= now - 0.2) & (along <= now + NEAR))
        gaps = np.abs(line[near] - here)
        now, off[-1] = float(along[near[gaps.argmin()]]), float(gaps.min())
        if now >= path.length - 0.1:
            break
        goal = complex(on_ground(fine.at(now + AHEAD)))
        pose = character.step(float(np.angle((goal - here) / turn)), speed)
        off.append(off[-1])
    return np.array(off), min(1.0, (now + 0.1) / path.length)


def _judged(make: Callable[[], Character], usual: Spread, speed: float) -> str:
    """Write the cells of a character: means of four runs, and of the times the least."""
    reports = [steering.judge_control(make, usual, speed=speed, seed=seed) for seed in SEEDS]
    delays = [report.delay for report in reports]

    def mean(name: str, form: str) -> str:
        return format(float(np.mean([getattr(report, name) for report in reports])), form)

    soon, slides = [delay.mean for delay in delays], [report.slide for report in reports]
    cells = [f"{np.mean(soon):.2f} ± {np.std(soon):.2f}", f"{np.mean([d.slowest for d in delays]):.2f}"]
    cells += [f"{np.mean(slides):.1f} ± {np.std(slides):.1f}", mean("cleaned", ".1f")]
    cells += [f"{min(report.kept for report in reports):.1%}", mean("jolting", ".1%")]
    cells += [mean("wags", ".1f") + "°", mean("pivots", ".1f") + "°", mean("pace", ".2f")]
    cells += [f"{min(delay.step for delay in delays):.2f}", f"{min(delay.worst for delay in delays):.1f}"]
    return " | ".join(cells)


if __name__ == "__main__":
    main()
