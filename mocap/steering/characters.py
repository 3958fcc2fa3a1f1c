"""A character that can be commanded: what all controllers have in common.

`steer` and `measure_delay` work with anything that fits `Character`, so each new way of control can be
steered, seen and measured as those before it.
"""

from collections.abc import Mapping
from types import MappingProxyType
from typing import NamedTuple, Protocol

from mocap._shared.arrays import Array
from mocap.body.skeleton import Skeleton


class Pose(NamedTuple):
    """One frame: root position (3,) in metres, rotations (J, 4), and whether a transition is under way.

    `contacts` says which joints stand, as the clips say that the frame comes from; empty where they do not.

    Examples
    --------
    >>> import numpy as np
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

    >>> import numpy as np
    >>> from mocap.datasets.generated import SKELETON
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
        ...

    @property
    def fps(self) -> float:
        """Steps per second."""
        ...

    @property
    def frames_left(self) -> int:
        """The frames until its next choice; 0 for one that can choose in every frame."""
        ...

    def step(self, heading: float, speed: float, label: str = "") -> Pose:
        """Walk on by one frame; heading in radians (0 is +z, π/2 is +x), speed in metres per second."""
        ...
