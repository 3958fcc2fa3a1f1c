"""A measured value with its limit, and what all measures of a motion start from.

Changes from frame to frame depend on the frame rate: a joint that leaps for one frame is four times as fast
at 120 Hz as at 30 Hz. Therefore all speeds and changes are measured over the same time, `STEP`, which is
several frames at higher rates, and from every frame. A leap then has the same size at each rate.

Fingers, toes and hands are light, and their rotations come from few markers. In captured clips they flip and
shake, and it is hardly visible. Therefore `main_joints` leaves them out.
"""

from __future__ import annotations

import numpy as np

from mocap._shared.arrays import Array, Indices
from mocap._shared.records import NamedTuple
from mocap.body.kinematics import GlobalPoses, forward_kinematics
from mocap.body.legs import Leg
from mocap.body.motion import Motion
from mocap.body.skeleton import Skeleton, reaches

STEP = 1 / 30  # seconds over which speeds and their changes are measured

SMALL_PART = 0.11  # of the longest chain of bones from the root: a hand without fingers, toes, a thumb


class Measure(NamedTuple):
    """A measured value, its limit in the same unit, and the place at which it is worst.

    Examples
    --------
    >>> sliding = Measure("foot_sliding", 5.0, 2.5, "cm", "'lfoot', frame 30")
    >>> sliding, sliding.ratio
    (Measure(foot_sliding 5 cm, limit 2.5, 'lfoot', frame 30), 2.0)
    """

    name: str
    value: float
    limit: float
    unit: str
    where: str = ""  # reads: name: public, and a key in the JSON of `mocap judge`

    def __repr__(self) -> str:
        place = f", {self.where}" if self.where else ""
        return f"Measure({with_limit(self)}{place})"

    @property
    def ratio(self) -> float:
        """The value, as a multiple of its limit."""
        return self.value / self.limit


def with_limit(measure: Measure) -> str:
    """Format a measured value with its name, unit and limit."""
    value = f"{measure.name} {measure.value:.3g} {measure.unit}"
    return value if measure.unit == "of its limit" else f"{value}, limit {measure.limit:.3g}"


class Seen(NamedTuple):
    """A motion of F frames and J joints, as all measures see it.

    `poses` has the position of each joint, (F, J, 3), metres, and its orientation. `legs` are the left and
    the right leg, or empty if they are not known. `step` is the number of frames of `STEP`.
    """

    motion: Motion
    poses: GlobalPoses
    legs: tuple[Leg, ...]
    step: int

    @property
    def positions(self) -> Array:
        """The positions of all joints, shape (F, J, 3), metres."""
        return self.poses.positions

    @property
    def seconds(self) -> float:
        """The duration of `step`."""
        return self.step / self.motion.fps

    def frames(self, seconds: float) -> int:
        """Return the number of frames of a duration, at least one."""
        return max(1, round(seconds * self.motion.fps))


def see(motion: Motion, legs: tuple[Leg, ...]) -> Seen:
    """Compute what all measures of a motion start from.

    Examples
    --------
    >>> from mocap.datasets.samples import sample
    >>> walk = sample("walk_straight")  # 120 Hz
    >>> see(walk, ()).step
    4
    """
    longest = (len(motion) - 1) // 3  # of which two make a second difference, and three a third one
    step = max(1, min(longest, round(STEP * motion.fps)))
    return Seen(motion, forward_kinematics(motion), legs, step)


def main_joints(skeleton: Skeleton) -> Indices:
    """List the joints that move more than fingers or toes.

    Examples
    --------
    >>> from mocap.datasets.samples import SKELETON
    >>> joints = {SKELETON.names[joint] for joint in main_joints(SKELETON)}
    >>> {"lfoot", "lwrist"} <= joints, {"ltoes", "lhand", "lthumb"} & joints
    (True, set())
    """
    reach = reaches(skeleton)
    return np.flatnonzero(reach >= SMALL_PART * reach[0])


def main_points(skeleton: Skeleton) -> Indices:
    """List the joints whose positions do not depend on the rotations of fingers and toes.

    Examples
    --------
    >>> from mocap.datasets.samples import SKELETON
    >>> joints = {SKELETON.names[joint] for joint in main_points(SKELETON)}
    >>> {"ltoes", "lhand"} <= joints, {"ltoes_end", "lfingers"} & joints
    (True, set())
    """
    parents = np.array(skeleton.parents[1:], int)
    moved = 1 + np.flatnonzero(np.isin(parents, main_joints(skeleton)))
    return np.append(0, moved)
