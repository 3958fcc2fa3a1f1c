"""Steer a character for 30 s: every two seconds a turn by 30 to 120 degrees, three seeds of commands.

Obeys: seconds until the direction of the last third of a second is within 20 degrees of the command, 2 s if
never. Foot sliding: the speed of low feet. Jolting: frames whose velocity jumps further than in 99.9 % of the
clips' own. Pace: metres per second beside those asked for. The clip that is turned at once is the longest
one, over and over: nothing obeys sooner, and its feet slide. The others are turned about the root as well,
with their standing feet held, so that they obey about as soon, and differ in what their feet do. Of the two
clips without turns, the right foot stands 3 cm higher in one than in the other, so that little of some walks
counts as low.
"""

from collections.abc import Callable, Iterator
from functools import cache

import compare_control
import networkx as nx
import numpy as np

from mocap._shared.arrays import Array
from mocap.body import Motion, on_ground, rotations
from mocap.errors import MocapError
from mocap.methods import motion_matching, parametric_graphs
from mocap.steering import Controller, RootTurner, command_headings, steer
from mocap.steering.characters import Character
from tasks import BANDAI, CMU_16, HOMEWORK, STRAIGHT, WALKS, Case, graph
from tasks._measures import foot_sliding_speed, jolting, sliding_of_clips

CLIPS = {
    "bundled clips": WALKS,
    "homework's clips": HOMEWORK,
    "CMU 16, walks": CMU_16,
    "Bandai-Namco": BANDAI,
    "CMU 02, without turns": STRAIGHT,
}
SEEDS = range(3)
SECONDS = 30.0  # of each case
FPS = 30.0  # frames per second
EVERY = 60  # frames between two commands
SPEEDS = {"CMU 16, walks": 1.1, "Bandai-Namco": 1.1, "CMU 02, without turns": 1.3}  # m/s; else 0.8
LIMITS = {"homework's clips": 120.0}  # degrees per stride; else 75
MEASURES = {"obeys, s": True, "foot sliding, cm/s": True, "jolting, %": True, "pace, m/s off": True}
BASELINES = ("clip turned at once", "motion graph")
DECIDED = {"obeys, s": "a rigid clip that turns by 240 degrees per second at once"}
OBEYS = np.radians(20)  # a direction that differs by less obeys
QUICKEST = np.radians(240)  # per second, of a clip that is turned
AROUND = 5  # frames before and after one, over which a clip's direction is measured


def cases(collection: str, clips: list[Motion]) -> Iterator[Case]:
    """Yield the commands: a heading for each frame."""
    for seed in SEEDS:
        headings = command_headings(SECONDS, FPS, seed)[:, None]
        numbers = [[SPEEDS.get(collection, 0.8), LIMITS.get(collection, 75.0)]]
        yield Case(
            collection, f"seed-{seed}", {"headings": headings, "speed": numbers, "clips": tuple(clips)}
        )


def steered(make: Callable[[Case], Character]) -> Callable[[Case], Motion]:
    """Steer a character by the commands of a case."""

    def method(case: Case) -> Motion:
        return steer(make(case), case.given["headings"][:, 0].tolist(), case.given["speed"][0][0]).motion

    return method


@cache
def steps(clips: tuple[Motion, ...], limit: float) -> nx.DiGraph:
    """Fit a parametric graph of steps to clips."""
    return parametric_graphs.fit_strides(clips, limit=np.radians(limit))


table = cache(motion_matching.tabulate)


def turned(case: Case) -> Motion:
    """Play the longest clip, and turn it at once to where it is told to go."""
    clip = max(case.given["clips"], key=len)
    headings = case.given["headings"][:, 0]
    rows = np.arange(len(headings)) % (len(clip) - 1)
    track = on_ground(clip.root_positions)
    starts = np.clip(rows - AROUND, 0, len(clip) - 1)
    stops = np.clip(rows + AROUND, 0, len(clip) - 1)
    directions = np.angle(track[stops] - track[starts])  # of the clip
    turn = _directions(headings) - directions
    moves = np.diff(track)[rows] * np.exp(1j * turn)
    places = np.append(0, np.cumsum(moves)[:-1])
    roots = np.stack([places.imag, clip.root_positions[rows, 1], places.real], axis=1)
    joint_rotations = clip.rotations[rows].copy()
    joint_rotations[:, 0] = rotations.multiply(rotations.about_y(turn), joint_rotations[:, 0])
    return Motion(clip.skeleton, roots, joint_rotations, FPS)


def _directions(headings: Array) -> Array:
    """Turn towards commanded headings (F,) as quickly as a clip is turned."""
    largest = QUICKEST / FPS
    direction = 0.0
    directions = []
    for heading in headings:
        difference = np.angle(np.exp(1j * (heading - direction)))
        direction += float(np.clip(difference, -largest, largest))
        directions.append(direction)
    return np.array(directions)


def on_graph(case: Case) -> Controller:
    """Make a character on the motion graph of the clips."""
    return Controller(graph(case.given["clips"]))


def matcher(case: Case) -> motion_matching.MotionMatcher:
    """Make a character of motion matching."""
    return motion_matching.MotionMatcher(table(case.given["clips"]), motion_matching.Wants(future=1.0))


def stepper(case: Case) -> parametric_graphs.ParametricController:
    """Make a character on a parametric graph of steps."""
    return parametric_graphs.ParametricController(steps(case.given["clips"], case.given["speed"][0][1]))


# reads: statement: a table
METHODS: dict[str, Callable[[Case], Motion]] = {
    "clip turned at once": turned,
    "motion graph": steered(on_graph),
    "motion graph, turned about the foot": steered(
        lambda case: compare_control.turned(graph(case.given["clips"]))
    ),
    "motion graph, turned about the root": steered(lambda case: RootTurner(on_graph(case))),
    "motion matching, turned about the root": steered(lambda case: RootTurner(matcher(case))),
    "parametric graph of steps, turned about the root": steered(lambda case: RootTurner(stepper(case))),
}


def of_clips(case: Case) -> tuple[float, ...]:
    """Measure the clips themselves."""
    clips = case.given["clips"]
    jolts = [jolting(clip, clips) for clip in clips]
    return np.nan, sliding_of_clips(clips), float(np.mean(jolts)), np.nan


def score(case: Case, answer: Motion) -> tuple[float, float, float, float]:
    """Measure how soon a motion goes where it is told."""
    headings = case.given["headings"][:, 0]
    track = on_ground(answer.root_positions)
    if len(answer) != len(headings):
        raise MocapError(f"{case.name} asks for {len(headings)} frames, got {len(answer)}.")
    window = round(FPS / 3)
    moves = track[window:] - track[:-window]
    differences = np.angle(moves * np.exp(-1j * headings[window:]))
    is_near = np.append(np.zeros(window, bool), np.abs(differences) < OBEYS)
    is_obeying = is_near.reshape(-1, EVERY)[1:]
    frames = np.where(is_obeying.any(axis=1), is_obeying.argmax(axis=1) + 1, EVERY)
    pace = float(np.abs(np.diff(track)).mean() * FPS)
    clips = case.given["clips"]
    sliding = foot_sliding_speed(answer, clips)
    difference = abs(pace - case.given["speed"][0][0])
    return float(frames.mean() / FPS), sliding, jolting(answer, clips), difference
