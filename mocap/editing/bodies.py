"""How joints may turn: which of them, about which axes, at what price, how far, and which way they look.

Only joints above a pinned one take part. Prices and hinges are ours.
"""

from collections.abc import Mapping, Sequence
from itertools import combinations

import numpy as np

from mocap._shared.arrays import Array, Indices
from mocap._shared.records import NamedTuple
from mocap.body import rotations
from mocap.body.kinematics import forward_kinematics, hinge_of, joint_positions
from mocap.body.motion import Motion, rotating_joints
from mocap.editing.displacements import Displacement
from mocap.editing.pins import Pins, Rows, pin_errors
from mocap.editing.tuned import TUNED
from mocap.editing.turns import Turn
from mocap.errors import MocapError, warn

TOLERANCE = 0.005  # metres: what pins may be missed by without a warning
SLACK = 1e-6  # metres by which pins may be farther apart than the bones between them: rounding

POSES = 20  # frames of a clip from which mean distances are taken


class Body(NamedTuple):
    """Which numbers of a pose may change, and what each costs.

    The numbers of a frame are the root's place (3), then T turns, each of one joint about one axis.

    Parameters
    ----------
    joints : shape (T,), whose turn each is; a joint that may turn freely has three.
    axes : shape (T, 3), about which axis, in the joint's own frame.
    price : shape (3 + T,), what a metre or a radian costs, squared.

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
        """Give the numbers' (F, n) meaning: a displacement of the root and of all `joints`."""
        turns = np.zeros((len(change), joints, 3))
        for number, (joint, axis) in enumerate(zip(self.joints, self.axes, strict=True), start=3):
            turns[:, joint] += change[:, [number]] * axis
        return Displacement(change[:, :3], turns)


def body_of(motion: Motion, pins: Pins, *, prices: Mapping[str, float] | None = None) -> Body:
    """Choose which joints may turn to bring pinned ones to their places, and price them.

    All joints above a pinned one that ever turn may turn. The price of a radian is what it moves: the squared
    distances of all joints below, added up (means over the clip), and `TUNED.effort`. A metre of the root's
    moves all J joints, and costs J.

    Parameters
    ----------
    motion : the clip that shows which joints turn, and which of them are hinges.
    pins : their joints count, not where these shall be.
    prices : factors for joints' prices, by name; more than 1 stiffens a joint.

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
    skeleton = motion.skeleton
    factors = {skeleton.index(name): factor for name, factor in (prices or {}).items()}
    if not all(np.isfinite(factor) and factor > 0 for factor in factors.values()):
        raise MocapError(f"Factors of prices are above 0, got {dict(prices or {})}.")
    can_turn = rotating_joints(motion)
    paths = [skeleton.path_to_root(joint) for joint in range(len(skeleton))]
    positions = joint_positions(motion[:: max(1, len(motion) // POSES)])
    joints: list[int] = []
    axes = [np.zeros((0, 3))]
    price = [float(len(skeleton))] * 3  # of the root's three coordinates
    above = sorted(set().union(*pins.movers(skeleton)))
    for joint in (joint for joint in above if can_turn[joint]):
        below = [descendant for descendant, path in enumerate(paths) if joint in path]
        moved = ((positions[:, below] - positions[:, [joint]]) ** 2).sum(axis=(1, 2)).mean()
        hinge = hinge_of(motion, joint) if joint else None  # a root that only turns on a circle can also tip
        axes.append(np.eye(3) if hinge is None else hinge[None])
        joints += [joint] * len(axes[-1])
        price += [factors.get(joint, 1.0) * (moved + TUNED.effort)] * len(axes[-1])
    return Body(np.array(joints, int), np.vstack(axes), np.array(price))


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
    skeleton = motion.skeleton
    paths = [set(skeleton.path_to_root(joint)) for joint in pins.joints]
    for a, b in combinations(range(len(pins.joints)), 2):
        distances = _distances_between_boxes(pins, a, b)
        worst = int(distances.argmax())
        bones = sorted(paths[a] ^ paths[b])
        reach = np.linalg.norm(skeleton.offsets[bones], axis=1).sum()
        if distances[worst] > reach + SLACK:
            first = skeleton.names[pins.joints[a]]
            second = skeleton.names[pins.joints[b]]
            request = f"'{second}' would be {distances[worst]:.2f} m from '{first}'"
            raise MocapError(f"Frame {worst}: {request}, the bones between reach {reach:.2f} m.")


def _distances_between_boxes(pins: Pins, a: int, b: int) -> Array:
    """Compute the least distances (F,) between points of the boxes in columns a and b, metres."""
    from_b_up_to_a = pins.low[:, a] - pins.high[:, b]
    from_a_up_to_b = pins.low[:, b] - pins.high[:, a]
    gaps = np.maximum(np.maximum(from_b_up_to_a, from_a_up_to_b), 0.0)
    return np.asarray(np.linalg.norm(gaps, axis=1))


def warn_of_gaps(motion: Motion, pins: Pins, tolerance: float = TOLERANCE) -> None:
    """Warn of the pin that is missed by most beyond a tolerance, metres.

    Examples
    --------
    >>> import warnings
    >>> from mocap.datasets import sample
    >>> from mocap.editing.pins import pin
    >>> walk = sample("walk_straight")[:9]
    >>> with warnings.catch_warnings(record=True, action="always") as said:
    ...     warn_of_gaps(walk, pin(walk, "root", [5, 6], walk.root_positions[5] + [0, 0.02, 0]))
    ...     warn_of_gaps(walk, pin(walk, "root", [5], walk.root_positions[5] + [0, 0.004, 0]))
    >>> print(*(warning.message for warning in said))
    'walk_straight', frame 6: 'root' is 21.6 mm off its pin, and pins of 2 frames are missed: are they
    within reach, and do they agree?
    """
    errors = pin_errors(motion, pins)
    if errors.max(initial=0.0) > tolerance:
        frame, joint = np.unravel_index(errors.argmax(), errors.shape)
        name = motion.skeleton.names[pins.ends[joint]]
        worst = f"'{name}' is {1000 * errors[frame, joint]:.3g} mm off its pin"
        frames = int((errors > tolerance).any(axis=1).sum())
        missed = f"pins of {frames} frames are missed"
        question = "are they within reach, and do they agree?"
        warn(f"'{motion.name}', frame {frame}: {worst}, and {missed}: {question}")


# reads: name: `more` is part of the public function, and goes when the pins are split into boxes
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
    >>> (neck.high[0] / TUNED.arm).round(2).tolist()  # radians
    [[0.18, 0.19, 0.18], [0.18, 0.19, 0.18]]
    >>> (neck.low[0] / TUNED.arm).round(2).tolist()
    [[-0.18, -0.19, -0.19], [-0.18, -0.19, -0.19]]

    Notebook: 14-levels
    """
    if not 0 <= more < np.inf:
        raise MocapError(f"Limits lie 0 degrees or more beyond what a clip does, got {more}.")
    turns = tuple(_turn_from_mean(motion, motion.skeleton.index(name)) for name in joints)
    zero = np.zeros((len(motion), len(turns), 3))
    arms = Pins((), zero, zero, turns).places(motion, forward_kinematics(motion))
    reach = TUNED.arm * np.radians(more)
    return Pins((), zero + arms.min(axis=0) - reach, zero + arms.max(axis=0) + reach, turns)


def _turn_from_mean(motion: Motion, joint: int) -> Turn:
    """Describe how a joint is turned against its parent, from its mean rotation in the clip."""
    mean = rotations.mean(motion.rotations[:, joint])
    return Turn(joint, np.tile(mean, (len(motion), 1)), world=False)


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
    reference = rotations.from_matrix(forward_kinematics(motion).matrices[:, number])
    zero = np.zeros((len(motion), 1, 3))
    return Pins((), zero, zero, (Turn(number, reference, world=True),)).only(frames)
