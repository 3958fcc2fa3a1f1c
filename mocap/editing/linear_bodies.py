"""How pinned joints move when joints above them turn a little: the body as a linear one, in all frames.

For a joint e below a joint j that is at p_j with the global rotation R_j, and turned by d_j already:

    ∂p_e/∂x_root = I,    ∂p_e/∂d_j = -[p_e - p_j]× R_j J(d_j) A_j.

J is the right Jacobian; the columns of A_j are the axes about which j may turn. Only joints above a pinned
one take part. Prices and hinges are ours.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import NamedTuple

import numpy as np

from mocap._shared.arrays import Array, Mask, frozen
from mocap.body import rotations
from mocap.body.kinematics import forward_kinematics, joint_positions
from mocap.body.motion import Motion, turning
from mocap.body.skeleton import Skeleton
from mocap.editing.displacements import Displacement, cross_matrix, displaced, right_jacobian
from mocap.editing.pins import Pins
from mocap.errors import MocapError

# Square metres per radian²: what a turn costs beyond what it moves. An ankle moves little: with 0.02 it turns
# by 84° when a foot steps on a stone of 20 cm, with 0.3, 1 and 2 by 63, 45 and 34°, and the root moves by 9,
# 11, 15 and 17 cm.
EFFORT = 1.0

# A joint is a hinge if its second singular value is below this share of the first. The knees of six sources
# have 0.8 % at most; puppy's, which are no hinges, 45 %.
HINGE = 0.05

# Radians (rms): a joint that turns less in a clip does not show its axis; then the file's axes count.
STILL = 0.01

SLACK = 1e-6  # metres by which pins may be farther apart than the bones between them: rounding

POSES = 20  # so many are enough for mean distances


@dataclass(frozen=True, eq=False)
class Body:
    """Which numbers of a pose may change, and what each costs.

    The numbers of a frame are the root's place (3), then for each joint the turns about its axes.

    Parameters
    ----------
    joints : the joints that may turn, as indices.
    axes : for each joint the axes in its own frame, shape (3, k) with k from 1 to 3.
    price : shape (n,), what a metre or a radian costs, squared.

    Examples
    --------
    >>> knee = Body((3,), (np.array([[1.0], [0], [0]]),), np.array([38.0, 38, 38, 1.7]))
    >>> knee.displacement(np.array([[0, 0, 0, 0.5]]), 5).turns[0, 3]
    array([0.5, 0. , 0. ])
    """

    joints: tuple[int, ...]
    axes: tuple[Array, ...]
    price: Array

    def __post_init__(self) -> None:
        object.__setattr__(self, "axes", tuple(frozen(axes, np.float64) for axes in self.axes))
        object.__setattr__(self, "price", frozen(self.price, np.float64))
        size = 3 + sum(axes.shape[1] for axes in self.axes)
        if self.price.shape != (size,) or not (self.price > 0).all():
            raise MocapError(
                f"A body of {size} numbers needs a price above 0 for each, got {self.price.shape}."
            )

    @property
    def columns(self) -> list[slice]:
        """Which numbers turn each joint."""
        stops = 3 + np.cumsum([0, *(axes.shape[1] for axes in self.axes)])
        return [slice(*ends) for ends in zip(stops[:-1].tolist(), stops[1:].tolist(), strict=True)]

    def displacement(self, change: Array, joints: int) -> Displacement:
        """Give the numbers' (F, n) meaning: a displacement of the root and of all `joints`."""
        turns = np.zeros((len(change), joints, 3))
        for joint, axes, columns in zip(self.joints, self.axes, self.columns, strict=True):
            turns[:, joint] = change[:, columns] @ axes.T
        return Displacement(change[:, :3], turns)


class Linear(NamedTuple):
    """The gaps of P pinned joints, `gap` (F, 3P), metres, and how they close, `slopes` (F, 3P, n).

    Rows of axes for which nothing is to do are 0: free ones, and boxes that the joint is in.
    """

    slopes: Array
    gap: Array

    @property
    def distances(self) -> Array:
        """How far each pinned joint is from its box, (F, P), metres."""
        return np.asarray(np.linalg.norm(self.gap.reshape(len(self.gap), -1, 3), axis=-1))

    def replaced(self, frames: Mask, other: "Linear") -> "Linear":
        """Take some frames from another one."""
        slopes = np.where(frames[:, None, None], other.slopes, self.slopes)
        return Linear(slopes, np.where(frames[:, None], other.gap, self.gap))


def body_of(
    motion: Motion,
    pinned: Sequence[int],
    *,
    effort: float = EFFORT,
    prices: Mapping[str, float] | None = None,
    still: Sequence[str] = (),
) -> Body:
    """Choose which joints may turn to bring pinned ones to their places, and price them.

    All joints above a pinned one that ever turn may turn. The price of a radian is what it moves: the squared
    distances of all joints below, added up (means over the clip), and `effort`. A metre of the root's moves
    all J joints, and costs J.

    Parameters
    ----------
    motion : the clip that shows which joints turn, and which of them are hinges.
    pinned : joints' indices.
    effort : what a radian costs beyond, m².
    prices : factors for joints' prices, by name; more than 1 stiffens a joint.
    still : the names of joints that shall not turn.

    Raises
    ------
    MocapError : for names that the skeleton lacks, an effort or a factor that is not above 0.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> walk = sample("walk_straight")
    >>> body = body_of(walk, [4, 5])  # left ankle and ball
    >>> [walk.skeleton.names[joint] for joint in body.joints], len(body.price)
    (['root', 'lfemur', 'ltibia', 'lfoot'], 13)

    Notebook: 14-levels
    """
    skeleton, prices = motion.skeleton, prices or {}
    fixed, factors = (
        {skeleton.index(name) for name in still},
        {skeleton.index(n): f for n, f in prices.items()},
    )
    if not all(np.isfinite(number) and number > 0 for number in (effort, *factors.values())):
        raise MocapError(f"An effort and factors of prices are above 0, got {effort} and {dict(prices)}.")
    turns = turning(motion)
    above = sorted({joint for pin in pinned for joint in skeleton.path_to_root(pin)[1:]} - fixed)
    joints = tuple(joint for joint in above if turns[joint])
    positions = joint_positions(motion[:: max(1, len(motion) // POSES)])
    axes, price = [], [float(len(skeleton))] * 3
    for joint in joints:
        below = [other for other in range(len(skeleton)) if joint in skeleton.path_to_root(other)]
        moved = ((positions[:, below] - positions[:, [joint]]) ** 2).sum(axis=(1, 2)).mean()
        hinge = hinge_of(motion, joint)
        axes.append(np.eye(3) if hinge is None else hinge[:, None])
        price += [factors.get(joint, 1.0) * (moved + effort)] * axes[-1].shape[1]
    return Body(joints, tuple(axes), np.array(price))


def hinge_of(motion: Motion, joint: int) -> Array | None:
    """Find the one axis about which a joint turns, a unit vector in its own frame, or None.

    A joint is a hinge if its rotation vectors from their mean spread along one direction. Where it hardly
    turns in the clip, it is one if its file gives it one axis. A knee that may turn about three axes meets
    its pins as well, and twists by up to 19°.

    Parameters
    ----------
    motion : the clip that shows it.
    joint : its index.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> hinge_of(sample("walk_straight"), 3).round(6) + 0.0  # the left knee
    array([1., 0., 0.])
    """
    turns = motion.rotations[:, joint]
    away = rotations.to_rotvec(rotations.multiply(rotations.inverse(rotations.mean(turns)), turns))
    spread, axes = np.linalg.svd(away - away.mean(axis=0), full_matrices=False)[1:]
    if len(away) > 3 and spread[0] > STILL * np.sqrt(len(away)):
        return np.asarray(axes[0]) if spread[1] < HINGE * spread[0] else None
    free = motion.skeleton.dofs[joint]
    if len(free) != 1:
        return None
    return rotations.rotate(motion.skeleton.axes[joint], np.eye(3)["xyz".index(free)])


def linear(base: Motion, body: Body, change: Array, pins: Pins) -> Linear:
    """Measure the pinned joints' gaps at m₀ ⊕ x, and how they close with x, in all frames at once.

    Parameters
    ----------
    base : m₀, F frames.
    body : n numbers in a frame.
    change : x, shape (F, n).
    pins : P joints in F frames.
    """
    moved = body.displacement(change, len(base.skeleton))
    poses = forward_kinematics(displaced(base, moved))
    joints = list(body.joints)
    turned = poses.matrices[:, joints] @ right_jacobian(moved.turns[:, joints])  # R_j J(d_j), (F, A, 3, 3)
    slopes = np.zeros((len(base), len(pins.joints), 3, change.shape[1]))
    slopes[..., :3] = np.eye(3)
    for number, end in enumerate(pins.joints):
        above = base.skeleton.path_to_root(end)[1:]
        movers = [n for n, joint in enumerate(joints) if joint in above]
        arms = poses.positions[:, [end]] - poses.positions[:, [joints[n] for n in movers]]
        swings = cross_matrix(-arms) @ turned[:, movers]
        for n, swing in zip(movers, np.moveaxis(swings, 1, 0), strict=True):
            slopes[:, number, :, body.columns[n]] = swing @ body.axes[n]
    gap = pins.gap(poses.positions)
    slopes *= (pins.held | (gap != 0))[..., None]
    return Linear(slopes.reshape(len(base), -1, change.shape[1]), gap.reshape(len(base), -1))


def require_reachable(motion: Motion, pins: Pins) -> None:
    """Raise `MocapError` for pins that no pose can meet.

    Two boxes are at least ‖max(low₁ - high₂, low₂ - high₁, 0)‖ apart; two joints are at most as far apart as
    the bones on the way from one to the other are long together. A solver would not notice: it tears the
    feet off their places, and converges.

    Parameters
    ----------
    motion, pins : F frames.

    Raises
    ------
    MocapError : naming the frame, both joints, and both lengths.
    """
    names = motion.skeleton.names
    for (a, first), (b, second) in combinations(enumerate(pins.joints), 2):
        below, above = pins.low[:, a] - pins.high[:, b], pins.low[:, b] - pins.high[:, a]
        apart = np.linalg.norm(np.maximum(np.maximum(below, above), 0.0), axis=-1)
        bones = length_between(motion.skeleton, first, second)
        worst = int(apart.argmax())
        if apart[worst] > bones + SLACK:
            raise MocapError(
                f"Frame {worst}: '{names[second]}' would be {apart[worst]:.2f} m from '{names[first]}', "
                f"the bones between reach {bones:.2f} m."
            )


def length_between(skeleton: Skeleton, first: int, second: int) -> float:
    """Add up the bones on the way from one joint to another, metres.

    Examples
    --------
    >>> offsets = [[0, 0, 0], [0, -0.4, 0], [0, -0.5, 0], [0, 0, 1]]
    >>> length_between(Skeleton(["hip", "knee", "ankle", "tail"], [-1, 0, 1, 0], offsets), 2, 3)
    1.9
    """
    way = set(skeleton.path_to_root(first)) ^ set(skeleton.path_to_root(second))
    return float(np.linalg.norm(skeleton.offsets[sorted(way)], axis=-1).sum())
