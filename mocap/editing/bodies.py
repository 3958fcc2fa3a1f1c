"""Which joints of a body may rotate to meet constraints, about which axes, and what that costs.

Only joints above a constrained one take part. The costs, called prices, and hinges are ours.
"""

from collections.abc import Iterable, Mapping

import numpy as np

from mocap._shared.arrays import Array, Indices
from mocap._shared.records import NamedTuple
from mocap.body.kinematics import hinge_of
from mocap.body.motion import rotating_joints
from mocap.editing.constraints import Pins
from mocap.editing.displacements import Displacement, right_jacobian
from mocap.editing.poses import ROOT, ROTATIONS, MotionOrPoses, Poses, WorldAxes, motion_of, poses_of
from mocap.editing.tuned import TUNED
from mocap.errors import MocapError

SAMPLED = 20  # frames of a clip, at least, from which mean distances are taken
SHOWN = 2000  # frames of a clip, at least, that show its hinges


class Body(NamedTuple):
    """Which numbers of a pose may change, and the price of each.

    The numbers of a frame are the root's position (3), then A rotations, each of a joint about an axis.

    Parameters
    ----------
    joints : shape (A,), the joint of each rotation; a joint that rotates freely has three.
    axes : shape (A, 3), the axis of each rotation, in the joint's own frame.
    price : shape (3 + A,), the cost of a metre or a radian, squared.

    Examples
    --------
    >>> knee = Body(np.array([3]), np.array([[1.0, 0, 0]]), np.array([38.0, 38, 38, 1.7]))
    >>> knee.displacement(np.array([[0, 0, 0, 0.5]]), 5).turns[0, 3]
    array([0.5, 0. , 0. ])
    """

    joints: Indices
    axes: Array
    price: Array

    def displacement(self, change: Array, joints: int) -> Displacement:
        """Return the displacement of the root and of all `joints` that a change (F, 3 + A) stands for."""
        turns = np.zeros((len(change), joints, 3))
        angles = change[:, ROTATIONS]
        for number, (joint, axis) in enumerate(zip(self.joints, self.axes, strict=True)):
            turns[:, joint] += angles[:, [number]] * axis
        return Displacement(change[:, ROOT], turns)

    def world_axes(self, poses: Poses, displacement: Displacement) -> WorldAxes:
        """Compute the axes about which the joints rotate in the world, if a displacement changes further.

        A joint with the rotation R in the world, of which a displacement d is a part, rotates about
        R J(d) a, where J is the right Jacobian.
        """
        joints, number = np.unique(self.joints, return_inverse=True)
        frames = poses.matrices[:, joints] @ right_jacobian(displacement.turns[:, joints])
        return WorldAxes(self.joints, np.einsum("ftij,tj->fti", frames[:, number], self.axes))


def body_of(motion: MotionOrPoses, pins: Pins, *, prices: Mapping[str, float] | None = None) -> Body:
    """Choose the joints that may rotate to bring constrained ones to their positions, and price them.

    All joints above a constrained one that rotate in the clip may rotate. The price of a radian is what it
    moves: the squared distances of all joints below, added up (means over the clip), and 1 m². A metre of the
    root's moves all J joints, and costs J.

    Parameters
    ----------
    motion : the clip that shows which joints rotate, and which of them are hinges.
    pins : constraints; only their joints matter.
    prices : factors on the prices of joints, by name; more than 1 stiffens a joint.

    Raises
    ------
    MocapError : for names that the skeleton lacks, and a factor that is not above 0.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> from mocap.editing.pins import pin
    >>> walk = sample("walk_straight")
    >>> body = body_of(walk, pin(walk, "ltoes", [0], [0, 0, 0]))
    >>> [walk.skeleton.names[joint] for joint in np.unique(body.joints)], len(body.price)
    (['root', 'lfemur', 'ltibia', 'lfoot'], 13)
    >>> body.price.round(2).tolist()  # a metre, then radians: of root and hip about 3 axes, knee, and ankle
    [38.0, 38.0, 38.0, 11.02, 11.02, 11.02, 3.52, 3.52, 3.52, 1.67, 1.06, 1.06, 1.06]

    Notebook: 14-levels
    """
    skeleton = motion_of(motion).skeleton
    return body_rotating(motion, pins.movers(skeleton), prices)


def body_rotating(
    motion: MotionOrPoses, movers: Iterable[Iterable[int]], prices: Mapping[str, float] | None = None
) -> Body:
    """Price the joints that may rotate, as `body_of` does.

    Parameters
    ----------
    motion : the clip that shows which joints rotate, and which of them are hinges.
    movers : the joints that may rotate for each constraint, as from `Pins.movers`.
    prices : as for `body_of`.
    """
    clip = motion_of(motion)
    skeleton = clip.skeleton
    factors = {skeleton.index(name): factor for name, factor in (prices or {}).items()}
    if not all(np.isfinite(factor) and factor > 0 for factor in factors.values()):
        raise MocapError(f"Factors of prices are above 0, got {dict(prices or {})}.")
    paths = [skeleton.path_to_root(joint) for joint in range(len(skeleton))]
    positions = poses_of(motion[:: max(1, len(clip) // SAMPLED)]).positions
    rotates = rotating_joints(clip)
    shown = clip[:: max(1, len(clip) // SHOWN)]
    joints: list[int] = []
    axes = [np.zeros((0, 3))]
    price = [float(len(skeleton))] * 3  # of the root's three coordinates
    movable = sorted({joint for joints in movers for joint in joints if rotates[joint]})
    for joint in movable:
        below = [descendant for descendant, path in enumerate(paths) if joint in path]
        moved = ((positions[:, below] - positions[:, [joint]]) ** 2).sum(axis=(1, 2)).mean()
        hinge = hinge_of(shown, joint) if joint else None  # a root that only turns on a circle can also tip
        axes.append(np.eye(3) if hinge is None else hinge[None])
        joints += [joint] * len(axes[-1])
        price += [factors.get(joint, 1.0) * (moved + TUNED.effort)] * len(axes[-1])
    return Body(np.array(joints, int), np.vstack(axes), np.array(price))


def priced(motion: MotionOrPoses, movers: Iterable[Iterable[int]], trunk: float, neck: float) -> Body:
    """Choose the joints that may rotate, with factors on the prices of the root, the trunk and the neck.

    The trunk is the joints that have a third of the body below them. The neck is the joints from there to the
    head.

    Parameters
    ----------
    motion, movers : as for `body_rotating`.
    trunk : factor for the joints of the trunk, and for translations of the root.
    neck : factor for the joints of the neck.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> from mocap.editing.pins import pin
    >>> walk = sample("walk_straight")
    >>> head = pin(walk, "head", [0], [0, 0, 0])
    >>> stiff = priced(poses_of(walk), head.movers(walk.skeleton), 4, 8)
    >>> (stiff.price / body_of(walk, head).price).tolist()[::3]  # metres, then joints
    [4.0, 4.0, 4.0, 4.0, 4.0, 8.0, 8.0]
    """
    skeleton = motion_of(motion).skeleton
    paths = [skeleton.path_to_root(joint) for joint in range(len(skeleton))]
    joints_below = np.bincount(np.concatenate(paths))
    head_paths = [path for path in paths if skeleton.names[path[0]].lower().endswith("head")]
    is_above_head = np.isin(range(len(paths)), [joint for path in head_paths for joint in path])
    is_trunk = joints_below > len(skeleton) / 3
    factors = np.where(is_trunk, trunk, np.where(is_above_head, neck, 1)).tolist()
    body = body_rotating(motion, movers, dict(zip(skeleton.names, factors, strict=True)))
    price = body.price.copy()
    price[ROOT] *= trunk
    return body._replace(price=price)
