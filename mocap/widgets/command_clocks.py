"""The seconds since a command, and whether it is obeyed, while a character walks.

It obeys as `steering.measure_delay` says: its way over the last third of a second is within 20 degrees of the
heading. But here a reader gives the commands, at any time, and may drag a heading along.
"""

from __future__ import annotations

import cmath
import math
from collections import deque

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
