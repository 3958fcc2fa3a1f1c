"""Checks of notebook 09b."""

import numpy as np
from numpy.typing import NDArray

from mocap._shared.arrays import Array
from mocap.course.check import Check, Mistake


def _track(rng: np.random.Generator) -> Array:
    return np.asarray(rng.normal(size=(int(rng.integers(12, 40)), 3)).cumsum(axis=0))


def _blended(rng: np.random.Generator) -> tuple[Array, Array, Array, Array, float]:
    """Draw tracks of a joint in two clips, and a blend of them with a little noise."""
    first = _track(rng)
    second = first + rng.normal(size=first.shape).cumsum(axis=0)
    window = len(first) - 8
    alpha = np.concatenate([np.ones(4), 1 - np.arange(1, window + 1) / window, np.zeros(4)])
    mixed = alpha[:, None] * first + (1 - alpha[:, None]) * second
    return mixed + 0.1 * rng.normal(size=first.shape), first, second, alpha, float(rng.integers(24, 121))


def _added(result: Array, first: Array, second: Array, alpha: Array) -> Array:
    """Second differences of a blend without the mean of those of its clips, (F - 2, 3)."""
    share = alpha[:, None]
    changes = [np.diff(places, 2, axis=0) for places in (result, first, second)]
    return np.asarray(changes[0] - share * changes[1] - (1 - share) * changes[2])


def _largest(vectors: Array) -> float:
    return float(np.linalg.norm(vectors, axis=1).max())


added_jolt = Check(
    name="added_jolt",
    asks="the largest |x'' of the blend - (α x'' of the first + (1 - α) x'' of the second)| times fps",
    start="np.diff(result, 2, axis=0) has two entries less than alpha; its entry 0 belongs to frame 1.",
    draw=_blended,
    truth=lambda result, first, second, alpha, fps: (
        _largest(_added(result, first, second, alpha[1:-1])) * fps
    ),
    mistakes=[
        Mistake(
            lambda result, first, second, alpha, fps: (
                _largest(_added(result, first, second, alpha[:-2])) * fps
            ),
            "your weights are a frame early: entry 0 of the second differences belongs to frame 1.",
        ),
        Mistake(
            lambda result, first, second, alpha, fps: (
                _largest(_added(result, first, second, alpha[2:])) * fps
            ),
            "your weights are a frame late: entry 0 of the second differences belongs to frame 1.",
        ),
        Mistake(
            lambda result, first, second, alpha, fps: (
                _largest(_added(result, second, first, alpha[1:-1])) * fps
            ),
            "α is the share of the first clip; you gave it to the second.",
        ),
        Mistake(
            lambda result, first, second, alpha, fps: _largest(np.diff(result, 2, axis=0)) * fps,
            "that is the jolt of the result; subtract what its two clips do themselves.",
        ),
        Mistake(
            lambda result, first, second, alpha, fps: (
                _largest(np.diff(result - alpha[:, None] * first - (1 - alpha[:, None]) * second, 2, axis=0))
                * fps
            ),
            "you mix the places and then take differences, so the change of α is in both and cancels; "
            "take the differences of each clip first, then mix.",
        ),
        Mistake(
            lambda result, first, second, alpha, fps: _largest(_added(result, first, second, alpha[1:-1])),
            "that is in metres per frame; velocities are in metres per second.",
        ),
        Mistake(
            lambda result, first, second, alpha, fps: (
                _largest(_added(result, first, second, alpha[1:-1])) * fps**2
            ),
            "times fps squared, it is an acceleration; for a change of velocity, multiply by fps once.",
        ),
        Mistake(
            lambda result, first, second, alpha, fps: (
                np.abs(_added(result, first, second, alpha[1:-1])).max() * fps
            ),
            "that is the largest coordinate; take the length of the vector first.",
        ),
    ],
)

beyond_baseline = Check(
    name="beyond_baseline",
    asks="the share of the seams with a larger jolt than 95 % of the baseline, where no seam is",
    start="95 % of the baseline is below np.percentile(baseline, 95).",
    draw=lambda rng: (rng.gamma(4.0, 0.1, rng.integers(20, 60)), rng.gamma(4.0, 0.07, rng.integers(20, 60))),
    truth=lambda seams, baseline: np.mean(seams > np.percentile(baseline, 95)),
    mistakes=[
        Mistake(
            lambda seams, baseline: np.sum(seams > np.percentile(baseline, 95)),
            "that is the number of seams; divide it by the number of all seams.",
        ),
        Mistake(
            lambda seams, baseline: np.mean(seams > np.median(baseline)),
            "half of the baseline itself is above its median, so such a jolt is nothing special.",
        ),
        Mistake(
            lambda seams, baseline: np.mean(seams > baseline.mean()),
            "much of the baseline itself is above its mean, so such a jolt is nothing special.",
        ),
        Mistake(
            lambda seams, baseline: np.mean(seams > baseline.max()),
            "one extreme value in the baseline would hide every bad seam; take its 95th percentile.",
        ),
        Mistake(
            lambda seams, baseline: np.mean(seams > np.percentile(seams, 95)),
            "you compare the seams with themselves: 5 % are always above.",
        ),
        Mistake(
            lambda seams, baseline: np.mean(seams > np.percentile(baseline, 0.95)),
            "np.percentile takes percent: 95, not 0.95.",
        ),
    ],
)


def _falling(rng: np.random.Generator) -> Array:
    """Draw weights that fall from nearly 1 to 0 and rarely pass 0.5 in the middle."""
    steps = np.arange(1, int(rng.integers(8, 60)) + 1)
    return (1 - steps / len(steps)) ** rng.uniform(1.5, 4)


def _asked(rng: np.random.Generator) -> tuple[int, NDArray[np.intp], Array, float]:
    """Draw frames at which transitions leave, and a frame up to the last of them; sometimes one of them."""
    leaves = np.unique(rng.integers(0, 200, int(rng.integers(3, 12))))
    now = rng.choice(leaves) if rng.random() < 0.3 else rng.integers(0, leaves[-1] + 1)
    return int(now), leaves, _falling(rng), float(rng.integers(24, 121))


def _next(asked: int, leaves: NDArray[np.intp]) -> int:
    return int(leaves[leaves >= asked].min())


reaction_time = Check(
    name="reaction_time",
    asks="the seconds from the frame `asked` to the first frame that holds more of the new motion",
    start="wait for the first of `leaves` from `asked` on; then find the first weight below a half.",
    draw=_asked,
    truth=lambda asked, leaves, weights, fps: (
        (_next(asked, leaves) - asked + int(np.argmax(weights < 0.5))) / fps
    ),
    mistakes=[
        Mistake(
            lambda asked, leaves, weights, fps: int(np.argmax(weights < 0.5)) / fps,
            "that is the blend alone; before it, the body waits for the next transition.",
        ),
        Mistake(
            lambda asked, leaves, weights, fps: (_next(asked, leaves) - asked) / fps,
            "that is the waiting alone; after it, the blend needs time, too.",
        ),
        Mistake(
            lambda asked, leaves, weights, fps: _next(asked, leaves) - asked + int(np.argmax(weights < 0.5)),
            "those are frames; a second has `fps` of them.",
        ),
        Mistake(
            lambda asked, leaves, weights, fps: (
                (_next(asked + (asked < leaves[-1]), leaves) - asked + int(np.argmax(weights < 0.5))) / fps
            ),
            "a transition that leaves at the frame `asked` itself can still be taken.",
        ),
        Mistake(
            lambda asked, leaves, weights, fps: (_next(asked, leaves) - asked + len(weights) / 2) / fps,
            "half the window is right only for weights that fall evenly.",
        ),
        Mistake(
            lambda asked, leaves, weights, fps: (_next(asked, leaves) - asked + len(weights)) / fps,
            "that is when the blend ends; the new motion has the larger weight before that.",
        ),
        Mistake(
            lambda asked, leaves, weights, fps: (
                (_next(asked, leaves) - asked + int(np.argmax(weights > 0.5))) / fps
            ),
            "the weights are those of the old motion: it leads while they are above a half.",
        ),
        Mistake(
            lambda asked, leaves, weights, fps: (
                (leaves[np.abs(leaves - asked).argmin()] - asked + int(np.argmax(weights < 0.5))) / fps
            ),
            "the nearest transition may be in the past; wait for the next one.",
        ),
    ],
)
