"""Pins for how joints are turned: limits, and orientations that are kept."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from mocap._shared.arrays import Array
from mocap.body import rotations
from mocap.body.kinematics import forward_kinematics
from mocap.body.motion import Motion
from mocap.editing.pins import Pins, Rows
from mocap.errors import MocapError

ARM = 0.3  # metres: a turn that is missed by an angle counts as a place missed by so many times the angle


class Turn(NamedTuple):
    """A box for how one joint is turned: low ≤ log(r⁻¹ q) ≤ high on each axis.

    Parameters
    ----------
    joint : its index.
    reference : r, quaternions (F, 4).
    low, high : shape (F, 3), radians, as for `Pins`.
    world : whether q is the joint's turn in the world, or against its parent.
    """

    joint: int
    reference: Array
    low: Array
    high: Array
    world: bool

    def away(self, motion: Motion, matrices: Array) -> Array:
        """Give log(r⁻¹ q), (F, 3); `matrices` (F, J, 3, 3) are the joints' turns in the world."""
        world = self.world
        turned = rotations.from_matrix(matrices[:, self.joint]) if world else motion.rotations[:, self.joint]
        return rotations.to_rotvec(rotations.multiply(rotations.inverse(self.reference), turned))

    def at(self, rows: Rows) -> "Turn":
        """Take some frames."""
        return self._replace(reference=self.reference[rows], low=self.low[rows], high=self.high[rows])

    def gap(self, away: Array) -> Array:
        """Give the way into the box, (F, 3), metres at the arm's end."""
        return np.asarray(ARM * (np.clip(away, self.low, self.high) - away))


def limit_turns(motion: Motion, joints: Sequence[str], *, more: float = 10.0) -> Pins:
    """Keep joints within what they do in the clip, and some degrees more.

    In the paper: [Gle98, joint limits], [LS99, joint limits].

    The paper's limits are angles from a table. Here the clip gives them [ours]: the range of each joint's
    rotation vectors about their mean.

    Parameters
    ----------
    motion : F frames.
    joints : their names.
    more : degrees beyond the clip's range, about each axis, 0 or more.

    Raises
    ------
    MocapError : for a joint that is not there, and degrees below 0.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> neck = limit_turns(sample("walk_straight")[:60], ["lowerneck", "upperneck"])
    >>> [turn.high[0].round(2).tolist() for turn in neck.turns]
    [[0.18, 0.18, 0.18], [0.18, 0.2, 0.19]]

    Notebook: 14-levels
    """
    if not 0 <= more < np.inf:
        raise MocapError(f"Limits lie 0 degrees or more beyond what a clip does, got {more}.")
    turns = []
    for joint in (motion.skeleton.index(name) for name in joints):
        mean = rotations.mean(motion.rotations[:, joint])
        away = rotations.to_rotvec(rotations.multiply(rotations.inverse(mean), motion.rotations[:, joint]))
        bounds = (mean, away.min(axis=0) - np.radians(more), away.max(axis=0) + np.radians(more))
        reference, low, high = (np.tile(values, (len(motion), 1)) for values in bounds)
        turns.append(Turn(joint, reference, low, high, world=False))
    nowhere = np.zeros((len(motion), 0, 3))
    return Pins((), nowhere, nowhere, tuple(turns))


def keep_turned(motion: Motion, joint: str, frames: Rows) -> Pins:
    """Keep how a joint is turned in the world in some frames.

    In the paper: [Gle98, orientations], [LS99, orientations].

    Parameters
    ----------
    motion : F frames.
    joint : its name.
    frames : a slice, the frames' numbers, or marks (F,).

    Raises
    ------
    MocapError : for a joint or a frame that is not there.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> upright = keep_turned(sample("walk_straight")[:60], "thorax", slice(20, 40))
    >>> int((upright.turns[0].low == 0).all(axis=1).sum())
    20

    Notebook: 14-levels
    """
    number = motion.skeleton.index(joint)
    own = rotations.from_matrix(forward_kinematics(motion).matrices[:, number])
    zero, nowhere = np.zeros((len(motion), 3)), np.zeros((len(motion), 0, 3))
    turn = Turn(number, own, zero, zero, world=True)
    return Pins((), nowhere, nowhere, (turn,)).only(frames)
