"""Steer a character for 30 s: every two seconds a turn by 30 to 120 degrees, ten seeds of commands.

Obeys: seconds until the direction of the last third of a second is within 20 degrees of the command, 2 s if
never. Foot sliding: the speed of low feet. Jolting: frames whose velocity jumps further than in 99.9 % of the
clips' own. Pace: metres per second beside those asked for. The clip that is turned at once is the longest
one, over and over.
"""

from collections.abc import Callable, Iterator
from functools import cache

import compare_control
import networkx as nx
import numpy as np

from mocap.body import Motion, on_ground, rotations
from mocap.errors import MocapError
from mocap.methods import motion_matching, parametric_graphs
from mocap.steering import Controller, RootTurner, command_headings, steer
from mocap.steering.characters import Character
from tasks import BANDAI, CMU_16, HOMEWORK, WALKS, Case, graph
from tasks._measures import foot_sliding_speed, jolting

CLIPS = {
    "bundled clips": WALKS,
    "homework's clips": HOMEWORK,
    "CMU 16, walks": CMU_16,
    "Bandai-Namco": BANDAI,
}
SEEDS, SECONDS, FPS, EVERY = range(10), 30.0, 30.0, 60  # frames between two commands
SPEEDS = {"CMU 16, walks": 1.1, "Bandai-Namco": 1.1}  # metres per second; else 0.8
LIMITS = {"homework's clips": 120.0}  # degrees per stride; else 75
MEASURES = {"obeys, s": True, "foot sliding, cm/s": True, "jolting, %": True, "pace, m/s off": True}
BASELINES = ("clip turned at once", "motion graph")
OBEYS, QUICKEST = np.radians(20), np.radians(240)  # of a direction; per second, of a clip that is turned


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
    """Build a parametric graph of steps."""
    return compare_control.strides(list(clips), ("lr", "rl"), limit)[0]


table = cache(motion_matching.tabulate)


def turned(case: Case) -> Motion:
    """Play the longest clip, and turn it at once to where it is told to go."""
    clip = max(case.given["clips"], key=len)
    headings = case.given["headings"][:, 0]
    rows = np.arange(len(headings)) % (len(clip) - 1)
    track = on_ground(clip.root_positions)
    step = np.diff(track)[rows]
    wide = np.clip(np.stack([rows - 5, rows + 5]), 0, len(clip) - 1)
    own = np.angle(track[wide[1]] - track[wide[0]])
    way, ways = 0.0, []
    for heading in headings:
        gap = np.angle(np.exp(1j * (heading - way)))
        way += float(np.clip(gap, -QUICKEST / FPS, QUICKEST / FPS))
        ways.append(way)
    turn = np.array(ways) - own
    place = np.append(0, np.cumsum(step * np.exp(1j * turn))[:-1])
    roots = np.stack([place.imag, clip.root_positions[rows, 1], place.real], axis=1)
    turns = clip.rotations[rows].copy()
    turns[:, 0] = rotations.multiply(rotations.about_y(turn), turns[:, 0])
    return Motion(clip.skeleton, roots, turns, FPS)


METHODS: dict[str, Callable[[Case], Motion]] = {
    "clip turned at once": turned,
    "motion graph": steered(lambda case: Controller(graph(case.given["clips"]))),
    "motion graph, turned about the foot": steered(
        lambda case: compare_control.turned(graph(case.given["clips"]))
    ),
    "motion graph, turned about the root": steered(
        lambda case: RootTurner(Controller(graph(case.given["clips"])))
    ),
    "motion matching": steered(
        lambda case: motion_matching.MotionMatcher(
            table(case.given["clips"]), motion_matching.Wants(future=1.0)
        )
    ),
    "parametric graph of steps": steered(
        lambda case: parametric_graphs.ParametricController(
            steps(case.given["clips"], case.given["speed"][0][1])
        )
    ),
}


def score(case: Case, answer: Motion) -> tuple[float, float, float, float]:
    """Measure how soon a motion goes where it is told."""
    headings, track = case.given["headings"][:, 0], on_ground(answer.root_positions)
    if len(answer) != len(headings):
        raise MocapError(f"{case.name} asks for {len(headings)} frames, got {len(answer)}.")
    back = round(FPS / 3)
    way = np.angle((track[back:] - track[:-back]) * np.exp(-1j * headings[back:]))
    obeys = np.append(np.zeros(back, bool), np.abs(way) < OBEYS).reshape(-1, EVERY)[1:]
    soon = np.where(obeys.any(axis=1), obeys.argmax(axis=1) + 1, EVERY) / FPS
    pace = np.abs(np.diff(track)).mean() * FPS
    off = abs(float(pace) - case.given["speed"][0][0])
    return float(soon.mean()), foot_sliding_speed(answer), jolting(answer, case.given["clips"]), off
