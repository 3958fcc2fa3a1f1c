"""Characters that take their steps together, under one order."""

from __future__ import annotations

import time
import warnings
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from mocap._shared.arrays import Array
from mocap.body.kinematics import joint_positions
from mocap.body.skeleton import Skeleton
from mocap.errors import MocapError, MocapWarning, shortened
from mocap.plotting.stick_figures import bones
from mocap.steering.characters import Character, Pose
from mocap.steering.steered_motion import as_motion
from mocap.widgets.command_clocks import CommandClock
from mocap.widgets.player import SIDES

MOST = 4  # characters side by side


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
        if not (np.isfinite(self.heading) and np.isfinite(self.speed) and self.speed >= 0):
            raise MocapError(
                f"A command is a finite heading and a speed from 0 on, got {self.heading}, {self.speed}."
            )
        return self


class Step(NamedTuple):
    """One step of a character: its pose, where its drawn joints are (K, 3), and what its clock says."""

    pose: Pose
    places: Array
    waited: float
    obeyed: bool


class Walked(NamedTuple):
    """The last F steps of a character, the first of them numbered `first`.

    `places` (F, K, 3) are the joints at which bones end, in metres; `fault` is the sentence of the error that
    it stands still for, or "".
    """

    first: int
    steps: list[Step]
    places: Array
    fault: str


class Limbs(NamedTuple):
    """What is drawn of a body: the joints, in order, and bones as rows (from, to, number of the side)."""

    joints: Array
    lines: list[list[int]]
    head: int | None


def limbs(skeleton: Skeleton) -> Limbs:
    """Choose the joints at which bones end, and the root, and number the bones' ends among them.

    Examples
    --------
    >>> from mocap.datasets.generated import SKELETON
    >>> limbs(SKELETON).lines[0], len(limbs(SKELETON).joints)
    ([1, 2, 1], 38)
    """
    starts, ends, sides = bones(skeleton)
    joints, index = np.unique([0, *starts, *ends], return_inverse=True)
    pairs = index[1:].reshape(2, -1).T.tolist()
    heads = [place for place, joint in enumerate(joints) if "head" in skeleton.names[joint].lower()]
    lines = [[*pair, SIDES.index(side)] for pair, side in zip(pairs, sides, strict=True)]
    return Limbs(joints, lines, heads[-1] if heads else None)


class Member:
    """One character of a company: its clock, its last pose, and its last error.

    Parameters
    ----------
    name : as the pictures say it.
    character : any controller.
    """

    def __init__(self, name: str, character: Character) -> None:
        self.name, self.character = name, character
        self.clock, self.limbs = CommandClock(character.fps), limbs(character.skeleton)
        self.steps, self.fault = 0, ""
        self.order: Order | None = None  # the last one that it took
        self.stands: tuple[Pose, Array] | None = None  # the last pose, and where its joints are

    def walk(self, order: Order, count: int) -> Walked:
        """Take some steps; after an error it stands still until the order changes."""
        if order != self.order:
            self.order, self.fault = order, ""
        first, steps = self.steps, [self._step(order) for _ in range(count)]
        places = np.array([step.places for step in steps]).reshape(count, len(self.limbs.joints), 3)
        return Walked(first, steps, places, self.fault)

    def _step(self, order: Order) -> Step:
        self.steps += 1
        if not self.fault:
            try:
                self.stands = self._stepped(order)
            except Exception as error:  # of any kind: it may come from a student's character
                if self.stands is None:
                    raise
                self.fault = shortened(f"{type(error).__name__}: {error}", 200)
        assert self.stands is not None
        pose, places = self.stands
        self.clock.command(order.heading)
        self.clock.step(complex(pose.root_position[2], pose.root_position[0]))
        return Step(pose, places, self.clock.waited, self.clock.obeyed)

    def _stepped(self, order: Order) -> tuple[Pose, Array]:
        pose = self.character.step(*order)
        places = joint_positions(as_motion(self.character, [pose]))[0, self.limbs.joints]
        return pose, places


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
    >>> from mocap import body, datasets, motion_matching
    >>> database = motion_matching.tabulate([body.resample(datasets.sample("walk_curve_1"), 30)])
    >>> company = Company({"matching": motion_matching.MotionMatcher(database)})
    >>> (walked,) = company.walk(Order(np.pi / 2, 0.8), 0.5)
    >>> walked.places.shape, walked.steps[-1].waited, walked.steps[-1].obeyed
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
