"""Find all strides like an example: from one strike of the left foot to the next.

Ten examples of each kind, evenly spread. What is found is right if it has more than half in common with a
true stride, or lies in clips of that kind alone. Precision: of what is found, how much is right. Recall: of
the true strides, how many are found. F1: their harmonic mean. One step finds what is like the example, a web
also what is like that; each at three limits of the distance.
"""

from collections.abc import Callable, Iterator
from functools import cache, partial
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from mocap._shared.arrays import Array, runs
from mocap.body import Motion, find_legs
from mocap.methods.match_webs import build_web, search
from mocap.methods.match_webs.webs import MatchWeb
from tasks import Case

CLIPS = {
    "bundled clips": ("walk_straight", "walk_circle", "sneak", "jog", "stop_and_go"),
    "CMU 16, walks, turns, runs": tuple(
        f"16/16_{n}" for n in (15, 16, 21, 31, 47, 17, 18, 19, 20, *range(35, 47))
    ),
}
TURNS = ("16_17", "16_18", "16_19", "16_20")  # by 90 degrees
FIRST_RUN = 35  # trials of CMU 16 from here on are runs, but for one
SHORTEST = 0.5  # seconds of a stride
LONGEST = 2.2  # seconds of a stride
EXAMPLES = 10  # of each kind
LIMITS = (0.04, 0.08, 0.12)  # metres
WIDEST = 0.12  # metres: the limit of the web
MEASURES = {"precision, %": False, "recall, %": False, "F1, %": False}


class Stride(NamedTuple):
    """The frames [start, stop) of a clip, and what they are."""

    clip: int
    start: int
    stop: int
    kind: str


def strides(clips: list[Motion]) -> list[Stride]:
    """List all strides with their kinds: labels, or what the trials are."""
    cut = []
    for number, clip in enumerate(clips):
        leg = find_legs(clip.skeleton)[0]
        names = clip.skeleton.names
        stands = clip.contacts[names[leg.ankle]] | clip.contacts[names[leg.ball]]
        for start, stop in pairwise(start for start, _ in runs(stands) if start > 0):
            kind = kind_of(clip, slice(start, stop))
            if kind and SHORTEST * clip.fps <= stop - start <= LONGEST * clip.fps:
                cut.append(Stride(number, int(start), int(stop), kind))
    return cut


def kind_of(clip: Motion, frames: slice) -> str:
    """Return the first label of all of the frames, or what a trial without labels is; "" for none."""
    if clip.labels:
        return next((label for label, mark in clip.labels.items() if mark[frames].all()), "")
    if clip.name in TURNS:
        return "turn"
    return "run" if int(clip.name[-2:]) >= FIRST_RUN and clip.name != "16_47" else "walk"


def cases(collection: str, clips: list[Motion]) -> Iterator[Case]:
    """Yield examples of each kind: the number of a clip, the first frame, and the one after the last."""
    of_all = strides(clips)
    for kind in dict.fromkeys(stride.kind for stride in of_all):
        of_kind = [stride for stride in of_all if stride.kind == kind]
        if len(of_kind) < 3:
            continue
        for stride in of_kind[:: max(1, len(of_kind) // EXAMPLES)][:EXAMPLES]:
            data = {"example": np.array([stride[:3]]), "clips": tuple(clips)}
            name = f"{clips[stride.clip].name}-{stride.start}"
            yield Case(f"{collection}: {kind}", name, data, (kind, of_all))


@cache
def web_of(clips: tuple[Motion, ...]) -> MatchWeb:
    """Find all paths of the clips, once."""
    return build_web(clips, below=WIDEST)


def searched(case: Case, below: float, steps: int | None) -> Array:
    """Search; rows are a clip's number, the first frame, and the one after the last."""
    clip, start, stop = case.given["example"][0]
    matches = search(web_of(case.given["clips"]), int(clip), slice(start, stop), below=below, steps=steps)
    return np.array([match[:3] for match in matches], float)


Method = Callable[[Case], Array]
ONE_STEP = {f"one step, {100 * below:.0f} cm": partial(searched, below=below, steps=1) for below in LIMITS}
WEB = {f"web, {100 * below:.0f} cm": partial(searched, below=below, steps=None) for below in LIMITS}
METHODS: dict[str, Method] = ONE_STEP | WEB
DECIDED = {"precision, %": "a search that finds few strides is right about them"}
BASELINES = tuple(name for name in METHODS if name.startswith("one step"))


def score(case: Case, answer: Array) -> tuple[float, float, float]:
    """Count what is right, and what is found."""
    kind, of_all = case.truth
    of_kind = [stride for stride in of_all if stride.kind == kind]
    clips = {stride.clip for stride in of_kind}
    pure = clips - {stride.clip for stride in of_all if stride.kind != kind}
    right = [row[0] in pure or any(overlaps(row, stride) for stride in of_kind) for row in answer]
    precision = np.mean(right)
    recall = np.mean([any(overlaps(row, stride) for row in answer) for stride in of_kind])
    f1 = 2 * precision * recall / max(precision + recall, 1e-9)
    return 100 * float(precision), 100 * float(recall), 100 * float(f1)


def overlaps(row: Array, stride: Stride) -> bool:
    """Tell whether a match has more than half of its union with a stride in common with it."""
    clip, start, stop = row
    common = min(stop, stride.stop) - max(start, stride.start)
    union = max(stop, stride.stop) - min(start, stride.start)
    return bool(clip == stride.clip and 2 * common > union)
