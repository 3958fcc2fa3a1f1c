"""A body that stands upright: the value that two bodies are compared by, whatever their rest poses are."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from mocap._shared.arrays import Array, frozen
from mocap.body import rotations
from mocap.body.limbs import Leg
from mocap.body.skeleton import Skeleton
from mocap.editing.body_roles import FEET, LEG, legs_among
from mocap.errors import MocapError


@dataclass(frozen=True, eq=False, repr=False)
class Stance:
    """How a skeleton stands upright on its flat feet, heading +z.

    Parameters
    ----------
    skeleton : J joints.
    roles : {role: joint}, from `roles`.
    turns : shape (J, 4), quaternions: how each joint is turned in the world.
    heights : {role: metres} of both ankles and balls over the floor.

    Raises
    ------
    MocapError : for legs without roles, turns that are no rotations of these joints, and heights that are
        missing or that no foot of this length has.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> from mocap.editing.stances import stance_of_walk
    >>> stance = stance_of_walk(sample("walk_straight"))
    >>> stance, round(stance.heights["left ankle"], 2)
    (Stance(38 joints, legs 0.86 m, ankles 0.068 m and balls 0.026 m over the floor), 0.07)
    """

    skeleton: Skeleton
    roles: Mapping[str, int]
    turns: Array
    heights: Mapping[str, float]
    points: Array = field(init=False)
    """Where the joints are in this stance, seen from joint 0, shape (J, 3), metres."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "roles", dict(self.roles))
        object.__setattr__(self, "heights", dict(self.heights))
        object.__setattr__(self, "turns", frozen(self.turns, np.float64))
        self._check()
        object.__setattr__(self, "points", frozen(joint_points(self.skeleton, self.turns), np.float64))

    def _check(self) -> None:
        legs = [f"{side} {part}" for side in ("left", "right") for part in LEG]
        if missing := [role for role in legs if role not in self.roles]:
            raise MocapError(f"A stance needs both legs, from hip to ball; the {missing[0]} is missing.")
        if missing := [role for role in FEET if not np.isfinite(self.heights.get(role, np.nan))]:
            raise MocapError(f"A stance needs the heights of ankles and balls; '{missing[0]}' is missing.")
        count = len(self.skeleton)
        if self.turns.shape != (count, 4) or not np.allclose(np.linalg.norm(self.turns, axis=-1), 1):
            raise MocapError(f"{count} joints need turns ({count}, 4) of length 1, got {self.turns.shape}.")
        for side, leg in zip(("left", "right"), self.legs, strict=True):
            drop = self.heights[f"{side} ankle"] - self.heights[f"{side} ball"]
            if not abs(drop) < (length := leg.lengths(self.skeleton)[2]):
                raise MocapError(
                    f"The {side} ankle would stand {100 * drop:.3g} cm over its ball; "
                    f"the foot is {100 * length:.3g} cm long."
                )

    def __repr__(self) -> str:
        ankles, balls = self.height("ankle"), self.height("ball")
        return (
            f"Stance({len(self.skeleton)} joints, legs {self.leg:.2f} m, ankles {ankles:.3f} m and "
            f"balls {balls:.3f} m over the floor)"
        )

    @property
    def legs(self) -> tuple[Leg, Leg]:
        """The left and the right leg."""
        return legs_among(self.roles)

    @property
    def leg(self) -> float:
        """How long a leg is from hip to ankle, the mean of both, metres."""
        return float(np.mean([leg.lengths(self.skeleton)[:2].sum() for leg in self.legs]))

    def height(self, part: str) -> float:
        """Give the mean height of both ankles ("ankle"), or both balls ("ball"), over the floor, metres."""
        return float(np.mean([self.heights[f"{side} {part}"] for side in ("left", "right")]))


def joint_points(skeleton: Skeleton, turns: Array) -> Array:
    """Place the joints of a body whose joints are turned by `turns` (J, 4) in the world: (J, 3), metres.

    Examples
    --------
    >>> bone = Skeleton(["a", "b"], [-1, 0], [[0, 0, 0], [0, 0, 1]])
    >>> joint_points(bone, rotations.about_y([np.pi / 2, 0])).round(6)[1] + 0.0
    array([1., 0., 0.])
    """
    points = np.zeros((len(skeleton), 3))
    for joint in range(1, len(skeleton)):
        above = skeleton.parents[joint]
        points[joint] = points[above] + rotations.rotate(turns[above], skeleton.offsets[joint])
    return points
