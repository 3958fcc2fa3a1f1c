"""Pairs of limbs: two segments each, which hang side by side and are mirror images by their lengths.

`limb_search` takes the legs and the arms of a body from them.
"""

from collections.abc import Mapping, Sequence
from itertools import combinations, product

import numpy as np

from mocap._shared.arrays import Array
from mocap._shared.records import NamedTuple, dataclass
from mocap.body.limb_tree import BodyTree, Chain


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


def length_of(tree: BodyTree, pair: Pair) -> float:
    """Return the mean length of the first limb of a pair, from its root to its end, in heights."""
    segments = np.diff(tree.positions[:, list(pair[0])], axis=1)
    return float(np.linalg.norm(segments, axis=-1).sum(axis=1).mean()) / tree.height


def _bend(tree: BodyTree, limb: Limb) -> Array:
    """Compute the bend of a limb's hinge, (F,), radians."""
    return Chain(tree, limb).bend(0, 1, 2)


def is_used(tree: BodyTree, pair: Pair) -> bool:
    """Check whether the hinges of both limbs bend in these frames."""
    return all(np.ptp(_bend(tree, limb)) > LIMITS.bends for limb in pair)


def fraction_on_floor(tree: BodyTree, pair: Pair) -> float:
    """Return the fraction of the frames in which a pair, below its hinges, holds the lowest joint."""
    lowest = tree.heights[:, tree.joints].min(axis=1)
    joints = [joint for limb in pair for joint in tree.below(limb.hinge)]
    is_low = tree.heights[:, joints].min(axis=1) < lowest + LIMITS.near_floor * tree.height
    return float(is_low.mean())


def leg_score(tree: BodyTree, pair: Pair) -> float:
    """Legs are on the floor, long, and hang."""
    length = min(length_of(tree, pair), 0.6)  # a longer pair is more likely a train or a wing than a leg
    return fraction_on_floor(tree, pair) + 2 * length + drop_of(tree, pair)


def drop_of(tree: BodyTree, pair: Pair) -> float:
    """Return how far the ends of a pair are below its roots on average, in heights."""
    drops = [(tree.heights[:, limb.root] - tree.heights[:, limb.end]).mean() for limb in pair]
    return float(np.mean(drops)) / tree.height


def arm_score(tree: BodyTree, pair: Pair, pelvis: int) -> float:
    """Arms are long, hang above the pelvis, and their elbows bend: no ears, braids and coat-tails."""
    chest = tree.last_common(pair[0].root, pair[1].root)
    score = length_of(tree, pair)
    if chest not in tree.path(pelvis):
        score += 0.3
    if is_used(tree, pair):
        score += 0.2
    return score


def overlap(tree: BodyTree, pair: Pair, legs: Pair) -> bool:
    """Tell whether a limb of a pair is part of a leg, or hangs on it, or the other way round."""
    return any(_on_one_path(tree, limb.root, leg.root) for limb in pair for leg in legs)


def _on_one_path(tree: BodyTree, first: int, second: int) -> bool:
    return first in tree.path(second) or second in tree.path(first)
