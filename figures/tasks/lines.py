"""Walk along lines that no clip turns along: a sine, a spiral, a zigzag, a heart, ten random lines of 7 m.

Off: the root's mean distance from the line; worst: its largest; left out: the largest distance of a point of
the line from the walk. Foot sliding: the speed of low feet. Jolting: frames whose velocity jumps further
than in 99.9 % of the clips' own. `layered search` is not bent; `laid on the line` is bent, and its feet left
alone. The CPU time of `bent` is that of the clean-up alone. Feet slide and velocities jump less in walks that
leave the line, where the clips never turn.
"""

from collections.abc import Iterator
from functools import cache

import numpy as np
from asked_lines import LINES, follow_unbent, random_line

from mocap._shared.arrays import Array
from mocap.body import GroundPath, Motion, on_ground
from mocap.editing import LIMIT
from mocap.steering import follow_path
from mocap.steering.followed import Followed
from tasks import STRAIGHT, WALKS, Case, Walked, graph
from tasks._measures import foot_sliding_speed, jolting, sliding_of_clips
from tasks.following import ALONG

STRAIGHT_WALKS = tuple(f"16/16_{n}" for n in (15, 16, 21, 22, 31, 32, 47))
CLIPS = {
    "bundled clips": (*WALKS, "stop_and_go"),
    "CMU 16, seven straight walks": STRAIGHT_WALKS,
    "CMU 02, two walks": STRAIGHT,
    "CMU 49, a walk and dance": ("49/49_01", "49/49_09", "49/49_12"),
}
SEEDS = range(500, 510)
SPACING = 0.02  # metres between the points of a line
MEASURES = {
    "off, cm": True,
    "worst, cm": True,
    "left out, cm": True,
    "foot sliding, cm/s": True,
    "jolting, %": True,
}
BASELINES = ("layered search",)


def cases(collection: str, clips: list[Motion]) -> Iterator[Case]:
    """Yield the lines."""
    lines = {name: draw() for name, draw in LINES.items()}
    lines |= {f"line-{seed}": GroundPath(random_line(seed).at(ALONG)) for seed in SEEDS}
    for name, line in lines.items():
        fine = line.at(np.arange(0, line.length, SPACING))
        yield Case(collection, name, {"line": fine, "clips": tuple(clips)})


@cache
def bent(clips: tuple[Motion, ...], line: bytes) -> Followed:
    """Lay a walk on a line."""
    points = np.frombuffer(line).reshape(-1, 2)
    return follow_path(graph(clips), GroundPath(points), bend=LIMIT)


def of(case: Case) -> Followed:
    """Lay a walk on the line of a case."""
    return bent(case.given["clips"], np.ascontiguousarray(case.given["line"]).tobytes())


def unbent(case: Case) -> Walked:
    """Follow the line of a case with clips as they are."""
    followed = follow_unbent(graph(case.given["clips"]), GroundPath(case.given["line"]))
    return Walked(followed.motion(), followed.seams_per_second)


def laid(case: Case) -> Walked:
    """Bend a walk onto the line, and leave its feet alone."""
    followed = of(case)
    return Walked(followed.motion(clean=False), followed.seams_per_second)


def cleaned(case: Case) -> Walked:
    """Bend a walk onto the line, and clean its feet up."""
    followed = of(case)
    return Walked(followed.motion(), followed.seams_per_second)


def of_clips(case: Case) -> tuple[float, ...]:
    """Measure the clips themselves."""
    clips = case.given["clips"]
    jolts = float(np.mean([jolting(clip, clips) for clip in clips]))
    return np.nan, np.nan, np.nan, sliding_of_clips(clips), jolts


METHODS = {"layered search": unbent, "laid on the line": laid, "bent": cleaned}


def score(case: Case, answer: Motion) -> Array:
    """Measure how near a walk is to its line, and what its feet do."""
    distances = np.abs(on_ground(answer.root_positions)[:, None] - on_ground(case.given["line"]))
    nearest = distances.min(axis=1)
    metres = [nearest.mean(), nearest.max(), distances.min(axis=0).max()]
    centimetres = [100 * distance for distance in metres]
    clips = case.given["clips"]
    return np.array([*centimetres, foot_sliding_speed(answer, clips), jolting(answer, clips)])
