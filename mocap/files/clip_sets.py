"""Motion files as sets: files that belong together have one unit and one vertical axis [ours].

Files belong together if

- they have the same hierarchy: the same joints by name, on the same parents, after joints that are no part of
  the body are left out;
- their formats have the same unit and axis by default: a `.bvh` and an `.npz` have not;
- their bones have about the same length in the unit of the file. The bodies of two people differ by less than
  the factor `TUNED.same_body`, two units by more.

In such a set, the files that show their space beyond doubt decide for the others. If there are none, the
evidence of all files is added up. If files that are beyond doubt contradict each other, no answer is right
for all: each file is read as it is by itself, and commands report it.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Sequence
from itertools import pairwise

import numpy as np

from mocap._shared.records import NamedTuple
from mocap.files.recordings import Recording
from mocap.files.space_evidence import Evidence
from mocap.files.spaces import Space, decide
from mocap.files.tuned import TUNED

ReadAgain = Callable[[int, Space], Recording]
"""Reads the recording of a number again, in a space."""

Hierarchy = tuple[tuple[str, ...], tuple[int, ...]]
"""The names of joints, and the index of each joint's parent."""


class SetMember(NamedTuple):
    """The content of a file on which the space of its set depends.

    hierarchy : of its skeleton.
    bones : the sum of the lengths of all bones, in the unit of the file.
    space : in which it is read by itself.
    evidence : of that space.
    """

    hierarchy: Hierarchy
    bones: float
    space: Space
    evidence: Evidence


NumberedMember = tuple[int, SetMember]
"""A member, after the number of its file."""


def set_member(recording: Recording) -> SetMember | None:
    """Return the content of a recording on which the space of its set depends.

    None if its format or the caller says the space, or if the frames show none.
    """
    if recording.space is None or recording.evidence is None:
        return None
    skeleton = recording.motion.skeleton
    hierarchy = (tuple(skeleton.names), tuple(skeleton.parents.tolist()))
    metres = np.linalg.norm(skeleton.offsets[1:], axis=-1).sum()
    return SetMember(hierarchy, float(metres) / recording.space.scale, recording.space, recording.evidence)


def agree(
    recordings: Sequence[Recording], spaces: Sequence[Space | None], read_again: ReadAgain
) -> list[Recording]:
    """Return recordings in the spaces of their sets.

    Parameters
    ----------
    recordings : as they were read, each by itself.
    spaces : from `agreed_spaces`.
    read_again : called for each file that was read in another space than that of its set.
    """
    agreed = []
    for number, (recording, space) in enumerate(zip(recordings, spaces, strict=True)):
        if space is None or recording.space is None:
            agreed.append(recording)
            continue
        if space.choices() != recording.space.choices():
            recording = read_again(number, space)
        agreed.append(recording._replace(space=space))
    return agreed


def agreed_spaces(members: Sequence[SetMember | None]) -> list[Space | None]:
    """Decide the space of each file together with those of its set; None for a file without evidence."""
    spaces: list[Space | None] = [None] * len(members)
    for together in _sets(members):
        decided = decide_together([member for _, member in together])
        for (number, _), space in zip(together, decided, strict=True):
            spaces[number] = space
    return spaces


def _sets(members: Sequence[SetMember | None]) -> list[list[NumberedMember]]:
    """List the files that belong together, in the order of their sizes."""
    of_hierarchy: dict[tuple[Hierarchy, tuple[float, str]], list[NumberedMember]] = defaultdict(list)
    for number, member in enumerate(members):
        if member is not None:
            of_hierarchy[member.hierarchy, member.space.usual].append((number, member))
    return [together for same_joints in of_hierarchy.values() for together in _of_similar_size(same_joints)]


def _of_similar_size(numbered: Sequence[NumberedMember]) -> list[list[NumberedMember]]:
    """Split files in the order of their sizes, wherever the next one is too large for the same unit."""
    by_size = sorted(numbered, key=lambda pair: pair[1].bones)
    sets = [by_size[:1]]
    for (_, smaller), (number, larger) in pairwise(by_size):
        if larger.bones > TUNED.same_body * smaller.bones:
            sets.append([])
        sets[-1].append((number, larger))
    return sets


def decide_together(members: Sequence[SetMember]) -> list[Space]:
    """Decide the space of files that belong together: one for all, unless they contradict each other."""
    certain = [member for member in members if not member.space.doubt]
    if len({member.space.choices() for member in certain}) > 1:
        return [member.space for member in members]
    first = members[0].space
    scale = None if "scale" in first.decided else first.scale
    up = None if "up" in first.decided else first.up
    root_offset = None if "root_offset" in first.decided else first.root_offset
    evidence = [member.evidence for member in certain or members]
    space = decide(evidence, first.usual, scale=scale, up=up, root_offset=root_offset)
    return [space] * len(members)
