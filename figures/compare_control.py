"""Compare ways of control by one protocol: `python figures/compare_control.py [FOLDER OF CLIPS] [NAME ...]`.

Writes the table `control.md` beside this script. The folder holds `hw3`, `cmu/16`, `cmu/02` and
`bvh/bandai_namco`; without it the bundled clips alone are compared. With names of sections, such as
"bundled clips", the other sections stay as they are. Times are CPU time of one run.
"""

import gc
import sys
import time
import warnings
from collections.abc import Callable, Iterator, Mapping
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import networkx as nx
import numpy as np

import mocap
from mocap import datasets, feet, graphs, quality, steering
from mocap._shared.arrays import Array
from mocap.body import SHAPES, GroundPath, heading, on_ground
from mocap.errors import MocapError, MocapWarning
from mocap.graphs.compiled_graph import CompiledGraph
from mocap.methods import motion_matching, parametric_graphs
from mocap.methods.motion_matching.pose_database import PoseDatabase
from mocap.quality.seam_measures import Spread
from mocap.steering.characters import Character, Pose
from mocap.steering.judged_control import ControlReport
from mocap.steering.root_turning import Turnable

PAGE = Path(__file__).with_name("control.md")
ABOUT_FOOT = ", turned about the foot"
ABOUT_ROOT = ", turned about the root"
WALKS = ("walk_circle", "walk_curve_1", "walk_curve_2", "walk_straight")
CMU = (*range(11, 35), 47, 58)
BANDAI = ("1_walk_normal", "2_walk_normal", "2_walk-turn-left_normal", "2_walk-turn-right_normal")
SHARE = {"lrl": 1.0, "lr": 0.55, "rl": 0.55}  # a step turns by half of what a stride does, or little more
SEEDS = range(3)  # of the commands
PAIRED = 60.0  # seconds of steps whose times are compared in pairs
BLOCK = 30  # steps that a character takes before it is the other's turn
SPACING = 0.02  # metres between the points of a path
AHEAD = 2 / 3  # of the seconds until it obeys: a character is led to the point where it will be by then
NEAREST = 0.3  # metres along a path: that point is no nearer
FARTHEST = 1.2  # metres along a path: and no farther
SEARCH_BACK = 0.2  # metres along a path: its nearest point is looked for that far behind the last one
SEARCH_FORWARD = 1.5  # metres along a path: and that far ahead of the last one
END = 0.1  # metres along a path: as near its end a character has arrived
LONGEST = 3.0  # times the seconds that a path takes, after which it ends
LIMITS = {"homework's clips": 120.0}  # degrees per stride; else 75


def clip_sets() -> dict[str, tuple[list[mocap.Motion], float]]:
    """Load the clips, at 30 Hz with their plants marked, and the speed they are asked for."""
    sets = {"bundled clips": ([datasets.sample(name) for name in WALKS], 1.0)}
    if len(sys.argv) > 1:
        folder = Path(sys.argv[1])
        sets["homework's clips"] = (
            [mocap.load(path) for path in sorted((folder / "hw3").glob("*.AMC"))],
            0.8,
        )
        people = [mocap.load(folder / "cmu" / "16" / f"16_{trial:02}.amc") for trial in CMU]
        sets["CMU 16, walks"] = (people, 1.1)
        straight = [mocap.load(folder / "cmu" / "02" / f"02_{trial:02}.amc") for trial in (1, 2)]
        sets["CMU 02, straight walks"] = (straight, 1.1)
        walker = [folder / "bvh" / "bandai_namco" / f"dataset-{name}_001.bvh" for name in BANDAI]
        sets["Bandai-Namco"] = ([mocap.load(path) for path in walker], 1.1)
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


Makers = Mapping[str, Callable[[Any], Character]]  # by what they add to a label, of what is prepared


class Preparation(NamedTuple):
    """Something to prepare from clips, such as a graph, and the functions that make characters of it.

    `prepare` returns what it has made, and what the label says of it.
    """

    label: str
    prepare: Callable[[], tuple[Any, str]]
    characters: Makers


class Ready(NamedTuple):
    """A way of control: how to make its character, and the CPU time of its preparation."""

    make: Callable[[], Character]
    seconds: float


def prepare_ways(name: str, clips: list[mocap.Motion]) -> tuple[dict[str, Ready], dict[str, str]]:
    """Prepare every way of control, by its label; and return why some cannot be, by theirs."""
    prepared: dict[str, Ready] = {}
    refused: dict[str, str] = {}
    for label, prepare, characters in preparations(clips, LIMITS.get(name, 75.0)):
        begun = time.process_time()
        try:
            source, detail = prepare()
        except MocapError as error:
            refused[label] = str(error)
            continue
        seconds = time.process_time() - begun
        for ending, character in characters.items():
            prepared[label + detail + ending] = Ready(partial(character, source), seconds)
    return prepared, refused


def preparations(clips: list[mocap.Motion], limit: float) -> Iterator[Preparation]:
    """Yield all that is prepared from clips; strides turn by up to `limit` degrees."""
    as_it_is: Makers = {"": steering.Controller}
    on_graph: Makers = {
        "": steering.Controller,
        ABOUT_FOOT: turned,
        ABOUT_ROOT: about_root(steering.Controller),
    }
    yield Preparation("motion graph", partial(graph, clips, 0.04), on_graph)
    yield Preparation("motion graph", partial(graph, clips, 0.08), as_it_is)

    by_strides = {
        "": parametric_graphs.ParametricController,
        ABOUT_ROOT: about_root(parametric_graphs.ParametricController),
    }
    yield Preparation("strides", partial(strides, clips, ("lrl",), limit), by_strides)
    yield Preparation("steps", partial(strides, clips, ("lr", "rl"), limit), by_strides)

    by_matching: Makers = {
        ", future × 1": partial(matcher, 1.0),
        ", future × 0.25": partial(matcher, 0.25),
        ABOUT_ROOT: about_root(partial(matcher, 1.0)),
    }
    yield Preparation("matching", partial(pose_table, clips), by_matching)


def about_root(make: Callable[[Any], Turnable]) -> Callable[[Any], Character]:
    """Make characters that turn about their roots."""
    return lambda source: steering.RootTurner(make(source))


def graph(clips: list[mocap.Motion], threshold: float) -> tuple[CompiledGraph, str]:
    """Build a motion graph."""
    pruned = graphs.prune(graphs.build(clips, window=10, threshold=threshold))
    return graphs.compile_graph(pruned), f", {100 * threshold:g} cm"


def turned(compiled: CompiledGraph) -> steering.FootTurner:
    """Make a character that turns about the foot that stands."""
    return steering.FootTurner(steering.Controller(compiled), np.radians(40))


def pose_table(clips: list[mocap.Motion]) -> tuple[PoseDatabase, str]:
    """Tabulate the poses of clips, for motion matching."""
    return motion_matching.tabulate(clips), ""


def matcher(future: float, table: PoseDatabase) -> motion_matching.MotionMatcher:
    """Make a character of motion matching, to which the path ahead is worth `future` times the usual."""
    return motion_matching.MotionMatcher(table, motion_matching.Wants(future=future))


def main() -> None:
    """Write the tables, each as soon as it is measured."""
    warnings.simplefilter("ignore", MocapWarning)
    sections = _sections() if len(sys.argv) > 2 else {}
    for name, (clips, speed) in clip_sets().items():
        if sys.argv[2:] and name not in sys.argv[2:]:
            continue
        title = f"{name}, asked for {speed} m/s"
        sections[title] = "\n".join(["", *_table(name, clips, speed), ""])
        page = [f"# How fast characters respond to commands, and at what cost\n\n{HEAD}\n"]
        page += [f"## {title}\n{text}" for title, text in sections.items()]
        PAGE.write_text("\n".join(page), "utf-8")


def _sections() -> dict[str, str]:
    """Read the sections of the page as it is: their texts by their titles."""
    _, *sections = PAGE.read_text("utf-8").split("\n## ")
    texts = dict(section.split("\n", 1) for section in sections)
    return {title: text.rstrip("\n") + "\n" for title, text in texts.items()}


HEAD = """`python figures/compare_control.py` writes this page. The first measurement is
`steering.measure_delay`:
sixty commanded turns by 30 to 120 degrees, and the seconds until the mean direction of the last third of
a second is within 20 degrees of the command, as a mean and for 95 % of the turns. The second is
`steering.judge_control`: a minute of such turns, one every two seconds. The columns are:

- slide: the distance of a joint in contact from its mean position, before and after foot clean-up, with
the footplants of the clips, and the fraction of footplant frames that clean-up keeps;
- jolting: frames with a change of velocity above 99.9 % of those in the clips;
- wags: the variation of the direction while a command is constant;
- pivots: the rotation of a foot during a contact, which is the disadvantage of rotating about it;
- step and ready: CPU times of a step, as a mean and a maximum in the fastest of three runs, and of the
preparation. They depend on the machine. Below each table, two characters take turns in blocks of 30 steps,
and the ratio of their times is given.

Values are means of three runs with different commands, ± their standard deviation. For the footplants kept
it is the minimum. Strides and steps accept only a turn as command, and have the speed of their clips. The
centimetres of a method are its threshold. Characters that are turned about the foot (`FootTurner`) or about
the root (`RootTurner`, with their standing feet held and their steps stretched) walk on the same clips as
those above them. The second table of each section shows characters that follow
five paths by commands alone (`lead`), with the mean and the largest distance from the path in metres. The
point to which a character is led is as far ahead as it walks in two thirds of its response, 0.3 to 1.2 m."""
COLUMNS = (
    "| method | response, s | 95 % | slide, cm | cleaned | footplants kept | jolting | wags | pivots | m/s "
    "| step, ms | worst | ready, s |"
)


def _table(name: str, clips: list[mocap.Motion], speed: float) -> list[str]:
    """Write two tables, with a row for each way: how it is judged, and how it is led along paths."""
    usual = quality.spread(clips)
    judged = _head(COLUMNS)
    led = _head(f"| method | {' | '.join(SHAPES)} |")
    prepared, refused = prepare_ways(name, clips)
    for label, (make, seconds) in prepared.items():
        gc.collect()
        gc.freeze()
        reports = judge(make, usual, speed)
        judged.append(f"| {label} | {_judged(reports)} | {seconds:.2f} |")
        response = float(np.mean([report.delay.mean for report in reports]))
        led.append(f"| {label} | {_led(make, speed, distance_ahead(speed, response))} |")
        print(judged[-1], flush=True)
    return [*judged, *_reasons(refused), "", *_compared_times(prepared, speed), "", *led]


def _compared_times(prepared: dict[str, Ready], speed: float) -> list[str]:
    """Write how long steps about the root take, as a multiple of those about the foot on the same graph."""
    lines = []
    for label, about_foot in prepared.items():
        if label.endswith(ABOUT_FOOT):
            method = label.removesuffix(ABOUT_FOOT)
            ratio = time_ratio(prepared[method + ABOUT_ROOT].make(), about_foot.make(), speed)
            lines.append(
                f"{method}: a step about the root takes {ratio:.2f} times as long as one about the foot."
            )
    return lines


def time_ratio(character: Character, reference: Character, speed: float) -> float:
    """Return the CPU time of a character's steps divided by that of a reference; the two take turns."""
    headings = steering.command_headings(PAIRED, character.fps).tolist()
    seconds = {character: 0.0, reference: 0.0}
    for start in range(0, len(headings), BLOCK):
        for walker in seconds:
            begun = time.thread_time()
            steering.steer(walker, headings[start : start + BLOCK], speed)
            seconds[walker] += time.thread_time() - begun
    return seconds[character] / seconds[reference]


def _head(columns: str) -> list[str]:
    """Write the head of a table: its columns, and the line below them."""
    count = columns.count("|") - 1
    return [columns, "|---" * count + "|"]


def _reasons(refused: dict[str, str]) -> list[str]:
    """Write a paragraph for each way that cannot be prepared."""
    lines = []
    for label, reason in refused.items():
        lines += ["", f"No {label} from these clips: {reason}"]
    return lines


def judge(make: Callable[[], Character], usual: Spread, speed: float) -> list[ControlReport]:
    """Judge a character by the commands of each seed."""
    return [steering.judge_control(make, usual, speed=speed, seed=seed) for seed in SEEDS]


def distance_ahead(speed: float, response: float) -> float:
    """Return how far ahead of a character it is led to, metres, by the seconds until it obeys.

    A point that is farther than the character needs makes it cut corners, and a nearer one makes it swing.
    """
    return max(NEAREST, min(FARTHEST, AHEAD * speed * response))


def _led(make: Callable[[], Character], speed: float, ahead: float) -> str:
    """Write the cells of a character that is led along each path: mean and largest distance from it, m.

    The share of a path that was walked is added where it is not all of it.
    """
    cells = []
    for shape in SHAPES.values():
        distances, share = lead(make(), shape(), speed, ahead)
        cell = f"{distances.mean():.2f}, {distances.max():.2f}"
        cells.append(cell if share == 1 else f"{cell} ({share:.0%})")
    return " | ".join(cells)


def lead(character: Character, path: GroundPath, speed: float, ahead: float) -> tuple[Array, float]:
    """Lead a character along a path by commands: to a point some metres `ahead` of it, by pure pursuit.

    Returns its distance from the path in each frame (F,), metres, and the share of the path that it walked,
    1 for all.
    """
    fine = path.resampled(SPACING)
    line = on_ground(fine.points)
    line_along = fine.along  # metres, of each of its points
    pose = character.step(0.0, speed)
    start = _position(pose)
    turn = _turn_onto(fine, pose)
    along = 0.0  # metres along the path, of the point that is nearest to the character
    distances = []
    for _ in range(round(LONGEST * path.length / speed * character.fps)):
        position = line[0] + turn * (_position(pose) - start)
        along, distance = _nearest(line_along, np.abs(line - position), along)
        distances.append(distance)
        if along >= path.length - END:
            break
        goal = complex(on_ground(fine.at(along + ahead)))
        direction = float(np.angle((goal - position) / turn))
        pose = character.step(direction, speed)
    else:
        distances.append(distances[-1])  # out of time: the last pose counts as the one before it
    return np.array(distances), min(1.0, (along + END) / path.length)


def _position(pose: Pose) -> complex:
    """Return where a pose is on the ground."""
    return complex(on_ground(pose.root_position))


def _turn_onto(path: GroundPath, pose: Pose) -> np.complex128:
    """Return the rotation, as a complex number, after which a pose faces along the first 10 cm of a path."""
    first_bit = on_ground(path.at(0.1)) - on_ground(path.points[0])
    angle = np.angle(first_bit) - heading(pose.rotations[0])
    return np.complex128(np.exp(1j * angle))


def _nearest(along: Array, distances: Array, previous: float) -> tuple[float, float]:
    """Find a path's nearest point, not far from the previous one: its metres along the path, its distance."""
    candidates = np.flatnonzero((along >= previous - SEARCH_BACK) & (along <= previous + SEARCH_FORWARD))
    nearest = candidates[distances[candidates].argmin()]
    return float(along[nearest]), float(distances[nearest])


def _judged(reports: list[ControlReport]) -> str:
    """Write the cells of a character: means of three runs, and of the times the least."""
    cells = [*_obeying(reports), *_feet(reports), *_moving(reports), *_step_times(reports)]
    return " | ".join(cells)


def _obeying(reports: list[ControlReport]) -> list[str]:
    """Write the seconds until a command is obeyed: on average, and for 95 %."""
    delays = [report.delay.mean for report in reports]
    slowest = [report.delay.slowest for report in reports]
    return [_mean_and_deviation(delays, ".2f"), _mean(slowest, ".2f")]


def _feet(reports: list[ControlReport]) -> list[str]:
    """Write how far planted feet slide, cm, as they are and cleaned, and the plants that cleaning keeps."""
    slides = [report.slide for report in reports]
    cleaned = [report.cleaned for report in reports]
    least_kept = min(report.kept for report in reports)
    return [_mean_and_deviation(slides, ".1f"), _mean(cleaned, ".1f"), f"{least_kept:.1%}"]


def _moving(reports: list[ControlReport]) -> list[str]:
    """Write the frames that jolt, degrees of wagging and of pivoting, and the speed, m/s."""
    jolting = _mean([report.jolting for report in reports], ".2%")
    wags = _mean([report.wags for report in reports], ".1f")
    pivots = _mean([report.pivots for report in reports], ".1f")
    pace = _mean([report.pace for report in reports], ".2f")
    return [jolting, f"{wags}°", f"{pivots}°", pace]


def _step_times(reports: list[ControlReport]) -> list[str]:
    """Write the CPU time of a step, ms: on average and at worst, each in the quickest run."""
    step = min(report.delay.step for report in reports)
    worst = min(report.delay.worst for report in reports)
    return [f"{step:.2f}", f"{worst:.1f}"]


def _mean(values: list[float], form: str) -> str:
    return format(float(np.mean(values)), form)


def _mean_and_deviation(values: list[float], form: str) -> str:
    deviation = format(float(np.std(values)), form)
    return f"{_mean(values, form)} ± {deviation}"


if __name__ == "__main__":
    main()
