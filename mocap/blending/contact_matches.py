"""Which plants of several clips are one and the same, and when a blend of the clips has this plant."""

from collections.abc import Sequence
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


class _Plant(NamedTuple):
    """A plant on the common clock: its start and stop in seconds, and whose it is."""

    start: float
    stop: float
    clip: int


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
        for group in _groups(_plants(joint, clips, times, span)):
            for parts in _split(group, len(clips)):
                starts, stops = [own[0].start for own in parts], [own[-1].stop for own in parts]
                matches.append(SharedPlant(joint, frozen(starts, np.float64), frozen(stops, np.float64)))
    return tuple(matches)


def plants_on_clock(clip: Motion, times: Curve) -> dict[str, Array]:
    """Give a clip's plants on the common clock, joint by joint.

    Parameters
    ----------
    clip : its contacts are marked.
    times : the curve from the common clock to the clip's seconds.

    Returns
    -------
    For each joint the starts and stops, shape (N, 2), seconds.

    Examples
    --------
    >>> from mocap.datasets.samples import sample
    >>> walk, twice_as_fast = sample("walk_straight"), Curve(0.0, 1.0, np.array([-1.0, 1.0, 3.0]))
    >>> plants_on_clock(walk, twice_as_fast)["lfoot"][0].round(2)
    array([0.06, 0.2 ])

    Notebook: 15-registration
    """
    return {joint: times.inverse(runs(marks) / clip.fps) for joint, marks in clip.contacts.items()}


def _plants(
    joint: str, clips: Sequence[Motion], times: Sequence[Curve], span: tuple[float, float]
) -> list[_Plant]:
    """List the plants of all clips on the common clock, by their starts."""
    plants = [
        _Plant(float(start), float(stop), number)
        for number, (clip, curve) in enumerate(zip(clips, times, strict=True))
        for start, stop in plants_on_clock(clip, curve)[joint]
    ]
    return sorted(_within(plants, *span))


def _within(plants: Sequence[_Plant], low: float, high: float) -> list[_Plant]:
    """Cut away what lies before `low` and after `high`, and leave out what is then too short."""
    parts = [_Plant(max(plant.start, low), min(plant.stop, high), plant.clip) for plant in plants]
    return [part for part in parts if part.stop - part.start >= SHORTEST]


def _groups(plants: Sequence[_Plant]) -> list[list[_Plant]]:
    """Collect plants that hang together: each starts before one of those before it stops."""
    groups: list[list[_Plant]] = []
    reach = -np.inf
    for plant in plants:
        if plant.start >= reach:
            groups.append([])
        groups[-1].append(plant)
        reach = max(reach, plant.stop)
    return groups


def _split(group: Sequence[_Plant], count: int) -> list[list[list[_Plant]]]:
    """Give the matches of a group: in each, the plants of every clip."""
    of_clips = [[plant for plant in group if plant.clip == clip] for clip in range(count)]
    most = max(of_clips, key=len)
    cuts = [(before.stop + after.start) / 2 for before, after in pairwise(most)]
    ends = zip([-np.inf, *cuts], [*cuts, np.inf], strict=True)
    matches = [[_within(own, low, high) for own in of_clips] for low, high in ends]
    return [parts for parts in matches if all(parts)]
