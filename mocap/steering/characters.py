"""A character that can be commanded: what all controllers have in common.

A command is a heading and a speed, which `require_command` checks. Where its frames come from clips that lie
elsewhere, `place_frames` puts them on the ground.

`steer` and `measure_delay` work with anything that fits `Character`, so each new way of control can be
steered, seen and measured as those before it.
"""

from collections.abc import Mapping
from types import MappingProxyType
from typing import NamedTuple, Protocol

import numpy as np

from mocap._shared.arrays import Array
from mocap.body.planar import PlanarTransform
from mocap.body.skeleton import Skeleton
from mocap.errors import MocapError


class Pose(NamedTuple):
    """One frame: root position (3,) in metres, rotations (J, 4), and whether a transition is under way.

    `contacts` says which joints stand, as the clips say that the frame comes from; empty where they do not.

    Examples
    --------
    >>> Pose(np.array([0.0, 1.0, 0.0]), np.array([[1.0, 0, 0, 0]]), blending=False).root_position
    array([0., 1., 0.])
    """

    root_position: Array
    rotations: Array
    blending: bool
    contacts: Mapping[str, bool] = MappingProxyType({})


class Character(Protocol):
    """Anything that takes a command in each frame and gives its next pose.

    Examples
    --------
    A statue fits, too; nothing has to be inherited:

    >>> from mocap.datasets.samples import SKELETON
    >>> class Statue:
    ...     skeleton, fps, frames_left = SKELETON, 30.0, 0
    ...     def step(self, heading, speed, label=""):
    ...         return Pose(np.array([0.0, 1.0, 0.0]), np.tile([1.0, 0, 0, 0], (38, 1)), blending=False)
    >>> character: Character = Statue()
    >>> character.step(heading=0.0, speed=1.0).blending
    False
    """

    @property
    def skeleton(self) -> Skeleton:
        """The joints that the poses move."""

    @property
    def fps(self) -> float:
        """Steps per second."""

    @property
    def frames_left(self) -> int:
        """The frames until its next choice; 0 for one that can choose in every frame."""

    def step(self, heading: float, speed: float, label: str = "") -> Pose:
        """Walk on by one frame; heading in radians (0 is +z, π/2 is +x), speed in metres per second."""


def require_command(heading: float, speed: float) -> None:
    """Raise `MocapError` unless a command is a finite heading and a finite speed from 0 on."""
    if not (np.isfinite(heading) and np.isfinite(speed) and speed >= 0):
        raise MocapError(f"A command is a finite heading and a speed from 0 on, got {heading}, {speed}.")


def place_frames(place: PlanarTransform, roots: Array, turns: Array) -> tuple[Array, Array]:
    """Put frames of a clip on the ground: root positions (..., 3), and rotations (..., J, 4).

    Examples
    --------
    >>> roots, turns = place_frames(PlanarTransform(0.0, 2.0, 0.0), np.zeros(3), np.array([[1.0, 0, 0, 0]]))
    >>> roots, turns
    (array([2., 0., 0.]), array([[1., 0., 0., 0.]]))
    """
    turned = turns.copy()
    turned[..., 0, :] = place.apply_orientations(turned[..., 0, :])
    return place.apply_points(roots), turned
