"""A character that turns about its root as people do, while its standing feet stay where they are.

A motion graph turns only where its clips turn, and has their speeds. But a figure that is turned about its
root and moved along its path, by a little in each frame, obeys at once, and its root does not jump. Its
standing feet would slide, so that `HeldFeet` holds them: legs, heels and hips take up the difference. This
is ours; the papers change the motion afterwards [Gle01], when the whole path is known.
"""

from __future__ import annotations

import cmath
import math
from collections import deque
from typing import Protocol, runtime_checkable

from mocap.body.motion import Motion
from mocap.body.planar import on_ground
from mocap.errors import MocapError, warn
from mocap.steering.characters import Character, Pose
from mocap.steering.held_feet import HeldFeet
from mocap.steering.tuned import TUNED

RATE = math.radians(100)  # per second, as people turn while they walk

# As long as the direction is off by more, the figure turns at its full rate; below, the rate falls with the
# square. The pelvis sways, and the direction with it, by about 6° to both sides.
FULL = math.radians(20)

TWIST = math.radians(45)  # of the leg of a standing foot against the clip, at most, as hips turn
STRETCH = 0.2  # of a step's length: the feet land that much nearer or farther than in the clips
STRETCH_RISE = 0.5  # seconds in which steps come to be stretched by the full fraction
RISE = 0.15  # seconds in which the rate rises from 0 to the full one
THIRD = 1 / 3  # seconds of path that show the direction
STRIDE = 1.0  # seconds, about that of two steps, in which the sway of the pelvis cancels
WALKING = 0.15  # m/s. A slower character goes nowhere, so it has no direction that could be wrong


@runtime_checkable
class Turnable(Character, Protocol):
    """A character that can be turned and moved on the ground while it walks."""

    rotation_rate: (
        float  # radians per second by which it will be turned at most: what it plans counts on that
    )

    @property
    def example(self) -> Motion:
        """A motion of its clips, which shows how its knees bend."""

    def transform_by(self, rotation: complex, translation: complex) -> None:
        """Transform what comes from now on by p ↦ rotation · p + translation, on the ground, z + ix."""


def as_turned(character: Character) -> Character:
    """Return a character that is turned about its root, if it can be, or else the character itself.

    Examples
    --------
    >>> from mocap import body, datasets, graphs
    >>> from mocap.steering import Controller
    >>> clips = [body.resample(datasets.sample("walk_curve_1"), 30)]
    >>> controller = Controller(graphs.prune(graphs.build(clips, window=10, threshold=0.04)))
    >>> turner = as_turned(controller)
    >>> type(turner).__name__, as_turned(turner) is turner
    ('RootTurner', True)
    """
    return RootTurner(character) if isinstance(character, Turnable) else character


class RootTurner:
    """A character that is turned about its root towards the command, with its standing feet held.

    The direction of the last third of a second is off the heading by e. Before each frame the figure is
    turned towards it by r min(1, e² / (20°)²) / fps, and in addition by as much as its clip turns away from
    it, but by no more than 1.5 r / fps. A clip that turns has gone on turning since the middle of that third;
    e counts that, at its mean rate over a second. The rate r rises within 0.15 s, and a leg whose
    ankle stands is turned by at most 45° against its clip. The steps become up to a fifth longer or shorter,
    towards the requested speed. The same class turns characters on motion graphs and on parametric graphs,
    and by motion matching.

    Parameters
    ----------
    character : what gives the poses; its figure is turned while it walks.
    rate : radians per second to turn at most; 0 leaves the direction to the clips.
    stretch : the fraction by which steps become longer or shorter at most, towards the requested speed.
    halflife : seconds, of the spring by which the offset of a lifted foot fades.

    Raises
    ------
    MocapError : for a rate that is below 0 or no finite number, a stretch outside 0 to 1, a half-life that is
        not positive, and legs that are not found.

    Warns
    -----
    MocapWarning : if the clips have no contacts, so that no foot can be held.

    Examples
    --------
    >>> from mocap import body, datasets, graphs
    >>> from mocap.steering import Controller, measure_delay
    >>> clips = [body.resample(datasets.sample("walk_circle"), 30)]
    >>> graph = graphs.compile_graph(graphs.prune(graphs.build(clips, window=10, threshold=0.04)))
    >>> untouched = measure_delay(Controller(graph), turns=10).mean
    >>> untouched - measure_delay(RootTurner(Controller(graph)), turns=10).mean > 0.5
    True

    Notebook: 18-motion-matching
    """

    def __init__(
        self,
        character: Turnable,
        rate: float = RATE,
        *,
        stretch: float = STRETCH,
        halflife: float = TUNED.foot_halflife,
    ) -> None:
        if not 0 <= rate < math.inf:
            raise MocapError(f"A figure turns by a finite rate from 0 on, got {rate} radians per second.")
        if not 0 <= stretch < 1:
            raise MocapError(f"Steps are stretched by a fraction from 0 up to 1, got {stretch}.")
        self.character = character
        self.rate = rate
        self.stretch = stretch
        self.skeleton = character.skeleton
        self.fps = character.fps
        self.feet = HeldFeet(character.example, halflife=halflife)
        character.rotation_rate = rate
        # The root's path in the last second, as it would be without any turn, and the turn so far.
        # So what was turned shows at once. If it showed only as the walk goes on, the figure would turn too
        # far and back, for ever.
        self.track: deque[complex] = deque(maxlen=round(STRIDE * character.fps) + 1)
        self.root = 0j  # on the ground, z + ix
        self.rotation = 1 + 0j
        self.angle = 0.0  # by which the last frame was turned, radians
        self.stretched = 0.0  # fraction by which the last frame's step was longer than the clip's

    @property
    def frames_left(self) -> int:
        """The frames until the character's next choice; it turns before that, too."""
        return self.character.frames_left

    def step(self, heading: float, speed: float, label: str = "") -> Pose:
        """Turn a little about the root, walk on by one frame as the character does, and hold its feet."""
        if len(self.track) > 1:
            self._transform(heading, speed)
        pose = self.character.step(heading, speed, label)
        if not (self.track or pose.contacts):
            warn("The clips do not say when feet stand, so that feet slide in turns; mark_plants finds out.")
        root = complex(on_ground(pose.root_position))
        if self.track:
            step = (root - self.root) / self.rotation
            self.track.append(self.track[-1] + step)
        else:
            self.track.append(0j)
        self.root = root
        return self.feet.hold(pose)

    def _transform(self, heading: float, speed: float) -> None:
        """Turn the figure about its root, and move it by what its last step lacks or exceeds."""
        self.angle = self._next_angle(heading)
        turn = cmath.exp(1j * self.angle)
        self.stretched = self._next_stretch(speed)
        self.rotation *= turn / abs(self.rotation)
        clip_step = self.track[-1] - self.track[-2]
        place = self.root + self.stretched * self.rotation * clip_step
        self.character.transform_by(turn, place - turn * self.root)
        self.root = place

    def _next_stretch(self, speed: float) -> float:
        """Return the fraction by which the next step is longer than the clip's."""
        path, seconds = self._path()
        clip_speed = abs(path) / seconds
        needed = speed / clip_speed - 1 if clip_speed > WALKING else 0.0
        goal = max(-self.stretch, min(self.stretch, needed))
        change = self.stretch / (STRETCH_RISE * self.fps)
        return max(self.stretched - change, min(self.stretched + change, goal))

    def _next_angle(self, heading: float) -> float:
        """Return the angle of the next frame, as far as the rate and the legs allow; radians."""
        path, seconds = self._path()
        error = 0.0
        if abs(path) > WALKING * seconds:
            since_middle = cmath.exp(0.5j * seconds * self._clip_rate(STRIDE))  # what the clip has turned
            error = cmath.phase(cmath.exp(1j * heading) / (self.rotation * since_middle * path))
        side = math.copysign(1.0, error)
        against = max(0.0, -side * self._clip_rate(THIRD))
        rate = self.rate * min(1.0, (error / FULL) ** 2)
        rate = min(rate + against, TUNED.largest_rotation * self.rate)
        rise = self.rate / (RISE * self.fps**2)
        angle = max(self.angle - rise, min(self.angle + rise, side * rate / self.fps))
        twists = [0.0, *self.feet.twists()]
        return max(min(0.0, max(twists) - TWIST), min(max(0.0, min(twists) + TWIST), angle))

    def _path(self) -> tuple[complex, float]:
        """Return the unturned path of the last third of a second, and its duration."""
        frames = min(len(self.track) - 1, round(THIRD * self.fps))
        return self.track[-1] - self.track[-1 - frames], frames / self.fps

    def _clip_rate(self, seconds: float) -> float:
        """Return the rate at which the root's path turned by itself, radians per second, up to `rate`."""
        half = min(len(self.track) - 1, round(seconds * self.fps)) // 2
        if half < 1:
            return 0.0
        middle = self.track[-1 - half]
        first = middle - self.track[-1 - 2 * half]
        second = self.track[-1] - middle
        if min(abs(first), abs(second)) * self.fps < WALKING * half:
            return 0.0
        rate = cmath.phase(second / first) * self.fps / half
        return max(-self.rate, min(self.rate, rate))
