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

import re
from collections.abc import Iterator, Mapping, Sequence
from itertools import combinations, product

import numpy as np
from numpy.typing import ArrayLike

from mocap._shared.arrays import Array, Mask
from mocap._shared.records import NamedTuple, dataclass
from mocap.body.limb_tree import LIMITS as TREE_LIMITS
from mocap.body.limb_tree import BodyTree, Chain
from mocap.body.skeleton import Skeleton

UP = (0.0, 1.0, 0.0)
LEFT = re.compile(r"left|(?:^|[^a-z])l(?![a-z])", re.IGNORECASE)
RIGHT = re.compile(r"right|(?:^|[^a-z])r(?![a-z])", re.IGNORECASE)


@dataclass(frozen=True)
class SearchLimits:
    """The thresholds of the search; lengths are fractions of the body's height.

    `figures/limb_schemes.py` measures what depends on them.
    """

    frames: int = 120  # that are looked at, spread evenly over the clip
    shortest: float = 0.07  # a bone of a limb. Bones of fingers have 0.03
    evenness: float = 0.52  # shorter / longer segment of a limb. People have 0.75
    length_difference: float = 0.15  # difference of the logarithms of lengths of mirror images
    bends: float = np.radians(8)  # radians: a joint whose bend changes by more is used in these frames
    knee_at_rest: float = 0.035  # radians: a bend that a knee keeps and a split bone has not
    roots: int = 4  # joints of a chain, from its top, that may be a hip or a shoulder
    hand: float = 0.3  # of a limb's length: what may follow below its end (hand, foot)
    clavicle: float = 0.8  # of the limb's first segment: a bone above its root. Clavicles have 0.7
    prop: float = 1.1  # of the limb's longer segment: a bone below its end. Hands have 0.4
    foot: float = 0.75  # of the shank: what is farther from the ankle is no toe. Feet have 0.5
    near_floor: float = 0.03  # above the lowest joint of a frame
    toe_ahead: float = 0.02  # that a toe is ahead of its ankle while it stands
    standing: float = 0.3  # of the frames: those in which an ankle is lowest
    rival: float = 0.8  # of the best score: another pair that is nearly as good is reported
    hanging: float = 0.6  # of a leg's length: the mean drop from hip to ankle. Walks have 0.9
    forelegs: float = 0.25  # of the frames in which a second pair of legs is on the floor
    sure_side: float = 0.6  # sum of the votes for left and right. Walks have 1.2 to 3.6


@dataclass(frozen=True)
class Weights:
    """Weights of the properties of two segments that may be a limb, relative to that of their length."""

    hinge_bends: float = 0.5  # the joint between the segments is used
    end_bends: float = 0.1  # so is the joint at the end, as an ankle is
    passed: float = 0.05  # for each joint within a segment, if it is clear which joint is the hinge
    passed_unclear: float = 0.3  # the same if it is not clear
    uneven: float = 0.3  # times the logarithm of the segments' ratio
    uneven_unused: float = 0.6  # the same if the hinge does not bend
    leaf: float = 0.1  # a split segment ends where the chain ends
    skipped: float = 0.8  # a segment above is as long as a limb's: thigh, shank and a ski are no limb
    fan: float = 0.3  # three or more bones start at a joint within a segment, as at a hand with fingers
    left_below: float = 4.0  # times what is below the limb beyond a hand or a foot
    most_left_below: float = 1.2  # for both limbs. Poles in both hands are longer than arms


LIMITS = SearchLimits()
WEIGHTS = Weights()


class Limb(NamedTuple):
    """The joints of a limb: hip, knee and ankle, or shoulder, elbow and wrist."""

    root: int
    hinge: int
    end: int


class ChainIndices(NamedTuple):
    """A limb as indices into the joints of a chain."""

    root: int
    hinge: int
    end: int


class Candidate(NamedTuple):
    """Two segments that may be a limb: lengths, score, and the excess length of the chain below them."""

    lengths: Array
    score: float
    left_below: float


Pair = tuple[Limb, Limb]
ChainWithCandidates = tuple[Chain, Mapping[ChainIndices, Candidate]]


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
    legs = max(pairs, key=lambda pair: _leg_score(tree, pair))
    rivals = [pair for pair in pairs if not _overlap(tree, pair, legs)]
    pelvis = tree.last_common(legs[0].root, legs[1].root)
    ranked = sorted(rivals, key=lambda pair: _arm_score(tree, pair, pelvis), reverse=True)
    arms = ranked[0] if ranked else None
    doubts = [*_doubts_of_legs(tree, skeleton.names, legs, rivals)]
    doubts += _doubts_of_arms(tree, skeleton.names, ranked, pelvis)
    legs, doubt = _left_first(tree, skeleton.names, legs, arms)
    roles = {"pelvis": pelvis} | _legs_by_role(tree, legs)
    if arms:
        roles |= _arms_by_role(tree, arms, legs) | _trunk_by_role(tree, arms, skeleton.dofs)
    return FoundLimbs(roles, (*doubts, *doubt))


# Limbs and pairs --------------------------------------------------------------------------------------------


def limb_pairs(tree: BodyTree) -> list[Pair]:
    """List the pairs of limbs that hang side by side and are mirror images by their lengths."""
    shortest = 2 * LIMITS.shortest * tree.height
    pairs = []
    for siblings in tree.children.values():
        tops = [joint for joint in siblings if tree.reach[joint] > shortest] if len(siblings) > 1 else []
        chains = [[(chain, limb_candidates(chain)) for chain in tree.chains(top, shortest)] for top in tops]
        for first, second in combinations(chains, 2):
            pair = _best_pair(first, second)
            if pair is not None:
                pairs.append(pair)
    return pairs


def _best_pair(first: Sequence[ChainWithCandidates], second: Sequence[ChainWithCandidates]) -> Pair | None:
    """Choose the pair of limbs with the highest score in the chains of two sides; None without any."""
    best = None
    highest = 0.0
    for (chain, candidates), (image, in_image) in product(first, second):
        indices, score = _best_indices(candidates, in_image)
        if indices is not None and score > highest:
            best = (_limb(chain, indices), _limb(image, indices))
            highest = score
    return best


def _limb(chain: Chain, indices: ChainIndices) -> Limb:
    return Limb(*(chain.joints[number] for number in indices))


def _best_indices(
    in_first: Mapping[ChainIndices, Candidate], in_second: Mapping[ChainIndices, Candidate]
) -> tuple[ChainIndices | None, float]:
    """Choose the indices of a pair of limbs in two chains, and their score; None if no score is above 0.

    Both sides are scored together, at the same indices. A single side may carry a sword: what is left below
    the limb counts by the smaller one.
    """
    best = None
    highest = 0.0
    for indices in in_first.keys() & in_second.keys():
        candidate = in_first[indices]
        image = in_second[indices]
        if np.abs(np.log(candidate.lengths / image.lengths)).max() > LIMITS.length_difference:
            continue
        score = candidate.score + image.score
        below = WEIGHTS.left_below * min(candidate.left_below, image.left_below)
        score -= min(below, WEIGHTS.most_left_below)
        if score > highest or (score == highest and best is not None and indices < best):
            best = indices
            highest = score
    return best, highest


def limb_candidates(chain: Chain) -> dict[ChainIndices, Candidate]:
    """Find all pairs of segments of a chain that may be a limb."""
    count = len(chain)
    height = chain.tree.height
    candidates = {}
    for root in range(min(LIMITS.roots, count)):
        for hinge in range(root + 1, count - 1):
            for end in range(hinge + 1, count):
                lengths = chain.segments[[root, hinge], [hinge, end]]
                longest = lengths.max()
                if lengths.min() >= max(LIMITS.shortest * height, LIMITS.evenness * longest):
                    indices = ChainIndices(root, hinge, end)
                    candidates[indices] = _candidate(chain, indices, lengths)
    return candidates


def _candidate(chain: Chain, indices: ChainIndices, lengths: Array) -> Candidate:
    """Score two segments as a limb, with the weights of `Weights`."""
    bend = chain.bend(*indices)
    hinge_turns = chain.bend_ranges[indices.hinge] > LIMITS.bends / 2
    is_used = hinge_turns and bool(np.ptp(bend) > LIMITS.bends)
    uneven = WEIGHTS.uneven if is_used else WEIGHTS.uneven_unused
    total = float(lengths.sum())
    score = total / chain.tree.height - _penalty_of_passed(chain, indices, bend, is_used=is_used)
    score -= uneven * abs(float(np.log(lengths[0] / lengths[1])))
    if is_used:
        score += WEIGHTS.hinge_bends
    if chain.bend_ranges[indices.end] > LIMITS.bends / 2:
        score += WEIGHTS.end_bends
    if indices.end > indices.hinge + 1 and chain.left_below(indices.end) == 0:
        score -= WEIGHTS.leaf
    above = slice(indices.root + 1)
    if chain.segments[above, above].max() > LIMITS.clavicle * lengths[0]:
        score -= WEIGHTS.skipped
    holds_prop = is_used and _is_prop(chain, indices.end, lengths)
    left_below = 0.0 if holds_prop else chain.left_below(indices.end) / total - LIMITS.hand
    return Candidate(lengths, score, max(0.0, left_below))


def _penalty_of_passed(chain: Chain, indices: ChainIndices, bend: Array, *, is_used: bool) -> float:
    """Compute the penalty for the joints within the segments, which may split a bone or be the hinge.

    A joint within a segment whose bend changes, or at which fingers start, is less likely one that splits a
    bone.
    """
    passed = [*range(indices.root + 1, indices.hinge), *range(indices.hinge + 1, indices.end)]
    keeps_a_bend = bend.min() > LIMITS.knee_at_rest and not any(chain.is_kinked[joint] for joint in passed)
    usual = WEIGHTS.passed if is_used or keeps_a_bend else WEIGHTS.passed_unclear
    penalty = sum(
        WEIGHTS.passed_unclear if chain.bend_ranges[joint] > LIMITS.bends else usual for joint in passed
    )
    return penalty + (WEIGHTS.fan if any(chain.is_fan(joint) for joint in passed) else 0.0)


def _is_prop(chain: Chain, end: int, lengths: Array) -> bool:
    """Tell whether below the end of a limb is one rigid thing, longer than its segments: a ski or a sword.

    A stiff forearm and hand are one rigid thing too, but fingers start there.
    """
    if any(chain.is_fan(joint) for joint in range(end + 1, len(chain))):
        return False
    is_rigid = max(chain.bend_ranges[end + 1 :], default=0.0) < LIMITS.bends / 2
    return is_rigid and bool(chain.segments[end:, end:].max() > LIMITS.prop * lengths.max())


# Legs and arms ----------------------------------------------------------------------------------------------


def _length(tree: BodyTree, pair: Pair) -> float:
    """Return the mean length of the first limb of a pair, from its root to its end, in heights."""
    segments = np.diff(tree.positions[:, list(pair[0])], axis=1)
    return float(np.linalg.norm(segments, axis=-1).sum(axis=1).mean()) / tree.height


def _bend(tree: BodyTree, limb: Limb) -> Array:
    """Compute the bend of a limb's hinge, (F,), radians."""
    return Chain(tree, limb).bend(0, 1, 2)


def _is_used(tree: BodyTree, pair: Pair) -> bool:
    return all(np.ptp(_bend(tree, limb)) > LIMITS.bends for limb in pair)


def _share_on_floor(tree: BodyTree, pair: Pair) -> float:
    """Return the fraction of the frames in which a pair, below its hinges, holds the lowest joint."""
    lowest = tree.heights[:, tree.joints].min(axis=1)
    joints = [joint for limb in pair for joint in tree.below(limb.hinge)]
    is_low = tree.heights[:, joints].min(axis=1) < lowest + LIMITS.near_floor * tree.height
    return float(is_low.mean())


def _leg_score(tree: BodyTree, pair: Pair) -> float:
    """Legs are on the floor, long, and hang."""
    length = min(_length(tree, pair), 0.6)  # a longer pair is more likely a train or a wing than a leg
    return _share_on_floor(tree, pair) + 2 * length + _drop(tree, pair)


def _drop(tree: BodyTree, pair: Pair) -> float:
    """Return how far the ends of a pair are below its roots on average, in heights."""
    drops = [(tree.heights[:, limb.root] - tree.heights[:, limb.end]).mean() for limb in pair]
    return float(np.mean(drops)) / tree.height


def _arm_score(tree: BodyTree, pair: Pair, pelvis: int) -> float:
    """Arms are long, hang above the pelvis, and their elbows bend: no ears, braids and coat-tails."""
    chest = tree.last_common(pair[0].root, pair[1].root)
    score = _length(tree, pair)
    if chest not in tree.path(pelvis):
        score += 0.3
    if _is_used(tree, pair):
        score += 0.2
    return score


def _overlap(tree: BodyTree, pair: Pair, legs: Pair) -> bool:
    """Tell whether a limb of a pair is part of a leg, or hangs on it, or the other way round."""
    return any(_on_one_path(tree, limb.root, leg.root) for limb in pair for leg in legs)


def _on_one_path(tree: BodyTree, first: int, second: int) -> bool:
    return first in tree.path(second) or second in tree.path(first)


def _doubts_of_legs(
    tree: BodyTree, names: Sequence[str], legs: Pair, rivals: Sequence[Pair]
) -> Iterator[str]:
    smallest = LIMITS.rival * _leg_score(tree, legs)
    on_floor = [pair for pair in rivals if _share_on_floor(tree, pair) > LIMITS.forelegs]
    forelegs = [pair for pair in on_floor if _leg_score(tree, pair) > smallest]
    if forelegs:
        yield f"more than two limbs are on the floor: {_ends(names, [legs, forelegs[0]])}"
    if _share_on_floor(tree, legs) < 0.5:
        yield f"other joints are lower than {_ends(names, [legs])} in most frames"
    if _drop(tree, legs) < LIMITS.hanging * _length(tree, legs):
        yield f"the body lies or hangs, or up is another axis: the legs {_ends(names, [legs])} do not stand"
    if not _is_used(tree, legs):
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
    scores = [_arm_score(tree, pair, pelvis) for pair in ranked[:2]]
    if len(scores) > 1 and scores[1] > LIMITS.rival * scores[0]:
        yield f"the arms end at {_ends(names, ranked[:1])}, or at {_ends(names, ranked[1:2])}"


def _ends(names: Sequence[str], pairs: Sequence[Pair], part: str = "end") -> str:
    """Name the ends, or another part, of all limbs of some pairs."""
    return ", ".join(f"'{names[getattr(limb, part)]}'" for pair in pairs for limb in pair)


# Left and right ---------------------------------------------------------------------------------------------


def _left_first(
    tree: BodyTree, names: Sequence[str], legs: Pair, arms: Pair | None
) -> tuple[Pair, list[str]]:
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


# Roles ------------------------------------------------------------------------------------------------------


def _legs_by_role(tree: BodyTree, legs: Pair) -> dict[str, int]:
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


def _arms_by_role(tree: BodyTree, arms: Pair, legs: Pair) -> dict[str, int]:
    """Order two arms by the legs: shoulders and hips of one side are beside each other on average."""
    across = tree.positions[:, legs[0].root] - tree.positions[:, legs[1].root]
    across_arms = tree.positions[:, arms[0].root] - tree.positions[:, arms[1].root]
    left, right = arms if np.sum(across * across_arms) > 0 else arms[::-1]
    roles: dict[str, int] = {}
    for side, arm in (("left", left), ("right", right)):
        roles |= {f"{side} shoulder": arm.root, f"{side} elbow": arm.hinge, f"{side} wrist": arm.end}
    return roles


def _trunk_by_role(tree: BodyTree, arms: Pair, dofs: Sequence[str]) -> dict[str, int]:
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
