"""Motion files as one set: clips of one skeleton are read in one space, for which all are evidence."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from mocap.files.recordings import Recording
from mocap.files.spaces import Space, decide

ReadAgain = Callable[[int, Space], Recording]
"""Reads the recording of a number again, in a space."""


def agree(recordings: Sequence[Recording], read_again: ReadAgain) -> list[Recording]:
    """Return recordings in which clips of the same joints have one unit and one vertical axis.

    Parameters
    ----------
    recordings : as they were read, each by itself.
    read_again : called for each clip that was read in another space than the set.
    """
    spaces = agreed_spaces(recordings)
    agreed = []
    for number, recording in enumerate(recordings):
        space = spaces.get(tuple(recording.motion.skeleton.names))
        if space is None or recording.space is None:
            agreed.append(recording)
            continue
        if space.choices() != recording.space.choices():
            recording = read_again(number, space)
        agreed.append(recording._replace(space=space))
    return agreed


def agreed_spaces(recordings: Sequence[Recording]) -> dict[tuple[str, ...], Space]:
    """Decide the space of all clips with the same joints together, by the joints' names.

    Formats that say their unit and axis, and clips whose space the caller says, decide nothing.
    """
    sets: dict[tuple[str, ...], list[Recording]] = {}
    for recording in recordings:
        if recording.evidence is not None and recording.space is not None:
            sets.setdefault(tuple(recording.motion.skeleton.names), []).append(recording)
    spaces = {}
    for names, members in sets.items():
        evidence = [member.evidence for member in members if member.evidence is not None]
        first = members[0].space
        assert first is not None
        scale = None if "scale" in first.decided else first.scale
        up = None if "up" in first.decided else first.up
        relative = None if "root_offset" in first.decided else first.root_offset
        spaces[names] = decide(evidence, first.usual, scale=scale, up=up, root_offset=relative)
    return spaces
