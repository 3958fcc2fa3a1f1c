"""Steer a character by a list of headings, and record what it does in each frame."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from mocap._shared.arrays import Array, Indices, Mask
from mocap.body.motion import Motion
from mocap.errors import MocapError
from mocap.steering.characters import Character, Pose


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
        fps, (x, _, z) = self.motion.fps, self.motion.root_positions.T
        track, back = (z + 1j * x) * np.exp(-1j * heading), round(self.motion.fps / 3)
        obeys = np.abs(np.angle(track[frame:] - track[frame - back : -back])) < np.pi / 9
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

    Raises
    ------
    MocapError : for no headings.

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
    if not len(headings):
        raise MocapError("To steer takes one heading per frame, got none.")
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
