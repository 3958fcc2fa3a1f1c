"""Walk along ten random lines of 7 m, with the clips as they are.

Off: the root's mean distance from the line; worst: its largest; left out: the largest distance of a point of
the line from the walk; at equal arc length: as the paper's Eq. 9 measures, on average. Skate: how fast low
feet slide, which each seam adds to. The search of 2002 looks 45 frames ahead, keeps 15,
and may expand 30 000 walks each time; a step at a time it takes the next edge alone. Both start where the
layered search does.
"""

from collections.abc import Iterator
from functools import cache, partial

import numpy as np
from asked_lines import random_line

from mocap._shared.arrays import Array, Points
from mocap.body import GroundPath, Motion, PlanarTransform, on_ground
from mocap.errors import MocapError
from mocap.steering import PathRequest, follow_as_2002, follow_path
from mocap.steering.followed import Followed
from tasks import BANDAI, CMU_16, HOMEWORK, WALKS, Case, graph
from tasks._measures import foot_sliding_speed

CLIPS = {
    "bundled clips": (*WALKS, "stop_and_go"),
    "homework's clips": HOMEWORK,
    "CMU 16, walks": CMU_16,
    "Bandai-Namco": BANDAI,
}
SEEDS = range(500, 510)
LENGTH = 7.0  # metres of a line
SPACING = 0.05  # metres between its points
MEASURES = {
    "off, cm": True,
    "worst, cm": True,
    "left out, cm": True,
    "Eq. 9, cm": True,
    "foot sliding, cm/s": True,
}
BUDGET = 30_000  # walks that a stretch of the search of 2002 may expand
BASELINES = ("nearest clip", "a step at a time", "search of 2002")
ALONG = np.arange(0, LENGTH + SPACING / 2, SPACING)


def cases(collection: str, clips: list[Motion]) -> Iterator[Case]:
    """Yield the lines."""
    for seed in SEEDS:
        line = random_line(seed).at(ALONG)
        yield Case(collection, f"line-{seed}", {"line": line, "clips": tuple(clips)})


@cache
def layered(clips: tuple[Motion, ...], seed: str) -> Followed:
    """Search in layers."""
    return follow_path(graph(clips), GroundPath(random_line(int(seed.split("-")[1])).at(ALONG)))


def as_2002(case: Case, look: tuple[int, int]) -> Motion:
    """Search by branch and bound."""
    request = PathRequest(start=layered(case.given["clips"], case.name).walk[0][0], correction=0)
    line = GroundPath(case.given["line"])
    return follow_as_2002(graph(case.given["clips"]), line, request, look=look, budget=BUDGET).motion()


def nearest_clip(case: Case) -> Motion:
    """Lay the piece of a clip whose way is most like the line there; where it is too short, it stands."""
    line = on_ground(case.given["line"])
    smallest = np.inf  # m², the mean squared distance of the best piece
    best: Motion | None = None
    for clip in case.given["clips"]:
        track = on_ground(clip.root_positions)
        metres = np.append(0, np.abs(np.diff(track)).cumsum())
        for start in range(0, len(clip) - 10, 5):
            frames = np.interp(metres[start] + ALONG, metres, np.arange(len(clip)))
            points = np.interp(frames, np.arange(len(clip)), track)
            rotation, translation = aligned(points, line)
            error = float((np.abs(rotation * points + translation - line) ** 2).mean())
            if error < smallest:
                smallest = error
                transform = PlanarTransform.from_complex(rotation, translation)
                best = transform.apply_motion(clip[start : int(frames[-1]) + 1])
    if best is None:
        raise MocapError("No clip is long enough.")
    return best


def aligned(points: Points, line: Points) -> tuple[complex, complex]:
    """Return the rotation and the translation that align points with those of a line, by least squares."""
    correlation = np.vdot(points - points.mean(), line - line.mean())
    rotation = np.exp(1j * np.angle(correlation))
    return rotation, line.mean() - rotation * points.mean()


def layered_motion(case: Case) -> Motion:
    """Search in layers, and return the motion."""
    return layered(case.given["clips"], case.name).motion()


METHODS = {
    "nearest clip": nearest_clip,
    "a step at a time": partial(as_2002, look=(1, 1)),
    "search of 2002": partial(as_2002, look=(45, 15)),
    "layered search": layered_motion,
}


def score(case: Case, answer: Motion) -> Array:
    """Measure how near a walk is to its line."""
    line = on_ground(case.given["line"])
    track = on_ground(answer.root_positions)
    distances = np.abs(track[:, None] - line)  # (F, P)
    metres = np.append(0, np.abs(np.diff(track)).cumsum())
    at_length = np.abs(track - np.interp(metres, ALONG, line))
    nearest = distances.min(axis=1)
    lengths = [nearest.mean(), nearest.max(), distances.min(axis=0).max(), at_length.mean()]
    return np.array([*(100 * metre for metre in lengths), foot_sliding_speed(answer)])
