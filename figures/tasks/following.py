"""Walk along three random lines of 7 m.

Off: the root's mean distance from the line; worst: its largest; left out: the largest distance of a point of
the line from the walk; at equal arc length: as the paper's Eq. 9 measures, on average. Foot sliding: the
speed of low feet, which each seam adds to. The search of 2002 looks 45 frames ahead, keeps 15, and may expand
30 000 walks each time; a step at a time it takes the next edge alone. Both start where the layered search
does, and the CPU time of the latter includes that. The package has three answers: a search that prices seams,
one with free seams, and a walk that is bent.

The search of 2002 is nearer to a line than one that prices seams, because it takes two to three times as
many: its walks waver less, and blend more. With free seams the layered search is nearer on most lines, and
quicker. Clips without turns are bent; nothing else keeps them on a line. Of these two clips, the right foot
stands 3 cm higher in one than in the other, so that little of some walks counts as low.
"""

from collections.abc import Iterator
from functools import cache, partial

import numpy as np
from asked_lines import follow_unbent, random_line

from mocap._shared.arrays import Array, Points
from mocap.body import GroundPath, Motion, PlanarTransform, on_ground
from mocap.editing import LIMIT
from mocap.errors import MocapError
from mocap.steering import PathRequest, Settings, follow_as_2002, follow_path
from mocap.steering.followed import Followed
from tasks import BANDAI, CMU_16, HOMEWORK, STRAIGHT, WALKS, Case, Walked, graph
from tasks._measures import foot_sliding_speed, sliding_of_clips

CLIPS = {
    "bundled clips": (*WALKS, "stop_and_go"),
    "homework's clips": HOMEWORK,
    "CMU 16, walks": CMU_16,
    "Bandai-Namco": BANDAI,
    "CMU 02, without turns": STRAIGHT,
}
SEEDS = range(500, 503)
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
FREE = Settings(seam=0, match=0, width=200, tries=1)  # seams cost nothing, as in 2002
ALONG = np.arange(0, LENGTH + SPACING / 2, SPACING)


def cases(collection: str, clips: list[Motion]) -> Iterator[Case]:
    """Yield the lines."""
    for seed in SEEDS:
        line = random_line(seed).at(ALONG)
        yield Case(collection, f"line-{seed}", {"line": line, "clips": tuple(clips)})


@cache
def start_of(clips: tuple[Motion, ...], line: bytes) -> tuple[int, int]:
    """Return where the layered search starts a walk."""
    points = np.frombuffer(line).reshape(-1, 2)
    return follow_unbent(graph(clips), GroundPath(points)).walk[0][0]


def walked(followed: Followed) -> Walked:
    """Return the motion of a walk, and its seams per second."""
    return Walked(followed.motion(), followed.seams_per_second)


def as_2002(case: Case, look: tuple[int, int]) -> Walked:
    """Search by branch and bound."""
    line = np.ascontiguousarray(case.given["line"])
    request = PathRequest(start=start_of(case.given["clips"], line.tobytes()), correction=0)
    source = graph(case.given["clips"])
    return walked(follow_as_2002(source, GroundPath(line), request, look=look, budget=BUDGET))


def layered(case: Case, settings: Settings | None = None, bend: float = 0.0) -> Walked:
    """Search in layers, and perhaps bend the walk."""
    line = GroundPath(case.given["line"])
    return walked(follow_path(graph(case.given["clips"]), line, settings=settings, bend=bend))


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


# reads: statement: a table
METHODS = {
    "seams priced": layered,
    "seams free": partial(layered, settings=FREE),
    "bent": partial(layered, bend=LIMIT),
    "nearest clip": nearest_clip,
    "a step at a time": partial(as_2002, look=(1, 1)),
    "search of 2002": partial(as_2002, look=(45, 15)),
}
DECIDED = {"foot sliding, cm/s": "a clip or a walk that leaves the line has fewer seams"}


def of_clips(case: Case) -> tuple[float, ...]:
    """Measure the clips themselves."""
    return np.nan, np.nan, np.nan, np.nan, sliding_of_clips(case.given["clips"])


def score(case: Case, answer: Motion) -> Array:
    """Measure how near a walk is to its line."""
    line = on_ground(case.given["line"])
    track = on_ground(answer.root_positions)
    distances = np.abs(track[:, None] - line)  # (F, P)
    along = np.append(0, np.abs(np.diff(track)).cumsum())
    at_length = np.abs(track - np.interp(along, ALONG, line))
    nearest = distances.min(axis=1)
    left_out = distances.min(axis=0).max()
    metres = np.array([nearest.mean(), nearest.max(), left_out, at_length.mean()])
    return np.append(100 * metres, foot_sliding_speed(answer, case.given["clips"]))
