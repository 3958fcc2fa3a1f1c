"""The positions and rotations of a motion's joints in the world: computed once, and handed on with it."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from mocap._shared.arrays import Array, Indices, Mask
from mocap._shared.records import NamedTuple, dataclass
from mocap.body.kinematics import GlobalPoses, forward_kinematics
from mocap.body.motion import Motion

Frames = slice | Sequence[int] | NDArray[np.intp] | Mask

# A change of a pose is a row of numbers: of the root's position, then a rotation about each axis of a body.
ROOT = slice(0, 3)
ROTATIONS = slice(3, None)


@dataclass(frozen=True, eq=False)
class Poses:
    """A motion together with its forward kinematics, which is the costly part of most measurements.

    Functions of this package that take a motion also take its poses, and then compute them no more.

    Parameters
    ----------
    motion : F frames of J joints.
    positions : shape (F, J, 3), metres, in the world.
    matrices : shape (F, J, 3, 3), rotations in the world.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> poses = poses_of(sample("walk_straight"))
    >>> poses[10:12].positions.shape, len(poses[10:12].motion)
    ((2, 38, 3), 2)
    """

    motion: Motion
    positions: Array
    matrices: Array

    def __len__(self) -> int:
        return len(self.motion)

    def __getitem__(self, frames: Frames) -> "Poses":
        """Select frames by a slice, by indices or by a mask."""
        return Poses(self.motion[frames], self.positions[frames], self.matrices[frames])

    @property
    def world(self) -> GlobalPoses:
        """The positions and matrices, as `forward_kinematics` returns them."""
        return GlobalPoses(self.positions, self.matrices)

    def updated(self, motion: Motion) -> "Poses":
        """Return the poses of a changed motion; these if it is the same motion."""
        return self if motion is self.motion else poses_of(motion)

    def with_frames_of(self, source: "Poses", chosen: Mask) -> "Poses":
        """Replace the chosen frames (F,) by those of the source: poses and contacts, to the last bit."""
        if source is self or not chosen.any():
            return self
        positions = np.where(chosen[:, None, None], source.positions, self.positions)
        matrices = np.where(chosen[:, None, None, None], source.matrices, self.matrices)
        return Poses(with_frames_of(self.motion, source.motion, chosen), positions, matrices)

    def with_part(self, part: "Poses", frames: slice | Indices) -> "Poses":
        """Replace some frames by all those of a part, with their contacts."""
        if len(part) == len(self):
            return part
        positions = self.positions.copy()
        positions[frames] = part.positions
        matrices = self.matrices.copy()
        matrices[frames] = part.matrices
        return Poses(with_part(self.motion, part.motion, frames), positions, matrices)


MotionOrPoses = Motion | Poses


def poses_of(motion: MotionOrPoses) -> Poses:
    """Return the poses of a motion, by forward kinematics; poses as they are.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> poses = poses_of(sample("walk_straight")[:9])
    >>> poses_of(poses) is poses
    True
    """
    if isinstance(motion, Poses):
        return motion
    world = forward_kinematics(motion)
    return Poses(motion, world.positions, world.matrices)


def motion_of(motion: MotionOrPoses) -> Motion:
    """Return the motion of poses; a motion as it is.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> walk = sample("walk_straight")[:9]
    >>> motion_of(walk) is motion_of(poses_of(walk)) is walk
    True
    """
    return motion.motion if isinstance(motion, Poses) else motion


def with_frames_of(motion: Motion, source: Motion, chosen: Mask) -> Motion:
    """Replace the chosen frames (F,) by those of the source: poses and contacts, to the last bit."""
    if not chosen.any():
        return motion
    roots = np.where(chosen[:, None], source.root_positions, motion.root_positions)
    local = np.where(chosen[:, None, None], source.rotations, motion.rotations)
    contacts = dict(motion.contacts)
    for name, mark in source.contacts.items():
        contacts[name] = np.where(chosen, mark, contacts.get(name, mark))
    return replace(motion, root_positions=roots, rotations=local, contacts=contacts)


def with_part(motion: Motion, part: Motion, frames: slice | Indices) -> Motion:
    """Replace some frames by all those of a part, with their contacts."""
    if len(part) == len(motion):
        return part
    roots = motion.root_positions.copy()
    roots[frames] = part.root_positions
    local = motion.rotations.copy()
    local[frames] = part.rotations
    contacts = {name: mark.copy() for name, mark in motion.contacts.items()}
    for name, mark in part.contacts.items():
        contacts.setdefault(name, np.zeros(len(motion), bool))[frames] = mark
    return replace(motion, root_positions=roots, rotations=local, contacts=contacts)


class WorldAxes(NamedTuple):
    """Axes of rotation in the world: A axes, each of a joint.

    Parameters
    ----------
    joints : shape (A,), the joint that rotates about each axis.
    directions : shape (F, A, 3), unit vectors, or others if a radian counts as more or less than one.

    Examples
    --------
    >>> upright = WorldAxes(np.array([2]), np.array([[[0.0, 1.0, 0.0]]]))
    >>> upright.moves([[0, 1], [0, 2]]).tolist()  # joints above two others: only the second one is moved
    [[False], [True]]
    """

    joints: Indices
    directions: Array

    def moves(self, movers: Sequence[Sequence[int]]) -> Mask:
        """Tell which axes belong to a joint of each list, (lists, A)."""
        return np.array([np.isin(self.joints, joints) for joints in movers]).reshape(-1, len(self.joints))
