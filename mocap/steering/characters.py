"""A character that can be commanded: what all controllers have in common, and how soon they obey.

A command is a heading and a speed, which `require_command` checks.

`steer` and `measure_delay` work with anything that fits `Character`, so each new way of control can be
steered, seen and measured as those before it.
"""

import cmath
import math
import time
from collections import deque
from collections.abc import Iterable, Mapping, Sequence
from types import MappingProxyType
from typing import Protocol

import numpy as np

from mocap._shared.arrays import Array, Indices, Mask
from mocap._shared.quantities import check_radians, described
from mocap._shared.records import NamedTuple
from mocap.body.motion import Motion
from mocap.body.planar import on_ground
from mocap.body.skeleton import Skeleton
from mocap.errors import MocapError

OBEYS = math.radians(20)  # between the way of the last third of a second and the heading, at most
LONGEST = 8.0  # seconds; a turn that takes longer counts as that long
TEN_TURNS = 20 * math.pi  # radians: a heading beyond them is meant in degrees
AGAIN = math.radians(5)  # between one heading and the next, for the clock to start again


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

    skeleton: Skeleton  # the joints that the poses move
    fps: float  # steps per second

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
        fps = self.motion.fps
        track = on_ground(self.motion.root_positions) * np.exp(-1j * heading)
        back = round(fps / 3)
        directions = np.angle(track[frame:] - track[frame - back : -back])
        obeys = np.abs(directions) < OBEYS
        if not obeys.any():
            return np.full(3, np.nan)
        took = int(obeys.argmax()) + 1
        wait = min(int(self.frames_left[frame]), took)
        blends = int(self.blending[frame + wait : frame + took].sum())
        return np.array([wait, blends, took - wait - blends]) / fps


def steer(character: Character, headings: Sequence[float] | Array, speed: float = 1.1) -> Steered:
    """Steer a character by one heading per frame, and record what it does.

    Parameters
    ----------
    character : any controller; it walks on from where it is.
    headings : shape (F,), radians; 0 is +z, π/2 is +x.
    speed : metres per second.

    Raises
    ------
    MocapError : for headings beyond ten full turns, which are meant in degrees, and for what is no character.

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
    if not hasattr(character, "step"):
        needs = "This steers a character, such as steering.Controller(graph)"
        raise MocapError(f"{needs}, got {described(character)}.")
    if not isinstance(headings, Iterable):
        needs = "Headings are a list, one for each frame"
        raise MocapError(f"{needs}, got {described(headings)}: write 30 * [{headings}] for 30 frames.")
    poses: list[Pose] = []
    frames_left: list[int] = []
    for heading in headings:
        check_radians(heading, "heading", largest=TEN_TURNS)
        frames_left.append(character.frames_left)
        poses.append(character.step(float(heading), speed))
    blending = np.array([pose.blending for pose in poses])
    return Steered(as_motion(character, poses), blending, np.array(frames_left))


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
    (Motion('steered', 9 frames at 30 Hz, 0.267 s, 38 joints), ['lfoot', 'ltoes', 'rfoot', 'rtoes'])
    """
    root_positions = np.array([pose.root_position for pose in poses])
    rotations = np.array([pose.rotations for pose in poses])
    marks = [mark for mark in poses[0].contacts if all(mark in pose.contacts for pose in poses)]
    contacts = {mark: np.array([pose.contacts[mark] for pose in poses]) for mark in marks}
    return Motion(character.skeleton, root_positions, rotations, character.fps, name, contacts=contacts)


def between(first: float, second: float) -> float:
    """Return the angle between two headings, radians from 0 to π.

    Examples
    --------
    >>> round(between(3.0, -3.0), 3)
    0.283
    """
    return abs(cmath.phase(cmath.exp(1j * (first - second))))


class CommandClock:
    """A clock for one character; it starts again with each command that differs by more than 5 degrees.

    A character obeys when its way over the last third of a second is within 20 degrees of the command.
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
        self.fps = fps
        self.back = round(fps / 3)
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
            self.started = heading
            self.frames = 0
            self.obeyed = False
            self.counts = len(self.track) > self.back and self._error() >= OBEYS

    def step(self, place: complex) -> None:
        """Take where the root is on the ground after a step, z + ix."""
        self.track.append(place)
        if self.obeyed:
            return
        self.frames += 1
        self.obeyed = self.frames > self.back and len(self.track) > self.back and self._error() < OBEYS
        if self.obeyed and self.counts:
            self.delays.append(self.waited)

    def _error(self) -> float:
        return between(cmath.phase(self.track[-1] - self.track[0]), self.heading)


class Delay(NamedTuple):
    """The delay until a character obeys, and the CPU time per step.

    `mean` and `slowest` (95 %) are delays in seconds; `step` (mean) and `worst` are CPU times in ms. Two mean
    parts of the delay are `waiting`, until the character can make its next choice, and `blending`, in
    transitions after it. The rest is spent in clips that turn. `never` is the number of
    turns that took longer than 8 s.
    """

    mean: float
    slowest: float
    step: float
    worst: float
    waiting: float
    blending: float
    never: int


def measure_delay(character: Character, *, turns: int = 60, speed: float = 1.1, seed: int = 0) -> Delay:
    """Command a character to turn by 30 to 120 degrees many times, and measure how soon it obeys.

    It obeys as `CommandClock` says; a turn that takes longer than 8 s counts as 8 s. The next command comes
    as soon as this one is obeyed.

    Parameters
    ----------
    character : any controller, just made; it has walked on when this returns.
    turns : the number of turns.
    speed : metres per second.
    seed : of the random turns.

    Examples
    --------
    >>> from mocap import body, datasets, graphs
    >>> from mocap.steering import Controller
    >>> clips = [body.resample(datasets.sample("walk_curve_1"), 30)]
    >>> graph = graphs.prune(graphs.build(clips, window=10, threshold=0.04))
    >>> 0 < measure_delay(Controller(graph), turns=1).mean <= 8
    True

    Notebook: 08b-steering
    """
    random = np.random.default_rng(seed)
    fps = character.fps
    clock = CommandClock(fps)
    heading = 0.0
    costs: list[float] = []  # CPU seconds of each step
    delays: list[tuple[int, int, int]] = []  # frames: of the whole delay, waiting, blending
    never = 0
    for _ in range(turns):
        heading += random.choice([-1, 1]) * random.uniform(np.pi / 6, 2 * np.pi / 3)
        wait = character.frames_left
        blends = 0
        clock.command(heading)
        while not clock.obeyed and clock.frames < round(LONGEST * fps):
            start = time.thread_time()
            pose = character.step(heading, speed)
            costs.append(time.thread_time() - start)
            blends += pose.blending and clock.frames >= wait
            clock.step(complex(on_ground(pose.root_position)))
        delays.append((clock.frames, min(wait, clock.frames), blends))
        never += not clock.obeyed
    took, waited, blended = np.transpose(delays) / fps
    # The first step looks ahead from the start without any frame to do so before; games do it while loading.
    cost = 1e3 * np.array(costs[1:])
    mean, step, waiting, blending = (float(values.mean()) for values in (took, cost, waited, blended))
    slowest = float(np.percentile(took, 95))
    return Delay(mean, slowest, step, float(cost.max()), waiting, blending, never)
