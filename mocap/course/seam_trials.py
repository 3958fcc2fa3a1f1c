"""What the discussion shares: random walks by a matrix, matches drawn at random, and blends of these.

All are measured on many collections of clips in the same way, in notebooks 09 and 09b.
"""

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from mocap._shared.arrays import Array
from mocap.blending.joining import align_window, blend, inertialize, splice
from mocap.blending.weights import cubic_weights
from mocap.body.motion import Motion
from mocap.matching.point_clouds import point_cloud
from mocap.matching.transitions import Transition, Transitions
from mocap.quality.seam_measures import sliding_per_frame

MATCHED = 10  # frames of a window in which matches were found; blends are centred at its middle
BESIDE = 24  # frames of both clips on either side of this middle


def walk_costs(odds: Array, costs: Array, *, walks: int = 40, steps: int = 60, seed: int = 0) -> Array:
    """Walk at random by a matrix of probabilities, and list what the steps cost.

    Parameters
    ----------
    odds : shape (S, S), P[i, j] of the step from i to j; where a row holds zeros only, a walk ends.
    costs : shape (S, S), of these steps.
    walks, steps, seed : how many walks of how many steps; all starts are equally likely.

    Returns
    -------
    Shape (walks, steps): NaN after the end of a walk, as `plotting.walk_rows` draws them.

    Examples
    --------
    >>> walk_costs(np.array([[0.0, 1], [1, 0]]), np.array([[0.0, 7], [7, 0]]), walks=1, steps=3)
    array([[7., 7., 7.]])

    Notebook: 09-discussion
    """
    rng = np.random.default_rng(seed)
    rows = np.full((walks, steps), np.nan)
    for row in rows:
        state = int(rng.integers(len(odds)))
        for step in range(steps):
            if not odds[state].any():
                break
            probabilities = odds[state] / odds[state].sum()
            successor = int(rng.choice(len(odds), p=probabilities))
            row[step] = costs[state, successor]
            state = successor
    return rows


def choose_matches(  # reads: name: the notebooks write `beside`
    clips: Sequence[Motion],
    transitions: Transitions,
    limits: tuple[float, float],
    *,
    count: int = 30,
    beside: int = BESIDE,
) -> list[Transition]:
    """Draw matches of two different clips at random, with room for a `passage` around them.

    Parameters
    ----------
    clips : in which they were found, over windows of ten frames.
    transitions : as from `matching.find_transitions`.
    limits : their costs, from the first to just below the second, metres.
    count : how many; fewer where there are no more.
    beside : frames of both clips on either side.

    Examples
    --------
    >>> choose_matches([], Transitions(*np.zeros((4, 0), int), np.zeros(0), None), (0, 0.04))
    []

    Notebook: 09-discussion
    """
    lengths = np.array([len(clip) for clip in clips], int)
    half = MATCHED // 2
    preceding = np.minimum(transitions.leave, transitions.enter)
    following_source = lengths[transitions.source] - transitions.leave
    following = np.minimum(following_source, lengths[transitions.target] - transitions.enter)
    has_room = (preceding >= beside - half) & (following >= beside + half)
    lowest, highest = limits
    is_wanted = (transitions.cost >= lowest) & (transitions.cost < highest)
    is_between_clips = transitions.source != transitions.target
    numbers = np.random.default_rng(0).permutation(np.flatnonzero(has_room & is_wanted & is_between_clips))
    return [transitions[number] for number in numbers[:count]]


class Passage(NamedTuple):
    """A blend and its two clips on one clock: frame f of the result is made of frame f of both.

    `second` is aligned with `first`; `weights` are those of the first clip in the window, which begins at
    `start`. Before it they are 1, after it 0.
    """

    result: Motion
    first: Motion
    second: Motion
    start: int
    weights: Array

    @property
    def alpha(self) -> Array:
        """The weight of the first clip in each frame, shape (F,)."""
        following = len(self.first) - self.start - len(self.weights)
        return np.concatenate([np.ones(self.start), self.weights, np.zeros(following)])

    @property
    def gap(self) -> Array:
        """How far the points of the two clips are apart, shape (F, 3P), metres."""
        return (point_cloud(self.first) - point_cloud(self.second)).reshape(len(self.first), -1)

    def size(self, vectors: Array) -> Array:
        """Give the RMS length over the points of vectors (F, 3P), metres per frame, in m/s, shape (F,)."""
        points = np.asarray(vectors).reshape(len(vectors), -1, 3)
        return np.asarray(np.sqrt((points**2).sum(axis=-1).mean(axis=-1)) * self.first.fps)

    @property
    def jolts(self) -> Array:
        """The jolts of the result and of both clips, and those that the blend itself adds, shape (4, F), m/s.

        A jolt is |x_{f+1} - 2 x_f + x_{f-1}| · fps, the RMS over the points, from the frame before the window
        to the one after it. The blend adds |ẍ_result - (α ẍ_first + (1 - α) ẍ_second)| / fps.
        """
        frames = slice(max(self.start - 2, 0), self.start + len(self.weights) + 2)
        result, first, second = (np.diff(point_cloud(motion[frames]), 2, axis=0) for motion in self[:3])
        share = self.alpha[frames][1:-1, None, None]
        added = result - share * first - (1 - share) * second
        return np.array([self.size(change) for change in (result, first, second, added)])

    @property
    def slide(self) -> float:
        """How much further planted feet slide than in the two clips, each up to or from the middle, cm."""
        middle = self.start + len(self.weights) // 2
        of_clips = (
            sliding_per_frame(self.first)[:middle].sum() + sliding_per_frame(self.second)[middle:].sum()
        )
        return float(sliding_per_frame(self.result).sum() - of_clips)


def passage(  # reads: name: the notebooks write `beside`
    clips: Sequence[Motion],
    match: Transition,
    window: int,
    weights: Callable[[int], Array] | None = cubic_weights,
    *,
    beside: int = BESIDE,
) -> Passage:
    """Blend two clips over a window that is centred at a match.

    Parameters
    ----------
    clips : with contacts of the feet for slides.
    match : from `choose_matches`.
    window : frames k of the blend.
    weights : as for `blending.join`; None stands for `blending.inertialize`.
    beside : frames of both clips on either side.

    Notebook: 09-discussion
    """
    middles = ((match.source, match.leave + MATCHED // 2), (match.target, match.enter + MATCHED // 2))
    first, second = (clips[clip][middle - beside : middle + beside] for clip, middle in middles)
    start = beside - window // 2
    laid = align_window(first, start, second, start, window)
    if weights is None:
        return Passage(inertialize(first, start, second, start, window), first, laid, start, np.zeros(window))
    mixed = blend(first[start : start + window], laid[start : start + window], weights(window))
    result = splice(first, start, mixed, laid, start + window)
    return Passage(result, first, laid, start, weights(window))
