"""Walk along ten random lines of 7 m, with the clips as they are.

Off: the root's mean distance from the line; worst: its largest; left out: the largest distance of a point of
the line from the walk; at equal arc length: as the paper's Eq. 9 measures, on average. Skate: how fast low
feet slide, which each seam adds to. The search of 2002 looks 45 frames ahead, keeps 15,
and may expand 30 000 walks each time; a step at a time it takes the next edge alone. Both start where the
layered search does.
"""

from collections.abc import Iterator
from functools import cache

import numpy as np
from asked_lines import random_line

from mocap._shared.arrays import Array
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
SEEDS, LENGTH, SPACING = range(500, 510), 7.0, 0.05
MEASURES = {
    "off, cm": True,
    "worst, cm": True,
    "left out, cm": True,
    "Eq. 9, cm": True,
    "foot sliding, cm/s": True,
}
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
    line, budget = GroundPath(case.given["line"]), 30_000
    return follow_as_2002(graph(case.given["clips"]), line, request, look=look, budget=budget).motion()


def nearest_clip(case: Case) -> Motion:
    """Lay the piece of a clip whose way is most like the line there; where it is too short, it stands."""
    line, best = on_ground(case.given["line"]), (np.inf, None)
    for clip in case.given["clips"]:
        track = on_ground(clip.root_positions)
        metres = np.append(0, np.abs(np.diff(track)).cumsum())
        for start in range(0, len(clip) - 10, 5):
            own = np.interp(metres[start] + ALONG, metres, np.arange(len(clip)))
            way = np.interp(own, np.arange(len(clip)), track)
            turn = np.exp(1j * np.angle(np.vdot(way - way.mean(), line - line.mean())))
            move = line.mean() - turn * way.mean()
            gap = float((np.abs(turn * way + move - line) ** 2).mean())
            if gap < best[0]:
                best = gap, (clip[start : int(own[-1]) + 1], PlanarTransform.from_complex(turn, move))
    if best[1] is None:
        raise MocapError("No clip is long enough.")
    return best[1][1].apply_motion(best[1][0])


METHODS = {
    "nearest clip": nearest_clip,
    "a step at a time": lambda case: as_2002(case, (1, 1)),
    "search of 2002": lambda case: as_2002(case, (45, 15)),
    "layered search": lambda case: layered(case.given["clips"], case.name).motion(),
}


def score(case: Case, answer: Motion) -> Array:
    """Measure how near a walk is to its line."""
    line, track = on_ground(case.given["line"]), on_ground(answer.root_positions)
    apart = np.abs(track[:, None] - line)  # (F, P)
    metres = np.append(0, np.abs(np.diff(track)).cumsum())
    at = np.interp(metres, ALONG, line)
    off = apart.min(axis=1)
    lengths = [off.mean(), off.max(), apart.min(axis=0).max(), np.abs(track - at).mean()]
    return np.array([*(100 * metre for metre in lengths), foot_sliding_speed(answer)])
