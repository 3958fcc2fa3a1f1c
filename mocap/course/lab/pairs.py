"""Films of a blind test: some with a seam, and each with its control.

A control is one of the same two clips at the same phase, without a seam. Which of the two it is, is drawn for
each pair: if it were always the first, a viewer could tell the films apart by the steps that follow. Both
films show the same motion up to the seam, or else after it.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from mocap._shared.arrays import Mask
from mocap.blending.joining import join, lay_window_on
from mocap.body.motion import Motion
from mocap.body.planar import lay_on, place
from mocap.errors import MocapError
from mocap.matching.transitions import Transition, Transitions

SECONDS = 2.6  # how long a film is
AROUND = 0.3  # a seam lies within as many seconds of the middle, so that nobody knows when it comes
MATCHED = 1 / 3  # seconds of the windows over which matches were found
NEAR = 0.75  # matches cost at least this share of the threshold, so that tests of other thresholds differ


class Pair(NamedTuple):
    """Two films, the control and the one with the seam, and whether the seam is in the left one."""

    seam: Motion
    control: Motion
    on_left: bool
    match: Transition


class Plan(NamedTuple):
    """What a blind test is about: frames of a blend, the threshold in metres, a seed, and how many pairs."""

    window: int = 10
    below: float = 0.04
    seed: int = 0
    pairs: int = 20


def choose(clips: Sequence[Motion], found: Transitions, plan: Plan) -> Transitions:
    """Choose matches near the threshold at random, with enough of both clips around them.

    Raises
    ------
    MocapError : where there are not enough.
    """
    usable = found[_usable(clips, found) & (found.cost <= plan.below) & (found.cost > NEAR * plan.below)]
    if len(usable) < plan.pairs:
        costs = f"{100 * NEAR * plan.below:.1f} to {100 * plan.below:.1f} cm"
        room = f"{SECONDS / 2 + AROUND:.1f} s of both clips around them"
        raise MocapError(
            f"A blind test needs {plan.pairs} matches of {costs}, with {room}; got {len(usable)}."
        )
    return usable[np.random.default_rng(plan.seed).permutation(len(usable))[: plan.pairs]]


def _usable(clips: Sequence[Motion], found: Transitions) -> Mask:
    """Mark matches with room around them, which do not only lead to the next moment of the same clip."""
    lengths = np.array([len(clip) for clip in clips])
    fps = clips[0].fps
    room = round((SECONDS / 2 + AROUND + MATCHED) * fps)
    before = np.minimum(found.leave, found.enter)
    after = np.minimum(lengths[found.source] - found.leave, lengths[found.target] - found.enter)
    elsewhere = (found.source != found.target) | (abs(found.leave - found.enter) > fps)
    return np.asarray((before >= room) & (after >= room) & elsewhere)


def make_pairs(clips: Sequence[Motion], found: Transitions, plan: Plan) -> list[Pair]:
    """Make the pairs of a plan; the same plan gives the same pairs.

    Parameters
    ----------
    clips : all of the same skeleton and rate.
    found : matches of these, as from `find_transitions`, over windows of a third of a second.
    plan : window, threshold, seed and pairs.

    Raises
    ------
    MocapError : for clips of several rates, a window that does not fit into a film, and too few matches.
    """
    if len({clip.fps for clip in clips}) != 1:
        raise MocapError("A blind test needs clips of one rate; resample them.")
    fps = clips[0].fps
    if not 1 <= plan.window <= (SECONDS - 2 * AROUND) * fps:
        raise MocapError(
            f"A window has 1 to {int((SECONDS - 2 * AROUND) * fps)} frames here, got {plan.window}."
        )
    rng = np.random.default_rng([plan.seed, 1])
    pairs = []
    for match in choose(clips, found, plan):
        seam_at = round((SECONDS / 2 + rng.uniform(-AROUND, AROUND)) * fps)
        first = _film(clips[match.source], match.leave, seam_at)
        second = _film(clips[match.target], match.enter, seam_at)
        start = seam_at - plan.window // 2
        second = lay_window_on(first, start, second, start, plan.window)
        joined = join(first, start, second, start, plan.window)
        control = first if rng.random() < 0.5 else second
        ahead = lay_on(first[seam_at:], place(first[seam_at:], 0.0, (0.0, 0.0)))
        seam, control = ahead.apply_motion(joined), ahead.apply_motion(control)
        pairs.append(Pair(seam, control, bool(rng.random() < 0.5), match))
    return pairs


def _film(clip: Motion, matched: int, at: int) -> Motion:
    """Cut a film so that the middle of the matched window is at a frame of it."""
    start = matched + round(MATCHED * clip.fps / 2) - at
    return clip[start : start + round(SECONDS * clip.fps)]
