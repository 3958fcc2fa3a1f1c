"""Skeletons: trees of joints with offsets."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import field
from functools import cached_property
from textwrap import shorten
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mocap._shared.arrays import Array, Indices, VectorsLike, frozen
from mocap._shared.records import dataclass, rebuilding, same_fields
from mocap.errors import MocapError, SkeletonMismatch, shortened

_LEFT = ("left", "Left", "_l", "_L", "l", "L")
_RIGHT = ("right", "Right", "_r", "_R", "r", "R")
_SIDES = [pair for left, right in zip(_LEFT, _RIGHT, strict=True) for pair in ((left, right), (right, left))]

SAME_OFFSET = 1e-4  # metres: files of one body differ by less, where each writes rounded positions of joints


@dataclass(frozen=True, eq=False)
class Skeleton:
    """A tree of joints. End sites are ordinary joints without children.

    Parameters
    ----------
    names : J unique names.
    parents : shape (J,), the index of each joint's parent; -1 for joint 0, the root, and
        `parents[j] < j` for every other.
    offsets : shape (J, 3), metres: the position of a joint in the frame of its parent.
    axes : shape (J, 4), quaternions C: the orientation of a joint's axes in its file, relative to its
        parent's frame. Angles M in the file are the rotation C M C⁻¹. By default the identity.
    dofs : the axes of a joint's rotations, in the order of rotations about fixed axes, such as "xyz" or "x";
        by default "xyz", and "" for a joint without children. `axes` and `dofs` describe the angles of a file
        only. In a motion, a joint may have any rotation.
    roles : names of joints by their role in a body, such as {"left knee": "calf_l"}; by default none, because
        `body.find_legs` knows the names of many files. `body.with_roles` and `files.load` set them.

    Raises
    ------
    MocapError : if one of these does not hold.

    Notes
    -----
    Two skeletons are equal, `==`, if all fields are exactly equal, and then have the same hash.
    `require_same` is less strict: it accepts offsets that agree within 0.1 mm, and ignores `axes` and `dofs`.

    Examples
    --------
    >>> leg = Skeleton(["hip", "knee", "ankle"], [-1, 0, 1], [[0, 0, 0], [0, -0.4, 0], [0, -0.4, 0]])
    >>> len(leg), leg.index("knee"), leg.children(1)
    (3, 1, [2])

    Notebook: 01b-motion-files
    """

    names: Sequence[str]
    parents: NDArray[np.intp]
    offsets: Array
    axes: Array = field(default_factory=lambda: np.empty((0, 4)))
    dofs: Sequence[str] = ()
    roles: Mapping[str, str] = field(default_factory=dict)

    if TYPE_CHECKING:  # the types that callers may pass: `__post_init__` converts them to arrays

        def __init__(  # noqa: PLR0913 (the fields)
            self,
            names: Sequence[str],
            parents: ArrayLike,
            offsets: VectorsLike,
            axes: VectorsLike = ...,
            dofs: Sequence[str] = ...,
            roles: Mapping[str, str] = ...,
        ) -> None: ...

    def __post_init__(self) -> None:
        object.__setattr__(self, "names", tuple(self.names))
        object.__setattr__(self, "parents", frozen(self.parents, np.intp))
        object.__setattr__(self, "offsets", frozen(self.offsets, np.float64))
        self._check_tree()
        count = len(self.names)
        identities = np.tile([1.0, 0.0, 0.0, 0.0], (count, 1))
        object.__setattr__(self, "axes", frozen(self.axes if len(self.axes) else identities, np.float64))
        ball_joints = ["xyz" if joint in self.parents else "" for joint in range(count)]
        object.__setattr__(self, "dofs", tuple(self.dofs or ball_joints))
        if self.axes.shape != (count, 4) or not np.allclose(np.linalg.norm(self.axes, axis=-1), 1):
            raise MocapError(f"{count} joints need axes ({count}, 4) of length 1, got {self.axes.shape}.")
        if len(self.dofs) != count:
            raise MocapError(f"{count} joints need as many dofs, got {len(self.dofs)}.")
        for name, axes in zip(self.names, self.dofs, strict=True):
            if not set(axes) <= set("xyz") or len(set(axes)) < len(axes):
                raise MocapError(f"Joint '{name}' needs dofs such as 'xyz', 'x' or '', got '{axes}'.")
        object.__setattr__(self, "roles", dict(self.roles))
        for name in self.roles.values():
            self.index(name)

    @classmethod
    def from_table(cls, rows: Mapping[str, tuple[str, ArrayLike]], scale: float = 1.0) -> Skeleton:
        """Build a skeleton from {joint: (parent, offset)}, the root first, with "" as its parent.

        Examples
        --------
        >>> Skeleton.from_table({"hip": ("", [0, 0, 0]), "knee": ("hip", [0, -4, 0])}, scale=0.1).offsets[1]
        array([ 0. , -0.4,  0. ])
        """
        names = list(rows)
        parents = [names.index(parent) if parent else -1 for parent, _ in rows.values()]
        return cls(names, np.array(parents), scale * np.array([place for _, place in rows.values()], float))

    def _check_tree(self) -> None:
        count = len(self.names)
        if count == 0:
            raise MocapError("A skeleton needs at least one joint.")
        if len(set(self.names)) < count:
            twice = sorted({name for name in self.names if self.names.count(name) > 1})
            raise MocapError(f"Joint names must be unique; given twice: {', '.join(twice)}.")
        if self.parents.shape != (count,) or self.offsets.shape != (count, 3):
            needs = f"{count} joints need parents ({count},) and offsets ({count}, 3)"
            raise MocapError(f"{needs}, got {self.parents.shape} and {self.offsets.shape}.")
        if self.parents[0] != -1 or np.any(self.parents[1:] < 0):
            raise MocapError("Joint 0, and no other, is the root with parent -1.")
        early = self.parents >= np.arange(count)
        if early.any():
            raise MocapError(f"Joint '{self.names[int(early.argmax())]}' stands before its parent.")
        if not np.isfinite(self.offsets).all():
            joint = self.names[int(np.argwhere(~np.isfinite(self.offsets))[0, 0])]
            raise MocapError(f"The offset of joint '{joint}' is not a finite number.")

    def __len__(self) -> int:
        return len(self.names)

    def __repr__(self) -> str:
        joints = f"{len(self)} {'joint' if len(self) == 1 else 'joints'}"
        return f"Skeleton({joints}, root '{shortened(self.names[0])}')"

    def __eq__(self, other: object) -> bool:  # reads: name: Python's word for it
        return same_fields(self, other) if isinstance(other, Skeleton) else NotImplemented

    def __hash__(self) -> int:
        return hash((self.names, self.dofs))

    def __reduce__(self) -> tuple[Callable[..., Any], tuple[Any, ...]]:
        return rebuilding(self)

    def index(self, name: str) -> int:
        """Return the index of a joint by its name."""
        if name not in self.names:
            raise MocapError(f"No joint '{name}'; there are: {shorten(', '.join(self.names), 150)}.")
        return self.names.index(name)

    def children(self, joint: int) -> list[int]:
        """List the joints whose parent is `joint`."""
        return [int(child) for child in np.flatnonzero(self.parents == joint)]

    def path_to_root(self, joint: int) -> list[int]:
        """List a joint and its ancestors, up to the root.

        Examples
        --------
        >>> Skeleton(["hip", "knee", "ankle"], [-1, 0, 1], np.eye(3)).path_to_root(2)
        [2, 1, 0]
        """
        path = [int(joint)]
        while path[-1] != 0:
            path.append(int(self.parents[path[-1]]))
        return path

    @cached_property
    def rest(self) -> Array:
        """Joint positions of the rest pose, with the root at the origin and no rotations, (J, 3), metres.

        Examples
        --------
        >>> Skeleton(["hip", "knee", "ankle"], [-1, 0, 1], [[5, 5, 5], [0, -1, 0], [0, -1, 0]]).rest[2]
        array([ 0., -2.,  0.])
        """
        places = np.zeros((len(self), 3))
        for joint in range(1, len(self)):
            places[joint] = places[self.parents[joint]] + self.offsets[joint]
        return frozen(places, np.float64)

    def side(self, joint: int) -> str:
        """Return the side of a joint by its name: "left" or "right" if it has a mirror image, else "middle".

        Examples
        --------
        >>> body = Skeleton(["lowerback", "lfoot", "rfoot"], [-1, 0, 0], np.eye(3))
        >>> [body.side(joint) for joint in range(3)]
        ['middle', 'left', 'right']
        """
        name = self.names[joint]
        image = self.names[self.partner(joint)]
        if name == image:
            return "middle"
        return "left" if name < image else "right"  # an l comes before an r

    def partner(self, joint: int) -> int:
        """Return the mirror image of a joint by its name, or the joint itself if it is in the middle.

        Examples
        --------
        >>> body = Skeleton(["lowerback", "lfoot", "rfoot"], [-1, 0, 0], np.eye(3))
        >>> [body.partner(joint) for joint in range(3)]
        [0, 2, 1]
        """
        name = self.names[joint]
        for side, opposite in _SIDES:
            image = name.replace(side, opposite, 1)
            if side in name and image in self.names:
                return self.names.index(image)
        return joint

    # reads: name: the other skeleton, as in `__eq__`
    def require_same(self, other: Skeleton) -> None:
        """Raise `SkeletonMismatch` unless `other` has the same joints, tree and offsets, within 0.1 mm."""
        if self is other:
            return
        if missing := set(self.names) ^ set(other.names):
            names = shorten(", ".join(sorted(missing)), 80)
            raise SkeletonMismatch(f"The skeletons differ in these joints: {names}. Retarget one first.")
        if tuple(self.names) != tuple(other.names) or not np.array_equal(self.parents, other.parents):
            raise SkeletonMismatch(
                "The skeletons have the same joints in another order or tree. Retarget one first."
            )
        gaps = np.linalg.norm(self.offsets - other.offsets, axis=-1)
        if gaps.max() > SAME_OFFSET:
            worst = f"'{self.names[gaps.argmax()]}' sits {100 * gaps.max():.2g} cm apart"
            raise SkeletonMismatch(f"The skeletons' bones differ: {worst}. Retarget one first.")

    # reads: name: the other skeleton, as in `__eq__`
    def joints_in(self, other: Skeleton) -> Indices:
        """Return the index of each joint in a skeleton that may differ in end sites, -1 if it has none, (J,).

        Raises
        ------
        SkeletonMismatch : if they differ in more than end sites.

        Examples
        --------
        >>> short = Skeleton(["neck", "head"], [-1, 0], np.zeros((2, 3)))
        >>> Skeleton(["neck", "head", "head_end"], [-1, 0, 1], np.zeros((3, 3))).joints_in(short)
        array([ 0,  1, -1])
        """
        self._without_ends.require_same(other._without_ends)
        return np.array([other.names.index(name) if name in other.names else -1 for name in self.names])

    @cached_property
    def _without_ends(self) -> Skeleton:
        """The skeleton without end sites: leaves with the names that the BVH reader gives them."""
        above = (f"{self.names[parent]}_end" for parent in self.parents)
        ends = [name.startswith(end) for name, end in zip(self.names, above, strict=True)]
        keep = [joint for joint, end in enumerate(ends) if joint in self.parents or not end]
        parents = [keep.index(self.parents[joint]) if joint else -1 for joint in keep]
        return Skeleton([self.names[joint] for joint in keep], np.array(parents), self.offsets[keep])


def reaches(skeleton: Skeleton) -> Array:
    """Compute the length of the longest chain of bones below each joint, shape (J,), metres.

    Examples
    --------
    >>> leg = Skeleton(["hip", "knee", "ankle"], [-1, 0, 1], [[0, 0, 0], [0, -0.4, 0], [0, -0.5, 0]])
    >>> reaches(leg)
    array([0.9, 0.5, 0. ])
    """
    lengths = np.linalg.norm(skeleton.offsets, axis=-1)
    reach = np.zeros(len(skeleton))
    for joint in range(len(skeleton) - 1, 0, -1):
        parent = skeleton.parents[joint]
        reach[parent] = max(reach[parent], reach[joint] + lengths[joint])
    return reach
