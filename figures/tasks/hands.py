"""Bring the right hand to a place by a punch, or by a reach in mid-stride, made of all such clips but one.

The place is that of the clip that is left out. How far is it missed? And how far is a joint on average from
where it is in the clip that was left out, both laid on one first frame?
"""

from collections.abc import Callable, Iterator
from itertools import pairwise

import numpy as np

from mocap import editing
from mocap._shared.arrays import Array
from mocap.body import Motion, joint_positions, place
from mocap.methods.match_webs import hand_target, sample_space, weights_for
from mocap.methods.match_webs import heading_change as turn
from mocap.methods.parametric_graphs import cut_actions, cut_strides
from tasks import HOMEWORK, WALKS, Case

CLIPS = {"bundled clips": WALKS, "homework's clips": HOMEWORK, "CMU 02, punches": ("02/02_05",)}
PUNCHES = (85, 130, 173, 216, 259, 301, 346, 392)  # frames of 02_05 near which the arm is longest
ROOM = 20  # frames before and after an action
AWAY = np.random.default_rng(0).uniform((-0.2, -0.2, 0.3), (0.3, 0.3, 0.45), (24, 3))  # left, up, ahead, m
MEASURES = {"hand off, cm": True, "joints off, cm": True}
BASELINES = ("nearest clip", "mean of the nearest")
WHAT: dict[str, Callable[[Motion], Array]] = {
    "reaches": lambda motion: 100 * hand_target(motion, at=0.5),
    "punches": lambda motion: 100 * hand_target(motion),
}


def cases(collection: str, clips: list[Motion]) -> Iterator[Case]:
    """Leave each of some actions out."""
    if "punches" in collection:
        return (yield from left_out(collection, "punches", [punch(clips[0], near) for near in PUNCHES]))
    strides = [part for clip in clips for part in strides_of(clip)]
    straightest = min(strides, key=lambda part: abs(turn(action(part))))
    yield from left_out(f"{collection}, reaches", "reaches", reaches_of(straightest))


def left_out(collection: str, what: str, parts: list[Motion]) -> Iterator[Case]:
    """Yield a case for each action, with all the others and what they do."""
    values = np.array([WHAT[what](action(part)) for part in parts])
    for out, part in enumerate(parts):
        others = tuple(other for number, other in enumerate(parts) if number != out)
        given = {"clips": others, "values": np.delete(values, out, axis=0), "asked": values[out][None]}
        yield Case(
            collection, f"{what}-{len(parts)}-{out}", {**given, "room": [[ROOM]]}, (action(part), what)
        )


def action(part: Motion) -> Motion:
    """Take off the room before and after an action, and let it start at the origin."""
    return place(part[ROOM : len(part) - ROOM], 0, (0, 0))


def strides_of(clip: Motion) -> list[Motion]:
    """Cut all strides of the left foot, with room around them."""
    strikes = 1 + np.flatnonzero(np.diff(clip.contacts["lfoot"].astype(int)) == 1)
    spans = [(a, b) for a, b in pairwise(strikes) if 24 <= b - a <= 48]
    return [clip[a - ROOM : b + ROOM + 1] for a, b in spans if a >= ROOM and b + ROOM < len(clip)]


def reaches_of(stride: Motion) -> list[Motion]:
    """Bring the right hand to places in the middle of a stride."""
    laid, middle = place(stride, 0, (0, 0)), len(stride) // 2
    shoulder = joint_positions(laid)[middle, laid.skeleton.index("rhumerus")]
    return [editing.edit(laid, editing.pin(laid, "rhand", [middle], shoulder + away)) for away in AWAY]


def punch(clip: Motion, near: int) -> Motion:
    """Cut 1.4 s about the moment when the arm is longest, with room around them."""
    points, index = joint_positions(clip[near - 12 : near + 12]), clip.skeleton.index
    longest = np.linalg.norm(points[:, index("rhand")] - points[:, index("rhumerus")], axis=-1).argmax()
    middle = near - 12 + int(longest)
    return clip[middle - 21 - ROOM : middle + 22 + ROOM]


def of_space(case: Case) -> Motion:
    """Blend as samples of random blends say that what is asked is done [KG04]."""
    others, asked, what = case.given["clips"], case.given["asked"][0], case.name.split("-")[0]
    spans = [(ROOM, len(part) - ROOM - 1) for part in others]
    examples = cut_actions(others, spans) if what == "punches" else cut_strides(others)
    space = sample_space(examples, WHAT[what])
    return examples.blend(weights_for(space, asked))


def nearest(case: Case, count: int = 1) -> list[Motion]:
    """Take the other actions that come nearest."""
    gaps = np.linalg.norm(case.given["values"] - case.given["asked"], axis=1)
    return [action(case.given["clips"][number]) for number in np.argsort(gaps)[:count]]


def mean(case: Case) -> Motion:
    """Take the mean of the d + 1 nearest, frame by frame, all as long as the nearest."""
    some = nearest(case, case.given["asked"].shape[1] + 1)
    first = some[0]
    frames = np.linspace(0, 1, len(first))
    some = [motion.at(frames * (len(motion) - 1)) for motion in some]
    turns = sum(
        m.rotations * np.where((m.rotations * first.rotations).sum(-1, keepdims=True) < 0, -1, 1)
        for m in some
    )
    roots = np.mean([motion.root_positions for motion in some], axis=0)
    return Motion(first.skeleton, roots, turns / np.linalg.norm(turns, axis=-1, keepdims=True), first.fps)


METHODS = {
    "nearest clip": lambda case: nearest(case)[0],
    "mean of the nearest": mean,
    "space of blends": of_space,
}


def score(case: Case, answer: Motion) -> tuple[float, float]:
    """Measure what it does, and how far its joints are, share for share of the time."""
    (truth, what), laid = case.truth, place(answer, 0, (0, 0))
    off = np.linalg.norm(WHAT[what](laid) - WHAT[what](truth))
    points = joint_positions(laid.at(np.linspace(0, len(laid) - 1, len(truth))))
    return float(off), 100 * float(np.linalg.norm(points - joint_positions(truth), axis=-1).mean())
