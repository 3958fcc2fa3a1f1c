"""Which plants of several clips are one and the same, and when a blend of the clips has this plant."""

from collections.abc import Iterable, Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from mocap._shared.arrays import Array, frozen, runs
from mocap.blending.timewarps import Curve
from mocap.body.motion import Motion

SHORTEST = 0.02  # seconds on the common clock: what is left of a plant beside a cut or the span's end


class SharedPlant(NamedTuple):
    """A plant that all clips have: when it starts and stops in each of them, on the common clock.

    joint : the one that stands.
    starts, stops : shape (C,), seconds.

    Examples
    --------
    >>> match = SharedPlant("lfoot", np.array([0.2, 0.3]), np.array([0.8, 0.9]))
    >>> weights = np.array([0.25, 0.75])
    >>> float(weights @ match.starts), float(weights @ match.stops)
    (0.275, 0.875)
    """

    joint: str
    starts: Array
    stops: Array


def match_contacts(
    clips: Sequence[Motion], times: Sequence[Curve], span: tuple[float, float]
) -> tuple[SharedPlant, ...]:
    """Match the plants of registered clips: in each match one of every clip, all at about the same time.

    In the paper: [KG03, constraint matches].

    Plants that overlap, or hang together by others that do, make a group. A group that lacks a clip is
    dropped. One with exactly one plant of each clip is a match. Any other is cut where the clip with the most
    plants pauses, each part by itself. [KG03] has matches of one interval for each clip, with intervals
    dropped or split; how it splits them is not known to us, so this rule is ours.

    Parameters
    ----------
    clips : C motions; those without contacts have no plants, so there is no match.
    times : for each clip, the curve from the common clock to the clip's own seconds.
    span : the stretch of the common clock to look at, seconds.

    Returns
    -------
    The matches, joint by joint, in the order of time.

    Examples
    --------
    >>> from mocap.datasets.samples import sample
    >>> walk, same_clock = sample("walk_straight"), Curve(0.0, 1.0, np.array([-0.5, 0.5, 1.5]))
    >>> match = match_contacts([walk, walk[12:]], [same_clock, same_clock], (1.0, 3.0))[1]
    >>> match.joint, match.starts.round(1)
    ('lfoot', array([2.5, 2.4]))
    """
    joints = [joint for joint in clips[0].contacts if all(joint in clip.contacts for clip in clips)]
    matches = []
    for joint in joints:
        plants = [
            (start, stop, number)
            for number, (clip, curve) in enumerate(zip(clips, times, strict=True))
            for start, stop in _within(curve.inverse(runs(clip.contacts[joint]) / clip.fps).tolist(), *span)
        ]
        for group in _groups(sorted(plants)):
            of_clips = [[(a, b) for a, b, clip in group if clip == number] for number in range(len(clips))]
            most = max(of_clips, key=len)
            pauses = [(before[1] + after[0]) / 2 for before, after in pairwise(most)]
            for low, high in pairwise([-np.inf, *pauses, np.inf]):
                parts = [_within(own, low, high) for own in of_clips]
                if all(parts):
                    starts, stops = [own[0][0] for own in parts], [own[-1][1] for own in parts]
                    matches.append(SharedPlant(joint, frozen(starts, np.float64), frozen(stops, np.float64)))
    return tuple(matches)


def _within(plants: Iterable[Sequence[float]], low: float, high: float) -> list[tuple[float, float]]:
    """Cut away what lies before `low` and after `high`, and leave out what is then too short."""
    parts = [(max(start, low), min(stop, high)) for start, stop in plants]
    return [(start, stop) for start, stop in parts if stop - start >= SHORTEST]


def _groups(plants: Sequence[tuple[float, float, int]]) -> list[list[tuple[float, float, int]]]:
    """Collect plants (start, stop, clip) that hang together: each starts before one before it stops."""
    groups: list[list[tuple[float, float, int]]] = []
    reach = -np.inf
    for plant in plants:
        if plant[0] >= reach:
            groups.append([])
        groups[-1].append(plant)
        reach = max(reach, plant[1])
    return groups
