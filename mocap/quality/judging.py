"""Judge a motion, whatever made it: what stands out beyond what captured people do.

Each measure is divided by a limit; up to 1 nothing stands out. The limits are ours, but for those of joints,
which `joint_limits` explains. Of 30 captured files from nine sources 11 keep all of them. In six, of one
source, an elbow bends backwards; in ten joints snap from one frame to the next, as after an Euler flip; two
are in inches, and of these one lies with the hands in the floor; one is a smoothed copy, whose feet skate.

What this cannot see: whether a motion is the one that was wanted, whether it looks alive, and in which style
it is; hands and faces; a body that walks through itself or through things; balance. Of the limits of joints
it sees those of knees, elbows, hips, wrists and the neck, not those of shoulders, ankles and fingers.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from mocap.body.ground_path import GroundPath
from mocap.body.kinematics import joint_positions
from mocap.body.limbs import find_legs
from mocap.body.motion import Motion
from mocap.errors import MocapError, shortened
from mocap.quality.clip_flaws import height_of
from mocap.quality.motion_measures import (
    Measure,
    measure_body,
    measure_joints,
    measure_limbs,
    measure_smoothness,
)


class Judgement(NamedTuple):
    """What was measured of a motion; `left_out` says what could not be, and why.

    `height` is the body's vertical extent, the median over the frames, and `bones` the length of each joint's
    bone, from its parent to it; both in metres.

    Examples
    --------
    >>> from mocap.datasets.samples import sample
    >>> judged = judge(sample("walk_straight"))
    >>> judged.worst.ratio < 1, judged.score
    (True, 0.0)
    """

    name: str
    frames: int
    fps: float
    measures: tuple[Measure, ...]
    left_out: tuple[str, ...]
    height: float
    bones: Mapping[str, float]

    @property
    def worst(self) -> Measure:
        """The measure that is most times its limit."""
        return max(self.measures, key=lambda measure: measure.ratio)

    @property
    def score(self) -> float:
        """How many times the measures must be halved, in all, to be within their limits; 0 is best."""
        return float(sum(np.log2(max(measure.ratio, 1.0)) for measure in self.measures))

    def as_dict(self) -> dict[str, Any]:
        """Give plain numbers and texts, for JSON."""
        rows = [measure._asdict() | {"ratio": measure.ratio} for measure in self.measures]
        more = {"left_out": list(self.left_out), "worst": self.worst.name, "score": self.score}
        return self._asdict() | {"measures": rows} | more


def judge(
    motion: Motion,
    *,
    against: Sequence[Motion] = (),
    path: GroundPath | None = None,
    stretch: Mapping[str, float] | None = None,
) -> Judgement:
    """Measure a motion and compare each number with its limit.

    - jolt: the largest jump of velocity from a frame to the next, over that of nine in ten frames; with
      `against`, over what is usual in windows of a third of a second of these clips.
    - tremble: how far joints are from smooth curves.
    - slide: how far a standing foot wanders, mean over the plants.
    - skate: how fast the slowest joint of the feet is over the ground, a quarter of the time, in percent of
      the body's speed. A body that glides has no plants that could slide.
    - sunk: how deep the lowest joint is below the ground, y = 0.
    - aloft: how high the lowest joint stays; told where it never comes down to 25 cm.
    - lopsided: how much the bones of left and right differ.
    - size: how many times a body is taller than 2.5 m, or 0.75 m is taller than it: its unit may be wrong.
    - bones: by how much a bone of the file changes its length.
    - bent: how far a knee, elbow, hip, wrist or the neck bends, over what people's do.
    - turn: how fast a joint turns.
    - path: how far the root is from a path, mean over the frames.

    Parameters
    ----------
    motion : F frames, at least 12.
    against : the clips that it was made of, if it was made of clips; resampled to its frame rate.
    path : what it should follow.
    stretch : by how much bones change their lengths in the motion's file, metres, by joint, as
        `files.load_save.read` gives it; a motion that was loaded has rigid bones.

    Raises
    ------
    MocapError : for a motion that is too short.

    Examples
    --------
    >>> from dataclasses import replace
    >>> from mocap.datasets.samples import sample
    >>> walk = sample("walk_straight")
    >>> gliding = replace(walk, root_positions=walk.root_positions * [0.8, 1, 0.8])
    >>> [measure.name for measure in judge(gliding).measures if measure.ratio > 1]
    ['slide', 'skate']
    """
    if len(motion) < 12:
        name = shortened(motion.name)
        raise MocapError(f"To judge '{name}' takes 12 frames or more, it has {len(motion)}.")
    left_out: tuple[str, ...] = ()
    try:
        legs = find_legs(motion.skeleton)
    except MocapError as error:
        legs, left_out = (), (f"feet and knees: {error}",)
    places = joint_positions(motion)
    measures = (
        *measure_smoothness(motion, places, against),
        *measure_joints(motion, places),
        *measure_limbs(motion, places, legs),
        *measure_body(motion, places, path, stretch),
    )
    lengths = np.linalg.norm(motion.skeleton.offsets[1:], axis=-1).tolist()
    bones, height = dict(zip(motion.skeleton.names[1:], lengths, strict=True)), height_of(places)
    return Judgement(motion.name, len(motion), motion.fps, measures, left_out, height, bones)


def judgement_table(judgements: Sequence[Judgement]) -> str:
    """Write a line for each motion, the best first: score, height, each measure over its limit, the worst.

    Examples
    --------
    >>> from mocap.datasets.samples import sample
    >>> for line in judgement_table([judge(sample("walk_straight"))]).splitlines():
    ...     print(line[:60])
    name          score  height    jolt tremble    sunk    turn
    walk_straight   0.0  1.69 m    0.38    0.05    0.00    0.23
    """
    names = list(dict.fromkeys(measure.name for judged in judgements for measure in judged.measures))
    width = max([4, *(len(shortened(judged.name, 40)) for judged in judgements)])
    heads = " ".join(f"{name:>7}" for name in ["height", *names])
    rows = [f"{'name':<{width}} {'score':>5} {heads}  worst"]
    for judged in sorted(judgements, key=lambda judged: (judged.score, judged.worst.ratio)):
        ratios, worst = {measure.name: f"{measure.ratio:.2f}" for measure in judged.measures}, judged.worst
        cells = [f"{ratios.get(name, '-'):>{max(7, len(name))}}" for name in names]
        numbers = " ".join([f"{f'{judged.height:.3g} m':>7}", *cells])
        said = f"{worst.name} {worst.value:.3g} {worst.unit} {worst.where and f'({worst.where})'}".rstrip()
        rows.append(f"{shortened(judged.name, 40):<{width}} {judged.score:>5.1f} {numbers}  {said}")
    return "\n".join(rows)
