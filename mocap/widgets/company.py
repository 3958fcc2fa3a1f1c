"""Characters that take their steps together, under one order, and the seconds until each obeys.

A reader gives the commands, at any time, and may drag a heading along: each character carries
a `CommandClock`.
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
from mocap.widgets.player import packed_body

MOST = 4  # characters side by side


Command = tuple[float, float, str]
"""Heading in radians (0 is +z, π/2 is +x), speed in metres per second, and a label."""
START: Command = (0.0, 1.1, "")


def checked(heading: float, speed: float, label: str) -> Command:
    """Return a command; a heading or speed that no character could take is an error."""
    require_command(float(heading), float(speed))
    return float(heading), float(speed), str(label)


class Walked(NamedTuple):
    """The last F steps of a character: its poses, where its drawn joints are (F, K, 3), and what to tell.

    `told` has for each step the seconds `waited` and whether the command is `obeyed`, the number of the
    `first` step, and the `fault`: the sentence of the error that the character stands still for, or "".
    """

    poses: list[Pose]
    places: Array
    told: dict[str, Any]


class Member:
    """One character of a company: its clock, its last pose, and its last error.

    Parameters
    ----------
    name : as the pictures say it.
    character : any controller.
    """

    def __init__(self, name: str, character: Character) -> None:
        self.name, self.character = name, character
        self.clock, (self.joints, self.body) = CommandClock(character.fps), packed_body(character.skeleton)
        self.steps, self.fault = 0, ""
        self.order: Command | None = None  # the last one that it took
        self.stands: tuple[Pose, Array] | None = None  # the last pose, and where its joints are

    def walk(self, order: Command, count: int) -> Walked:
        """Take some steps; after an error it stands still until the order changes."""
        if order != self.order:
            self.order, self.fault = order, ""
        told: dict[str, Any] = {"first": self.steps, "waited": [], "obeyed": [], "blending": []}
        self.steps += count
        poses, places = [], np.empty((count, len(self.joints), 3))
        for frame in range(count):
            try:
                if not self.fault:
                    pose = self.character.step(*order)
                    self.stands = pose, joint_positions(as_motion(self.character, [pose]))[0, self.joints]
            except Exception as error:  # of any kind: it may come from a student's character
                if self.stands is None:
                    raise
                self.fault = shortened(f"{type(error).__name__}: {error}", 200)
            assert self.stands is not None
            pose, places[frame] = self.stands
            self.clock.command(order[0])
            self.clock.step(complex(pose.root_position[2], pose.root_position[0]))
            poses.append(pose)
            told["waited"].append(round(self.clock.waited, 3))
            told["obeyed"].append(self.clock.obeyed)
            told["blending"].append(bool(pose.blending))
        return Walked(poses, places, told | {"fault": self.fault, "delays": self.clock.delays[-20:]})


class Company:
    """Characters that take their steps together; seconds are counted for all, frames for each.

    Parameters
    ----------
    characters : one to four, by name; each takes its first step.

    Raises
    ------
    MocapError : for no characters or more than four, and for the same one under two names.
    Exception : whatever a character raises at its first step. Later, it stands still and says why.

    Examples
    --------
    >>> from mocap import body, datasets
    >>> from mocap.methods import motion_matching
    >>> database = motion_matching.tabulate([body.resample(datasets.sample("walk_curve_1"), 30)])
    >>> company = Company({"matching": motion_matching.MotionMatcher(database)})
    >>> (walked,) = company.walk((np.pi / 2, 0.8, ""), 0.5)
    >>> walked.places.shape, walked.told["waited"][-1], walked.told["obeyed"][-1]
    ((15, 38, 3), 0.5, False)
    """

    def __init__(self, characters: Mapping[str, Character]) -> None:
        if not 1 <= len(characters) <= MOST:
            raise MocapError(f"One to {MOST} characters walk side by side, got {len(characters)}.")
        if len({id(character) for character in characters.values()}) < len(characters):
            raise MocapError("One character has two names, and would take two steps at once.")
        self.members = [Member(str(name), character) for name, character in characters.items()]
        self.seconds = 0.0
        self.cost = 0.0  # of the last walk, CPU ms per step of all
        self.notes: list[str] = []  # warnings of the last walk
        self.walk(START, 0.0)

    def walk(self, order: Command, seconds: float) -> list[Walked]:
        """Walk on for some seconds under one order, all of them; warnings are kept as `notes`."""
        self.seconds += seconds
        start, before = time.thread_time(), self.members[0].steps
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always", MocapWarning)
            walked = [
                member.walk(order, max(0, 1 + round(self.seconds * member.character.fps) - member.steps))
                for member in self.members
            ]
        steps = max(1, self.members[0].steps - before)
        self.cost = 1e3 * (time.thread_time() - start) / steps
        self.notes = list(dict.fromkeys(str(one.message) for one in caught))
        return walked
