"""Checks of notebook 09."""

import numpy as np
from numpy.typing import NDArray

from mocap._shared.arrays import Array
from mocap.course.check import Check, Mistake

beyond_control = Check(
    name="beyond_control",
    asks="the share of the seams that jump more than 95 % of the control, where no seam is",
    start="95 % of the control is below np.percentile(control, 95).",
    draw=lambda rng: (rng.gamma(4.0, 0.1, rng.integers(20, 60)), rng.gamma(4.0, 0.07, rng.integers(20, 60))),
    truth=lambda seams, control: np.mean(seams > np.percentile(control, 95)),
    mistakes=[
        Mistake(
            lambda seams, control: np.sum(seams > np.percentile(control, 95)),
            "that is the number of seams; divide it by the number of all seams.",
        ),
        Mistake(
            lambda seams, control: np.mean(seams > np.median(control)),
            "half of the control itself is above its median: such a jump is nothing special.",
        ),
        Mistake(
            lambda seams, control: np.mean(seams > control.mean()),
            "much of the control itself is above its mean: such a jump is nothing special.",
        ),
        Mistake(
            lambda seams, control: np.mean(seams > control.max()),
            "one extreme value in the control would hide every bad seam; take its 95th percentile.",
        ),
        Mistake(
            lambda seams, control: np.mean(seams > np.percentile(seams, 95)),
            "you compare the seams with themselves: 5 % are always above.",
        ),
        Mistake(
            lambda seams, control: np.mean(seams > np.percentile(control, 0.95)),
            "np.percentile takes percent: 95, not 0.95.",
        ),
    ],
)


def _track(rng: np.random.Generator) -> Array:
    return np.asarray(rng.normal(size=(int(rng.integers(12, 40)), 3)).cumsum(axis=0))


def _seam(rng: np.random.Generator) -> tuple[Array, int, int, float]:
    positions = _track(rng)
    start = int(rng.integers(2, len(positions) - 6))
    stop = int(rng.integers(start + 2, len(positions) - 2))
    return positions, start, stop, float(rng.integers(24, 121))


def _jumps(positions: Array) -> Array:
    """Measure how much the step changes at each frame but the first and the last."""
    return np.asarray(np.linalg.norm(np.diff(positions, 2, axis=0), axis=1))


seam_jump = Check(
    name="seam_jump",
    asks="the largest of |x[f+1] - 2 x[f] + x[f-1]| times fps over the frames start <= f < stop",
    start="np.diff(positions, 2, axis=0) holds the changes of step; its entry 0 belongs to frame 1.",
    draw=_seam,
    truth=lambda positions, start, stop, fps: _jumps(positions)[start - 1 : stop - 1].max() * fps,
    mistakes=[
        Mistake(
            lambda positions, start, stop, fps: _jumps(positions)[start:stop].max() * fps,
            "you look one frame too late: entry 0 of the second differences belongs to frame 1.",
        ),
        Mistake(
            lambda positions, start, stop, fps: _jumps(positions)[start - 1 : stop - 1].max(),
            "that is in metres per frame; velocities are in metres per second.",
        ),
        Mistake(
            lambda positions, start, stop, fps: _jumps(positions)[start - 1 : stop - 1].max() * fps**2,
            "times fps squared, it is an acceleration; for a jump in velocity, multiply by fps once.",
        ),
        Mistake(
            lambda positions, start, stop, fps: _jumps(positions).max() * fps,
            "that is the largest of the whole clip; look at the seam alone.",
        ),
        Mistake(
            lambda positions, start, stop, fps: (
                np.linalg.norm(np.diff(positions, axis=0), axis=1)[start:stop].max() * fps
            ),
            "that is the speed; a steady walk has speed but no jump. Take the difference once more.",
        ),
    ],
)


def _weights(rng: np.random.Generator) -> tuple[Array, float]:
    """Draw weights that fall from nearly 1 to 0 and rarely pass 0.5 in the middle."""
    steps = np.arange(1, int(rng.integers(8, 60)) + 1)
    return (1 - steps / len(steps)) ** rng.uniform(1.5, 4), float(rng.integers(24, 121))


reaction_time = Check(
    name="reaction_time",
    asks="the seconds from the window's first frame to the first that holds more of the new motion",
    start="find the first frame whose weight is below a half; frame p comes p / fps seconds after frame 0.",
    draw=_weights,
    truth=lambda weights, fps: int(np.argmax(weights < 0.5)) / fps,
    mistakes=[
        Mistake(
            lambda weights, fps: int(np.argmax(weights < 0.5)),
            "those are frames; a second has `fps` of them.",
        ),
        Mistake(
            lambda weights, fps: len(weights) / 2 / fps,
            "half the window is right only for weights that fall evenly.",
        ),
        Mistake(
            lambda weights, fps: len(weights) / fps,
            "that is when the blend ends; the new motion leads before that.",
        ),
        Mistake(
            lambda weights, fps: int(np.argmax(weights > 0.5)) / fps,
            "the weights are those of the old motion: it leads while they are above a half.",
        ),
    ],
)


def _steps(positions: Array) -> Array:
    return np.asarray(np.hypot(*np.diff(positions[:, [0, 2]], axis=0).T))


def _standing(rng: np.random.Generator) -> tuple[Array, NDArray[np.bool_]]:
    """Draw a track, and two stretches of it in which the foot is planted."""
    positions = _track(rng)
    planted = np.zeros(len(positions), bool)
    first, second = rng.integers(2, 5, 2)
    planted[1 : 1 + first] = planted[7 : 7 + second] = True
    return positions, planted


ground_slid = Check(
    name="ground_slid",
    asks="the distance over the ground, in metres, of the steps with the foot planted at both ends",
    start="the step from frame f to f+1 counts if planted[f] and planted[f+1]; the ground is x and z.",
    draw=_standing,
    truth=lambda positions, planted: _steps(positions)[planted[1:] & planted[:-1]].sum(),
    mistakes=[
        Mistake(
            lambda positions, planted: np.linalg.norm(np.diff(positions, axis=0), axis=1)[
                planted[1:] & planted[:-1]
            ].sum(),
            "your sum includes the height; sliding is over the ground, x and z.",
        ),
        Mistake(
            lambda positions, planted: _steps(positions)[planted[1:]].sum(),
            "your sum includes the step in which the foot comes down; both its ends must be planted.",
        ),
        Mistake(
            lambda positions, planted: _steps(positions)[planted[:-1]].sum(),
            "your sum includes the step in which the foot leaves; both its ends must be planted.",
        ),
        Mistake(
            lambda positions, planted: _steps(positions[planted]).sum(),
            "your sum includes the way from one plant to the next, where the foot swings.",
        ),
        Mistake(
            lambda positions, planted: _steps(positions).sum(),
            "your sum includes the swings; only planted feet slide.",
        ),
    ],
)
