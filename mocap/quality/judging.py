"""Judgement of a motion of any origin: measures, each divided by a limit that captured motion keeps.

A ratio up to 1 is inconspicuous. The limits are our own, except those of joints, which `joint_limits`
explains. Of 153 captured clips of CMU, the homework and six other makers, 132 keep all limits. In 14 of the
others, bones or the whole body leap from one frame to the next, as after an Euler flip or a lost marker. In
four, the floor is uneven or not at y = 0. In two, a hop and a roll, a leg whips round; in one, the body hangs
on ropes. `figures/judged_faults.py` lists them, and puts faults of rising size into clips.

The following are not measured: agreement with a request, liveliness and style, hands and faces,
interpenetration of the body with itself or with objects, and balance. Joint limits are measured at knees,
elbows, hips, wrists and the neck, but not at shoulders, ankles and fingers.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np
from scipy.spatial import cKDTree

from mocap._shared.arrays import Array, Indices, VectorsLike
from mocap._shared.records import NamedTuple
from mocap.body import rotations
from mocap.body.body_sides import partners
from mocap.body.ground_path import GroundPath, as_path
from mocap.body.legs import Leg
from mocap.body.limbs import find_legs, with_roles
from mocap.body.motion import Motion, require_motion, require_motions
from mocap.body.skeleton import Skeleton
from mocap.errors import MocapError, shortened
from mocap.quality.clip_flaws import height_of
from mocap.quality.joint_limits import joint_bends
from mocap.quality.limits import LIMITS
from mocap.quality.measures import Measure as Measure
from mocap.quality.measures import Seen, main_joints, main_points, see, with_limit
from mocap.quality.smoothness import LOWEST_RATE, measure_smoothness
from mocap.quality.standing_feet import BRIEF, joints_of_foot, lasting_values, measure_feet


def measure_joints(seen: Seen) -> Iterator[Measure]:
    """Measure depths, heights and rotation speeds of joints, and bones that differ from left to right."""
    skeleton = seen.motion.skeleton
    yield _sunk(seen)
    yield _rotation(seen)
    images = partners(skeleton)
    if images != list(range(len(skeleton))):
        lengths = np.linalg.norm(skeleton.offsets, axis=-1)
        differences = 1000 * np.abs(lengths - lengths[images])
        joint = skeleton.names[differences.argmax()]
        yield Measure("lopsided", float(differences.max()), LIMITS.lopsided, "mm", f"'{joint}'")
    heights = 100 * seen.positions[..., 1].min(axis=1)
    lowest = float(heights.min())
    if lowest > LIMITS.aloft:
        yield Measure("aloft", lowest, LIMITS.aloft, "cm", f"lowest in frame {heights.argmin()}")


def _sunk(seen: Seen) -> Measure:
    """Measure the depth below the ground, for a tenth of a second, of all joints but fingers."""
    joints = _joints_on_the_floor(seen)
    depths = lasting_values(-seen.positions[:, joints, 1], seen.frames(BRIEF))
    depth = 100 * max(0.0, float(depths.max()))
    return Measure("sunk", depth, LIMITS.sunk, "cm", _largest_at(depths, joints, seen.motion.skeleton))


def _joints_on_the_floor(seen: Seen) -> Indices:
    """List the joints that the floor bears: all but fingers, or all if the feet are not known."""
    if not seen.legs:
        return np.arange(len(seen.motion.skeleton))
    feet = [joint for leg in seen.legs for joint in joints_of_foot(seen, leg)]
    return np.union1d(main_points(seen.motion.skeleton), feet)


def _rotation(seen: Seen) -> Measure:
    """Measure the largest rotation speed of a joint, over a step, without fingers and toes."""
    joints = main_joints(seen.motion.skeleton)
    local = seen.motion.rotations[:, joints]
    angles = rotations.angle_between(local[seen.step :], local[: -seen.step])
    speeds = np.degrees(angles) / seen.seconds
    fastest = _largest_at(speeds, joints, seen.motion.skeleton, first=seen.step)
    return Measure("rotation", float(speeds.max()), LIMITS.rotation, "°/s", fastest)


def _largest_at(values: Array, joints: Indices, skeleton: Skeleton, first: int = 0) -> str:
    """Name the joint and the frame of the largest of values (F, joints); frames count from `first`."""
    frame, column = np.unravel_index(int(values.argmax()), values.shape)
    return f"'{skeleton.names[joints[int(column)]]}', frame {int(frame) + first}"


def measure_limbs(seen: Seen) -> Iterator[Measure]:
    """Measure feet, if there are legs, and joints that bend too far."""
    if seen.legs:
        yield from measure_feet(seen)
    bends = joint_bends(seen.motion, seen.legs, seen.poses)
    if bends:
        worst = max(bends, key=lambda bend: float(bend.fraction.max()))
        frame = int(worst.fraction.argmax())
        detail = f"'{worst.joint}' {worst.direction} by {worst.angles[frame]:.0f}°, frame {frame}"
        yield Measure("bent", float(worst.fraction[frame]), 1.0, "of its limit", detail)


def measure_body(
    seen: Seen, path: GroundPath | None, stretch: Mapping[str, float] | None
) -> Iterator[Measure]:
    """Measure the body's size and, if known, stretching bones and the root's distance from its path."""
    if stretch is not None:
        change, joint = max(((change, joint) for joint, change in stretch.items()), default=(0.0, ""))
        yield Measure("bones", 1000 * change, LIMITS.bones, "mm", f"'{joint}'")
    if path is not None:
        line = cKDTree(path.resampled(0.01).points)
        distances, _ = line.query(seen.motion.root_positions[:, [0, 2]])
        detail = f"{100 * distances.max():.0f} cm in frame {distances.argmax()}"
        yield Measure("path", 100 * float(distances.mean()), LIMITS.path, "cm", detail)
    yield _size(seen.positions)


def _size(positions: Array) -> Measure:
    """Compare a body's height with that of people. For a body that lies, the height is its length."""
    height = height_of(positions)
    if not LIMITS.shortest <= height <= LIMITS.longest:
        height = float(np.median(np.ptp(positions, axis=1).max(axis=-1)))
    ratio = max(LIMITS.shortest / max(height, 1e-9), height / LIMITS.longest)
    if ratio <= 1:
        return Measure("size", 0.0, 1.0, "of its limit")
    detail = f"{height:.3g} m tall"
    if LIMITS.shortest / 2 < height < LIMITS.shortest:
        detail += f"; {2.54 * height:.3g} m if it is in inches"
    return Measure("size", ratio, 1.0, "of its limit", detail)


class Judgement(NamedTuple):
    """The measures of a motion, and in `left_out` the omitted measures with reasons.

    `height` is the body's vertical extent, the median over the frames. `bones` has the length of each joint's
    bone, from its parent to it. Both are in metres.

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

    def __repr__(self) -> str:
        worst = "nothing measured"
        if self.measures:
            worst = f"worst {with_limit(self.worst)}"
        return f"Judgement('{shortened(self.name)}', score {self.score:.3g}, {worst})"

    @property
    def worst(self) -> Measure:
        """The measure with the largest ratio to its limit."""
        return max(self.measures, key=lambda measure: measure.ratio)

    @property
    def score(self) -> float:
        """The excess of all measures over their limits, Σ log₂ max(ratio, 1). 0 is best."""
        return float(sum(np.log2(max(measure.ratio, 1.0)) for measure in self.measures))

    def as_dict(self) -> dict[str, Any]:
        """Return the judgement as a dictionary of plain numbers and texts, for JSON."""
        rows = [measure._asdict() | {"ratio": measure.ratio} for measure in self.measures]
        summary = {"left_out": list(self.left_out), "worst": self.worst.name, "score": self.score}
        return self._asdict() | {"measures": rows} | summary


def judge(
    motion: Motion,
    *,
    against: Sequence[Motion] = (),
    path: GroundPath | VectorsLike | None = None,
    stretch: Mapping[str, float] | None = None,
) -> Judgement:
    """Measure the quality of a motion and compare each measure with its limit.

    - jolt: the largest jump of velocity of the middle of the body, within 1/30 s, divided by the usual one in
      the second around it, or, with `against`, by the usual jump in windows of a third of a second of these
      clips.
    - cut: the largest jump of the whole pose from one frame to the next, divided by the usual one in the
      second around it. It detects a cut without a blend.
    - tremble: the distance of joints from their trajectories without frequencies above 8 Hz, which takes 20
      frames per second.
    - snap: the largest leap in the direction of a thigh, shank, upper arm or forearm, divided by the usual
      one in the second around it.
    - frozen: the longest stretch in which no joint moves and which starts or ends abruptly.
    - slip: the speed of standing feet along the body's path, in percent of its speed. It detects a path that
      is longer or shorter than the steps.
    - foot_sliding: the foot sliding distance within a stance, mean over the footplants.
    - sliding_speed: the foot sliding speed, the 25th percentile of the slowest joint of the feet, in percent
      of the body's speed. It detects a body that glides and has no footplants. Feet far above the lowest
      ones of the clip, as of a body that hangs, count neither here nor in the two measures before.
    - toes: the depth of a foot below the height at which the clip's feet stand, for a tenth of a second.
    - sunk: the depth of the lowest joint, except fingers, below the ground, y = 0, for a tenth of a second.
    - aloft: the minimum height of the lowest joint, reported if it is above 25 cm in all frames.
    - lopsided: the largest difference in length between a left bone and a right one.
    - size: the ratio of a body's height to 2.5 m, or of 0.75 m to its height, above 1: its unit may be wrong.
    - bones: the largest change in the length of a bone of the file.
    - bent: the angle of a knee, elbow, hip, wrist or the neck, divided by the human limit.
    - rotation: the largest rotation speed of a joint, within 1/30 s, except fingers and toes.
    - path: the distance of the root from a path, mean over the frames.

    Parameters
    ----------
    motion : F frames, at least 12.
    against : the clips from which the motion was made, if any. They are resampled to its frame rate.
    path : the path that the motion should follow, or its points (x, z), metres.
    stretch : the changes of the bones' lengths in the motion's file, metres, by joint, as returned by
        `files.load_save.read`. The bones of a loaded motion are rigid.

    Raises
    ------
    MocapError : for a motion that is too short, and objects that are not motions.

    Examples
    --------
    >>> from dataclasses import replace
    >>> from mocap.datasets.samples import sample
    >>> walk = sample("walk_straight")
    >>> gliding = replace(walk, root_positions=walk.root_positions * [0.8, 1, 0.8])
    >>> [measure.name for measure in judge(gliding).measures if measure.ratio > 1]
    ['slip', 'foot_sliding', 'sliding_speed']
    """
    require_motion(motion)
    against = require_motions(against)
    line = None if path is None else as_path(path)
    if len(motion) < 12:
        name = shortened(motion.name)
        raise MocapError(f"To judge '{name}' takes 12 frames or more, it has {len(motion)}.")
    legs: tuple[Leg, ...] = ()
    left_out: tuple[str, ...] = ()
    motion = with_roles(motion)
    try:
        legs = find_legs(motion.skeleton)
    except MocapError as error:
        left_out = (f"feet and knees: {error.problem()}",)
    if motion.fps < LOWEST_RATE:
        left_out += (f"tremble: {motion.fps:g} frames per second are too few to show it",)
    seen = see(motion, legs)
    measures = [
        *measure_smoothness(seen, against),
        *measure_joints(seen),
        *measure_limbs(seen),
        *measure_body(seen, line, stretch),
    ]
    lengths = np.linalg.norm(motion.skeleton.offsets[1:], axis=-1).tolist()
    bones = dict(zip(motion.skeleton.names[1:], lengths, strict=True))
    height = height_of(seen.positions)
    return Judgement(motion.name, len(motion), motion.fps, tuple(measures), left_out, height, bones)


def judgement_table(judgements: Sequence[Judgement]) -> str:
    """Format a line for each motion, best first: score, height, ratios to limits, and the worst measure.

    Examples
    --------
    >>> from mocap.datasets.samples import sample
    >>> for line in judgement_table([judge(sample("walk_straight"))]).splitlines():
    ...     print(line[:59])
    name          score  height    jolt     cut tremble    snap
    walk_straight   0.0  1.71 m    0.29    0.19    0.15    0.38
    """
    names = list(dict.fromkeys(measure.name for judged in judgements for measure in judged.measures))
    width = max([4, *(len(shortened(judged.name, 40)) for judged in judgements)])
    heads = " ".join(f"{name:>7}" for name in ["height", *names])
    rows = [f"{'name':<{width}} {'score':>5} {heads}  worst"]
    for judged in sorted(judgements, key=lambda judged: (judged.score, judged.worst.ratio)):
        name = f"{shortened(judged.name, 40):<{width}}"
        height = f"{judged.height:.3g} m"
        rows.append(f"{name} {judged.score:>5.1f} {height:>7} {_ratios(judged, names)}  {_worst(judged)}")
    return "\n".join(rows)


def _ratios(judged: Judgement, names: Sequence[str]) -> str:
    """Format the ratios of measures to their limits in columns, with "-" for a missing measure."""
    ratios = {measure.name: f"{measure.ratio:.2f}" for measure in judged.measures}
    return " ".join(f"{ratios.get(name, '-'):>{max(7, len(name))}}" for name in names)


def _worst(judged: Judgement) -> str:
    """Format the name, the value and the place of the worst measure."""
    worst = judged.worst
    text = f"{worst.name} {worst.value:.3g} {worst.unit}"
    return f"{text} ({worst.where})" if worst.where else text.rstrip()
