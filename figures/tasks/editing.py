"""A walk that must step on a stone, hold a post with a hand, or pass below a bar, and else stay as it is.

`misses` is the largest distance of a joint from its pin; `shakes` the 95th percentile of the accelerations
over the clip's own, from half a second before the event to half a second after it; `tips` how far the way
from the root to the base of the neck leans otherwise, at most; `neck` how much further than in the clip the
head bends against that way, at most; `through` how deep two bones, drawn as capsules, are in one another
beyond how deep they are in the clip, at most. Pins are boxes: row f of `low` and `high` has x, y and z of
each of the `joints`, metres; -inf and inf leave an axis free. `edit` solves spacetime constraints, splines
over the whole motion, and then closes what remains; `five levels` are splines of several knot spacings.
"""

from collections.abc import Iterator

import numpy as np

from mocap._shared.arrays import Array, runs
from mocap.body import Motion, heading, joint_positions, rotations
from mocap.editing import (
    REACH,
    Pins,
    difference,
    displaced,
    edit,
    hierarchy,
    join_pins,
    pin,
    pin_errors,
    plant_pins,
    solve,
)
from tasks import Case
from tasks._measures import through

CLIPS = {
    "bundled clips": ("walk_curve_1", "walk_straight"),
    "homework's clips": ("hw3/walk_fwd_curve1",),
    "CMU": ("16/16_15", "16/16_58", "49/49_01"),
}
MEASURES = {"misses (mm)": True, "shakes (×)": True, "tips (°)": True, "neck (°)": True, "through (mm)": True}
BASELINES = ("each frame by itself", "linear in-betweening")
STONES, BARS = (0.1, 0.3, 0.5), (0.9, 0.75)  # metres; shares of the height of the head's top
HEAD, FEET = ("head_end", "head", "upperneck", "lowerneck"), ("lfoot", "ltoes")
SECONDS, AROUND, HELD = 5.0, 0.5, 0.4
AHEAD = (-0.15, 0.3, 0.15)  # metres, to the body's left, up and ahead: where the hand shall be
NOISE = ("hand", "finger", "thumb", "_end")  # of names of joints whose accelerations are those of markers


def cases(collection: str, clips: list[Motion]) -> Iterator[Case]:
    """Yield stones, a hand and bars in the first five seconds of each clip."""
    for clip in clips:
        walk = clip[6 : 6 + round(SECONDS * clip.fps)]
        wishes = {f"stone {height:g}": stone(walk, height) for height in STONES}
        wishes |= {"hand": hand(walk)} | {f"bar {share:g}": bar(walk, share) for share in BARS}
        for name, pins in wishes.items():
            asked = pin_errors(walk, pins).max(axis=1) > 0.01
            low, high = (ends.reshape(len(walk), -1) for ends in (pins.low, pins.high))
            given = {"motion": walk, "joints": [pins.joints], "low": low, "high": high}
            event = np.flatnonzero(asked)[[0, -1]]
            yield Case(
                f"{collection}, {name.split()[0]}s", f"{clip.name}-{name.replace(' ', '-')}", given, event
            )


def stone(walk: Motion, height: float) -> Pins:
    """Put the second step of the left foot higher."""
    pins = plant_pins(walk)
    start, stop = runs(walk.contacts[FEET[1]])[1]
    up = np.zeros(pins.low.shape)
    up[start:stop, [pins.joints.index(walk.skeleton.index(name)) for name in FEET], 1] = height
    return Pins(pins.joints, pins.low + up, pins.high + up)


def hand(walk: Motion) -> Pins:
    """Hold the right wrist at one place for 0.4 s."""
    middle, half = len(walk) // 2, round(HELD / 2 * walk.fps)
    wrist = walk.skeleton.index("rwrist")
    place = joint_positions(walk)[middle, wrist] + rotations.rotate(walk.rotations[middle, 0], AHEAD)
    return join_pins(plant_pins(walk), pin(walk, wrist, range(middle - half, middle + half), place))


def bar(walk: Motion, share: float) -> Pins:
    """Hang a bar across the way: head and neck pass below it."""
    points, middle, index = joint_positions(walk), len(walk) // 2, walk.skeleton.index
    turn = heading(walk.rotations[middle, 0])
    away = (points - walk.root_positions[middle]) @ [np.sin(turn), 0, np.cos(turn)]
    near = (np.abs(np.arange(len(walk)) - middle) < 1.5 * walk.fps)[:, None] & (np.abs(away) < 0.25)
    box = [-np.inf] * 3, [np.inf, share * points[:, index(HEAD[0]), 1].mean(), np.inf]
    return join_pins(plant_pins(walk), *(pin(walk, name, near[:, index(name)], *box) for name in HEAD))


def pins_of(case: Case) -> Pins:
    """Read the pins that a case gives."""
    joints = tuple(case.given["joints"][0])
    return Pins(joints, *(case.given[end].reshape(-1, len(joints), 3) for end in ("low", "high")))


def in_between(case: Case) -> Motion:
    """Solve the pinned frames, and let the change come and go along a straight line in half a second."""
    walk, pins = case.given["motion"], pins_of(case)
    change = difference(solve(walk, pins, [REACH]).motion, walk)
    asked = pin_errors(walk, pins).max(axis=1) > 0.03  # not feet that slide
    keys, frames = np.flatnonzero(asked), np.arange(len(walk))
    nearest = keys[np.abs(frames[:, None] - keys).argmin(axis=1)]
    share = np.clip(1 - np.abs(frames - nearest) / (AROUND * walk.fps), 0, 1)
    root, turns = share[:, None] * change.root[nearest], share[:, None, None] * change.turns[nearest]
    return displaced(walk, change._replace(root=root, turns=turns))


METHODS = {
    "edit": lambda case: edit(case.given["motion"], pins_of(case)),
    "five levels": lambda case: hierarchy(case.given["motion"], pins_of(case))[0],
    "each frame by itself": lambda case: solve(case.given["motion"], pins_of(case), [REACH]).motion,
    "linear in-betweening": in_between,
}


def between(a: Array, b: Array) -> Array:
    """Measure the angles between ways (F, 3), degrees."""
    sizes = np.linalg.norm(a, axis=-1) * np.linalg.norm(b, axis=-1)
    return np.asarray(np.degrees(np.arccos(np.clip((a * b).sum(axis=-1) / sizes, -1, 1))))


def score(case: Case, answer: Motion) -> tuple[float, ...]:
    """Measure what is missed, accelerations around the event over the clip's own, and what the trunk does."""
    walk, (first, last) = case.given["motion"], case.truth
    gap = pin_errors(answer, pins_of(case)).max()
    around = round(AROUND * walk.fps)
    columns = [n for n, name in enumerate(walk.skeleton.names) if not any(word in name for word in NOISE)]
    shakes, trunks, necks = [], [], []
    for motion in (answer, walk):
        points = joint_positions(motion)
        sizes = np.linalg.norm(np.diff(points[:, columns], 2, axis=0), axis=-1)
        shakes.append(np.percentile(sizes[max(first - around, 0) : last + around], 95))
        head, base = (points[:, walk.skeleton.index(name)] for name in ("head", "lowerneck"))
        trunks.append(base - points[:, 0])
        necks.append(between(trunks[-1], head - base))
    tips, neck = between(*trunks).max(), max(0.0, round((necks[0] - necks[1]).max(), 3))
    return 1000 * float(gap), float(shakes[0] / shakes[1]), float(tips), float(neck), through(answer, walk)
