"""Checks of notebook 05."""

from typing import Any

import numpy as np

from mocap._shared.arrays import Array
from mocap.course.check import Check, Mistake, close


def _matches(rng: np.random.Generator) -> tuple[Array, float]:
    """Draw the distances of some matches, and the probability that the successor leaves them."""
    return rng.uniform(100, 400, rng.integers(1, 9)), float(rng.choice([0.5, 1.0]))


def _with_odds(rng: np.random.Generator) -> tuple[Array, Array]:
    costs, left = _matches(rng)
    odds = rng.uniform(0.1, 1, len(costs))
    return costs, left * odds / odds.sum()


def _clip(rng: np.random.Generator) -> tuple[int, list[int], list[int], int]:
    """Draw a clip's length, where transitions leave and enter it, and their window."""
    frames, window = int(rng.integers(60, 300)), int(rng.integers(5, 15))
    leaves, enters = (rng.integers(0, frames - window, rng.integers(1, 9)) for _ in range(2))
    return frames, [*leaves.tolist(), int(leaves[0])], enters.tolist(), window


def _curve(rng: np.random.Generator) -> tuple[Array, Array, float]:
    """Draw thresholds, the frames that would be kept at each, and the share that is enough."""
    count = rng.integers(5, 20)
    frames = np.sort(rng.choice(3000, count, replace=False)).astype(float)
    frames[: rng.integers(1, 3)] = 0
    return np.linspace(0.01, 0.06, count), frames, float(rng.uniform(0.3, 0.95))


def _same_order(given: Any, wanted: Any) -> bool:  # noqa: ANN401
    return bool(given == wanted) if isinstance(given, set) else close(given, wanted)


inverse_shares = Check(
    name="inverse_shares",
    asks="the probability of each match: smaller for a larger D, and `left` in all",
    start="a match with half the distance should be taken twice as often: start with 1 / costs.",
    draw=_matches,
    truth=lambda costs, left: left / costs / np.sum(1 / costs),
    mistakes=[
        Mistake(
            lambda costs, left: left * costs / np.sum(costs),
            "in proportion to D, the worst match is taken most often: that is the slip to fix.",
        ),
        Mistake(
            lambda costs, left: 1 / costs / np.sum(1 / costs),
            "these add up to 1, but the successor may have taken half: share only `left`.",
        ),
        Mistake(lambda costs, left: left / costs, "these do not add up to `left`: divide by their sum."),
        Mistake(lambda costs, left: 1 / costs, "these do not add up to `left`: divide by their sum."),
        Mistake(
            lambda costs, left: left * (1 - costs / np.sum(costs)),
            "1 - D / ΣD falls with D, but with n matches it adds up to n - 1, and a single match gets 0.",
        ),
    ],
)

expected_seam = Check(
    name="expected_seam",
    asks="the mean D of the matches that are taken",
    start="weight each D by its probability; then think of the walks that take no match at all.",
    draw=_with_odds,
    truth=lambda costs, probabilities: np.sum(costs * probabilities) / np.sum(probabilities),
    mistakes=[
        Mistake(
            lambda costs, probabilities: np.sum(costs * probabilities),
            "where the successor takes half, the probabilities add up to ½: divide by their sum.",
        ),
        Mistake(
            lambda costs, probabilities: np.mean(costs),
            "this is the mean if all matches are equally likely; here the likelier ones count more.",
        ),
        Mistake(
            lambda costs, probabilities: np.mean(costs * probabilities),
            "the probabilities already replace 1 / n: take the sum, and divide it by their sum.",
        ),
        Mistake(
            lambda costs, probabilities: costs[np.argmax(probabilities)],
            "that is the likeliest match alone; the others are taken too.",
        ),
    ],
)

choice_points = Check(
    name="choice_points",
    asks="the frames of the clip's nodes, in order and each once",
    start="a clip without transitions has two nodes, where it starts and where it ends.",
    draw=_clip,
    truth=lambda frames, leaves, enters, window: sorted({0, frames, *leaves, *(e + window for e in enters)}),
    same=_same_order,
    mistakes=[
        Mistake(
            lambda frames, leaves, enters, window: {0, frames, *leaves, *(e + window for e in enters)},
            "these are the right frames, but a set has no order: sort them.",
        ),
        Mistake(
            lambda frames, leaves, enters, window: sorted({0, frames, *leaves, *enters}),
            "the blend already plays the window: the clip continues *after* the window that is entered.",
        ),
        Mistake(
            lambda frames, leaves, enters, window: sorted({*leaves, *(e + window for e in enters)}),
            "the clip's start and end are nodes too.",
        ),
        Mistake(
            lambda frames, leaves, enters, window: sorted(
                {0, frames, *(i + window for i in leaves), *(e + window for e in enters)}
            ),
            "a transition leaves where its window starts: the blend plays the window's frames.",
        ),
        Mistake(
            lambda frames, leaves, enters, window: sorted(
                {0, frames - 1, *leaves, *(e + window for e in enters)}
            ),
            "node f lies before frame f, so the node after the last frame is `frames`.",
        ),
        Mistake(
            lambda frames, leaves, enters, window: sorted(
                [0, frames, *leaves, *(e + window for e in enters)]
            ),
            "if two transitions meet the clip at the same frame, there is one node, not two.",
        ),
    ],
)

suggested_threshold = Check(
    name="suggested_threshold",
    asks="the lowest threshold that keeps at least the share `keep` of the largest number of frames",
    start="which entries of `frames` are at least keep * frames.max()?",
    draw=_curve,
    truth=lambda thresholds, frames, keep: thresholds[np.argmax(frames >= keep * frames.max())],
    mistakes=[
        Mistake(
            lambda thresholds, frames, keep: thresholds[np.argmax(frames)],
            "that keeps the largest number of frames; a share of it is enough.",
        ),
        Mistake(
            lambda thresholds, frames, keep: thresholds[np.argmax(frames >= keep)],
            "`keep` is a share, not a number of frames: a share of what?",
        ),
        Mistake(
            lambda thresholds, frames, keep: thresholds[np.argmax(frames > 0)],
            "that is where the first cycle appears, however short it is.",
        ),
        Mistake(
            lambda thresholds, frames, keep: frames[np.argmax(frames >= keep * frames.max())],
            "those are frames; return the threshold at the same index.",
        ),
        Mistake(
            lambda thresholds, frames, keep: np.argmax(frames >= keep * frames.max()),
            "that is an index; return the threshold at that index.",
        ),
    ],
)
