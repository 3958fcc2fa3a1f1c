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
from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

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
from mocap.quality.clip_flaws import FAST, UNDER, height_of
from mocap.quality.joint_limits import joint_bends
from mocap.quality.judgements import Judgement, Measure
from mocap.quality.seam_measures import LEAP, MOSTLY, USUAL, jumps, largest_jumps
from mocap.quality.standing_feet import feet_of, mean_slide, plant_slides

WINDOW = 1 / 3  # seconds: jumps in a window are compared with those in the clips' windows
FLAT = 0.1  # seconds of a smooth curve, from which a joint trembles
STILL = 0.02  # m/s: a jump of velocity that one who stands still makes
SLOWEST, SLOW = 25, 0.5  # percentile of the frames in which a foot skates; the least speed of a body, m/s
ALOFT = 25.0  # centimetres; in 153 clips the lowest joint comes down to 12.5 cm at least, also on stairs
SHORTEST, TALLEST = 0.75, 2.5  # metres, of one who walks; a grown body in inches, read as cm, is 0.7 at most


class Judged(NamedTuple):
    """What is judged, as for `judge`; `places` are the joints' positions, (F, J, 3). None is not known."""

    motion: Motion
    places: Array
    legs: Sequence[Leg] | None
    against: Sequence[Motion]
    path: GroundPath | None
    stretch: Mapping[str, float] | None


Found = tuple[float, str] | None
"""A value in the unit of its row in `MEASURES`, and where it is worst; None where there is none."""


def _jolt(body: Judged) -> Found:
    own, fps = jumps(body.motion)[0], body.motion.fps
    usual = float(np.percentile(own, MOSTLY))
    if body.against:
        clips = [jumps(resample(clip, fps))[0] for clip in body.against]
        usual = float(np.percentile(largest_jumps(clips, max(2, round(WINDOW * fps))), USUAL))
    frame = 1 + int(own[1:-1].argmax())
    apart = np.linalg.norm(np.diff(body.places[frame - 1 : frame + 2], 2, axis=0), axis=-1)
    most = body.motion.skeleton.names[int(apart.max(axis=0).argmax())]
    return float(own.max()) / max(usual, STILL), f"frame {frame}, most '{most}'"


def _tremble(body: Judged) -> Found:
    points = point_cloud(body.motion)
    window = max(5, 2 * round(FLAT * body.motion.fps / 2) + 1)
    window = min(window, len(points) - 1 + len(points) % 2)
    off = np.sqrt(((points - savgol_filter(points, window, 3, axis=0)) ** 2).sum(-1).mean(-1))
    return 1000 * float(np.median(off)), ""


def _sunk(body: Judged) -> Found:
    heights = body.places[..., 1]
    frame, joint = map(int, np.unravel_index(int(heights.argmin()), heights.shape))
    depth = max(0.0, -float(heights[frame, joint]))
    return 100 * depth, f"'{body.motion.skeleton.names[joint]}', frame {frame}"


def _turn(body: Judged) -> Found:
    motion = body.motion
    turns = rotations.angle_between(motion.rotations[1:], motion.rotations[:-1]) * motion.fps
    frame, joint = map(int, np.unravel_index(int(turns.argmax()), turns.shape))
    return float(np.degrees(turns.max())), f"'{motion.skeleton.names[joint]}', frame {frame + 1}"


def _lopsided(body: Judged) -> Found:
    skeleton = body.motion.skeleton
    partners = [skeleton.partner(joint) for joint in range(len(skeleton))]
    lengths = np.linalg.norm(skeleton.offsets, axis=-1)
    gaps = 1000 * np.abs(lengths - lengths[partners])
    worst = int(gaps.argmax())
    sided = partners != list(range(len(skeleton)))
    return (float(gaps[worst]), f"'{skeleton.names[worst]}'") if sided else None


def _aloft(body: Judged) -> Found:
    lowest = body.places[..., 1].min(axis=1)
    high = 100 * float(lowest.min())
    return (high, f"lowest in frame {int(lowest.argmin())}") if high > ALOFT else None


def _slide(body: Judged) -> Found:
    slides = plant_slides(
        mark_plants(body.motion, body.legs), feet_of(body.legs or ()), positions=body.places
    )
    if not slides:
        return 0.0, "no foot stands"
    worst = max(slides, key=lambda slide: slide.far)
    return mean_slide(slides), f"'{worst.joint}', frames {worst.start} to {worst.stop - 1}"


def _skate(body: Judged) -> Found:
    fps, feet = body.motion.fps, body.places[:, feet_of(body.legs or ())][..., [0, 2]]
    slowest = (np.linalg.norm(np.diff(feet, axis=0), axis=-1) * fps).min(axis=1)
    steps = np.linalg.norm(np.diff(body.motion.root_positions[:, [0, 2]], axis=0), axis=-1)
    return 100 * float(np.percentile(slowest, SLOWEST)) / max(SLOW, float(steps.mean()) * fps), ""


def _bent(body: Judged) -> Found:
    bends = joint_bends(body.motion, body.legs or ())
    if not bends:
        return None
    worst = max(bends, key=lambda bend: float(bend.share.max()))
    frame = int(worst.share.argmax())
    where = f"'{worst.joint}' {worst.way} by {worst.angles[frame]:.0f}°, frame {frame}"
    return float(worst.share[frame]), where


def _bones(body: Judged) -> Found:
    stretch = body.stretch or {}
    worst = max(stretch, key=stretch.__getitem__, default="")
    return 1000 * stretch.get(worst, 0.0), worst and f"'{worst}'"


def _path(body: Judged) -> Found:
    assert body.path is not None
    off, _ = cKDTree(body.path.resampled(0.01).points).query(body.motion.root_positions[:, [0, 2]])
    return 100 * float(off.mean()), f"{100 * off.max():.0f} cm in frame {int(off.argmax())}"


def _size(body: Judged) -> Found:
    """Compare a body with the smallest and the tallest people; one who lies down is as long as tall."""
    height = height_of(body.places)
    if not SHORTEST <= height <= TALLEST:
        height = float(np.median(np.ptp(body.places, axis=1).max(axis=-1)))
    times = max(SHORTEST / max(height, 1e-9), height / TALLEST)
    if times <= 1:
        return 0.0, ""
    inches = f" (in inches it would be {2.54 * height:.3g} m)" if SHORTEST / 2 < height < SHORTEST else ""
    warnings.warn(
        f"'{shortened(body.motion.name)}' is {height:.3g} m tall, as nobody is who walks{inches}: "
        "is its scale right?",
        MocapWarning,
        stacklevel=3,
    )
    return times, f"{height:.3g} m tall"


MEASURES: tuple[tuple[str, str, Callable[[Judged], Found], str, float], ...] = (
    ("tremble", "motion", _tremble, "mm", 3.0),
    ("sunk", "motion", _sunk, "cm", 100 * UNDER),
    ("turn", "motion", _turn, "°/s", float(np.degrees(FAST))),
    ("lopsided", "motion", _lopsided, "mm", 20.0),
    ("aloft", "motion", _aloft, "cm", ALOFT),
    ("slide", "legs", _slide, "cm", 2.5),
    ("skate", "legs", _skate, "% of speed", 8.0),
    ("bent", "motion", _bent, "of its limit", 1.0),
    ("bones", "stretch", _bones, "mm", 5.0),
    ("path", "path", _path, "cm", 15.0),  # as `steering.follow_path` warns
    ("size", "motion", _size, "of its limit", 1.0),
)
"""A row for each measure: its name, what it needs, its function, its unit and its limit."""
ALONE, BESIDE_CLIPS = ("times usual", LEAP), ("times the clips'", 1.5)  # the units and limits of "jolt"


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
    left_out: tuple[str, ...] = ()
    try:
        legs = find_legs(motion.skeleton) if legs is None else legs
        if not legs:
            raise MocapError("no legs are named.")
    except MocapError as error:
        legs, left_out = None, (f"feet and knees: {error}",)
    body = Judged(motion, joint_positions(motion), legs, against, path, stretch)
    measures = []
    for name, needs, measure, unit, limit in (
        ("jolt", "motion", _jolt, *(BESIDE_CLIPS if against else ALONE)),
        *MEASURES,
    ):
        if getattr(body, needs) is not None and (found := measure(body)):
            measures.append(Measure(name, found[0], limit, unit, found[1]))
    lengths = np.linalg.norm(motion.skeleton.offsets, axis=-1)
    bones = dict(zip(motion.skeleton.names[1:], lengths[1:].tolist(), strict=True))
    height = height_of(body.places)
    return Judgement(motion.name, len(motion), motion.fps, tuple(measures), left_out, height, bones)
