"""Left, right and the head of a skeleton, by the names of joints, or by their roles if names tell nothing.

Measures, drawings and mirror images use these, so that they are the same under any names.
"""

from functools import lru_cache

from mocap.body.limb_partners import limb_partners
from mocap.body.limbs import has_leg_roles
from mocap.body.skeleton import Skeleton


@lru_cache(maxsize=64)
def _partners_by_role(skeleton: Skeleton) -> dict[int, int]:
    """Pair joints that no name pairs by the roles that are stored, {left joint: right joint}."""
    if not has_leg_roles(skeleton):
        return {}
    is_named = [skeleton.partner(joint) != joint for joint in range(len(skeleton))]
    pairs = limb_partners(skeleton).items()
    return {left: right for left, right in pairs if left != right and not (is_named[left] or is_named[right])}


def partners(skeleton: Skeleton) -> list[int]:
    """Return the mirror image of each joint, J indices: the joint itself if it is in the middle.

    Examples
    --------
    >>> partners(Skeleton(["lowerback", "lfoot", "rfoot"], [-1, 0, 0], [[0, 0, 0]] * 3))
    [0, 2, 1]
    """
    images = [skeleton.partner(joint) for joint in range(len(skeleton))]
    for left, right in _partners_by_role(skeleton).items():
        images[left] = right
        images[right] = left
    return images


def sides(skeleton: Skeleton) -> list[str]:
    """Return the side of each joint: "left", "right" or "middle".

    Examples
    --------
    >>> sides(Skeleton(["lowerback", "lfoot", "rfoot"], [-1, 0, 0], [[0, 0, 0]] * 3))
    ['middle', 'left', 'right']
    """
    side_of = [skeleton.side(joint) for joint in range(len(skeleton))]
    for left, right in _partners_by_role(skeleton).items():
        side_of[left] = "left"
        side_of[right] = "right"
    return side_of


def head_joints(skeleton: Skeleton) -> list[int]:
    """Find the joints of the head, of which the last is its tip.

    They have "head" in their names. Otherwise they are the joint with the role "head" and its first child.

    Examples
    --------
    >>> head_joints(Skeleton(["neck", "head", "head_end"], [-1, 0, 1], [[0, 0, 0]] * 3))
    [1, 2]
    >>> head_joints(Skeleton(["a", "b", "c"], [-1, 0, 1], [[0, 0, 0]] * 3, roles={"head": "b"}))
    [1, 2]
    """
    named = [joint for joint, name in enumerate(skeleton.names) if "head" in name.lower()]
    if named or "head" not in skeleton.roles:
        return named
    head = skeleton.index(skeleton.roles["head"])
    return [head, *skeleton.children(head)[:1]]
