"""Take a captured turn's way with a captured straight walk of the same person.

Speed: in the turn over that straight on, off the captured turn's, %; lean: of the mass over the
lower foot where the way bends most, off the captured turn's; off: the root's mean distance from the way;
acc: the 99th percentile of accelerations over the straight walk's. Laid: put on the way and cleaned up.
The bundled clips are generated, and slow down in curves as people do; the others are captured.
"""

from collections.abc import Iterator

import numpy as np
from scipy.ndimage import gaussian_filter1d
from scipy.spatial import cKDTree

from mocap._shared.arrays import Array, runs
from mocap.body import GroundPath, Motion, find_legs, joint_positions
from mocap.editing import bend, moving_frames, on_path, ride_of
from mocap.feet import clean_up
from tasks import Case

NORMAL = ("left_180", "left_45", "left_90", "right_45", "right_90")
CLIPS = {
    "bundled clips": ("walk_straight", "walk_curve_1", "walk_curve_2"),
    "walks of one person": tuple(
        f"puppy0512_motion_graph/walk_normal_{name}" for name in ("stright", *NORMAL)
    ),
    "CMU 16, walks": tuple(f"16/16_{trial}" for trial in (15, *range(11, 15), *range(17, 21))),
    "CMU 16, brisk": tuple(f"16/16_{trial}" for trial in (21, *range(23, 31))),
}
MOST, SMOOTH, STRIDE = 5, 0.3, 1.25  # turns of a clip; seconds
MEASURES = {"speed, %": True, "lean, °": True, "off, cm": True, "acc": True}
BASELINES = ("laid",)


def speeds(motion: Motion) -> tuple[Array, Array, GroundPath, Array]:
    """Give speed and turning (F,) along a motion's own path, smoothed; the path, and the metres along it."""
    ride = ride_of(motion)
    angle = np.asarray(moving_frames(ride.path, ride.along).angle)
    pace, turning = (
        gaussian_filter1d(np.gradient(some) * motion.fps, SMOOTH * motion.fps, mode="nearest")
        for some in (ride.along, angle)
    )
    return pace, turning, ride.path, ride.along


def turns(clip: Motion) -> Iterator[Motion]:
    """Cut out where a walk turns once by 30 to 190 degrees, with 1.2 s before and after it."""
    pace, turning, _, _ = speeds(clip)
    angle, more, found = np.cumsum(turning) / clip.fps, round(1.2 * clip.fps), 0
    for first, last in runs(pace > 0.4).tolist():
        for start, stop in (runs(np.abs(turning[first:last]) > np.radians(12)) + first).tolist():
            turned = abs(np.degrees(angle[stop - 1] - angle[start]))
            if 30 < turned < 190 and pace[start:stop].mean() > 0.55 and found < MOST:
                found += 1
                yield clip[max(first, start - more) : min(last, stop + more)]


def cases(collection: str, clips: list[Motion]) -> Iterator[Case]:
    """Yield the turns, each with as much of its way as the straight walk is long."""
    pace, turning, _, _ = speeds(clips[0])
    first, last = max(runs((pace > 0.8) & (np.abs(turning) < np.radians(20))), key=np.ptp).tolist()
    walk = clips[0][first:last]
    for clip in clips[1:]:
        for number, turn in enumerate(turns(clip)):
            pace, turning, path, along = speeds(turn)
            half = min(0.42 * speeds(walk)[2].length, path.length / 2)
            middle = np.clip(along[np.abs(turning).argmax()], half, path.length - half)
            line = path.at(np.arange(middle - half, middle + half, 0.02))
            yield Case(collection, f"{clip.name}-{number}", {"walk": walk, "line": line}, turn)


def measured(motion: Motion) -> tuple[float, float, float]:
    """Give the mean speed in a turn over that straight on, the lean (degrees inwards), and accelerations."""
    pace, turning, path, along = speeds(motion)
    middle = int(np.abs(turning).argmax())
    inside = np.abs(turning) > 0.3 * np.abs(turning[middle])
    first, last = next(run for run in runs(inside).tolist() if run[0] <= middle < run[1])
    points, legs = joint_positions(motion), find_legs(motion.skeleton)
    hips = points[:, [leg.hip for leg in legs]].mean(axis=1)
    names = [name.lower().rpartition(":")[2] for name in motion.skeleton.names]
    neck = points[:, next(names.index(name) for name in ("neck", "upperneck", "head") if name in names)]
    mass = 0.34 * (hips + neck) + sum(0.08 * (points[:, leg.hip] + points[:, leg.ankle]) for leg in legs)
    ankles = points[:, [leg.ankle for leg in legs]]
    away = mass - ankles[np.arange(len(motion)), ankles[..., 1].argmin(axis=1)]
    way = np.asarray(moving_frames(path, along).angle)
    left = away[:, 0] * np.cos(way) - away[:, 2] * np.sin(way)
    near = slice(max(0, middle - round(STRIDE * motion.fps / 2)), middle + round(STRIDE * motion.fps / 2))
    lean = np.sign(turning[middle]) * np.degrees(np.arctan2(left[near].mean(), mass[near, 1].mean()))
    jerks = np.linalg.norm(np.diff(points, 2, axis=0), axis=-1)
    return pace[first:last].mean() / np.percentile(pace, 90), float(lean), float(np.percentile(jerks, 99))


def laid(case: Case) -> Motion:
    """Put the walk on the way, as far as it goes, as fast and as upright as before."""
    walk, line = case.given["walk"], GroundPath(case.given["line"])
    ride = ride_of(walk)
    frames = int(np.searchsorted(ride.along, line.length))
    return clean_up(on_path(walk, line, ride)[:frames])


METHODS = {"laid": laid, "bend": lambda case: bend(case.given["walk"], GroundPath(case.given["line"])).motion}


def score(case: Case, answer: Motion) -> Array:
    """Compare a bent walk with the captured turn."""
    (speed, lean, acc), (own_speed, own_lean, _) = measured(answer), measured(case.truth)
    line = cKDTree(GroundPath(case.given["line"]).resampled(0.01).points)
    off = line.query(answer.root_positions[:, [0, 2]])[0].mean()
    straight = measured(case.given["walk"])[2]
    return np.array([100 * abs(speed / own_speed - 1), abs(lean - own_lean), 100 * off, acc / straight])
