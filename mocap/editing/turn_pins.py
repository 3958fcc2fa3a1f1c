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
    """How one joint is turned, q, as a place for which `Pins` have a box: ARM log(r⁻¹ q).

    Parameters
    ----------
    joint : its index.
    reference : r, quaternions (F, 4).
    world : whether q is the joint's turn in the world, or against its parent.
    """

    joint: int
    reference: Array
    world: bool

    def arm(self, motion: Motion, matrices: Array) -> Array:
        """Give ARM log(r⁻¹ q), (F, 3), metres; `matrices` (F, J, 3, 3) are the joints' turns in the world."""
        world = self.world
        turned = rotations.from_matrix(matrices[:, self.joint]) if world else motion.rotations[:, self.joint]
        return np.asarray(ARM * rotations.difference(self.reference, turned))


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
    >>> (neck.high[0] / ARM).round(2).tolist()  # radians
    [[0.18, 0.18, 0.18], [0.18, 0.2, 0.19]]

    Notebook: 14-levels
    """
    if not 0 <= more < np.inf:
        raise MocapError(f"Limits lie 0 degrees or more beyond what a clip does, got {more}.")
    numbers = [motion.skeleton.index(name) for name in joints]
    means = (np.tile(rotations.mean(motion.rotations[:, number]), (len(motion), 1)) for number in numbers)
    turns = tuple(Turn(number, mean, world=False) for number, mean in zip(numbers, means, strict=True))
    zero, reach = np.zeros((len(motion), len(turns), 3)), ARM * np.radians(more)
    arms = Pins((), zero, zero, turns).places(motion, forward_kinematics(motion))
    return Pins((), zero + arms.min(axis=0) - reach, zero + arms.max(axis=0) + reach, turns)


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
    >>> int(upright.asked.sum())
    20

    Notebook: 14-levels
    """
    number = motion.skeleton.index(joint)
    own = rotations.from_matrix(forward_kinematics(motion).matrices[:, number])
    zero = np.zeros((len(motion), 1, 3))
    return Pins((), zero, zero, (Turn(number, own, world=True),)).only(frames)
