"""Let another body wear a clip: a child, a giant, a body with long arms and short legs, other people.

Slide: how far planted feet stray over the ground, on average over the source's plants. Height: how far they
are from where the new feet stand. Shake: accelerations beside those of the copied poses. Pose: how far bones
point elsewhere than in the copy.
"""

from collections.abc import Iterator
from functools import cache
from typing import NamedTuple

import numpy as np

from mocap._shared.arrays import runs
from mocap.body import Motion, joint_positions, rotations
from mocap.editing import body_of, copied, floor_pins, proportioned, retarget, solve, stance_of
from mocap.editing.stages import REACH
from mocap.editing.stances import Stance
from mocap.errors import MocapError
from tasks import BANDAI, HOMEWORK, Case
from tasks._measures import shaking

SHARES = {
    "child": {"legs": 0.55, "trunk": 0.62, "arms": 0.58, "head": 0.85},
    "giant": {"legs": 1.3, "trunk": 1.2, "arms": 1.25},
    "long arms": {"legs": 0.8, "arms": 1.3},
}
CLIPS = {  # the last one, where it is another person's, is not worn, but its body wears the others
    "bundled clips": ("walk_curve_1", "walk_straight", "sneak", "jog", "stop_and_go"),
    "homework's clips": HOMEWORK,
    "CMU 16 on 02": (*(f"16/16_{n}" for n in (15, 17, 20, 26, 33, 36, 44, 57)), "02/02_01"),
    "CMU 49, dance, on 127": (*(f"49/49_{n:02}" for n in (1, 10, 12, 14)), "127/127_04"),
    "Bandai-Namco on bundled": (*BANDAI, "walk_straight"),
}
LONGEST = 240  # frames
MEASURES = {"slide, mm": True, "height, mm": True, "shake": True, "pose, °": True}
DECIDED = {
    "shake": "the copied poses shake as themselves",
    "pose, °": "the copied poses point as themselves",
}
BASELINES = ("angles", "poses", "poses, feet frame by frame")


class Bodies(NamedTuple):
    """How both bodies stand, and the poses as they are copied."""

    source: Stance
    target: Stance
    base: Motion


def cases(collection: str, clips: list[Motion]) -> Iterator[Case]:
    """Yield each clip on each body; a body is given as one frame of its rest pose."""
    giver = clips.pop() if " on " in collection else None
    for clip in clips:
        own = stance_of(clip)
        bodies = {name: proportioned(own, **shares) for name, shares in SHARES.items()}
        clip = clip[:LONGEST]
        for name, target in {**bodies, **({giver.name: stance_of(giver)} if giver else {})}.items():
            rest = np.tile(rotations.IDENTITY, (1, len(target.skeleton), 1))
            body = Motion(target.skeleton, [[0.0, target.leg, 0.0]], rest, clip.fps, name)
            truth = Bodies(own, target, copied(clip, own, target))
            yield Case(collection, f"{clip.name}-{name}", {"motion": clip, "body": body}, truth)


def angles(case: Case) -> Motion:
    """Keep all numbers, and scale the root's way by the legs."""
    clip, body = case.given["motion"], case.truth.target.skeleton
    if clip.skeleton.names != body.names:
        raise MocapError("Angles go from body to body only where the joints are the same.")
    ratio = case.truth.target.leg / case.truth.source.leg
    return Motion(body, ratio * clip.root_positions, clip.rotations, clip.fps)


def frame_by_frame(case: Case) -> Motion:
    """Copy the poses, and bring planted feet to their places in each frame by itself."""
    base = case.truth.base
    pins = floor_pins(base, case.truth.target)
    return solve(base, pins, [REACH], body_of(base, pins)).motion


METHODS = {
    "angles": angles,
    "poses": lambda case: case.truth.base,
    "poses, feet frame by frame": frame_by_frame,
    "retarget": lambda case: retarget(case.given["motion"], case.truth.target, case.truth.source),
}


@cache
def plants(base: Motion) -> list[tuple[int, int, int]]:
    """List joints and frames of the plants of two frames and more."""
    marks = ((base.skeleton.index(name), mark) for name, mark in base.contacts.items())
    return [(joint, *run) for joint, mark in marks for run in runs(mark) if run[1] - run[0] > 1]


def score(case: Case, answer: Motion) -> tuple[float, float, float, float]:
    """Measure feet by the plants of the source, and poses by those that are copied."""
    _, target, base = case.truth
    if len(answer) != len(base) or answer.skeleton.names != base.skeleton.names:
        raise MocapError(f"{case.name} asks for {len(base)} frames of the body that is given.")
    places, copies = joint_positions(answer), joint_positions(base)
    stands = {target.roles[role]: height for role, height in target.heights.items()}
    slides, heights = [], []
    for joint, start, stop in plants(base):
        planted = places[start:stop, joint]
        over = planted[:, [0, 2]] - planted[:, [0, 2]].mean(axis=0)
        slides.append(np.linalg.norm(over, axis=-1).max())
        heights.append(np.abs(planted[:, 1] - stands[joint]).mean())
    parents = base.skeleton.parents
    long = np.flatnonzero(np.linalg.norm(base.skeleton.offsets, axis=-1) > 0.02)
    long = long[parents[long] >= 0]
    bones = [some[:, long] - some[:, parents[long]] for some in (places, copies)]
    cosine = (bones[0] * bones[1]).sum(-1) / np.prod(
        [np.linalg.norm(bone, axis=-1) for bone in bones], axis=0
    )
    pose = np.degrees(np.arccos(np.clip(cosine, -1, 1))).mean()
    return (
        1000 * float(np.mean(slides)),
        1000 * float(np.mean(heights)),
        shaking(answer, base),
        float(pose),
    )
