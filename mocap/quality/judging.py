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

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from scipy.signal import savgol_filter
from scipy.spatial import cKDTree

from mocap._shared.arrays import Array
from mocap.body import rotations
from mocap.body.ground_path import GroundPath
from mocap.body.kinematics import joint_positions
from mocap.body.limbs import Leg, find_legs
from mocap.body.motion import Motion, resample
from mocap.errors import MocapError, shortened
from mocap.feet.footplants import mark_plants
from mocap.matching.point_clouds import point_cloud
from mocap.quality.clip_flaws import FAST, UNDER, height_of
from mocap.quality.joint_limits import joint_bends
from mocap.quality.seam_measures import LEAP, MOSTLY, USUAL, Spread, feet_of, jumps, mean_slide, plant_slides

WINDOW = 1 / 3  # seconds: jumps in a window are compared with those in the clips' windows
FLAT = 0.1  # seconds of a smooth curve, from which a joint trembles
STILL = 0.02  # m/s: a jump of velocity that one who stands still makes
SLOWEST = 25  # percentile of the frames in which a foot skates
SLOW = 0.5  # m/s: the least speed of a body
ALOFT = 25.0  # centimetres; in 153 clips the lowest joint comes down to 12.5 cm at least, also on stairs
SHORTEST = 0.75  # metres, of one who walks; a grown body in inches, read as cm, is 0.7 at most
TALLEST = 2.5  # metres


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
    where: str = ""  # reads: name: a field that JSON files have

    @property
    def ratio(self) -> float:
        """How many times its limit it is."""
        return self.value / self.limit


def measure_smoothness(motion: Motion, places: Array, against: Sequence[Motion]) -> Iterator[Measure]:
    """Measure jolts and trembling; `places` are the joints' positions, (F, J, 3)."""
    velocity_jumps = jumps(motion)
    fps = motion.fps
    usual = float(np.percentile(velocity_jumps, MOSTLY))
    limit = LEAP
    unit = "times usual"
    if against:
        clips = Spread(tuple(jumps(resample(clip, fps)) for clip in against))
        usual = float(np.percentile(clips.within(max(2, round(WINDOW * fps))), USUAL))
        limit = 1.5
        unit = "times the clips'"
    frame = 1 + int(velocity_jumps[1:-1].argmax())
    changes = np.linalg.norm(np.diff(places[frame - 1 : frame + 2], 2, axis=0), axis=-1)
    joint = motion.skeleton.names[int(changes.max(axis=0).argmax())]
    ratio = float(velocity_jumps.max()) / max(usual, STILL)
    yield Measure("jolt", ratio, limit, unit, f"frame {frame}, most '{joint}'")
    points = point_cloud(motion)
    window = max(5, 2 * round(FLAT * fps / 2) + 1)
    window = min(window, len(points) - 1 + len(points) % 2)
    distances = np.sqrt(((points - savgol_filter(points, window, 3, axis=0)) ** 2).sum(-1).mean(-1))
    yield Measure("tremble", 1000 * float(np.median(distances)), 3.0, "mm")


def measure_joints(motion: Motion, places: Array) -> Iterator[Measure]:
    """Measure where joints go, how fast they turn, and whether left and right are alike."""
    skeleton = motion.skeleton
    local = motion.rotations

    def largest(values: Array, first: int = 0) -> str:
        """Say at which joint and in which frame values (F, J) are largest, if they start at a frame."""
        frame, joint = np.unravel_index(int(values.argmax()), values.shape)
        return f"'{skeleton.names[int(joint)]}', frame {frame + first}"

    depths = -places[..., 1]
    yield Measure("sunk", 100 * max(0.0, float(depths.max())), 100 * UNDER, "cm", largest(depths))
    turns = np.degrees(rotations.angle_between(local[1:], local[:-1])) * motion.fps
    yield Measure("turn", float(turns.max()), float(np.degrees(FAST)), "°/s", largest(turns, first=1))
    partners = [skeleton.partner(joint) for joint in range(len(skeleton))]
    if partners != list(range(len(skeleton))):
        lengths = np.linalg.norm(skeleton.offsets, axis=-1)
        gaps = 1000 * np.abs(lengths - lengths[partners])
        yield Measure("lopsided", float(gaps.max()), 20.0, "mm", f"'{skeleton.names[gaps.argmax()]}'")
    lowest = 100 * places[..., 1].min(axis=1)
    if lowest.min() > ALOFT:
        yield Measure("aloft", float(lowest.min()), ALOFT, "cm", f"lowest in frame {lowest.argmin()}")


def measure_limbs(motion: Motion, places: Array, legs: Sequence[Leg]) -> Iterator[Measure]:
    """Measure feet that slide or skate, where there are `legs`, and joints that bend too far."""
    if legs:
        slides = plant_slides(mark_plants(motion, legs), feet_of(legs), positions=places)
        longest = max(slides, key=lambda slide: slide.far, default=None)
        place = "no foot stands"
        if longest:
            place = f"'{longest.joint}', frames {longest.start} to {longest.stop - 1}"
        yield Measure("slide", mean_slide(slides), 2.5, "cm", place)
        feet = places[:, feet_of(legs)][..., [0, 2]]
        roots = motion.root_positions[:, [0, 2]]
        slowest = (np.linalg.norm(np.diff(feet, axis=0), axis=-1) * motion.fps).min(axis=1)
        speed = max(SLOW, float(np.linalg.norm(np.diff(roots, axis=0), axis=-1).mean()) * motion.fps)
        yield Measure("skate", 100 * float(np.percentile(slowest, SLOWEST)) / speed, 8.0, "% of speed")
    if bends := joint_bends(motion, legs):
        worst = max(bends, key=lambda bend: float(bend.share.max()))
        frame = int(worst.share.argmax())
        bend = f"'{worst.joint}' {worst.way} by {worst.angles[frame]:.0f}°, frame {frame}"
        yield Measure("bent", float(worst.share[frame]), 1.0, "of its limit", bend)


def measure_body(
    motion: Motion, places: Array, path: GroundPath | None, stretch: Mapping[str, float] | None
) -> Iterator[Measure]:
    """Measure bones that stretch and a root off its path, where these are known, and the body's size.

    A body is compared with the smallest and the tallest people; one who lies down is as long as tall.
    """
    if stretch is not None:
        change, joint = max(((change, joint) for joint, change in stretch.items()), default=(0.0, ""))
        yield Measure("bones", 1000 * change, 5.0, "mm", f"'{joint}'")
    if path is not None:
        distances, _ = cKDTree(path.resampled(0.01).points).query(motion.root_positions[:, [0, 2]])
        worst = f"{100 * distances.max():.0f} cm in frame {distances.argmax()}"
        yield Measure("path", 100 * float(distances.mean()), 15.0, "cm", worst)  # as `follow_path` warns
    height = height_of(places)
    if not SHORTEST <= height <= TALLEST:
        height = float(np.median(np.ptp(places, axis=1).max(axis=-1)))
    times = max(SHORTEST / max(height, 1e-9), height / TALLEST)
    inches = f"; {2.54 * height:.3g} m if it is in inches" if SHORTEST / 2 < height < SHORTEST else ""
    is_odd = times > 1
    size = f"{height:.3g} m tall{inches}" if is_odd else ""
    yield Measure("size", times if is_odd else 0.0, 1.0, "of its limit", size)


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
        summary = {"left_out": list(self.left_out), "worst": self.worst.name, "score": self.score}
        return self._asdict() | {"measures": rows} | summary


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
        legs = ()
        left_out = (f"feet and knees: {error.problem()}",)
    places = joint_positions(motion)
    measures = [*measure_smoothness(motion, places, against), *measure_joints(motion, places)]
    measures += measure_limbs(motion, places, legs)
    measures += measure_body(motion, places, path, stretch)
    lengths = np.linalg.norm(motion.skeleton.offsets[1:], axis=-1).tolist()
    bones = dict(zip(motion.skeleton.names[1:], lengths, strict=True))
    height = height_of(places)
    return Judgement(motion.name, len(motion), motion.fps, tuple(measures), left_out, height, bones)


def judgement_table(judgements: Sequence[Judgement]) -> str:
    """Write a line for each motion, the best first: score, height, each measure over its limit, the worst.

    Examples
    --------
    >>> from mocap.datasets.samples import sample
    >>> for line in judgement_table([judge(sample("walk_straight"))]).splitlines():
    ...     print(line[:60])
    name          score  height    jolt tremble    sunk    turn
    walk_straight   0.0  1.71 m    0.34    0.06    0.00    0.25
    """
    names = list(dict.fromkeys(measure.name for judged in judgements for measure in judged.measures))
    width = max([4, *(len(shortened(judged.name, 40)) for judged in judgements)])
    heads = " ".join(f"{name:>7}" for name in ["height", *names])
    rows = [f"{'name':<{width}} {'score':>5} {heads}  worst"]
    for judged in sorted(judgements, key=lambda judged: (judged.score, judged.worst.ratio)):
        ratios = {measure.name: f"{measure.ratio:.2f}" for measure in judged.measures}
        worst = judged.worst
        cells = [f"{ratios.get(name, '-'):>{max(7, len(name))}}" for name in names]
        numbers = " ".join([f"{f'{judged.height:.3g} m':>7}", *cells])
        place = f" ({worst.where})" if worst.where else ""
        flaw = f"{worst.name} {worst.value:.3g} {worst.unit}{place}"
        rows.append(f"{shortened(judged.name, 40):<{width}} {judged.score:>5.1f} {numbers}  {flaw}")
    return "\n".join(rows)
