"""Judgement of a motion of any origin: measures, each divided by a limit that captured motion keeps.

A ratio up to 1 is inconspicuous. The limits are our own, except those of joints, which `joint_limits`
explains. Of 30 captured files from nine sources, 11 keep all limits. In six files, of one source, an elbow
bends backwards. In ten, joints snap from one frame to the next, as after an Euler flip. Two are in inches,
and in one of these the body lies with its hands below the floor. One is a smoothed copy with sliding feet.

The following are not measured: agreement with a request, liveliness and style, hands and faces,
interpenetration of the body with itself or with objects, and balance. Joint limits are measured at knees,
elbows, hips, wrists and the neck, but not at shoulders, ankles and fingers.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np
from scipy.signal import savgol_filter
from scipy.spatial import cKDTree

from mocap._shared.arrays import Array, VectorsLike
from mocap._shared.records import NamedTuple
from mocap.body import rotations
from mocap.body.body_sides import partners
from mocap.body.ground_path import GroundPath, as_path
from mocap.body.kinematics import joint_positions
from mocap.body.limbs import Leg, find_legs, with_roles
from mocap.body.motion import Motion, require_motion, require_motions, resample
from mocap.body.skeleton import Skeleton
from mocap.errors import MocapError, shortened
from mocap.feet.footplants import mark_plants
from mocap.matching.point_clouds import point_cloud
from mocap.quality.clip_flaws import height_of
from mocap.quality.joint_limits import joint_bends
from mocap.quality.limits import LIMITS
from mocap.quality.seam_measures import (
    MOSTLY,
    USUAL,
    Spread,
    feet_of,
    foot_sliding,
    jumps,
    mean_foot_sliding,
)

WINDOW = 1 / 3  # seconds: a jump in a window is compared with those in windows of the clips
FLAT = 0.1  # seconds: the window of the smoothing filter from which a trembling joint deviates
STILL = 0.02  # m/s: jumps of velocity of a body that stands
SLOWEST = 25  # percentile of the frames, by the speed of the slowest joint of the feet
SLOW = 0.5  # m/s: the foot sliding of a slower body is divided by this speed


class Measure(NamedTuple):
    """A measured value, its limit in the same unit, and the place at which it is worst.

    Examples
    --------
    >>> sliding = Measure("foot_sliding", 5.0, 2.5, "cm", "'lfoot', frame 30")
    >>> sliding, sliding.ratio
    (Measure(foot_sliding 5 cm, limit 2.5, 'lfoot', frame 30), 2.0)
    """

    name: str
    value: float
    limit: float
    unit: str
    where: str = ""  # reads: name: public, and a key in the JSON of `mocap judge`

    def __repr__(self) -> str:
        place = f", {self.where}" if self.where else ""
        return f"Measure({_with_limit(self)}{place})"

    @property
    def ratio(self) -> float:
        """The value, as a multiple of its limit."""
        return self.value / self.limit


def _with_limit(measure: Measure) -> str:
    """Return a measured value with its name, unit and limit, as text."""
    value = f"{measure.name} {measure.value:.3g} {measure.unit}"
    return value if measure.unit == "of its limit" else f"{value}, limit {measure.limit:.3g}"


def measure_smoothness(motion: Motion, positions: Array, against: Sequence[Motion]) -> Iterator[Measure]:
    """Measure jolts and trembling, from a motion and the positions (F, J, 3) of its joints."""
    yield _jolt(motion, positions, against)
    points = point_cloud(motion)
    window = max(5, 2 * round(FLAT * motion.fps / 2) + 1)
    window = min(window, len(points) - 1 + len(points) % 2)
    residuals = points - savgol_filter(points, window, 3, axis=0)
    distances = np.sqrt((residuals**2).sum(-1).mean(-1))
    yield Measure("tremble", 1000 * float(np.median(distances)), LIMITS.tremble, "mm")


def _jolt(motion: Motion, positions: Array, against: Sequence[Motion]) -> Measure:
    """Measure the largest jump of velocity, as a multiple of the usual one."""
    velocity_jumps = jumps(motion)
    if against:
        usual = _usual_jump(against, motion.fps)
        limit = LIMITS.seam_jolt
        unit = "times the clips'"
    else:
        usual = float(np.percentile(velocity_jumps, MOSTLY))
        limit = LIMITS.jolt
        unit = "times usual"
    frame = 1 + int(velocity_jumps[1:-1].argmax())
    joint_jumps = np.linalg.norm(np.diff(positions[frame - 1 : frame + 2], 2, axis=0), axis=-1)[0]
    joint = motion.skeleton.names[int(joint_jumps.argmax())]
    value = float(velocity_jumps.max()) / max(usual, STILL)
    return Measure("jolt", value, limit, unit, f"frame {frame}, most '{joint}'")


def _usual_jump(clips: Sequence[Motion], fps: float) -> float:
    """Return the jump of velocity that nearly all windows of clips stay below, m/s."""
    velocity_jumps = tuple(jumps(resample(clip, fps)) for clip in clips)
    largest = Spread(velocity_jumps).within(max(2, round(WINDOW * fps)))
    return float(np.percentile(largest, USUAL))


def measure_joints(motion: Motion, positions: Array) -> Iterator[Measure]:
    """Measure depths, heights and rotation speeds of joints, and bones that differ from left to right."""
    skeleton = motion.skeleton
    depths = -positions[..., 1]
    depth = 100 * max(0.0, float(depths.max()))
    yield Measure("sunk", depth, LIMITS.sunk, "cm", _largest_at(depths, skeleton))
    speeds = np.degrees(rotations.angle_between(motion.rotations[1:], motion.rotations[:-1])) * motion.fps
    fastest = _largest_at(speeds, skeleton, first=1)
    yield Measure("rotation", float(speeds.max()), LIMITS.rotation, "°/s", fastest)
    images = partners(skeleton)
    if images != list(range(len(skeleton))):
        lengths = np.linalg.norm(skeleton.offsets, axis=-1)
        differences = 1000 * np.abs(lengths - lengths[images])
        joint = skeleton.names[differences.argmax()]
        yield Measure("lopsided", float(differences.max()), LIMITS.lopsided, "mm", f"'{joint}'")
    heights = 100 * positions[..., 1].min(axis=1)
    lowest = float(heights.min())
    if lowest > LIMITS.aloft:
        yield Measure("aloft", lowest, LIMITS.aloft, "cm", f"lowest in frame {heights.argmin()}")


def _largest_at(values: Array, skeleton: Skeleton, first: int = 0) -> str:
    """Name the joint and the frame of the largest of values (F, J), whose frames are counted from `first`."""
    frame, joint = np.unravel_index(int(values.argmax()), values.shape)
    return f"'{skeleton.names[int(joint)]}', frame {frame + first}"


def measure_limbs(motion: Motion, positions: Array, legs: Sequence[Leg]) -> Iterator[Measure]:
    """Measure foot sliding, if there are `legs`, and joints that bend too far."""
    if legs:
        yield _foot_sliding(motion, positions, legs)
        yield _sliding_speed(motion, positions, legs)
    bends = joint_bends(motion, legs)
    if bends:
        worst = max(bends, key=lambda bend: float(bend.fraction.max()))
        frame = int(worst.fraction.argmax())
        detail = f"'{worst.joint}' {worst.direction} by {worst.angles[frame]:.0f}°, frame {frame}"
        yield Measure("bent", float(worst.fraction[frame]), 1.0, "of its limit", detail)


def _foot_sliding(motion: Motion, positions: Array, legs: Sequence[Leg]) -> Measure:
    """Measure the foot sliding distance, the mean over the footplants."""
    slides = foot_sliding(mark_plants(motion, legs), feet_of(legs), positions=positions)
    detail = "no foot contact"
    if slides:
        worst = max(slides, key=lambda slide: slide.far)
        detail = f"'{worst.joint}', frames {worst.start} to {worst.stop - 1}"
    return Measure("foot_sliding", mean_foot_sliding(slides), LIMITS.foot_sliding, "cm", detail)


def _sliding_speed(motion: Motion, positions: Array, legs: Sequence[Leg]) -> Measure:
    """Measure the foot sliding speed, in percent of the body's speed."""
    feet = positions[:, feet_of(legs)]
    slowest = (_ground_steps(feet) * motion.fps).min(axis=1)
    body_speed = float(_ground_steps(motion.root_positions).mean()) * motion.fps
    percent = 100 * float(np.percentile(slowest, SLOWEST)) / max(SLOW, body_speed)
    return Measure("sliding_speed", percent, LIMITS.sliding_speed, "% of speed")


def _ground_steps(positions: Array) -> Array:
    """Return the distances over the ground from each frame to the next, of positions (F, ..., 3)."""
    return np.asarray(np.linalg.norm(np.diff(positions[..., [0, 2]], axis=0), axis=-1))


def measure_body(
    motion: Motion, positions: Array, path: GroundPath | None, stretch: Mapping[str, float] | None
) -> Iterator[Measure]:
    """Measure the body's size and, if known, stretching bones and the root's distance from its path."""
    if stretch is not None:
        change, joint = max(((change, joint) for joint, change in stretch.items()), default=(0.0, ""))
        yield Measure("bones", 1000 * change, LIMITS.bones, "mm", f"'{joint}'")
    if path is not None:
        line = cKDTree(path.resampled(0.01).points)
        distances, _ = line.query(motion.root_positions[:, [0, 2]])
        detail = f"{100 * distances.max():.0f} cm in frame {distances.argmax()}"
        yield Measure("path", 100 * float(distances.mean()), LIMITS.path, "cm", detail)
    yield _size(positions)


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
            worst = f"worst {_with_limit(self.worst)}"
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

    - jolt: the largest jump of velocity from one frame to the next, divided by the 90th percentile of all
      frames, or, with `against`, by the usual jump in windows of a third of a second of these clips.
    - tremble: the distance of joints from their smoothed trajectories.
    - foot_sliding: the foot sliding distance, mean over the footplants.
    - sliding_speed: the foot sliding speed, the 25th percentile of the slowest joint of the feet, in percent
      of the body's speed. It detects a body that glides and has no footplants.
    - sunk: the depth of the lowest joint below the ground, y = 0.
    - aloft: the minimum height of the lowest joint, reported if it is above 25 cm in all frames.
    - lopsided: the largest difference in length between a left bone and a right one.
    - size: the ratio of a body's height to 2.5 m, or of 0.75 m to its height, above 1: its unit may be wrong.
    - bones: the largest change in the length of a bone of the file.
    - bent: the angle of a knee, elbow, hip, wrist or the neck, divided by the human limit.
    - rotation: the largest rotation speed of a joint.
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
    ['foot_sliding', 'sliding_speed']
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
    positions = joint_positions(motion)
    measures = [
        *measure_smoothness(motion, positions, against),
        *measure_joints(motion, positions),
        *measure_limbs(motion, positions, legs),
    ]
    measures += measure_body(motion, positions, line, stretch)
    lengths = np.linalg.norm(motion.skeleton.offsets[1:], axis=-1).tolist()
    bones = dict(zip(motion.skeleton.names[1:], lengths, strict=True))
    height = height_of(positions)
    return Judgement(motion.name, len(motion), motion.fps, tuple(measures), left_out, height, bones)


def judgement_table(judgements: Sequence[Judgement]) -> str:
    """Format a line for each motion, best first: score, height, ratios to limits, and the worst measure.

    Examples
    --------
    >>> from mocap.datasets.samples import sample
    >>> for line in judgement_table([judge(sample("walk_straight"))]).splitlines():
    ...     print(line[:61])
    name          score  height    jolt tremble    sunk rotation
    walk_straight   0.0  1.71 m    0.34    0.06    0.00     0.25
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
