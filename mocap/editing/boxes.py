"""Constraints on a motion: boxes for the positions and for the rotations of its joints, measured alike.

Each kind has a value v of three numbers for a joint in a frame, in metres, and keeps it in a box, low ≤ v ≤
high. The same number twice holds an axis, -∞ and ∞ leave it free, and one of the two is a floor or a ceiling.
The residual of all of these is r = clip(v, low, high) - v.

The value of a position is the position p itself. The value of a rotation q is ℓ log(r⁻¹ q): the rotation
vector from a reference r to it, times a length ℓ = `TUNED.arm`, 0.3 m. [Gle98] and [LS99] list their
constraints kind by kind; boxes are ours. One value, `constraints.Pins`, holds the boxes of both kinds.
"""

from abc import ABC, abstractmethod

import numpy as np

from mocap._shared.arrays import Array, Mask, frozen
from mocap._shared.records import NamedTuple, dataclass
from mocap.body import rotations
from mocap.body.skeleton import Skeleton
from mocap.editing.displacements import right_jacobian
from mocap.editing.poses import ROOT, ROTATIONS, Frames, Poses, WorldAxes
from mocap.editing.tuned import TUNED
from mocap.errors import MocapError

# Metres. A value that is so near to the end of its box counts in the next step as if it were outside. With 0
# the step takes it far out.
MARGIN = 1e-4


class Boxes(ABC):
    """Boxes of one kind, for N joints in F frames: what both kinds have in common.

    `joints` are N indices; `low` and `high` are (F, N, 3), metres.
    """

    low: Array
    high: Array

    @property
    @abstractmethod
    def indices(self) -> list[int]:
        """The joint of each box."""

    @abstractmethod
    def values(self, poses: Poses) -> Array:
        """Compute what the boxes are for, (F, N, 3), metres."""

    @abstractmethod
    def jacobian(self, poses: Poses, axes: WorldAxes) -> Array:
        """Compute the derivatives of the values by a change of the pose, (F, N, 3, 3 + A).

        A change is a translation of the root, metres, and rotations about A axes, radians.
        """

    @abstractmethod
    def movers(self, skeleton: Skeleton) -> list[list[int]]:
        """List for each box the joints whose rotations change its value."""

    def __len__(self) -> int:
        return len(self.low)

    @property
    def held(self) -> Mask:
        """The axes that are held, (F, N, 3)."""
        return np.asarray(self.low == self.high)

    @property
    def bounded(self) -> Mask:
        """The axes that are not free, (F, N, 3)."""
        return np.asarray(np.isfinite(self.low) | np.isfinite(self.high))

    @property
    def constrained(self) -> Mask:
        """Whether a box is bounded on any axis, (F, N)."""
        return np.asarray(self.bounded.any(axis=-1))

    def residual(self, values: Array) -> Array:
        """Compute clip(v, low, high) - v, (F, N, 3), metres."""
        return np.asarray(np.clip(values, self.low, self.high) - values)

    def errors(self, poses: Poses) -> Array:
        """Compute the distances from the boxes, (F, N), metres."""
        return np.asarray(np.linalg.norm(self.residual(self.values(poses)), axis=-1))

    def active(self, values: Array) -> Mask:
        """Tell which axes a step must bring to their boxes or keep there, (F, N, 3).

        They are those that are held, and those outside of their box or within `MARGIN` of its ends.
        """
        return np.asarray(values != np.clip(values, self.low + MARGIN, self.high - MARGIN))


@dataclass(frozen=True, eq=False)
class PositionBoxes(Boxes):
    """Boxes for the positions of different joints [Gle98, constraints].

    Parameters
    ----------
    joints : P different joints, as indices.
    low, high : shape (F, P, 3), metres.

    Raises
    ------
    MocapError : for a low above its high, a number that is none, and a joint that is given twice.

    Examples
    --------
    >>> rail = PositionBoxes((4,), [[[0.3, 0.9, -np.inf]]], [[[0.3, 0.9, np.inf]]])
    >>> rail.held
    array([[[ True,  True, False]]])
    >>> rail.residual(np.zeros((1, 1, 3)))
    array([[[0.3, 0.9, 0. ]]])
    """

    joints: tuple[int, ...]
    low: Array
    high: Array

    def __post_init__(self) -> None:
        object.__setattr__(self, "joints", tuple(int(joint) for joint in self.joints))
        _freeze_ends(self)
        are_different = len(set(self.joints)) == len(self.joints)
        _check_ends(self, are_different=are_different)

    @property
    def indices(self) -> list[int]:
        """The joint of each box."""
        return list(self.joints)

    def __getitem__(self, frames: Frames) -> "PositionBoxes":
        """Select frames."""
        return PositionBoxes(self.joints, self.low[frames], self.high[frames])

    def limited_to(self, frames: Frames) -> "PositionBoxes":
        """Free the joints in all other frames."""
        return PositionBoxes(self.joints, *_ends_in(frames, self))

    def values(self, poses: Poses) -> Array:
        """Return the positions of the joints, (F, P, 3), metres."""
        return np.asarray(poses.positions[:, self.indices])

    def jacobian(self, poses: Poses, axes: WorldAxes) -> Array:
        """Compute the derivatives of the positions by a change of the pose, (F, P, 3, 3 + A).

        The root takes all joints along, ∂p = I. A rotation about an axis a through p_j moves a joint below by
        ∂p = a × (p - p_j).
        """
        jacobian = np.zeros((len(poses), len(self.joints), 3, ROTATIONS.start + len(axes.joints)))
        jacobian[..., ROOT] = np.eye(3)
        levers = poses.positions[:, self.indices, None] - poses.positions[:, None, axes.joints]
        rates = np.swapaxes(np.cross(axes.directions[:, None], levers), 2, 3)
        moves = axes.moves(self.movers(poses.motion.skeleton))
        jacobian[..., ROTATIONS] = np.where(moves[:, None], rates, 0.0)
        return jacobian

    def movers(self, skeleton: Skeleton) -> list[list[int]]:
        """List for each joint those above it."""
        return [skeleton.path_to_root(joint)[1:] for joint in self.joints]


class RelativeRotation(NamedTuple):
    """The rotation q of a joint in relation to a reference r.

    Parameters
    ----------
    joint : its index.
    reference : r, quaternions (F, 4).
    is_global : whether q is the joint's rotation in the world; else it is the one in its parent's frame.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> from mocap.editing.poses import poses_of
    >>> poses = poses_of(sample("walk_straight")[:2])
    >>> relative = RelativeRotation(0, poses.motion.rotations[:, 0], is_global=True)
    >>> float(abs(relative.vectors(poses)).max()) < 1e-12
    True
    """

    joint: int
    reference: Array
    is_global: bool

    def vectors(self, poses: Poses) -> Array:
        """Compute log(r⁻¹ q), (F, 3), radians."""
        if self.is_global:
            quaternions = rotations.from_matrix(poses.matrices[:, self.joint])
        else:
            quaternions = poses.motion.rotations[:, self.joint]
        return np.asarray(rotations.difference(self.reference, quaternions))


@dataclass(frozen=True, eq=False)
class RotationBoxes(Boxes):
    """Boxes for rotations [Gle98, joint limits; orientations].

    Parameters
    ----------
    rotations : R rotations of joints, each in relation to a reference of F frames.
    low, high : shape (F, R, 3), metres: rotation vectors times 0.3 m.

    Raises
    ------
    MocapError : for a low above its high, and a number that is none.

    Examples
    --------
    >>> free = RotationBoxes((), np.zeros((9, 0, 3)), np.zeros((9, 0, 3)))
    >>> len(free), free.indices
    (9, [])
    """

    rotations: tuple[RelativeRotation, ...]
    low: Array
    high: Array

    def __post_init__(self) -> None:
        _freeze_ends(self)
        _check_ends(self)

    @property
    def indices(self) -> list[int]:
        """The joint of each box."""
        return [rotation.joint for rotation in self.rotations]

    def __getitem__(self, frames: Frames) -> "RotationBoxes":
        """Select frames."""
        selected = [rotation._replace(reference=rotation.reference[frames]) for rotation in self.rotations]
        return RotationBoxes(tuple(selected), self.low[frames], self.high[frames])

    def limited_to(self, frames: Frames) -> "RotationBoxes":
        """Free the joints in all other frames."""
        return RotationBoxes(self.rotations, *_ends_in(frames, self))

    def values(self, poses: Poses) -> Array:
        """Compute ℓ log(r⁻¹ q), (F, R, 3), metres."""
        values = np.zeros((len(poses), len(self.rotations), 3))
        for number, rotation in enumerate(self.rotations):
            values[:, number] = TUNED.arm * rotation.vectors(poses)
        return values

    def jacobian(self, poses: Poses, axes: WorldAxes) -> Array:
        """Compute the derivatives of the values by a change of the pose, (F, R, 3, 3 + A).

        A joint with the rotation R in the world, rotated with a joint above it about an axis a of the world,
        rotates about Rᵀ a in its own frame. The rotation vector v = log(r⁻¹ q) then changes by
        J(v)⁻¹ Rᵀ a, where J is the right Jacobian.
        """
        jacobian = np.zeros((len(poses), len(self.rotations), 3, ROTATIONS.start + len(axes.joints)))
        vectors = self.values(poses) / TUNED.arm
        local = np.einsum("fpji,ftj->fpit", poses.matrices[:, self.indices], axes.directions)
        rates = TUNED.arm * np.linalg.solve(right_jacobian(vectors), local)
        moves = axes.moves(self.movers(poses.motion.skeleton))
        jacobian[..., ROTATIONS] = np.where(moves[:, None], rates, 0.0)
        return jacobian

    def movers(self, skeleton: Skeleton) -> list[list[int]]:
        """List for each rotation the joint itself, and for a global one the joints above it."""
        movers = []
        for rotation in self.rotations:
            path = skeleton.path_to_root(rotation.joint)
            movers.append(path if rotation.is_global else path[:1])
        return movers


def _ends_in(frames: Frames, boxes: Boxes) -> tuple[Array, Array]:
    """Return the ends of boxes in some frames, and infinite ones in all others."""
    keep = np.zeros((len(boxes), 1, 1), bool)
    keep[frames] = True
    return np.where(keep, boxes.low, -np.inf), np.where(keep, boxes.high, np.inf)


def _freeze_ends(boxes: Boxes) -> None:
    """Make read-only arrays of the ends of boxes."""
    for key in ("low", "high"):
        object.__setattr__(boxes, key, frozen(getattr(boxes, key), np.float64))


def _check_ends(boxes: Boxes, *, are_different: bool = True) -> None:
    """Raise `MocapError` unless there is a box for each joint in each frame, each with low ≤ high."""
    joints = boxes.indices
    shape = (len(boxes), len(joints), 3)
    if not are_different or boxes.low.shape != shape or boxes.high.shape != shape:
        raise MocapError(f"{len(joints)} different joints need boxes {shape}, got {boxes.low.shape}.")
    is_ordered = boxes.low <= boxes.high  # False for what is no number
    is_bounded = (boxes.low < np.inf) & (boxes.high > -np.inf)
    wrong = np.argwhere(~(is_ordered & is_bounded))
    if len(wrong):
        frame, number, axis = wrong[0]
        low = boxes.low[frame, number, axis]
        high = boxes.high[frame, number, axis]
        got = f"{low:.4g} and {high:.4g} for {'xyz'[axis]}"
        needs = f"a pin needs low ≤ high, got {got}; from -inf to inf an axis is free"
        raise MocapError(f"Frame {frame}, joint {joints[number]}: {needs}.")
