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
EXAMPLES, LIMITS, MOST = 10, (0.04, 0.08, 0.12), 0.12
MEASURES = {"precision, %": False, "recall, %": False, "F1, %": False}


class Stride(NamedTuple):
    """The frames [start, stop) of a clip, and what they are."""

    clip: int
    start: int
    stop: int
    kind: str


def strides(clips: list[Motion]) -> list[Stride]:
    """List all strides with their kinds: labels, or what the trials are."""
    found = []
    for number, clip in enumerate(clips):
        leg, names = find_legs(clip.skeleton)[0], clip.skeleton.names
        stands = clip.contacts[names[leg.ankle]] | clip.contacts[names[leg.ball]]
        for start, stop in pairwise(start for start, _ in runs(stands) if start > 0):
            kinds = [label for label, mark in clip.labels.items() if mark[start:stop].all()]
            if not clip.labels:
                run = int(clip.name[-2:]) >= 35 and clip.name != "16_47"
                kinds = ["turn" if clip.name in TURNS else "run" if run else "walk"]
            if kinds and 0.5 * clip.fps <= stop - start <= 2.2 * clip.fps:
                found.append(Stride(number, int(start), int(stop), kinds[0]))
    return found


def cases(collection: str, clips: list[Motion]) -> Iterator[Case]:
    """Yield examples of each kind: the number of a clip, the first frame, and the one after the last."""
    every = strides(clips)
    for kind in dict.fromkeys(stride.kind for stride in every):
        own = [stride for stride in every if stride.kind == kind]
        if len(own) < 3:
            continue
        for stride in own[:: max(1, len(own) // EXAMPLES)][:EXAMPLES]:
            given = {"example": np.array([stride[:3]]), "clips": tuple(clips)}
            name = f"{clips[stride.clip].name}-{stride.start}"
            yield Case(f"{collection}: {kind}", name, given, (kind, every))


@cache
def web_of(clips: tuple[Motion, ...]) -> MatchWeb:
    """Find all paths of the clips, once."""
    return build_web(clips, below=MOST)


def found(case: Case, below: float, steps: int | None) -> Array:
    """Search; rows are a clip's number, the first frame, and the one after the last."""
    clip, start, stop = case.given["example"][0]
    matches = search(web_of(case.given["clips"]), int(clip), slice(start, stop), below=below, steps=steps)
    return np.array([match[:3] for match in matches], float)


METHODS: dict[str, Callable[[Case], Array]] = {
    f"{name}, {100 * below:.0f} cm": partial(found, below=below, steps=steps)
    for name, steps in (("one step", 1), ("web", None))
    for below in LIMITS
}
BASELINES = tuple(name for name in METHODS if name.startswith("one step"))


def score(case: Case, answer: Array) -> tuple[float, float, float]:
    """Count what is right, and what is found."""
    kind, every = case.truth
    clips = {stride.clip for stride in every if stride.kind == kind}
    pure = clips - {stride.clip for stride in every if stride.kind != kind}

    def like(row: Array, stride: Stride) -> bool:
        both = min(row[2], stride.stop) - max(row[1], stride.start)
        return bool(row[0] == stride.clip and 2 * both > max(row[2], stride.stop) - min(row[1], stride.start))

    own = [stride for stride in every if stride.kind == kind]
    right = [row[0] in pure or any(like(row, stride) for stride in own) for row in answer]
    precision, recall = np.mean(right), np.mean([any(like(row, stride) for row in answer) for stride in own])
    both = 2 * precision * recall / max(precision + recall, 1e-9)
    return 100 * float(precision), 100 * float(recall), 100 * float(both)
