"""Jolts, cuts, snapping bones, frozen stretches and trembling.

A jolt, a cut or a snap is large only relative to what the body does around it: a runner's knee is stopped by
the ground in each step, a standing one's is not. Therefore they are divided by the usual value nearby, the
90th percentile in the second around the frame. That value has bounds. Below the lower one, no viewer sees a
change; above the upper one, a clip would excuse its flaws by other flaws.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from scipy.signal import butter, sosfiltfilt

from mocap._shared.arrays import Array, Indices, runs
from mocap._shared.records import NamedTuple
from mocap.body.motion import Motion, resample
from mocap.body.skeleton import reaches
from mocap.quality.limits import LIMITS
from mocap.quality.measures import Measure, Seen, main_points
from mocap.quality.seam_measures import USUAL, Spread, jumps

WINDOW = 1 / 3  # seconds: a jump in a window is compared with those in windows of the clips
STILL = 0.02  # m/s: jumps of velocity of a body that stands

NEARBY = 0.5  # seconds on either side of a frame
USUAL_PERCENTILE = 90  # of the frames nearby
SIMULTANEOUS = 0.9  # of the largest value: bones with more than that snap together

LONG_BONE = 0.17  # of the longest chain of bones from the root: thighs, shanks, upper arms and forearms

TREMOR = 8.0  # Hz: people move more slowly, but for impacts; physiological tremor is at 8 to 12 Hz
LOWEST_RATE = 20.0  # frames per second that show a tremor of 8 Hz
ORDER = 2  # of the high-pass filter, which is run forwards and backwards


def tremble(seen: Seen) -> Measure:
    """Measure the distance of the main joints from their trajectories without frequencies above 8 Hz.

    It is the root mean square over the joints, and the median over the frames.
    """
    points = seen.positions[:, main_points(seen.motion.skeleton)]
    high_pass = butter(ORDER, TREMOR, "highpass", fs=seen.motion.fps, output="sos")
    padding = min(len(points) - 1, 3 * (2 * ORDER + 1))
    residuals = sosfiltfilt(high_pass, points, axis=0, padlen=padding)
    distances = np.sqrt((residuals**2).sum(axis=-1).mean(axis=-1))
    return Measure("tremble", 1000 * float(np.median(distances)), LIMITS.tremble, "mm")


def jolt(seen: Seen, against: Sequence[Motion]) -> Measure:
    """Measure the largest jump of velocity, as a multiple of the usual one nearby, or in some clips."""
    if against:
        return _jolt_against(seen, against)
    step = seen.step
    points = seen.positions[:, main_points(seen.motion.skeleton)]
    centre = points.mean(axis=1)
    jump = np.linalg.norm(_second_differences(centre, step), axis=-1) / seen.seconds
    usual = usual_nearby(jump, seen)
    ratios = jump / usual.clip(LIMITS.jolt_floor, LIMITS.jolt_ceiling)
    frame = step + int(ratios.argmax())
    return Measure("jolt", float(ratios.max()), LIMITS.jolt, "times usual", _most_moved(seen, frame))


def _second_differences(values: Array, step: int) -> Array:
    """Return x_{f + step} - 2 x_f + x_{f - step} of values (F, ...), without the first and last frames."""
    later = values[2 * step :]
    earlier = values[: -2 * step]
    return np.asarray(later - 2 * values[step:-step] + earlier)


def _most_moved(seen: Seen, frame: int) -> str:
    """Name a frame and the joint whose velocity jumps most in it."""
    first = max(0, frame - seen.step)
    last = min(len(seen.motion) - 1, frame + seen.step)
    changes = np.diff(seen.positions[[first, frame, last]], 2, axis=0)
    joint = int(np.linalg.norm(changes[0], axis=-1).argmax())
    return f"frame {frame}, most '{seen.motion.skeleton.names[joint]}'"


def _jolt_against(seen: Seen, clips: Sequence[Motion]) -> Measure:
    """Compare the largest jump of velocity from frame to frame with those in windows of clips."""
    largest = jumps(seen.motion)
    frame = 1 + int(largest[1:-1].argmax())
    usual = _usual_jump(clips, seen.motion.fps)
    value = float(largest.max()) / max(usual, STILL)
    return Measure("jolt", value, LIMITS.seam_jolt, "times the clips'", _most_moved(seen, frame))


def _usual_jump(clips: Sequence[Motion], fps: float) -> float:
    """Return the jump of velocity that nearly all windows of clips stay below, m/s."""
    velocity_jumps = tuple(jumps(resample(clip, fps)) for clip in clips)
    largest = Spread(velocity_jumps).within(max(2, round(WINDOW * fps)))
    return float(np.percentile(largest, USUAL))


def usual_nearby(values: Array, seen: Seen) -> Array:
    """Compute the 90th percentile of values (F, ...) in the second around each frame.

    It is computed from every `step`-th frame. Near an end, the second is the first or the last one.
    """
    sampled = values[:: seen.step]
    window = min(len(sampled), 1 + 2 * round(NEARBY / seen.seconds))
    windows = sliding_window_view(sampled, window, axis=0)
    percentiles = np.percentile(windows, USUAL_PERCENTILE, axis=-1)
    first = np.arange(len(values)) // seen.step - window // 2
    return np.asarray(percentiles[first.clip(0, len(percentiles) - 1)])


def _leaps(changes: Array, step: int) -> Array:
    """Return the distances of changes (F, ..., 3) from the mean of those a step before and a step after."""
    return np.asarray(np.linalg.norm(_second_differences(changes, step), axis=-1) / 2)


def cut(seen: Seen) -> Measure:
    """Measure the largest jump of the whole pose, as a multiple of the usual one nearby.

    A joint moves by x_{f + n} - x_f within n frames. Its jump is the distance of this displacement from the
    mean of those in the n frames before and after, and the jump of the pose is the median over the joints. A
    limb that leaps alone, and a foot that hits the ground, move few joints. The measure is computed for
    n = 1, where a cut is clearest, and for the frames of a step, to which resampling extends a cut.
    """
    points = seen.positions[:, main_points(seen.motion.skeleton)]
    largest = 0.0
    detail = ""
    for step in {1, seen.step}:
        pose_jumps = np.median(_leaps(points[step:] - points[:-step], step), axis=-1)
        ratios = pose_jumps / usual_nearby(pose_jumps, seen).clip(LIMITS.cut_floor, LIMITS.cut_ceiling)
        if ratios.max() > largest:
            largest = float(ratios.max())
            detail = f"frame {int(ratios.argmax()) + 2 * step}"
    return Measure("cut", largest, LIMITS.cut, "times usual", detail)


class LongBones(NamedTuple):
    """The long bones of a skeleton: the joint at the upper and at the lower end of each."""

    upper: Indices
    lower: Indices


def long_bones(seen: Seen) -> LongBones:
    """List the bones that are longer than 17 % of the longest chain of bones from the root."""
    skeleton = seen.motion.skeleton
    lengths = np.linalg.norm(skeleton.offsets, axis=-1)
    is_long = lengths > LONG_BONE * reaches(skeleton)[0]
    lower = 1 + np.flatnonzero(is_long[1:])
    return LongBones(skeleton.parents[lower], lower)


def snap(seen: Seen) -> Measure | None:
    """Measure the largest leap in the direction of a long bone, or return None without such bones.

    Over a step, the direction changes by u_{f + step} - u_f. A leap is the distance of this change from the
    mean of the changes in the step before and in the step after. Smooth motion has none, however fast, and
    neither has a bone that rotates about itself.
    """
    bones = long_bones(seen)
    step = seen.step
    if len(bones.lower) == 0:
        return None
    directions = seen.positions[:, bones.lower] - seen.positions[:, bones.upper]
    directions /= np.linalg.norm(directions, axis=-1, keepdims=True)
    leaps = _leaps((directions[step:] - directions[:-step]) / seen.seconds, step)
    usual = usual_nearby(leaps, seen)
    ratios = leaps / usual.clip(LIMITS.snap_floor, LIMITS.snap_ceiling)
    largest = float(ratios.max())
    frame = int(ratios.max(axis=1).argmax())
    bone = int((ratios[frame] > SIMULTANEOUS * largest).argmax())  # the first one, which moves those below
    name = seen.motion.skeleton.names[bones.upper[bone]]
    return Measure("snap", largest, LIMITS.snap_ratio, "times usual", f"'{name}', frame {frame + 2 * step}")


def frozen(seen: Seen) -> Measure:
    """Measure the longest stretch in which no joint moves, if it starts or ends abruptly.

    That is within two steps. People come to rest slowly, and then tremble.
    """
    step = seen.step
    points = seen.positions[:, main_points(seen.motion.skeleton)]
    distances = np.linalg.norm(points[step:] - points[:-step], axis=-1)
    speeds = np.sqrt((distances**2).mean(axis=-1)) / seen.seconds
    longest = 0.0
    detail = ""
    for start, stop in runs(speeds < LIMITS.still).tolist():
        seconds = (stop - start + step - 1) / seen.motion.fps
        arrival = speeds[max(0, start - 2 * step) : start].max(initial=0.0)
        departure = speeds[stop : stop + 2 * step].max(initial=0.0)
        if max(arrival, departure) > LIMITS.halting and seconds > longest:
            longest = seconds
            detail = f"frames {start} to {stop + step - 1}"
    return Measure("frozen", longest, LIMITS.standstill, "s", detail)


def measure_smoothness(seen: Seen, against: Sequence[Motion]) -> Iterator[Measure]:
    """Measure jolts, cuts, trembling, snapping bones and frozen stretches."""
    yield jolt(seen, against)
    yield cut(seen)
    if seen.motion.fps >= LOWEST_RATE:
        yield tremble(seen)
    snapping = snap(seen)
    if snapping is not None:
        yield snapping
    yield frozen(seen)
