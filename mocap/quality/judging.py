"""Judge a motion, whatever made it: what stands out beyond what captured people do.

Each measure is divided by a limit; up to 1 nothing stands out. The limits are ours. Of 30 captured files from
nine sources 16 keep all of them. In six, of one source, an elbow bends backwards; in six others joints snap
from one frame to the next, as after an Euler flip; one is a smoothed copy, whose feet skate; and in one the
body is half in the floor.

What this cannot see: whether a motion is the one that was wanted, whether it looks alive, and in which style
it is; hands and faces; a body that walks through itself or through things; balance. Of the limits of joints
it sees those of knees and elbows, and how fast joints turn.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from scipy.signal import savgol_filter
from scipy.spatial import cKDTree

from mocap._shared.arrays import Array, runs
from mocap.body import rotations
from mocap.body.ground_path import GroundPath
from mocap.body.kinematics import forward_kinematics, joint_positions
from mocap.body.limbs import Leg, find_legs
from mocap.body.motion import Motion, resample
from mocap.body.skeleton import Skeleton
from mocap.errors import MocapError, shortened
from mocap.feet.footplants import mark_plants
from mocap.matching.point_clouds import point_cloud
from mocap.quality.clip_flaws import FAST, UNDER
from mocap.quality.seam_measures import LEAP, MOSTLY, USUAL, Spread, jumps

WINDOW = 1 / 3  # seconds: jumps in a window are compared with those in the clips' windows
SEAM = 1.5  # times what all but one in a thousand windows of the clips do
TREMBLE, FLAT = 3.0, 0.1  # millimetres from a smooth curve through so many seconds
STILL = 0.02  # m/s: a jump of velocity that one who stands still makes
SLIDE = 2.5  # centimetres that a planted foot may wander
SKATE, SLOWEST, SLOW = 8.0, 25, 0.5  # percent of the body's speed; the percentile of the frames; least m/s
LOPSIDED = 20.0  # millimetres between a left bone and its partner
BACKWARDS, FOLDED = 10.0, 160.0  # degrees that a knee or an elbow may bend backwards, and forwards
ELBOW = "elbow|radius|forearm|lowerarm"  # in the names of joints
OFF = 15.0  # centimetres from the path, as `steering.follow_path` warns


class Measure(NamedTuple):
    """Something measured, its limit in the same unit, and where it is worst.

    Examples
    --------
    >>> Measure("slide", 5.0, 2.5, "cm", "'lfoot', frame 30").ratio
    2.0
    """

    name: str
    value: float
    limit: float
    unit: str
    where: str = ""

    @property
    def ratio(self) -> float:
        """How many times its limit it is."""
        return self.value / self.limit


class Judgement(NamedTuple):
    """What was measured of a motion; `left_out` says what could not be, and why.

    Examples
    --------
    >>> from mocap.datasets.generated import generate
    >>> judged = judge(generate("walk_straight"))
    >>> judged.worst.ratio < 1, judged.stand_out
    (True, [])
    """

    name: str
    frames: int
    fps: float
    measures: tuple[Measure, ...]
    left_out: tuple[str, ...]

    @property
    def worst(self) -> Measure:
        """The measure that is most times its limit."""
        return max(self.measures, key=lambda measure: measure.ratio)

    @property
    def score(self) -> float:
        """How many times the measures must be halved, in all, to be within their limits; 0 is best."""
        return float(sum(np.log2(max(measure.ratio, 1.0)) for measure in self.measures))

    @property
    def stand_out(self) -> list[Measure]:
        """The measures beyond their limits, the worst first."""
        return sorted((m for m in self.measures if m.ratio > 1), key=lambda m: -m.ratio)

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
    legs: Sequence[Leg] | None = None,
) -> Judgement:
    """Measure a motion and compare each number with its limit.

    - jolt: the largest jump of velocity from a frame to the next, over that of nine in ten frames; with
      `against`, over what is usual in windows of a third of a second of these clips.
    - tremble: how far joints are from smooth curves.
    - slide: how far a standing foot wanders, mean over the plants.
    - skate: how fast the slowest joint of the feet is over the ground, a quarter of the time, in percent of
      the body's speed. A body that glides has no plants that could slide.
    - sunk: how deep the lowest joint is below the ground, y = 0.
    - lopsided: how much the bones of left and right differ.
    - bent: how far a knee or an elbow bends, over what they do. turn: how fast a joint turns.
    - path: how far the root is from a path, mean over the frames.

    Parameters
    ----------
    motion : F frames, at least 12.
    against : the clips that it was made of, if it was made of clips; resampled to its frame rate.
    path : what it should follow.
    legs : found by name by default; where they are not found, feet and knees are left out.

    Raises
    ------
    MocapError : for a motion that is too short.

    Examples
    --------
    >>> from dataclasses import replace
    >>> from mocap.datasets.generated import generate
    >>> walk = generate("walk_straight")
    >>> gliding = replace(walk, root_positions=walk.root_positions * [0.8, 1, 0.8])
    >>> [measure.name for measure in judge(gliding).stand_out]
    ['skate', 'slide']

    Notebook: 10-real-data
    """
    if len(motion) < 12:
        raise MocapError(
            f"To judge '{shortened(motion.name)}' takes 12 frames or more, it has {len(motion)}."
        )
    places, left_out = joint_positions(motion), []
    measures = [_jolt(motion, against), _tremble(motion), _sunk(motion, places), _fastest(motion)]
    if (lopsided := _lopsided(motion)) is not None:
        measures.append(lopsided)
    try:
        legs = find_legs(motion.skeleton) if legs is None else legs
        measures += [_slide(motion, places, legs), _skate(motion, places, legs)]
    except MocapError as error:
        legs = ()
        left_out.append(f"feet and knees: {error}")
    if hinges := [(leg.hip, leg.knee, leg.ankle) for leg in legs] + _elbows(motion.skeleton):
        measures.append(_bent(motion, hinges))
    if path is not None:
        measures.append(_off(motion, path))
    return Judgement(motion.name, len(motion), motion.fps, tuple(measures), tuple(left_out))


def _jolt(motion: Motion, against: Sequence[Motion]) -> Measure:
    own = jumps(motion)[0]
    frame = 1 + int(own[1:-1].argmax())
    apart = np.linalg.norm(np.diff(joint_positions(motion)[frame - 1 : frame + 2], 2, axis=0), axis=-1)
    where = f"frame {frame}, most '{motion.skeleton.names[int(apart.max(axis=0).argmax())]}'"
    if not against:
        usual = max(float(np.percentile(own, MOSTLY)), STILL)
        return Measure("jolt", float(own.max()) / usual, LEAP, "times usual", where)
    clips = [jumps(resample(clip, motion.fps)) for clip in against]
    velocity, acceleration = zip(*clips, strict=True)
    windows = Spread(velocity, acceleration, np.inf, np.empty(0)).within(max(2, round(WINDOW * motion.fps)))
    usual = max(float(np.percentile(windows[0], USUAL)), STILL)
    return Measure("jolt", float(own.max()) / usual, SEAM, "times the clips'", where)


def _tremble(motion: Motion) -> Measure:
    points = point_cloud(motion)
    window = max(5, 2 * round(FLAT * motion.fps / 2) + 1)
    window = min(window, len(points) - 1 + len(points) % 2)
    off = np.sqrt(((points - savgol_filter(points, window, 3, axis=0)) ** 2).sum(-1).mean(-1))
    return Measure("tremble", 1000 * float(np.median(off)), TREMBLE, "mm")


def _sunk(motion: Motion, places: Array) -> Measure:
    frame, joint = map(int, np.unravel_index(int(places[..., 1].argmin()), places.shape[:2]))
    depth = max(0.0, -float(places[frame, joint, 1]))
    return Measure("sunk", 100 * depth, 100 * UNDER, "cm", f"'{motion.skeleton.names[joint]}', frame {frame}")


def _fastest(motion: Motion) -> Measure:
    turns = rotations.angle_between(motion.rotations[1:], motion.rotations[:-1]) * motion.fps
    frame, joint = map(int, np.unravel_index(int(turns.argmax()), turns.shape))
    where = f"'{motion.skeleton.names[joint]}', frame {frame + 1}"
    return Measure("turn", float(np.degrees(turns.max())), float(np.degrees(FAST)), "°/s", where)


def _lopsided(motion: Motion) -> Measure | None:
    skeleton = motion.skeleton
    partners = [skeleton.partner(joint) for joint in range(len(skeleton))]
    if partners == list(range(len(skeleton))):
        return None
    lengths = np.linalg.norm(skeleton.offsets, axis=-1)
    gaps = 1000 * np.abs(lengths - lengths[partners])
    worst = int(gaps.argmax())
    return Measure("lopsided", float(gaps[worst]), LOPSIDED, "mm", f"'{skeleton.names[worst]}'")


def _slide(motion: Motion, places: Array, legs: Sequence[Leg]) -> Measure:
    """Measure how far each planted joint is from its mean place at most, on average over the plants."""
    marked, slides = mark_plants(motion, legs), {}
    for joint in (joint for leg in legs for joint in leg[2:]):
        name = motion.skeleton.names[joint]
        for start, stop in runs(marked.contacts[name]):
            stood = places[start:stop, joint][:, [0, 2]]
            far = float(np.linalg.norm(stood - stood.mean(axis=0), axis=-1).max())
            slides[f"'{name}', frames {start} to {stop - 1}"] = 100 * far
    worst = max(slides, key=slides.__getitem__, default="no foot stands")
    return Measure("slide", float(np.mean(list(slides.values()) or [0.0])), SLIDE, "cm", worst)


def _skate(motion: Motion, places: Array, legs: Sequence[Leg]) -> Measure:
    feet = places[:, [joint for leg in legs for joint in leg[2:]]][..., [0, 2]]
    slowest = (np.linalg.norm(np.diff(feet, axis=0), axis=-1) * motion.fps).min(axis=1)
    steps = np.linalg.norm(np.diff(motion.root_positions[:, [0, 2]], axis=0), axis=-1)
    speed = max(SLOW, float(steps.mean()) * motion.fps)
    return Measure("skate", 100 * float(np.percentile(slowest, SLOWEST)) / speed, SKATE, "% of speed")


def _elbows(skeleton: Skeleton) -> list[tuple[int, int, int]]:
    """Find shoulder, elbow and wrist of each arm by the elbow's name."""
    found = [joint for joint in range(1, len(skeleton)) if re.search(ELBOW, skeleton.names[joint].lower())]
    return [(int(skeleton.parents[j]), j, skeleton.children(j)[0]) for j in found if skeleton.children(j)]


def _bent(motion: Motion, hinges: Sequence[tuple[int, int, int]]) -> Measure:
    """Measure how far knees and elbows bend beyond their limits, backwards or forwards, as a share."""
    poses, worst = forward_kinematics(motion), Measure("bent", 0.0, 1.0, "of its limit")
    for above, joint, below in hinges:
        upper = poses.positions[:, joint] - poses.positions[:, above]
        lower = poses.positions[:, below] - poses.positions[:, joint]
        bends = np.einsum("fji,fj->fi", poses.matrices[:, above], np.cross(upper, lower))  # seen from above
        axis = bends.sum(axis=0) / max(float(np.linalg.norm(bends.sum(axis=0))), 1e-12)
        sine = np.linalg.norm(bends, axis=-1) * np.sign(bends @ axis)
        angle = np.degrees(np.arctan2(sine, (upper * lower).sum(-1)))
        share = np.maximum(-angle / BACKWARDS, angle / FOLDED)
        frame = int(share.argmax())
        if share[frame] > worst.value:
            where = f"'{motion.skeleton.names[joint]}' by {angle[frame]:.0f}°, frame {frame}"
            worst = worst._replace(value=float(share[frame]), where=where)
    return worst


def _off(motion: Motion, path: GroundPath) -> Measure:
    line = path.resampled(0.01).points
    off, _ = cKDTree(line).query(motion.root_positions[:, [0, 2]])
    where = f"{100 * off.max():.0f} cm in frame {int(off.argmax())}"
    return Measure("path", 100 * float(off.mean()), OFF, "cm", where)


def judgement_table(judgements: Sequence[Judgement]) -> str:
    """Write a line for each motion, the best first: its score, each measure over its limit, what is worst.

    Examples
    --------
    >>> from mocap.datasets.generated import generate
    >>> print(judgement_table([judge(generate("walk_straight"))]))
    name          score    jolt tremble    sunk    turn lopsided   slide   skate    bent  worst
    walk_straight   0.0    0.38    0.05    0.00    0.23     0.00    0.00    0.00    0.43  bent 0.429 of ...

    Notebook: 10-real-data
    """
    names = list(dict.fromkeys(measure.name for judged in judgements for measure in judged.measures))
    width = max([4, *(len(shortened(judged.name, 40)) for judged in judgements)])
    rows = [f"{'name':<{width}} {'score':>5} " + " ".join(f"{name:>7}" for name in names) + "  worst"]
    for judged in sorted(judgements, key=lambda judged: (judged.score, judged.worst.ratio)):
        ratios = {measure.name: f"{measure.ratio:.2f}" for measure in judged.measures}
        worst = judged.worst
        cells = " ".join(f"{ratios.get(name, '-'):>{max(7, len(name))}}" for name in names)
        said = f"{worst.name} {worst.value:.3g} {worst.unit} {worst.where and f'({worst.where})'}".rstrip()
        rows.append(f"{shortened(judged.name, 40):<{width}} {judged.score:>5.1f} {cells}  {said}")
    return "\n".join(rows)
