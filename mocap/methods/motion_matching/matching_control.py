"""A character by motion matching: search, cut, and let the difference die away [Cla16, Hol20]."""

import math
from collections import deque

import numpy as np

from mocap._shared.arrays import Array, Indices, Mask
from mocap.body import rotations
from mocap.body.motion import Motion
from mocap.body.planar import PlanarTransform
from mocap.errors import warn
from mocap.methods.motion_matching.nearest_frames import EQUAL, FrameSearch, Wants, fade, foresee
from mocap.methods.motion_matching.pose_database import FUTURE, POSE, PoseDatabase
from mocap.steering.characters import Pose, require_command

USUAL = Wants()
# A cut must halve the cost of playing on. If no clip has the future asked for, all frames cost nearly the
# same, and a character that takes each small gain cuts five times a second, to one moment of a stride.
GAIN = 0.5
BACK = (0.1, 0.6)  # seconds before now: poses of the last stride to which no cut returns
SIMILAR = 0.1  # distance of standardised poses up to which they count as one, as of a character that stands
HORIZON = 1.0  # seconds that the features look ahead
SHARPEST = 99  # percentile of the frames, of how far they turn within the horizon
SLOW = 4.0  # seconds: clips that turn more slowly to a command than in this time are warned of


class MotionMatcher:
    """A character that searches all clips for the frame to play next; it fits `steering.Character`.

    Every 0.1 s, and at each new command, it asks which frame has a pose like its own and a future like the
    one asked for. Where one is better than to play on, it cuts there. The offset to the old pose, with its
    velocity, dies away by a spring (inertialization). Nothing is known beforehand, and nothing is planned.

    Parameters
    ----------
    database : the frames of all clips.
    wants : how it searches, and how a cut fades.
    start : the frame it starts with; by default the first usable one.

    Examples
    --------
    >>> from mocap import body, datasets
    >>> from mocap.methods.motion_matching.pose_database import tabulate
    >>> clips = [body.resample(datasets.sample("walk_curve_1"), 30)]
    >>> matcher = MotionMatcher(tabulate(clips))
    >>> poses = [matcher.step(heading=1.0, speed=0.8) for _ in range(15)]
    >>> poses[0].rotations.shape, matcher.frames_left, matcher.cuts
    ((38, 4), 0, [9])
    >>> [number for number, pose in enumerate(poses) if pose.blending]  # for 0.2 s after the cut
    [9, 10, 11, 12, 13, 14]
    >>> [number for number, pose in enumerate(poses) if pose.contacts["rtoes"]]  # then the right ball lifts
    [0, 1]

    Notebook: 18-motion-matching
    """

    frames_left = 0  # it can choose in every frame

    def __init__(self, database: PoseDatabase, wants: Wants = USUAL, *, start: int | None = None) -> None:
        self.database = database
        self.wants = wants
        self.skeleton = database.motion.skeleton
        self.fps = database.motion.fps
        self.frame = int(np.argmax(database.usable)) if start is None else start
        self._searches: dict[str, FrameSearch] = {}  # by label
        turn = complex(np.exp(-1j * database.heading[self.frame]))
        self.place = PlanarTransform.from_complex(turn, -turn * complex(database.ground[self.frame]))
        # The difference after a cut, (J + 1, 3): the root, metres, and a rotation vector for each joint.
        self.offset = np.zeros(database.speeds.shape[1:])
        self.offset_speed = np.zeros_like(self.offset)
        self.cuts: list[int] = []  # at which steps it cut
        self._steps = 0
        self._wait = 0  # steps until the next search
        self._command: tuple[float, float, str] | None = None
        self._is_told = False  # that the clips hardly turn
        self._played: deque[int] = deque(maxlen=round(BACK[1] * self.fps))
        self.rotation_rate = 0.0  # radians per second, of one who turns the figure in addition
        self.sharpest = _sharpest_turn(database)  # radians

    def step(self, heading: float, speed: float, label: str = "") -> Pose:
        """Walk on by one frame.

        Parameters
        ----------
        heading : the direction to go in, radians; 0 is +z, π/2 is +x.
        speed : metres per second.
        label : the kind of motion, "" for any.

        Raises
        ------
        MocapError : for a heading or speed that is no finite number, or a speed below 0.
        NoWalk : for a label that no clip has.

        Warns
        -----
        MocapWarning : for a new speed outside what 98 % of the clips' frames have, and once for a turn that
            would take the clips more than four seconds.
        """
        table = self.database
        command = (heading, speed, label)
        if command != self._command:
            require_command(heading, speed)
            self._warn_of_speed(speed)
            if label not in self._searches:
                self._searches[label] = FrameSearch(table, future=self.wants.future, label=label)
            self._command = command
            self._wait = 0  # a new command is searched for at once
        if self._wait <= 0 or self.frame >= table.last[self.frame]:
            self._wait = max(1, round(self.wants.every * self.fps))
            self._cut_if_better(heading, speed, label)
        root, turns = self._placed(self.place, self.frame)
        blending_steps = 2 * self.wants.fade * self.fps
        is_blending = bool(self.cuts) and self._steps - self.cuts[-1] < blending_steps
        contacts = {name: bool(mark[self.frame]) for name, mark in table.motion.contacts.items()}
        self._played.append(self.frame)
        self.frame = min(self.frame + 1, int(table.last[self.frame]))
        self._steps += 1
        self._wait -= 1
        self.offset, self.offset_speed = fade(self.offset, self.offset_speed, self.wants.fade, 1 / self.fps)
        return Pose(root, turns, is_blending, contacts)

    @property
    def example(self) -> Motion:
        """All clips, which show how the joints bend."""
        return self.database.motion

    def transform_by(self, rotation: complex, translation: complex) -> None:
        """Transform what comes from now on by p ↦ rotation · p + translation, on the ground, z + ix."""
        turn = complex(rotation * self.place.rotation)
        move = complex(rotation * self.place.translation + translation)
        self.place = PlanarTransform.from_complex(turn, move)
        for vector in (self.offset[0], self.offset_speed[0]):
            on_floor = rotation * complex(vector[2], vector[0])
            vector[0] = on_floor.imag
            vector[2] = on_floor.real

    def _warn_of_speed(self, speed: float) -> None:
        """Warn of a new speed outside those of 98 % of the frames."""
        if self._command is not None and speed == self._command[1]:
            return
        slow, fast = np.percentile(np.abs(self.database.drift), [1, 99])
        if not slow <= speed <= fast:
            clips = f"the clips' {slow:.1f} to {fast:.1f} m/s"
            warn(f"{speed:g} m/s is outside {clips}: the nearest is walked.")

    def _cut_if_better(self, heading: float, speed: float, label: str) -> None:
        """Search, and cut if another frame is better than to play on.

        The pose of the query is that of the frame that plays, so that to play on costs only the difference
        of the futures.
        """
        table = self.database
        frame = self.frame
        search = self._searches[label]
        bearing = math.remainder(heading - self.place.angle - table.heading[frame], 2 * math.pi)
        bearing = self._possible_bearing(bearing)
        goal = speed * complex(np.exp(1j * bearing))
        query = table.values[frame].copy()
        query[FUTURE] = foresee(table, frame, goal, self.wants.halflife)
        can_stay = frame < table.last[frame] and (not label or bool(table.motion.labels[label][frame]))
        cost_of_staying = search.cost(query, frame) - self.wants.bonus if can_stay else np.inf
        new, cost = search.nearest(query, self._goes_on if self.wants.guarded else self._is_elsewhere)
        if new < 0 and not can_stay:
            new, cost = search.nearest(query, self._is_elsewhere)
        gain = GAIN if self.wants.guarded else 1.0
        if cost < gain * cost_of_staying - EQUAL:
            self._cut_to(new)

    def _is_elsewhere(self, frames: Indices) -> Mask:
        """Return which frames are not about the one that plays, to which a cut would show nothing new."""
        return np.asarray(np.abs(frames - self.frame) >= round(self.wants.near * self.fps))

    def _goes_on(self, frames: Indices) -> Mask:
        """Return which frames lead on: their pose is no more like those of the last stride than like mine.

        Without it a character whose request no clip fulfils returns again and again to the moment of a stride
        that comes nearest to it, and glides on one pose.
        """
        poses = self.database.values[:, POSE]
        until = len(self._played) - round(BACK[0] * self.fps)
        past = poses[list(self._played)[: max(0, until)]]
        candidates = poses[frames]
        from_now = np.linalg.norm(candidates - poses[self.frame], axis=1)
        from_past = np.linalg.norm(candidates[:, None] - past, axis=2).min(axis=1, initial=np.inf)
        return np.asarray(self._is_elsewhere(frames) & (from_now <= from_past + SIMILAR))

    def _possible_bearing(self, bearing: float) -> float:
        """Return the part of a turn that the clips are asked for, radians.

        Less whatever the figure is turned in addition within the horizon, and no more than clips turn in it:
        a future that no clip has is as far from each frame, so that the character would play one pose.
        """
        if not self.wants.guarded:
            return bearing
        if self.rotation_rate:
            bearing = math.copysign(max(0.0, abs(bearing) - HORIZON * self.rotation_rate), bearing)
        elif abs(bearing) > SLOW * self.sharpest / HORIZON and not self._is_told:
            self._is_told = True
            turns = f"The clips turn by {math.degrees(self.sharpest):.0f}° in a second at most"
            command = f"a command asks for {abs(math.degrees(bearing)):.0f}°"
            warn(f"{turns}, and {command}: steering.RootTurner(character) turns the figure.")
        return max(-self.sharpest, min(self.sharpest, bearing))

    def _cut_to(self, new: int) -> None:
        """Play another frame: align its track with that of the current one; the residual is the offset."""
        table = self.database
        frame = self.frame
        turn = complex(self.place.rotation * np.exp(1j * (table.heading[frame] - table.heading[new])))
        turn /= abs(turn)
        target = self.place.rotation * table.ground[frame] + self.place.translation
        place = PlanarTransform.from_complex(turn, complex(target - turn * table.ground[new]))
        root, turns = self._placed(self.place, frame)
        motion = table.motion
        new_root, new_turns = place.apply_frames(motion.root_positions[new], motion.rotations[new])
        self.offset = np.concatenate([[root - new_root], rotations.difference(new_turns, turns)])
        self.offset_speed = self.offset_speed + self._speeds(self.place, frame) - self._speeds(place, new)
        self.frame = new
        self.place = place
        self.cuts.append(self._steps)

    def _placed(self, place: PlanarTransform, frame: int) -> tuple[Array, Array]:
        """Return the pose of a frame with the offset: root position (3,) and rotations (J, 4)."""
        motion = self.database.motion
        root, turns = place.apply_frames(motion.root_positions[frame], motion.rotations[frame])
        return root + self.offset[0], rotations.multiply(turns, rotations.from_rotvec(self.offset[1:]))

    def _speeds(self, place: PlanarTransform, frame: int) -> Array:
        """Return the velocities of a frame, (J + 1, 3), the root's rotated as its place is."""
        speeds: Array = self.database.speeds[frame].copy()
        speeds[0] = rotations.rotate(rotations.about_y(place.angle), speeds[0])
        return speeds


def _sharpest_turn(database: PoseDatabase) -> float:
    """Return by how much 99 % of the usable frames turn at most within a second, radians."""
    last = slice(-2, None)  # the direction after a second, (x, z)
    directions = database.values[:, last] * database.scale[last] + database.mean[last]
    turns = np.abs(np.arctan2(*directions[database.usable].T))
    return float(np.percentile(turns, SHARPEST))
