"""Characters that are stepped together by one command, and the delay until each obeys.

A reader may change the command at any time, and drag the heading. Therefore each character has a
`CommandClock`.
"""

from __future__ import annotations

import time
import warnings
from collections.abc import Mapping
from typing import Any

import numpy as np

from mocap._shared.arrays import Array
from mocap._shared.records import NamedTuple
from mocap.body.kinematics import joint_positions
from mocap.errors import MocapError, MocapWarning, shortened
from mocap.steering.characters import Character, CommandClock, Pose, as_motion, require_command
from mocap.steering.root_turning import as_turned
from mocap.widgets.player import packed_body

MOST = 4  # largest number of characters side by side
LONGEST_FAULT = 200  # letters of an error message
DELAYS = 20  # number of the last delays that are sent to a browser

Command = tuple[float, float, str]
"""Heading in radians (0 along +z, π/2 along +x), speed in metres per second, and a label."""
START: Command = (0.0, 1.1, "")


def checked(heading: float, speed: float, label: str) -> Command:
    """Return a command, or raise for a heading or speed that no character accepts."""
    require_command(float(heading), float(speed))
    return float(heading), float(speed), str(label)


class Walked(NamedTuple):
    """The last F steps of a character.

    poses : a pose for each step.
    positions : the positions of its drawn joints, (F, K, 3), metres.
    report : a message to the browser. It has, for each step, the seconds `waited` and whether the command is
        `obeyed` and the pose `blending`. It also has the number of the `first` step, the last `delays`, and
        the `fault`, which is the message of the error that stopped the character, or "".
    """

    poses: list[Pose]
    positions: Array
    report: dict[str, Any]


class Member:
    """A character of a company, with its clock, its last pose, and its last error.

    Parameters
    ----------
    name : the name in the pictures.
    character : any object that implements `steering.Character`.
    """

    def __init__(self, name: str, character: Character) -> None:
        self.name = name
        self.character = character
        self.clock = CommandClock(character.fps)
        self.joints, self.body = packed_body(character.skeleton)
        self.steps = 0
        self.fault = ""
        self.order: Command | None = None  # the last command
        self.last: tuple[Pose, Array] | None = None  # the last pose, and the positions of its joints

    def walk(self, order: Command, count: int) -> Walked:
        """Take `count` steps. After an error, the character stands still until the command changes."""
        if order != self.order:
            self.order = order
            self.fault = ""
        heading, _, _ = order
        report: dict[str, Any] = {"first": self.steps, "waited": [], "obeyed": [], "blending": []}
        self.steps += count
        poses = []
        positions = np.empty((count, len(self.joints), 3))
        for frame in range(count):
            pose, positions[frame] = self._step(order)
            self.clock.command(heading)
            self.clock.step(complex(pose.root_position[2], pose.root_position[0]))
            poses.append(pose)
            report["waited"].append(round(self.clock.waited, 3))
            report["obeyed"].append(self.clock.obeyed)
            report["blending"].append(bool(pose.blending))
        report["fault"] = self.fault
        report["delays"] = self.clock.delays[-DELAYS:]
        return Walked(poses, positions, report)

    def _step(self, order: Command) -> tuple[Pose, Array]:
        """Take a step, or stand still after an error. Return the pose and the positions of its joints."""
        try:
            if not self.fault:
                pose = self.character.step(*order)
                positions = joint_positions(as_motion(self.character, [pose]))
                self.last = (pose, positions[0, self.joints])
        except Exception as error:  # any exception, because a student's character may raise it
            if self.last is None:
                raise
            self.fault = shortened(f"{type(error).__name__}: {error}", LONGEST_FAULT)
        assert self.last is not None
        return self.last


class Company:
    """Characters that are stepped together for the same time, each at its own frame rate.

    Parameters
    ----------
    characters : one to four characters, by name. Each takes its first step.
    turned : whether those that can be are turned about their roots, see `steering.RootTurner`.

    Raises
    ------
    MocapError : for no characters or more than four, and for one character under two names.
    Exception : any exception of a character at its first step. Later, the character stands still, and the
        message to the browser contains the error.

    Examples
    --------
    >>> from mocap import body, datasets
    >>> from mocap.methods import motion_matching
    >>> database = motion_matching.tabulate([body.resample(datasets.sample("walk_curve_1"), 30)])
    >>> company = Company({"matching": motion_matching.MotionMatcher(database)})
    >>> (walked,) = company.walk((np.pi / 2, 0.8, ""), 0.5)
    >>> walked.positions.shape, walked.report["waited"][-1], walked.report["obeyed"][-1]
    ((15, 38, 3), 0.5, False)
    """

    def __init__(self, characters: Mapping[str, Character], *, turned: bool = True) -> None:
        if not 1 <= len(characters) <= MOST:
            raise MocapError(f"One to {MOST} characters walk side by side, got {len(characters)}.")
        if len({id(character) for character in characters.values()}) < len(characters):
            raise MocapError("One character has two names, and would take two steps at once.")
        shown = {
            str(name): as_turned(character) if turned else character for name, character in characters.items()
        }
        self.members = [Member(name, character) for name, character in shown.items()]
        self.seconds = 0.0
        self.cost = 0.0  # CPU time of the last walk, ms per step of all characters
        self.notes: list[str] = []  # warnings of the last walk
        self.walk(START, 0.0)

    def walk(self, order: Command, seconds: float) -> list[Walked]:
        """Advance all characters by some seconds with one command, and store the warnings as `notes`."""
        self.seconds += seconds
        start = time.thread_time()
        previous_steps = self.members[0].steps
        walked = []
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always", MocapWarning)
            for member in self.members:
                steps = 1 + round(self.seconds * member.character.fps) - member.steps
                walked.append(member.walk(order, max(0, steps)))
        steps_taken = max(1, self.members[0].steps - previous_steps)
        self.cost = 1e3 * (time.thread_time() - start) / steps_taken
        self.notes = list(dict.fromkeys(str(warning.message) for warning in caught))
        return walked


def _unchanged(character: Character) -> Character:
    return character
