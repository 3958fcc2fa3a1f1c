"""What `judge` measures: each thing that can be wrong with a motion, its limit, and where it is worst."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
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


def measure_smoothness(motion: Motion, places: Array, against: Sequence[Motion]) -> Iterator[Measure]:
    """Measure jolts and trembling; `places` are the joints' positions, (F, J, 3)."""
    own, fps = jumps(motion), motion.fps
    usual, limit, unit = float(np.percentile(own, MOSTLY)), LEAP, "times usual"
    if against:
        clips = Spread(tuple(jumps(resample(clip, fps)) for clip in against))
        usual = float(np.percentile(clips.within(max(2, round(WINDOW * fps))), USUAL))
        limit, unit = 1.5, "times the clips'"
    frame = 1 + int(own[1:-1].argmax())
    apart = np.linalg.norm(np.diff(places[frame - 1 : frame + 2], 2, axis=0), axis=-1)
    most = motion.skeleton.names[int(apart.max(axis=0).argmax())]
    yield Measure("jolt", float(own.max()) / max(usual, STILL), limit, unit, f"frame {frame}, most '{most}'")
    points = point_cloud(motion)
    window = max(5, 2 * round(FLAT * fps / 2) + 1)
    window = min(window, len(points) - 1 + len(points) % 2)
    off = np.sqrt(((points - savgol_filter(points, window, 3, axis=0)) ** 2).sum(-1).mean(-1))
    yield Measure("tremble", 1000 * float(np.median(off)), 3.0, "mm")


def measure_joints(motion: Motion, places: Array) -> Iterator[Measure]:
    """Measure where joints go, how fast they turn, and whether left and right are alike."""
    skeleton, local = motion.skeleton, motion.rotations

    def most(values: Array, first: int = 0) -> str:
        """Say at which joint and in which frame values (F, J) are largest, if they start at a frame."""
        frame, joint = np.unravel_index(int(values.argmax()), values.shape)
        return f"'{skeleton.names[int(joint)]}', frame {frame + first}"

    depths = -places[..., 1]
    yield Measure("sunk", 100 * max(0.0, float(depths.max())), 100 * UNDER, "cm", most(depths))
    turns = np.degrees(rotations.angle_between(local[1:], local[:-1])) * motion.fps
    yield Measure("turn", float(turns.max()), float(np.degrees(FAST)), "°/s", most(turns, first=1))
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
        far = max(slides, key=lambda slide: slide.far, default=None)
        where = f"'{far.joint}', frames {far.start} to {far.stop - 1}" if far else "no foot stands"
        yield Measure("slide", mean_slide(slides), 2.5, "cm", where)
        feet, roots = places[:, feet_of(legs)][..., [0, 2]], motion.root_positions[:, [0, 2]]
        slowest = (np.linalg.norm(np.diff(feet, axis=0), axis=-1) * motion.fps).min(axis=1)
        speed = max(SLOW, float(np.linalg.norm(np.diff(roots, axis=0), axis=-1).mean()) * motion.fps)
        yield Measure("skate", 100 * float(np.percentile(slowest, SLOWEST)) / speed, 8.0, "% of speed")
    if bends := joint_bends(motion, legs):
        worst = max(bends, key=lambda bend: float(bend.share.max()))
        frame = int(worst.share.argmax())
        how = f"'{worst.joint}' {worst.way} by {worst.angles[frame]:.0f}°, frame {frame}"
        yield Measure("bent", float(worst.share[frame]), 1.0, "of its limit", how)


def measure_body(
    motion: Motion, places: Array, path: GroundPath | None, stretch: Mapping[str, float] | None
) -> Iterator[Measure]:
    """Measure bones that stretch and a root off its path, where these are known, and the body's size.

    A body is compared with the smallest and the tallest people; one who lies down is as long as tall.
    """
    if stretch is not None:
        far, joint = max(((far, joint) for joint, far in stretch.items()), default=(0.0, ""))
        yield Measure("bones", 1000 * far, 5.0, "mm", f"'{joint}'")
    if path is not None:
        off, _ = cKDTree(path.resampled(0.01).points).query(motion.root_positions[:, [0, 2]])
        where = f"{100 * off.max():.0f} cm in frame {off.argmax()}"
        yield Measure("path", 100 * float(off.mean()), 15.0, "cm", where)  # as `steering.follow_path` warns
    height = height_of(places)
    if not SHORTEST <= height <= TALLEST:
        height = float(np.median(np.ptp(places, axis=1).max(axis=-1)))
    times = max(SHORTEST / max(height, 1e-9), height / TALLEST)
    inches = f"; {2.54 * height:.3g} m if it is in inches" if SHORTEST / 2 < height < SHORTEST else ""
    value, where = (times, f"{height:.3g} m tall{inches}") if times > 1 else (0.0, "")
    yield Measure("size", value, 1.0, "of its limit", where)
