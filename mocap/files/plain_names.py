"""Names of joints without the characters that three.js drops from the names of objects.

Its animations address a joint by its name, in which the characters `[ ] . : /` have a meaning. Its glTF
loader therefore drops them and replaces blanks by underscores (`PropertyBinding.sanitizeNodeName`). Names
that were different may then be equal, and joints get names that the file does not contain. Its BVH loader
does not drop them, and cannot animate such joints.
"""

import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import replace

from mocap.body.motion import Motion, require_motion

DROPPED = re.compile(r"[\[\].:/]")
BLANK = re.compile(r"[\s\ufeff]")  # as JavaScript's \s
NAMELESS = "joint"  # the name of a joint of which no character is left


def plain_name(name: str) -> str:
    """Return a name as three.js changes it.

    Examples
    --------
    >>> plain_name("mixamorig:Left Arm"), plain_name("thigh.L")
    ('mixamorigLeft_Arm', 'thighL')
    """
    return DROPPED.sub("", BLANK.sub("_", name))


def plain_names(names: Sequence[str]) -> list[str]:
    """Return names that three.js does not change, all different. Names that are plain already stay.

    Examples
    --------
    >>> plain_names(["rig:hip", "rig.hip", "foot", ":"])
    ['righip', 'righip_2', 'foot', 'joint']
    """
    used = {name for name in names if name and plain_name(name) == name}
    numbers: Counter[str] = Counter()  # the last number behind each name
    plain: list[str] = []
    for name in names:
        if not name or plain_name(name) != name:
            name = _next_free(plain_name(name) or NAMELESS, used, numbers)
            used.add(name)
        plain.append(name)
    return plain


def _next_free(name: str, used: set[str], numbers: Counter[str]) -> str:
    """Return a name that is not used, with the next number if the name itself is."""
    free = name
    while free in used:
        numbers[name] = max(numbers[name] + 1, 2)
        free = f"{name}_{numbers[name]}"
    return free


def with_plain_names(motion: Motion) -> Motion:
    """Rename the joints of a motion so that three.js keeps their names, for `.glb` and `.bvh` files.

    Parameters
    ----------
    motion : F frames.

    Returns
    -------
    The motion, with the characters `[ ] . : /` dropped from the names of its joints, and blanks replaced by
    underscores. Joints that would have equal names get numbers: `hip`, `hip_2`. Roles and contacts keep
    their joints.

    Examples
    --------
    >>> from mocap.body import Skeleton
    >>> bone = Skeleton(["rig:hip", "foot.L"], [-1, 0], [[0, 0, 0], [0, -1, 0]])
    >>> still = Motion(bone, [[0, 1, 0]], [[[1, 0, 0, 0], [1, 0, 0, 0]]], 30.0)
    >>> with_plain_names(still).skeleton.names
    ('righip', 'footL')
    """
    skeleton = require_motion(motion).skeleton
    plain = dict(zip(skeleton.names, plain_names(skeleton.names), strict=True))
    roles = {role: plain[name] for role, name in skeleton.roles.items()}
    contacts = {plain[name]: mark for name, mark in motion.contacts.items()}
    renamed = replace(skeleton, names=tuple(plain.values()), roles=roles)
    return replace(motion, skeleton=renamed, contacts=contacts)
