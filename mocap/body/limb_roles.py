"""Left and right of a body, and the roles of the joints of its legs, arms and trunk."""

import re
from collections.abc import Sequence

import numpy as np

from mocap._shared.arrays import Array, Mask
from mocap.body.limb_pairs import LIMITS, Limb, Pair
from mocap.body.limb_tree import LIMITS as TREE_LIMITS
from mocap.body.limb_tree import BodyTree, Chain

LEFT = re.compile(r"left|(?:^|[^a-z])l(?![a-z])", re.IGNORECASE)
RIGHT = re.compile(r"right|(?:^|[^a-z])r(?![a-z])", re.IGNORECASE)


def left_first(tree: BodyTree, names: Sequence[str], legs: Pair, arms: Pair | None) -> tuple[Pair, list[str]]:
    """Order two legs, the left one first, and return what is doubtful about it."""
    votes = sum(side_votes(tree, legs, arms).values())
    named = _named_side(names[legs[0].root]) - _named_side(names[legs[1].root])
    doubts = []
    if abs(votes) < LIMITS.sure_side:
        source = "taken from the names" if named else "guessed"
        doubts.append(f"left and right are {source}, for the poses do not show them")
        votes = named or votes
    elif named * votes < 0:
        doubts.append("the names say left where the motion says right")
    return (legs if votes > 0 else legs[::-1]), doubts


def _named_side(name: str) -> int:
    """Return 1 for a name of the left side, -1 for one of the right, 0 for others.

    Examples
    --------
    >>> [_named_side(name) for name in ("LeftLeg", "thigh_r", "DEF-shin.L", "lfemur", "calf")]
    [1, -1, 1, 0, 0]
    """
    if LEFT.search(name):
        return 1
    return -1 if RIGHT.search(name) else 0


def _ahead(tree: BodyTree, legs: Pair) -> Array:
    """Compute the level direction that the body faces, unit vectors (F, 3), if the left leg is the first."""
    across = tree.positions[:, legs[0].root] - tree.positions[:, legs[1].root]
    ahead = np.cross(across, tree.up)
    return np.asarray(ahead / np.maximum(np.linalg.norm(ahead, axis=-1, keepdims=True), 1e-12))


def side_votes(tree: BodyTree, legs: Pair, arms: Pair | None) -> dict[str, float]:
    """Collect votes that the first leg is the left one; negative votes say that it is the right one.

    Toes point ahead, knees bend forwards, elbows backwards, and most bodies move forwards. Each vote is a
    length along `_ahead`, compared with a usual one by tanh, which limits it to its weight.
    """
    ahead = _ahead(tree, legs)
    steps = np.diff(tree.positions[:, tree.joints].mean(axis=1), axis=0)
    distance = max(float(np.abs(steps).sum()), 0.2 * tree.height)
    toes = np.mean([_toes_ahead(tree, leg, ahead) for leg in legs])
    knees = np.mean([_hinge_ahead(tree, leg, ahead) for leg in legs])
    elbows = np.mean([_hinge_ahead(tree, arm, ahead) for arm in arms]) if arms else 0.0
    lengths = np.array([toes / 0.04, knees / 0.015, elbows / 0.02])
    weights = np.array([1.5, 1.0, -0.4])
    votes = dict(zip(("toes", "knees", "elbows"), weights * np.tanh(lengths), strict=True))
    return votes | {"path": 0.8 * float(np.sum(steps * ahead[1:])) / distance}


def _along(tree: BodyTree, vectors: Array, ahead: Array) -> float:
    """Return the mean length of vectors (F, 3) along directions (F, 3), in heights."""
    return float(np.mean(np.sum(vectors * ahead, axis=-1))) / tree.height


def _toes_ahead(tree: BodyTree, leg: Limb, ahead: Array) -> float:
    """Return how far the joint of a foot that is farthest from the ankle is ahead of it; negative behind."""
    offsets = [tree.positions[:, joint] - tree.positions[:, leg.end] for joint in foot_joints(tree, leg)]
    return max((_along(tree, offset, ahead) for offset in offsets), key=abs)


def _hinge_ahead(tree: BodyTree, limb: Limb, ahead: Array) -> float:
    """Return how far a knee or an elbow is ahead of the middle between the ends of its limb."""
    root, hinge, end = (tree.positions[:, joint] for joint in limb)
    return _along(tree, hinge - (root + end) / 2, ahead)


def legs_by_role(tree: BodyTree, legs: Pair) -> dict[str, int]:
    """Name the joints of two legs, the left one first, by their roles; feet without toes have no ball."""
    roles: dict[str, int] = {}
    toes = _toes(tree, legs)
    for side, leg, (ball, tip) in zip(("left", "right"), legs, toes, strict=True):
        roles |= {f"{side} hip": leg.root, f"{side} knee": leg.hinge, f"{side} ankle": leg.end}
        roles |= {f"{side} ball": ball} if ball is not None else {}
        roles |= {f"{side} tip": tip} if tip is not None else {}
    return roles


def _toes(tree: BodyTree, legs: Pair) -> list[tuple[int | None, int | None]]:
    """Find the ball and the tip of both feet: the first and the last joint ahead of the ankle.

    A heel is behind it, and a toe without a length is at the ankle. Only frames count in which the ankle is
    low, for a foot in the air hangs. What is ahead on one foot is so on the other, which may be turned out.
    """
    ahead = _ahead(tree, legs)
    feet = [foot_joints(tree, leg) for leg in legs]
    distances = [_ahead_of_ankle(tree, joints, ahead) for joints in feet]
    if len(distances[0]) == len(distances[1]):
        distances = [np.maximum(*distances)] * 2
    toes: list[tuple[int | None, int | None]] = []
    for joints, distance in zip(feet, distances, strict=True):
        is_ahead = dict(zip(joints, distance > LIMITS.toe_ahead, strict=True))
        farthest = joints[int(np.argmax(distance))]
        path = [joint for joint in tree.path(farthest) if is_ahead.get(joint)]
        ball = path[0] if path else None
        toes.append((ball, farthest if path and farthest != ball else None))
    return toes


def foot_joints(tree: BodyTree, leg: Limb) -> list[int]:
    """List the ankle and the joints of the foot below it, without skis and stilts.

    A joint that is too far from the ankle for a toe is left out, and so are joints that only hold such a one,
    unless the foot has no other joint.
    """
    below = tree.below(leg.end)
    offsets = tree.positions[:, below] - tree.positions[:, [leg.end]]
    distances = np.median(np.linalg.norm(offsets, axis=-1), axis=0)
    farthest = LIMITS.foot * Chain(tree, leg).distances[:, 1, 2].mean()
    within_foot = [joint for joint, distance in zip(below, distances, strict=True) if distance <= farthest]
    holders = {above for joint in set(below) - set(within_foot) for above in tree.path(joint)}
    ends = [joint for joint in within_foot if joint not in holders]
    foot = {joint for end in ends for joint in tree.path(end) if joint in within_foot}
    return sorted(foot | {leg.end}) if ends else within_foot


def _ahead_of_ankle(tree: BodyTree, joints: Sequence[int], ahead: Array) -> Array:
    """Return how far each joint of a foot is ahead of its first, the ankle, in heights.

    They are medians over the frames in which the ankle is low.
    """
    ankle = joints[0]
    heights = tree.heights[:, ankle]
    stands: Mask = heights <= np.quantile(heights, LIMITS.standing)
    offsets = tree.positions[stands][:, joints] - tree.positions[stands][:, [ankle]]
    along = np.einsum("fjc,fc->fj", offsets, ahead[stands])
    return np.asarray(np.median(along, axis=0)) / tree.height


def arms_by_role(tree: BodyTree, arms: Pair, legs: Pair) -> dict[str, int]:
    """Order two arms by the legs: shoulders and hips of one side are beside each other on average."""
    across = tree.positions[:, legs[0].root] - tree.positions[:, legs[1].root]
    across_arms = tree.positions[:, arms[0].root] - tree.positions[:, arms[1].root]
    left, right = arms if np.sum(across * across_arms) > 0 else arms[::-1]
    roles: dict[str, int] = {}
    for side, arm in (("left", left), ("right", right)):
        roles |= {f"{side} shoulder": arm.root, f"{side} elbow": arm.hinge, f"{side} wrist": arm.end}
    return roles


def trunk_by_role(tree: BodyTree, arms: Pair, dofs: Sequence[str]) -> dict[str, int]:
    """Find the chest, on which the arms hang, and the neck and the head on the highest other path from it.

    The head is where that path branches (eyes, jaw, hair), or its last joint with a bone. A joint at the
    position of its parent, such as one for the face, is not the head, but its parent is. Of two joints, the
    last may be the head, unless it cannot rotate, as an end site. Then the other one is the head, without a
    neck.
    """
    chest = tree.last_common(arms[0].root, arms[1].root)
    in_arms = {joint for arm in arms for joint in tree.path(arm.root)}
    branches = [joint for joint in tree.children[chest] if joint not in in_arms]
    path = []
    while branches:
        path.append(max(branches, key=lambda joint: _top(tree, joint)))
        branches = tree.children[path[-1]] if len(tree.children[path[-1]]) <= 2 else []
    if not path:
        return {"chest": chest}
    shortest = TREE_LIMITS.no_bone * tree.height
    while len(path) > 2 and tree.children[path[-1]] and tree.lengths[path[-1]] < shortest:
        path.pop()
    last = path[-1]
    if len(path) == 2 and not tree.children[last] and not dofs[last]:
        return {"chest": chest, "head": path[0]}
    is_end = not tree.children[last] and len(path) > 2
    return {"chest": chest, "neck": path[0], "head": path[-2] if is_end else last}


def _top(tree: BodyTree, joint: int) -> float:
    """Return the mean height of the highest joint at or below a joint."""
    return float(tree.heights[:, tree.below(joint)].mean(axis=0).max())
