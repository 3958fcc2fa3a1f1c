"""The parts of a body in which limbs are looked for: bones that keep their lengths, and chains of them.

Nothing here reads a name. All lengths are in the unit of the positions.
"""

from collections.abc import Sequence
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from mocap._shared.arrays import Array, Indices
from mocap._shared.records import dataclass


@dataclass(frozen=True)
class TreeLimits:
    """When joints belong to one body, and when bones are one straight segment."""

    stretch: float = 0.04  # of the body's extent: what changes its distance by more is no bone (a still root)
    longest_bone: float = 0.6  # of the body's extent: what is farther from its parent is no part of the body
    reach_per_height: float = 1.5  # longest path along bones / height of people. 1.38 to 1.66 measured
    least_reach: float = 0.2  # of the body's height: a branch that reaches less is no limb, neck or trunk
    no_bone: float = 0.004  # of the body's height: a shorter bone only adds an axis of rotation to its joint
    most_joints: int = 12  # of a chain that are looked at, from the body outwards
    straight: float = 0.97  # distance / length along the bones of a segment
    rigid: float = 0.015  # of a segment's length: change of the distance of its ends
    kink: float = np.radians(0.6)  # radians: a smaller bend is rounding


LIMITS = TreeLimits()


class BodyTree:
    """The largest part of a skeleton whose bones keep their lengths; its joints keep their numbers.

    Roots that stay on the floor, targets of inverse kinematics and props are not part of it.

    Parameters
    ----------
    parents : shape (J,), as in a `Skeleton`.
    positions : shape (F, J, 3).
    up : the unit vector against gravity, (3,).

    Notes
    -----
    `lengths` (J,) are those of the joints' bones, `reach` the longest path down from each joint, and `height`
    estimates how tall the body is.

    Examples
    --------
    A root on the floor, and a pelvis from which two legs hang:

    >>> heights = np.array([0.0, 1.0, 0.5, 0.0, 0.5, 0.0])
    >>> tree = BodyTree([-1, 0, 1, 2, 1, 4], np.outer(heights, [0, 1, 0])[None], [0, 1, 0])
    >>> tree.joints, tree.children[1], tree.path(3)
    ([1, 2, 3, 4, 5], [2, 4], [1, 2, 3])
    """

    def __init__(self, parents: ArrayLike, positions: Array, up: ArrayLike) -> None:
        self.positions = positions
        self.up = np.asarray(up, float)
        self.heights = positions @ self.up  # (F, J)
        parents = np.asarray(parents)
        self.lengths = np.median(_bone_lengths(parents, positions), axis=0)
        self.joints = largest_part(parents, positions)
        self._set_top(parents, self.joints[0])
        branches = self._branches()
        while len(branches) == 1:
            self.joints = self.below(branches[0])
            self._set_top(parents, branches[0])
            branches = self._branches()

    def _set_top(self, parents: Array, top: int) -> None:
        """List the children of the part's joints, and the longest path down from each of them."""
        self.parents = {joint: int(parents[joint]) for joint in self.joints if joint != top}
        self.children: dict[int, list[int]] = {joint: [] for joint in self.joints}
        for joint, parent in self.parents.items():
            self.children[parent].append(joint)
        self.reach = dict.fromkeys(self.joints, 0.0)
        for joint in reversed(self.joints):
            if joint != top:
                parent = self.parents[joint]
                self.reach[parent] = max(self.reach[parent], self._reach_with_bone(joint))
        self.height = self._longest_path() / LIMITS.reach_per_height

    def _reach_with_bone(self, joint: int) -> float:
        return float(self.lengths[joint]) + self.reach[joint]

    def _branches(self) -> list[int]:
        """List the children of the top joint on which limbs may hang."""
        shortest = LIMITS.least_reach * self.height
        return [child for child in self.children[self.joints[0]] if self._reach_with_bone(child) > shortest]

    def _longest_path(self) -> float:
        """Return the longest path along bones between two ends: it shows the height in any pose."""
        longest = 0.0
        for children in self.children.values():
            reaches = sorted((self._reach_with_bone(child) for child in children), reverse=True)
            longest = max(longest, sum(reaches[:2]))
        return longest

    def path(self, joint: int) -> list[int]:
        """List the joints from the top of the body to a joint."""
        path = [joint]
        while path[-1] in self.parents:
            path.append(self.parents[path[-1]])
        return path[::-1]

    def below(self, joint: int) -> list[int]:
        """List a joint and all that hang on it, parents first."""
        joints = [joint]
        for above in joints:
            joints += self.children[above]
        return sorted(joints)

    def last_common(self, first: int, second: int) -> int:
        """Return the lowest joint on which two others both hang."""
        shared = set(self.path(first)[:-1]) & set(self.path(second)[:-1])
        return max(shared)  # parents have lower numbers than their children

    def chain(self, top: int, branching: int | None = None) -> "Chain":
        """Follow the longest path down from a joint, without joints at the position of their parent.

        At the joint `branching`, the second longest path is followed.
        """
        path = self._path_down(top, branching)
        shortest = LIMITS.no_bone * self.height
        joints = [top] + [joint for joint in path[1:] if self.lengths[joint] > shortest]
        return Chain(self, joints[: LIMITS.most_joints])

    def _path_down(self, top: int, branching: int | None = None) -> list[int]:
        path = [top]
        while below := self.children[path[-1]]:
            longest_first = sorted(below, key=self._reach_with_bone, reverse=True)
            path.append(longest_first[path[-1] == branching])
        return path

    def chains(self, top: int, shortest: float) -> list["Chain"]:
        """List the longest chain down from a joint, and those that leave it for the second longest.

        A shield may be longer than the forearm that it hangs on.

        Parameters
        ----------
        top : the first joint of all chains.
        shortest : the least length of what follows after a chain has left the longest one.
        """
        chains = [self.chain(top)]
        for joint in self._path_down(top):
            reaches = [self._reach_with_bone(child) for child in self.children[joint]]
            if sum(reach > shortest for reach in reaches) > 1:
                chains.append(self.chain(top, joint))
        return chains


def _bone_lengths(parents: Indices, positions: Array) -> Array:
    """Measure each joint's bone to its parent, (F, J); that of the root means nothing."""
    return np.asarray(np.linalg.norm(positions - positions[:, parents], axis=-1))


def largest_part(parents: Indices, positions: Array) -> list[int]:
    """List the joints of the largest part of a tree whose bones keep their lengths.

    Parameters
    ----------
    parents : shape (J,), as in a `Skeleton`.
    positions : in the world, (F, J, 3).

    Examples
    --------
    The second joint moves away from the first, and the third follows it:

    >>> positions = np.zeros((9, 3, 3))
    >>> positions[:, 1:, 0] = np.arange(9)[:, None]
    >>> positions[:, 2, 1] = 0.1
    >>> largest_part(np.array([-1, 0, 1]), positions)
    [1, 2]
    """
    lengths = _bone_lengths(parents, positions)
    extent = np.median(np.linalg.norm(extents(positions), axis=1))
    short, usual, long = np.quantile(lengths, (0.05, 0.5, 0.95), axis=0)
    is_bone = (long - short < LIMITS.stretch * extent) & (usual < LIMITS.longest_bone * extent)
    part = np.arange(len(parents))
    for joint in range(1, len(parents)):
        if is_bone[joint]:
            part[joint] = part[parents[joint]]
    return [int(joint) for joint in np.flatnonzero(part == np.bincount(part).argmax())]


def extents(positions: Array) -> Array:
    """Return the extents along x, y and z of the box around all joints in each frame, (F, 3).

    Examples
    --------
    >>> extents(np.array([[[0.0, 0.0, 1.0], [2.0, 0.0, 4.0]]]))
    array([[2., 0., 3.]])
    """
    columns = [np.ptp(positions[..., axis], axis=1) for axis in range(3)]  # six times as fast as one call
    return np.stack(columns, axis=-1)


class Chain:
    """Joints one below the other, from the body outwards, and the angles between them.

    Parameters
    ----------
    tree : the body.
    joints : n joints, each below the one before.
    """

    def __init__(self, tree: BodyTree, joints: Sequence[int]) -> None:
        self.tree = tree
        self.joints = list(joints)

    def __len__(self) -> int:
        return len(self.joints)

    @cached_property
    def distances(self) -> Array:
        """Distances between any two joints of the chain in each frame, (F, n, n)."""
        positions = self.tree.positions[:, self.joints]
        return np.asarray(np.linalg.norm(positions[:, :, None] - positions[:, None], axis=-1))

    @cached_property
    def along(self) -> Array:
        """Lengths along the bones from the chain's first joint to each of them, (n,)."""
        lengths = [0.0]
        for above, joint in zip(self.joints, self.joints[1:], strict=False):
            between = self.tree.path(joint)[len(self.tree.path(above)) :]
            lengths.append(lengths[-1] + float(self.tree.lengths[between].sum()))
        return np.array(lengths)

    def bend(self, first: int, middle: int, last: int) -> Array:
        """Compute the angle of the bend at `middle` between two others of the chain, (F,), radians.

        By the law of cosines: 0 where the three are in line.
        """
        upper = self.distances[:, first, middle]
        lower = self.distances[:, middle, last]
        across = self.distances[:, first, last]
        cosines = (across**2 - upper**2 - lower**2) / np.maximum(2 * upper * lower, 1e-300)
        return np.asarray(np.arccos(np.clip(cosines, -1.0, 1.0)))

    @cached_property
    def segments(self) -> Array:
        """Lengths of the straight segments between any two joints, (n, n); 0 if a joint between them bends.

        A single bone always is one, even if its length changes a little, as in bodies estimated from video.
        """
        count = len(self)
        lengths = np.zeros((count, count))
        for first in range(count):
            for last in range(first + 1, count):
                lengths[first, last] = self._segment(first, last)
        return lengths

    def _segment(self, first: int, last: int) -> float:
        along = float(self.along[last] - self.along[first])
        if last == first + 1:
            return along
        distances = self.distances[:, first, last]
        is_straight = distances.min() > LIMITS.straight * along
        return along if is_straight and np.ptp(distances) < LIMITS.rigid * along else 0.0

    @cached_property
    def is_kinked(self) -> list[bool]:
        """Whether the chain ever bends at each joint; the ends count as bent."""
        inner = range(1, len(self) - 1)
        bent = [bool(self.bend(index - 1, index, index + 1).max() > LIMITS.kink) for index in inner]
        return [True, *bent, True][: len(self)]

    @cached_property
    def bend_ranges(self) -> list[float]:
        """Range over the frames of the bend at each joint, radians; 0 at the ends."""
        inner = range(1, len(self) - 1)
        ranges = [float(np.ptp(self.bend(index - 1, index, index + 1))) for index in inner]
        return [0.0, *ranges, 0.0][: len(self)]

    def is_fan(self, index: int) -> bool:
        """Return whether three or more bones start at a joint, as fingers do at a hand."""
        shortest = LIMITS.no_bone * self.tree.height
        children = self.tree.children[self.joints[index]]
        return len([child for child in children if self.tree.lengths[child] > shortest]) >= 3

    def left_below(self, index: int) -> float:
        """Return the length along the bones from a joint to the farthest end below it."""
        return self.tree.reach[self.joints[index]]
