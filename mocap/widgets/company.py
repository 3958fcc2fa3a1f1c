"""Characters that take their steps together, under one order, and the seconds until each obeys.

It obeys as `steering.measure_delay` says: its way over the last third of a second is within 20 degrees of the
heading. But here a reader gives the commands, at any time, and may drag a heading along.
"""

from __future__ import annotations

import cmath
import math
import time
import warnings
from collections import deque
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from mocap._shared.arrays import Array
from mocap.body.kinematics import joint_positions
from mocap.errors import MocapError, MocapWarning, shortened
from mocap.steering.characters import Character, Pose, as_motion, require_command
from mocap.widgets.packing import drawn

MOST = 4  # characters side by side
OBEYS = math.radians(20)  # between the way and the heading, at most
AGAIN = math.radians(5)  # between one heading and the next, for the clock to start again


def between(heading: float, other: float) -> float:
    """Give the angle between two headings, radians from 0 to π.

    Examples
    --------
    >>> round(between(3.0, -3.0), 3)
    0.283
    """
    return abs(cmath.phase(cmath.exp(1j * (heading - other))))


class CommandClock:
    """A clock for one character; it starts again with each command that differs by more than 5 degrees.

    A delay counts where the command was not obeyed when it came, and was before the next one came.

    Parameters
    ----------
    fps : steps per second.

    Examples
    --------
    A dot goes ahead for a second, and then to the left at once. When half of the last third of a second lies
    on the new way, that is 45 degrees off; within 20 degrees it is after 9 steps.

    >>> clock, place = CommandClock(30.0), 0j
    >>> for step in range(60):
    ...     clock.command(0.0 if step < 30 else math.pi / 2)
    ...     place += 0.04 if step < 30 else 0.04j
    ...     clock.step(place)
    >>> clock.obeyed, [round(delay, 2) for delay in clock.delays]
    (True, [0.37])
    """

    def __init__(self, fps: float) -> None:
        self.fps, self.back = fps, round(fps / 3)
        self.track: deque[complex] = deque(maxlen=self.back + 1)
        self.heading = self.started = 0.0  # the command's, now and when the clock started; radians
        self.frames = 0
        self.obeyed = self.counts = False
        self.delays: list[float] = []  # seconds

    @property
    def waited(self) -> float:
        """The seconds since the command; once it is obeyed, the seconds that this took."""
        return self.frames / self.fps

    def command(self, heading: float) -> None:
        """Take the heading of the next step."""
        self.heading = heading
        if between(heading, self.started) > AGAIN:
            self.started, self.frames, self.obeyed = heading, 0, False
            self.counts = len(self.track) > self.back and self._off() >= OBEYS

    def step(self, place: complex) -> None:
        """Take where the root is on the ground after a step, z + ix."""
        self.track.append(place)
        if self.obeyed:
            return
        self.frames += 1
        self.obeyed = self.frames > self.back and len(self.track) > self.back and self._off() < OBEYS
        if self.obeyed and self.counts:
            self.delays.append(self.waited)

    def _off(self) -> float:
        return between(cmath.phase(self.track[-1] - self.track[0]), self.heading)


class Order(NamedTuple):
    """One command for all: heading in radians (0 is +z, π/2 is +x), speed in metres per second, and a label.

    Examples
    --------
    >>> Order(0.5).checked()
    Order(heading=0.5, speed=1.1, label='')
    """

    heading: float = 0.0
    speed: float = 1.1
    label: str = ""

    def checked(self) -> Order:
        """Return it as it is; a heading or speed that no character could take is an error."""
        require_command(self.heading, self.speed)
        return self


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
        self.clock, self.drawn = CommandClock(character.fps), drawn(character.skeleton)
        self.steps, self.fault = 0, ""
        self.order: Order | None = None  # the last one that it took
        self.stands: tuple[Pose, Array] | None = None  # the last pose, and where its joints are

    def walk(self, order: Order, count: int) -> Walked:
        """Take some steps; after an error it stands still until the order changes."""
        if order != self.order:
            self.order, self.fault = order, ""
        told: dict[str, Any] = {"first": self.steps, "waited": [], "obeyed": [], "blending": []}
        self.steps += count
        poses, places = [], np.empty((count, len(self.drawn.joints), 3))
        for frame in range(count):
            pose, places[frame] = self._step(order)
            self.clock.command(order.heading)
            self.clock.step(complex(pose.root_position[2], pose.root_position[0]))
            poses.append(pose)
            told["waited"].append(round(self.clock.waited, 3))
            told["obeyed"].append(self.clock.obeyed)
            told["blending"].append(bool(pose.blending))
        return Walked(poses, places, told | {"fault": self.fault, "delays": self.clock.delays[-20:]})

    def _step(self, order: Order) -> tuple[Pose, Array]:
        """Take a step, or stand still."""
        if not self.fault:
            try:
                pose = self.character.step(*order)
                motion = as_motion(self.character, [pose])
                self.stands = pose, joint_positions(motion)[0, self.drawn.joints]
            except Exception as error:  # of any kind: it may come from a student's character
                if self.stands is None:
                    raise
                self.fault = shortened(f"{type(error).__name__}: {error}", 200)
        assert self.stands is not None
        return self.stands


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
    >>> (walked,) = company.walk(Order(np.pi / 2, 0.8), 0.5)
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
        self.walk(Order(), 0.0)

    def walk(self, order: Order, seconds: float) -> list[Walked]:
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
