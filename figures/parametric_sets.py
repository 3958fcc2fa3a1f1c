"""Build parametric graphs of sets of ordinary clips: `python figures/parametric_sets.py FOLDER [SET ...]`.

Writes the table `parametric_sets.md` beside this script. The folder holds `hw3`, `cmu` and `bvh`. Each set is
built twice: with one margin, range and T_GOOD for all sets, as in `compare_control.strides`, and by
`fit_strides` or `fit_parametric`, which choose them from the examples.
"""

import sys
import warnings
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

import networkx as nx
import numpy as np
from compare_control import strides
from scipy.signal import find_peaks
from tasks import Case, control
from tasks._measures import jolting
from tasks.hands import PUNCHES

import mocap
from mocap import feet, quality, steering
from mocap._shared.arrays import Array, runs
from mocap.body import Motion, heading, joint_positions, on_ground
from mocap.errors import MocapError, MocapWarning
from mocap.methods import parametric_graphs
from mocap.methods.match_webs import hand_target, sample_space
from mocap.methods.match_webs.motion_spaces import Measure
from mocap.methods.parametric_graphs.parametric_control import ParametricController
from mocap.methods.parametric_graphs.stride_spaces import parameter_text
from mocap.quality.seam_measures import mean_foot_sliding
from mocap.steering.characters import Pose

PAGE = Path(__file__).with_name("parametric_sets.md")
STRIDES = ("lrl",)
STEPS = ("lr", "rl")
AROUND_FLIGHT = 15  # frames before a jump's flight and after it
PUNCH_START = -21  # frames from the moment when the arm is longest
PUNCH_STOP = 22
SCOOPED = 0.5  # metres: a hand below it scoops up
HOP_FRAMES = (12, 30)  # from one flight to the next
CONSTANT = {"margin": 0.38, "good": 0.06}  # of an action; metres
ACTIONS = 30  # played in a row, with random parameters


class Actions(NamedTuple):
    """Clips, the frames of an action in each, and what is measured of the actions."""

    clips: list[Motion]
    spans: list[tuple[int, int]]
    measure: Measure
    parameters: tuple[str, ...]


def load(folder: Path, subject: str, trial: int) -> Motion:
    """Load a clip of the CMU database at 30 Hz, with its plants marked."""
    return marked(mocap.load(folder / "cmu" / subject / f"{subject}_{trial:02}.amc"))


def marked(clip: Motion) -> Motion:
    """Resample a clip to 30 Hz, and mark its plants."""
    return feet.mark_plants(mocap.resample(clip, 30))


def people(folder: Path, subject: str, trials: Sequence[int]) -> list[Motion]:
    """Load clips of one subject of the CMU database."""
    return [load(folder, subject, trial) for trial in trials]


def files(folder: Path, pattern: str, scale: float | None = None) -> list[Motion]:
    """Load the clips whose paths match a pattern."""
    return [marked(mocap.load(path, scale=scale)) for path in sorted(folder.glob(pattern))]


def flights(clip: Motion) -> list[tuple[int, int]]:
    """Find the stretches of at least four frames in which no foot stands."""
    is_standing = np.any(list(clip.contacts.values()), axis=0)
    return [(start, stop) for start, stop in runs(~is_standing).tolist() if stop - start >= 4]


def ahead(motion: Motion) -> float:
    """Measure how far a motion goes along its first heading, metres."""
    track = on_ground(motion.root_positions)
    direction = np.exp(1j * heading(motion.rotations[0, 0]))
    return float(((track[-1] - track[0]) / direction).real)


def height(motion: Motion) -> float:
    """Measure the largest height of the root, metres."""
    return float(motion.root_positions[:, 1].max())


def jumps(folder: Path, trials: Sequence[int], measure: Measure, parameter: str) -> Actions:
    """Cut the longest flight of each clip, with what leads to it and follows."""
    clips = people(folder, "16", trials)
    longest = [max(flights(clip), key=np.ptp) for clip in clips]
    spans = [(start - AROUND_FLIGHT, stop + AROUND_FLIGHT) for start, stop in longest]
    return Actions(clips, spans, measure, (parameter,))


def punches(folder: Path) -> Actions:
    """Cut the punches of one clip."""
    clip = load(folder, "02", 5)
    spans = [(moment + PUNCH_START, moment + PUNCH_STOP) for moment in PUNCHES]
    return Actions([clip] * len(spans), spans, hand_target, ("left", "up", "ahead"))


def reaches(folder: Path) -> Actions:
    """Cut one clip where the hand is lowest: each time it scoops up and reaches above the head."""
    clip = load(folder, "02", 6)
    heights = joint_positions(clip)[:, clip.skeleton.index("rhand"), 1]
    low = [int(frame) for frame in find_peaks(-heights, distance=30)[0] if heights[frame] < SCOOPED]
    spans = list(pairwise(low))
    return Actions([clip] * len(spans), spans, hand_target, ("left", "up", "ahead"))


def hops(folder: Path, trial: int) -> Actions:
    """Cut hops, each from one flight to the next."""
    clip = load(folder, "49", trial)
    starts = [start for start, _ in flights(clip)]
    shortest, longest = HOP_FRAMES
    spans = [(start, stop) for start, stop in pairwise(starts) if shortest <= stop - start <= longest]
    return Actions([clip] * len(spans), spans, height, ("height",))


WALKS_16 = (*range(11, 35), 47, 58)
RUNS_16 = (8, *range(35, 47), *range(48, 58))
RUNS_127 = (3, 6, 7, 8, 9, 10, 11, 12, 15, 16)
BANDAI = "bvh/bandai_namco/dataset-[12]_walk*normal*.bvh"
# reads: statement: a table
STRIDE_SETS: Mapping[str, Callable[[Path], list[Motion]]] = {
    "walk: CMU 16": partial(people, subject="16", trials=WALKS_16),
    "turns: a walker's": partial(files, pattern="bvh/puppy0512_motion_graph/*.bvh"),
    "run: CMU 16": partial(people, subject="16", trials=RUNS_16),
    "run and turn: CMU 127": partial(people, subject="127", trials=RUNS_127),
    "walk: homework": partial(files, pattern="hw3/*.AMC"),
    "walk: Bandai-Namco": partial(files, pattern=BANDAI),
    "walk on uneven ground: CMU 03": partial(people, subject="03", trials=(1, 2, 3, 4)),
    "walk an eight: pymo": partial(files, pattern="bvh/pymo/*.bvh", scale=0.0254),
    "straight walks: CMU 02": partial(people, subject="02", trials=(1, 2)),
    "one straight walk: CMU 49": partial(people, subject="49", trials=(1,)),
}
# reads: statement: a table
ACTION_SETS: Mapping[str, Callable[[Path], Actions]] = {
    "punch: CMU 02": punches,
    "reach: CMU 02": reaches,
    "jump ahead: CMU 16": partial(jumps, trials=(5, 6, 7, 9, 10), measure=ahead, parameter="ahead"),
    "jump up: CMU 16": partial(jumps, trials=(1, 2, 3, 4), measure=height, parameter="height"),
    "hop: CMU 49_02": partial(hops, trial=2),
    "hop: CMU 49_03": partial(hops, trial=3),
}


def constant_actions(actions: Actions) -> nx.DiGraph:
    """Build a graph with one margin and one T_GOOD for all sets."""
    examples = parametric_graphs.cut_actions(actions.clips, actions.spans, margin=CONSTANT["margin"])
    space = sample_space(examples, actions.measure, parameters=actions.parameters)
    return parametric_graphs.build_parametric({"action": space}, good=CONSTANT["good"])


def fitted_actions(actions: Actions) -> nx.DiGraph:
    """Build a graph with what suits the examples."""
    examples = parametric_graphs.cut_actions(actions.clips, actions.spans, margin=None)
    space = sample_space(examples, actions.measure, parameters=actions.parameters)
    return parametric_graphs.fit_parametric({"action": space}, [("action", "action")])


def play(graph: nx.DiGraph) -> Motion:
    """Play actions in a row, each with parameters drawn from its box."""
    random = np.random.default_rng(0)
    character = ParametricController(graph)

    def anywhere(*_: object) -> Array:
        box = next(iter(character.boxes.values()))
        return random.uniform(np.minimum(box.low, box.high), np.maximum(box.low, box.high))

    character._requested = anywhere  # type: ignore[method-assign]
    poses: list[Pose] = []
    while len(character.chosen) < ACTIONS or character.frames_left:
        poses.append(character.step(0.0, 0.0))
    names = poses[0].contacts
    roots = np.array([pose.root_position for pose in poses])
    rotations = np.array([pose.rotations for pose in poses])
    contacts = {name: np.array([pose.contacts[name] for pose in poses]) for name in names}
    return Motion(character.skeleton, roots, rotations, character.fps, contacts=contacts)


def ranges(graph: nx.DiGraph) -> str:
    """Describe the examples and the range of each node, and T_GOOD."""
    texts = []
    for node, space in graph.nodes(data="space"):
        ends = []
        for name, low, high in zip(space.parameters, space.low, space.high, strict=True):
            ends.append(f"{name} {parameter_text(name, low)} to {parameter_text(name, high)}")
        texts.append(f"{len(space.examples)} '{node}', {', '.join(ends)}")
    needed = max(edge.smallest_good for _, _, edge in graph.edges(data="edge"))
    return f"{'; '.join(texts)} | {100 * needed:.1f}"


def steered(graph: nx.DiGraph, clips: list[Motion]) -> str:
    """Write the cells of a character that is steered."""
    space = next(iter(graph.nodes(data="space")))[1]
    speed = float(np.median(space.examples.values[:, 1]))
    headings = steering.command_headings(control.SECONDS, control.FPS)
    character = steering.RootTurner(ParametricController(graph))
    motion = steering.steer(character, headings.tolist(), speed).motion
    request = {"headings": headings[:, None], "speed": [[speed]], "clips": tuple(clips)}
    obeys, _, jolts, _ = control.score(Case("", "", request), motion)
    slide = mean_foot_sliding(quality.foot_sliding(motion))
    return f"{jolts:.2f} | {slide:.1f} | {obeys:.2f}"


def acted(graph: nx.DiGraph, clips: list[Motion]) -> str:
    """Write the cells of a character that acts again and again."""
    motion = play(graph)
    slide = mean_foot_sliding(quality.foot_sliding(motion))
    distinct = tuple({clip.name: clip for clip in clips}.values())
    return f"{jolting(motion, distinct):.2f} | {slide:.1f} | "


def first_sentence(build: Callable[[], nx.DiGraph]) -> tuple[nx.DiGraph | None, str]:
    """Build a graph, or return the refusal."""
    try:
        return build(), "built"
    except MocapError as error:
        return None, f"refused: {error}"


def row(name: str, kind: str, constant: str, fitted: str, cells: str) -> str:
    """Write a row of the table."""
    return f"| {name} | {kind} | {constant} | {fitted} | {cells} |"


def stride_rows(name: str, clips: list[Motion]) -> list[str]:
    """Write the rows of a set of clips: its strides, and its steps."""
    lines = []
    for kind, kinds in (("strides", STRIDES), ("steps", STEPS)):
        _, constant = first_sentence(lambda kinds=kinds: strides(clips, kinds, 75.0)[0])
        graph, fitted = first_sentence(lambda kinds=kinds: parametric_graphs.fit_strides(clips, feet=kinds))
        if graph is None:
            lines.append(row(name, kind, constant, f"{fitted} | ", " | | "))
        else:
            lines.append(row(name, kind, constant, ranges(graph), steered(graph, clips)))
    return lines


def action_rows(name: str, actions: Actions) -> list[str]:
    """Write the row of a set of actions."""
    _, constant = first_sentence(lambda: constant_actions(actions))
    graph, fitted = first_sentence(lambda: fitted_actions(actions))
    if graph is None:
        return [row(name, "actions", constant, f"{fitted} | ", " | | ")]
    return [row(name, "actions", constant, ranges(graph), acted(graph, actions.clips))]


HEAD = """# Parametric graphs of ordinary clips

`python figures/parametric_sets.py` writes this page. Each set is built with one margin, one range and a
T_GOOD of at most 6 cm for all sets, and then by `fit_strides` or, from the spans of actions, by
`fit_parametric`. These choose all three from the examples: T_GOOD up to the distance by which poses change in
1/15 s, and ranges in which something follows each source. T_GOOD is the one that the edges need. Jolting:
frames whose velocity jumps further than in 99.9 % of the clips' frames. Slide: of planted feet, without any
clean-up of the result. Obeys: of characters that are turned about the root, 30 s of commands. Actions are
played thirty in a row, with random parameters."""
COLUMNS = (
    "| set | examples | with constants | fitted | T_GOOD, cm | jolting, % | slide, cm | obeys, s |",
    "|---|---|---|---|---|---|---|---|",
)


def main() -> None:
    """Write the table, or print the rows of some sets."""
    warnings.simplefilter("ignore", MocapWarning)
    folder = Path(sys.argv[1])
    wanted = sys.argv[2:]
    lines = []
    for name, find in STRIDE_SETS.items():
        if not wanted or name in wanted:
            lines += stride_rows(name, find(folder))
            print("\n".join(lines[-2:]), flush=True)
    for name, cut in ACTION_SETS.items():
        if not wanted or name in wanted:
            lines += action_rows(name, cut(folder))
            print(lines[-1], flush=True)
    if not wanted:
        PAGE.write_text("\n".join([HEAD, "", *COLUMNS, *lines, ""]), "utf-8")


if __name__ == "__main__":
    main()
