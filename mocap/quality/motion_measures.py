"""What `judge` measures: a function for each thing that can be wrong with a motion, and a table of them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

import numpy as np
from scipy.signal import savgol_filter
from scipy.spatial import cKDTree

from mocap._shared.arrays import Array
from mocap.body import rotations
from mocap.body.ground_path import GroundPath
from mocap.body.limbs import Leg
from mocap.body.motion import Motion, resample
from mocap.feet.footplants import mark_plants
from mocap.matching.point_clouds import point_cloud
from mocap.quality.clip_flaws import FAST, UNDER, height_of
from mocap.quality.joint_limits import joint_bends
from mocap.quality.seam_measures import LEAP, MOSTLY, USUAL, Spread, jumps
from mocap.quality.standing_feet import feet_of, mean_slide, plant_slides

WINDOW = 1 / 3  # seconds: jumps in a window are compared with those in the clips' windows
FLAT = 0.1  # seconds of a smooth curve, from which a joint trembles
STILL = 0.02  # m/s: a jump of velocity that one who stands still makes
SLOWEST, SLOW = 25, 0.5  # percentile of the frames in which a foot skates; the least speed of a body, m/s
ALOFT = 25.0  # centimetres; in 153 clips the lowest joint comes down to 12.5 cm at least, also on stairs
SHORTEST, TALLEST = 0.75, 2.5  # metres, of one who walks; a grown body in inches, read as cm, is 0.7 at most


Found = tuple[float, str] | None
"""A value in the unit of its row in `MEASURES`, and where it is worst; None where there is none."""


class Judged(NamedTuple):
    """What is judged, as for `judge`; `places` are the joints' positions, (F, J, 3)."""

    motion: Motion
    places: Array
    legs: Sequence[Leg]
    against: Sequence[Motion]
    path: GroundPath | None
    stretch: Mapping[str, float] | None

    def at(self, values: Array, later: int = 0) -> str:
        """Say at which joint and in which frame values (F, J) are largest."""
        frame, joint = np.unravel_index(int(values.argmax()), values.shape)
        return f"'{self.motion.skeleton.names[int(joint)]}', frame {frame + later}"


def _jolt(body: Judged) -> Found:
    own, fps = jumps(body.motion), body.motion.fps
    usual = float(np.percentile(own, MOSTLY))
    if body.against:
        clips = Spread(tuple(jumps(resample(clip, fps)) for clip in body.against))
        usual = float(np.percentile(clips.within(max(2, round(WINDOW * fps))), USUAL))
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
    depth = -body.places[..., 1]
    return 100 * max(0.0, float(depth.max())), body.at(depth)


def _turn(body: Judged) -> Found:
    local = body.motion.rotations
    turns = np.degrees(rotations.angle_between(local[1:], local[:-1])) * body.motion.fps
    return float(turns.max()), body.at(turns, later=1)


def _lopsided(body: Judged) -> Found:
    skeleton = body.motion.skeleton
    partners = [skeleton.partner(joint) for joint in range(len(skeleton))]
    lengths = np.linalg.norm(skeleton.offsets, axis=-1)
    gaps = 1000 * np.abs(lengths - lengths[partners])
    sided = partners != list(range(len(skeleton)))
    return (float(gaps.max()), f"'{skeleton.names[gaps.argmax()]}'") if sided else None


def _aloft(body: Judged) -> Found:
    lowest = body.places[..., 1].min(axis=1)
    high = 100 * float(lowest.min())
    return (high, f"lowest in frame {lowest.argmin()}") if high > ALOFT else None


def _slide(body: Judged) -> Found:
    if not body.legs:
        return None
    slides = plant_slides(mark_plants(body.motion, body.legs), feet_of(body.legs), positions=body.places)
    if not slides:
        return 0.0, "no foot stands"
    worst = max(slides, key=lambda slide: slide.far)
    return mean_slide(slides), f"'{worst.joint}', frames {worst.start} to {worst.stop - 1}"


def _skate(body: Judged) -> Found:
    if not body.legs:
        return None
    fps, feet = body.motion.fps, body.places[:, feet_of(body.legs)][..., [0, 2]]
    slowest = (np.linalg.norm(np.diff(feet, axis=0), axis=-1) * fps).min(axis=1)
    steps = np.linalg.norm(np.diff(body.motion.root_positions[:, [0, 2]], axis=0), axis=-1)
    return 100 * float(np.percentile(slowest, SLOWEST)) / max(SLOW, float(steps.mean()) * fps), ""


def _bent(body: Judged) -> Found:
    bends = joint_bends(body.motion, body.legs)
    if not bends:
        return None
    worst = max(bends, key=lambda bend: float(bend.share.max()))
    frame = int(worst.share.argmax())
    how = f"'{worst.joint}' {worst.way} by {worst.angles[frame]:.0f}°, frame {frame}"
    return float(worst.share[frame]), how


def _bones(body: Judged) -> Found:
    stretched = sorted((far, f"'{joint}'") for joint, far in (body.stretch or {"": 0.0}).items())
    return None if body.stretch is None else (1000 * stretched[-1][0], stretched[-1][1])


def _path(body: Judged) -> Found:
    if body.path is None:
        return None
    off, _ = cKDTree(body.path.resampled(0.01).points).query(body.motion.root_positions[:, [0, 2]])
    return 100 * float(off.mean()), f"{100 * off.max():.0f} cm in frame {off.argmax()}"


def _size(body: Judged) -> Found:
    """Compare a body with the smallest and the tallest people; one who lies down is as long as tall."""
    height = height_of(body.places)
    if not SHORTEST <= height <= TALLEST:
        height = float(np.median(np.ptp(body.places, axis=1).max(axis=-1)))
    times = max(SHORTEST / max(height, 1e-9), height / TALLEST)
    inches = f"; {2.54 * height:.3g} m if it is in inches" if SHORTEST / 2 < height < SHORTEST else ""
    return (times, f"{height:.3g} m tall{inches}") if times > 1 else (0.0, "")


MEASURES: tuple[tuple[str, Callable[[Judged], Found], str, float], ...] = (
    ("jolt", _jolt, "times usual", LEAP),
    ("tremble", _tremble, "mm", 3.0),
    ("sunk", _sunk, "cm", 100 * UNDER),
    ("turn", _turn, "°/s", float(np.degrees(FAST))),
    ("lopsided", _lopsided, "mm", 20.0),
    ("aloft", _aloft, "cm", ALOFT),
    ("slide", _slide, "cm", 2.5),
    ("skate", _skate, "% of speed", 8.0),
    ("bent", _bent, "of its limit", 1.0),
    ("bones", _bones, "mm", 5.0),
    ("path", _path, "cm", 15.0),  # as `steering.follow_path` warns
    ("size", _size, "of its limit", 1.0),
)
"""A row for each measure: its name, its function, its unit and its limit."""
