"""A character that can be commanded: what all controllers have in common.

A command is a heading and a speed, which `require_command` checks.

`steer` (and `measure_delay` of `delays`) work with anything that fits `Character`, so each new way of control
can be steered, seen and measured as those before it.
"""

import math
from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import NamedTuple, Protocol

import numpy as np

from mocap._shared.arrays import Array, Indices, Mask
from mocap.body.motion import Motion
from mocap.body.planar import on_ground
from mocap.body.skeleton import Skeleton
from mocap.errors import MocapError

OBEYS = math.radians(20)  # between the way of the last third of a second and the heading, at most


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


class Steered(NamedTuple):
    """A steered motion, F frames, and what the character did in each.

    `blending` (F,) says whether a transition was under way, `frames_left` (F,) how many frames the character
    still had to play before its next choice.
    """

    motion: Motion
    blending: Mask
    frames_left: Indices

    def delay(self, heading: float, frame: int) -> Array:
        """Split the delay of a command: seconds of waiting, of transitions and of clip until it is obeyed.

        Parameters
        ----------
        heading, frame : the direction asked for, radians, and the frame of the command, from 1/3 s on.

        Returns
        -------
        Three numbers; nan where the command is not obeyed, as `measure_delay` defines it.
        """
        fps, track = self.motion.fps, on_ground(self.motion.root_positions) * np.exp(-1j * heading)
        back = round(fps / 3)
        obeys = np.abs(np.angle(track[frame:] - track[frame - back : -back])) < OBEYS
        if not obeys.any():
            return np.full(3, np.nan)
        took = int(obeys.argmax()) + 1
        wait = min(int(self.frames_left[frame]), took)
        blends = int(self.blending[frame + wait : frame + took].sum())
        return np.array([wait, blends, took - wait - blends]) / fps


def steer(character: Character, headings: Sequence[float], speed: float = 1.1) -> Steered:
    """Steer a character by one heading per frame, and record what it does.

    Parameters
    ----------
    character : any controller; it walks on from where it is.
    headings : shape (F,), radians; 0 is +z, π/2 is +x.
    speed : metres per second.

    Examples
    --------
    Two seconds ahead, then to the left:

    >>> from mocap import body, datasets, graphs
    >>> from mocap.steering import Controller
    >>> clips = [body.resample(datasets.sample("walk_curve_1"), 30)]
    >>> graph = graphs.prune(graphs.build(clips, window=10, threshold=0.04))
    >>> steered = steer(Controller(graph), [0.0] * 60 + [np.pi / 2] * 60)
    >>> len(steered.motion), steered.blending.shape
    (120, (120,))

    Notebook: 08b-steering
    """
    poses, left = [], []
    for heading in headings:
        left.append(character.frames_left)
        poses.append(character.step(float(heading), speed))
    return Steered(as_motion(character, poses), np.array([pose.blending for pose in poses]), np.array(left))


def as_motion(character: Character, poses: Sequence[Pose], name: str = "steered") -> Motion:
    """Put the poses of a character in a row; marks that all of them have become contacts.

    Examples
    --------
    >>> from mocap import body, datasets, graphs
    >>> from mocap.steering import Controller
    >>> clips = [body.resample(datasets.sample("walk_curve_1"), 30)]
    >>> character = Controller(graphs.prune(graphs.build(clips, window=10, threshold=0.04)))
    >>> walked = as_motion(character, [character.step(0.0, 1.0) for _ in range(9)])
    >>> walked, sorted(walked.contacts)
    (Motion('steered', 9 frames at 30 Hz, 38 joints), ['lfoot', 'ltoes', 'rfoot', 'rtoes'])
    """
    marks = [mark for mark in poses[0].contacts if all(mark in pose.contacts for pose in poses)]
    return Motion(
        character.skeleton,
        np.array([pose.root_position for pose in poses]),
        np.array([pose.rotations for pose in poses]),
        character.fps,
        name,
        contacts={mark: np.array([pose.contacts[mark] for pose in poses]) for mark in marks},
    )
