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

import warnings
from collections.abc import Mapping, Sequence

import numpy as np
from scipy.signal import savgol_filter
from scipy.spatial import cKDTree

from mocap._shared.arrays import Array
from mocap.body import rotations
from mocap.body.ground_path import GroundPath
from mocap.body.kinematics import joint_positions
from mocap.body.limbs import Leg, find_legs
from mocap.body.motion import Motion, resample
from mocap.errors import MocapError, MocapWarning, shortened
from mocap.feet.footplants import mark_plants
from mocap.matching.point_clouds import point_cloud
from mocap.quality.clip_flaws import FAST, UNDER
from mocap.quality.joint_limits import joint_bends
from mocap.quality.judgements import Judgement, Measure
from mocap.quality.seam_measures import LEAP, MOSTLY, USUAL, Spread, jumps
from mocap.quality.standing_feet import plant_slides

WINDOW = 1 / 3  # seconds: jumps in a window are compared with those in the clips' windows
SEAM = 1.5  # times what all but one in a thousand windows of the clips do
TREMBLE, FLAT = 3.0, 0.1  # millimetres from a smooth curve through so many seconds
STILL = 0.02  # m/s: a jump of velocity that one who stands still makes
ALOFT = 0.25  # metres; in 153 clips the lowest joint comes down to 12.5 cm at least, also on stairs
SLIDE = 2.5  # centimetres that a planted foot may wander
SKATE, SLOWEST, SLOW = 8.0, 25, 0.5  # percent of the body's speed; the percentile of the frames; least m/s
LOPSIDED = 20.0  # millimetres between a left bone and its partner
STRETCH = 5.0  # millimetres by which a bone may change its length
SHORTEST, TALLEST = 0.75, 2.5  # metres, of one who walks; a grown body in inches, read as cm, is 0.7 at most
OFF = 15.0  # centimetres from the path, as `steering.follow_path` warns


def judge(
    motion: Motion,
    *,
    against: Sequence[Motion] = (),
    path: GroundPath | None = None,
    legs: Sequence[Leg] | None = None,
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
    - size: how many times a body is taller or shorter than people are: its unit of length may be wrong.
    - bones: by how much a bone of the file changes its length.
    - bent: how far a knee, elbow, hip, wrist or the neck bends, over what people's do.
    - turn: how fast a joint turns.
    - path: how far the root is from a path, mean over the frames.

    Parameters
    ----------
    motion : F frames, at least 12.
    against : the clips that it was made of, if it was made of clips; resampled to its frame rate.
    path : what it should follow.
    legs : the left and the right one, found by name by default; where they are not found, feet, knees and
        hips are left out.
    stretch : by how much bones change their lengths in the motion's file, metres, by joint, as
        `files.bone_stretch` gives it; a motion that was loaded has rigid bones.

    Raises
    ------
    MocapError : for a motion that is too short.

    Warns
    -----
    MocapWarning : for a body that is not between 0.75 and 2.5 m tall.

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
    measures += filter(None, (_lopsided(motion), _aloft(places)))
    try:
        legs = find_legs(motion.skeleton) if legs is None else legs
        if not legs:
            raise MocapError("no legs are named.")
        measures += [_slide(motion, places, legs), _skate(motion, places, legs)]
    except MocapError as error:
        legs = ()
        left_out.append(f"feet and knees: {error}")
    if (bent := _bent(motion, legs)) is not None:
        measures.append(bent)
    if stretch is not None:
        measures.append(_stretched(stretch))
    if path is not None:
        measures.append(_off(motion, path))
    height = float(np.median(np.ptp(places[..., 1], axis=1)))
    measures.append(_size(motion, places, height))
    lengths = np.linalg.norm(motion.skeleton.offsets, axis=-1)
    bones = dict(zip(motion.skeleton.names[1:], lengths[1:].tolist(), strict=True))
    return Judgement(motion.name, len(motion), motion.fps, tuple(measures), tuple(left_out), height, bones)


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


def _aloft(places: Array) -> Measure | None:
    """Find a body that never comes down to the ground; one who climbs stairs stood below them."""
    lowest = places[..., 1].min(axis=1)
    where = f"lowest in frame {int(lowest.argmin())}"
    high = float(lowest.min())
    return Measure("aloft", 100 * high, 100 * ALOFT, "cm", where) if high > ALOFT else None


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
    feet = [joint for leg in legs for joint in leg[2:]]
    slides = plant_slides(mark_plants(motion, legs), feet, positions=places)
    if not slides:
        return Measure("slide", 0.0, SLIDE, "cm", "no foot stands")
    worst = max(slides, key=lambda slide: slide.far)
    where = f"'{worst.joint}', frames {worst.start} to {worst.stop - 1}"
    return Measure("slide", float(np.mean([slide.far for slide in slides])), SLIDE, "cm", where)


def _skate(motion: Motion, places: Array, legs: Sequence[Leg]) -> Measure:
    feet = places[:, [joint for leg in legs for joint in leg[2:]]][..., [0, 2]]
    slowest = (np.linalg.norm(np.diff(feet, axis=0), axis=-1) * motion.fps).min(axis=1)
    steps = np.linalg.norm(np.diff(motion.root_positions[:, [0, 2]], axis=0), axis=-1)
    speed = max(SLOW, float(steps.mean()) * motion.fps)
    return Measure("skate", 100 * float(np.percentile(slowest, SLOWEST)) / speed, SKATE, "% of speed")


def _bent(motion: Motion, legs: Sequence[Leg]) -> Measure | None:
    """Find the joint that bends most beyond its limit, as a share of it."""
    bends = joint_bends(motion, legs)
    if not bends:
        return None
    worst = max(bends, key=lambda bend: float(bend.share.max()))
    frame = int(worst.share.argmax())
    where = f"'{worst.joint}' {worst.way} by {worst.angles[frame]:.0f}°, frame {frame}"
    return Measure("bent", float(worst.share[frame]), 1.0, "of its limit", where)


def _stretched(stretch: Mapping[str, float]) -> Measure:
    """Find the bone that changes its length most."""
    worst = max(stretch, key=stretch.__getitem__, default="")
    return Measure("bones", 1000 * stretch.get(worst, 0.0), STRETCH, "mm", worst and f"'{worst}'")


def _size(motion: Motion, places: Array, height: float) -> Measure:
    """Compare a body with the smallest and the tallest people; one who lies down is as long as tall."""
    if not SHORTEST <= height <= TALLEST:
        height = float(np.median(np.ptp(places, axis=1).max(axis=-1)))
    times = max(SHORTEST / max(height, 1e-9), height / TALLEST)
    if times <= 1:
        return Measure("size", 0.0, 1.0, "of its limit")
    inches = f" (in inches it would be {2.54 * height:.3g} m)" if SHORTEST / 2 < height < SHORTEST else ""
    warnings.warn(
        f"'{shortened(motion.name)}' is {height:.3g} m tall, as nobody is who walks{inches}: "
        "is its scale right?",
        MocapWarning,
        stacklevel=3,
    )
    return Measure("size", times, 1.0, "of its limit", f"{height:.3g} m tall")


def _off(motion: Motion, path: GroundPath) -> Measure:
    line = path.resampled(0.01).points
    off, _ = cKDTree(line).query(motion.root_positions[:, [0, 2]])
    where = f"{100 * off.max():.0f} cm in frame {int(off.argmax())}"
    return Measure("path", 100 * float(off.mean()), OFF, "cm", where)
