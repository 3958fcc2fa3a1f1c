"""All constraints on a motion, on positions and on rotations, as one value: `Pins`.

A solver needs of them the residuals and the Jacobian, row by row. They are computed kind by kind, in `boxes`,
and joined here.
"""

from collections.abc import Sequence
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from mocap._shared.arrays import Array, Mask
from mocap._shared.records import dataclass
from mocap.body.skeleton import Skeleton
from mocap.editing.boxes import Boxes, PositionBoxes, RotationBoxes
from mocap.editing.poses import Frames, Poses, WorldAxes
from mocap.errors import MocapError
from mocap.feet.ankle_targets import smooth_fill

NO_ROTATIONS = RotationBoxes((), np.zeros((0, 0, 3)), np.zeros((0, 0, 3)))


@dataclass(frozen=True, eq=False)
class Pins:
    """Constraints on the positions of P joints, and on R rotations, in F frames [Gle98, constraints].

    Parameters
    ----------
    joints : P different joints, as indices.
    low, high : shape (F, P, 3), metres: boxes for their positions. An axis is held where they are equal, and
        free from -∞ to ∞.
    rotations : boxes for R rotations, from `limit_turns` and `keep_turned`; by default none.

    Raises
    ------
    MocapError : for a low above its high, a number that is none, a joint that is given twice, and boxes for
        rotations in another number of frames.

    Examples
    --------
    >>> rail = Pins((4,), [[[0.3, 0.9, -np.inf]]], [[[0.3, 0.9, np.inf]]])
    >>> rail.held
    array([[[ True,  True, False]]])
    >>> rail.positions.residual(np.zeros((1, 1, 3)))
    array([[[0.3, 0.9, 0. ]]])

    Notebook: 14-levels
    """

    joints: tuple[int, ...]
    low: Array
    high: Array
    rotations: RotationBoxes = NO_ROTATIONS

    if TYPE_CHECKING:  # what a caller may pass: `__post_init__` makes arrays of it

        def __init__(
            self, joints: Sequence[int], low: ArrayLike, high: ArrayLike, rotations: RotationBoxes = ...
        ) -> None: ...

    def __post_init__(self) -> None:
        positions = PositionBoxes(self.joints, self.low, self.high)
        for key in ("joints", "low", "high"):
            object.__setattr__(self, key, getattr(positions, key))
        if not self.rotations.indices:
            no_boxes = np.zeros((len(positions), 0, 3))
            object.__setattr__(self, "rotations", RotationBoxes((), no_boxes, no_boxes))
        if len(self.rotations) != len(self):
            counts = f"{len(self)} and {len(self.rotations)}"
            raise MocapError(f"Positions and rotations need boxes in the same frames, got {counts} frames.")

    def __len__(self) -> int:
        return len(self.low)

    @cached_property
    def positions(self) -> PositionBoxes:
        """The boxes for positions."""
        return PositionBoxes(self.joints, self.low, self.high)

    @property
    def kinds(self) -> tuple[Boxes, Boxes]:
        """Both kinds of constraint: on positions, and on rotations."""
        return self.positions, self.rotations

    @property
    def indices(self) -> list[int]:
        """The joint of each of the P + R boxes, those of positions first."""
        return [joint for boxes in self.kinds for joint in boxes.indices]

    @property
    def held(self) -> Mask:
        """The axes that are held, (F, P + R, 3)."""
        return np.hstack([boxes.held for boxes in self.kinds])

    @property
    def bounded(self) -> Mask:
        """The axes that are not free, (F, P + R, 3)."""
        return np.hstack([boxes.bounded for boxes in self.kinds])

    @property
    def constrained(self) -> Mask:
        """Whether a joint is constrained on any axis, (F, P + R)."""
        return np.hstack([boxes.constrained for boxes in self.kinds])

    def __getitem__(self, frames: Frames) -> "Pins":
        """Select frames."""
        return Pins(self.joints, self.low[frames], self.high[frames], self.rotations[frames])

    def limited_to(self, frames: Frames) -> "Pins":
        """Free the joints in all other frames."""
        positions = self.positions.limited_to(frames)
        return Pins(self.joints, positions.low, positions.high, self.rotations.limited_to(frames))

    def movers(self, skeleton: Skeleton) -> list[list[int]]:
        """List for each box the joints whose rotations change its value."""
        return [joints for boxes in self.kinds for joints in boxes.movers(skeleton)]

    def errors(self, poses: Poses) -> Array:
        """Compute the distances from the boxes, (F, P + R), metres."""
        return np.hstack([boxes.errors(poses) for boxes in self.kinds])

    def linearised(self, poses: Poses, axes: WorldAxes) -> tuple[Array, Array]:
        """Compute the residuals of all constraints, and their Jacobian, in all frames at once.

        Rows of axes for which nothing is to do are 0 in the Jacobian: free ones, and those within their box.

        Parameters
        ----------
        poses : F frames.
        axes : A axes about which joints rotate.

        Returns
        -------
        residual : shape (F, m), metres, three rows for each box.
        jacobian : shape (F, m, 3 + A): the derivatives of the values, which are those of -residual.
        """
        residuals = []
        jacobians = []
        for boxes in self.kinds:
            if not boxes.indices:
                continue
            values = boxes.values(poses)
            jacobian = boxes.jacobian(poses, axes)
            jacobian[~boxes.active(values)] = 0.0
            residuals.append(boxes.residual(values).reshape(len(poses), -1))
            jacobians.append(jacobian.reshape(len(poses), -1, jacobian.shape[-1]))
        return np.concatenate(residuals, axis=1), np.concatenate(jacobians, axis=1)

    def led(self, poses: Poses, seconds: float) -> "Pins":
        """Hold constrained joints also between their constraints: on a smooth path next to their own [ours].

        A joint's own path is moved by the curve through the residuals that bends least. Without it angles
        change smoothly, but a foot at the end of a chain of them accelerates.

        Parameters
        ----------
        poses : F frames.
        seconds : over which the curve begins before the first constraint and ends after the last one.
        """
        positions = self.positions.values(poses)
        held = self.positions.held
        low = self.low.copy()
        high = self.high.copy()
        for number, axis in np.argwhere(held.any(axis=0)):
            column = np.s_[:, number, axis]
            residual = np.where(held[column], low[column] - positions[column], 0.0)
            curve = smooth_fill(residual[:, None], held[column], poses.motion.fps, seconds)
            path = positions[column] + curve[:, 0]
            is_free = np.isinf(low[column]) & np.isinf(high[column])
            low[column] = np.where(is_free, path, low[column])
            high[column] = np.where(is_free, path, high[column])
        return Pins(self.joints, low, high, self.rotations)
