"""Legs, arms and head of a body by its tree, its bones and its motion, whatever its joints are called.

The method is ours. A limb is two segments of similar length with a hinge between them: thigh and shank, or
upper arm and forearm. A segment is a bone, or several bones in one line that never bend, as where a thigh is
split or has a joint for its twist. Two limbs that hang side by side and have segments of equal lengths are a
pair. Above a limb is at most a clavicle, and below it a hand, a foot, or a rigid thing: a shank and a ski
below a thigh are no limb. The legs are the pair that holds the lowest joint in most frames, and the arms the
longest other pair. Left and right follow from where toes point, how knees and elbows bend, and which way the
body goes.
Names count only if all of this is open, and it is reported.
"""

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import ArrayLike

from mocap._shared.records import NamedTuple
from mocap.body.limb_pairs import (
    LIMITS,
    Limb,
    Pair,
    arm_score,
    drop_of,
    fraction_on_floor,
    is_used,
    leg_score,
    length_of,
    limb_pairs,
    overlap,
)
from mocap.body.limb_roles import arms_by_role, left_first, legs_by_role, trunk_by_role
from mocap.body.limb_tree import BodyTree, Chain
from mocap.body.skeleton import Skeleton

UP = (0.0, 1.0, 0.0)


class FoundLimbs(NamedTuple):
    """The joints of a body by their roles, such as "left knee", and what is doubtful, in sentences."""

    roles: dict[str, int]
    doubts: tuple[str, ...]


def find_limbs(skeleton: Skeleton, positions: ArrayLike, up: ArrayLike = UP) -> FoundLimbs:
    """Find legs, arms, pelvis, chest, neck and head of a body, whatever its joints are called.

    Parameters
    ----------
    skeleton : J joints.
    positions : of the joints in F frames, (F, J, 3), in any unit; in a motion in which the knees bend.
        One frame, such as the rest pose, shows less.
    up : the vector against gravity.

    Returns
    -------
    Roles: for each side "hip", "knee", "ankle", "shoulder", "elbow", "wrist", and "ball" and "tip" (the end
    of the toe) where a joint is ahead of the ankle; "pelvis", "chest", "neck", "head". Doubts: one sentence
    for each role that could be another joint; none if all are clear.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> walk = sample("walk_straight")
    >>> roles, doubts = find_limbs(walk.skeleton, walk.positions)
    >>> [walk.skeleton.names[roles[f"left {part}"]] for part in ("hip", "knee", "ankle", "ball", "elbow")]
    ['lfemur', 'ltibia', 'lfoot', 'ltoes', 'lradius']
    >>> doubts
    ()
    """
    positions = np.asarray(positions, float)
    frames = np.linspace(0, len(positions) - 1, min(len(positions), LIMITS.frames)).astype(int)
    tree = BodyTree(skeleton.parents, positions[frames], up)
    pairs = limb_pairs(tree)
    if not pairs:
        return FoundLimbs({}, ("no two limbs are mirror images of each other",))
    legs = max(pairs, key=lambda pair: leg_score(tree, pair))
    rivals = [pair for pair in pairs if not overlap(tree, pair, legs)]
    pelvis = tree.last_common(legs[0].root, legs[1].root)
    ranked = sorted(rivals, key=lambda pair: arm_score(tree, pair, pelvis), reverse=True)
    arms = ranked[0] if ranked else None
    doubts = [*_doubts_of_legs(tree, skeleton.names, legs, rivals)]
    doubts += _doubts_of_arms(tree, skeleton.names, ranked, pelvis)
    legs, doubt = left_first(tree, skeleton.names, legs, arms)
    roles = {"pelvis": pelvis} | legs_by_role(tree, legs)
    if arms:
        roles |= arms_by_role(tree, arms, legs) | trunk_by_role(tree, arms, skeleton.dofs)
    return FoundLimbs(roles, (*doubts, *doubt))


def _doubts_of_legs(
    tree: BodyTree, names: Sequence[str], legs: Pair, rivals: Sequence[Pair]
) -> Iterator[str]:
    smallest = LIMITS.rival * leg_score(tree, legs)
    on_floor = [pair for pair in rivals if fraction_on_floor(tree, pair) > LIMITS.forelegs]
    forelegs = [pair for pair in on_floor if leg_score(tree, pair) > smallest]
    if forelegs:
        yield f"more than two limbs are on the floor: {_ends(names, [legs, forelegs[0]])}"
    if fraction_on_floor(tree, legs) < 0.5:
        yield f"other joints are lower than {_ends(names, [legs])} in most frames"
    if drop_of(tree, legs) < LIMITS.hanging * length_of(tree, legs):
        yield f"the body lies or hangs, or up is another axis: the legs {_ends(names, [legs])} do not stand"
    if not is_used(tree, legs):
        yield f"the knees {_ends(names, [legs], 'hinge')} hardly bend in these frames"
    if any(_goes_on(tree, leg) for leg in legs):
        yield f"below the ankles {_ends(names, [legs])} are long bones with joints that bend"


def _goes_on(tree: BodyTree, leg: Limb) -> bool:
    """Tell whether a joint bends that is farther below a leg than a foot is long."""
    segments = Chain(tree, leg).distances.mean(axis=0)
    foot = LIMITS.hand * (segments[0, 1] + segments[1, 2])
    below = tree.chain(leg.end)
    bends = zip(below.along, below.bend_ranges, strict=True)
    return any(distance > foot and bend > LIMITS.bends for distance, bend in bends)


def _doubts_of_arms(
    tree: BodyTree, names: Sequence[str], ranked: Sequence[Pair], pelvis: int
) -> Iterator[str]:
    if not ranked:
        yield "no second pair of limbs, which would be arms"
    scores = [arm_score(tree, pair, pelvis) for pair in ranked[:2]]
    if len(scores) > 1 and scores[1] > LIMITS.rival * scores[0]:
        yield f"the arms end at {_ends(names, ranked[:1])}, or at {_ends(names, ranked[1:2])}"


def _ends(names: Sequence[str], pairs: Sequence[Pair], part: str = "end") -> str:
    """Name the ends, or another part, of all limbs of some pairs."""
    return ", ".join(f"'{names[getattr(limb, part)]}'" for pair in pairs for limb in pair)
