"""A character by motion matching: search, cut, and let what differs die away [Cla16, Hol20]."""

import numpy as np

from mocap._shared.arrays import Array
from mocap.body import rotations
from mocap.body.planar import PlanarTransform
from mocap.errors import warn
from mocap.methods.motion_matching.nearest_frames import EQUAL, FrameSearch, Wants, fade, foresee
from mocap.methods.motion_matching.pose_database import FUTURE, PoseDatabase
from mocap.steering.characters import Pose, require_command

USUAL = Wants()


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
    ((38, 4), 0, [6])
    >>> [number for number, pose in enumerate(poses) if pose.blending]  # for 0.2 s after the cut
    [6, 7, 8, 9, 10, 11]
    >>> [number for number, pose in enumerate(poses) if pose.contacts["rtoes"]]  # then the right ball lifts
    [0, 1]

    Notebook: 18-motion-matching
    """

    frames_left = 0  # it can choose in every frame

    def __init__(self, database: PoseDatabase, wants: Wants = USUAL, *, start: int | None = None) -> None:
        self.database, self.wants = database, wants
        self.skeleton, self.fps = database.motion.skeleton, database.motion.fps
        self.frame = int(np.argmax(database.usable)) if start is None else start
        self._searches: dict[str, FrameSearch] = {}  # by label
        turn = complex(np.exp(-1j * database.heading[self.frame]))
        self.place = PlanarTransform.from_complex(turn, -turn * complex(database.ground[self.frame]))
        # What differs after a cut, (J + 1, 3): the root, metres, and a rotation vector for each joint.
        self.offset = np.zeros(database.speeds.shape[1:])
        self.offset_speed = np.zeros_like(self.offset)
        self.cuts: list[int] = []  # at which steps it cut
        self._steps = self._wait = 0
        self._command: tuple[float, float, str] | None = None

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
        MocapWarning : for a new speed outside what 98 % of the clips' frames have.
        """
        table, command = self.database, (heading, speed, label)
        if command != self._command:
            require_command(heading, speed)
            slow, fast = np.percentile(np.abs(table.drift), [1, 99])
            if (self._command is None or speed != self._command[1]) and not slow <= speed <= fast:
                clips = f"the clips' {slow:.1f} to {fast:.1f} m/s"
                warn(f"{speed:g} m/s is outside {clips}: the nearest is walked.")
            if label not in self._searches:
                self._searches[label] = FrameSearch(table, future=self.wants.future, label=label)
            self._command, self._wait = command, 0  # what is new is searched for at once
        if self._wait <= 0 or self.frame >= table.last[self.frame]:
            self._wait = max(1, round(self.wants.every * self.fps))
            self._look(heading, speed, label)
        root, turns = self._placed(self.place, self.frame)
        blending = bool(self.cuts) and self._steps - self.cuts[-1] < 2 * self.wants.fade * self.fps
        contacts = {name: bool(mark[self.frame]) for name, mark in table.motion.contacts.items()}
        self.frame = min(self.frame + 1, int(table.last[self.frame]))
        self._steps, self._wait = self._steps + 1, self._wait - 1
        self.offset, self.offset_speed = fade(self.offset, self.offset_speed, self.wants.fade, 1 / self.fps)
        return Pose(root, turns, blending, contacts)

    def _look(self, heading: float, speed: float, label: str) -> None:
        """Search, and cut where another frame is better than to play on.

        The pose asked for is that of now, so that to play on costs only what the future asks.
        """
        table, now, search = self.database, self.frame, self._searches[label]
        goal = speed * complex(np.exp(1j * (heading - self.place.angle - table.heading[now])))
        query = table.values[now].copy()
        query[FUTURE] = foresee(table, now, goal, self.wants.halflife)
        stay = now < table.last[now] and (not label or bool(table.motion.labels[label][now]))
        staying = search.cost(query, now) - self.wants.bonus if stay else np.inf
        new, cost = search.nearest(query, now, round(self.wants.near * self.fps))
        if cost >= staying - EQUAL:
            return
        # The new frame's track is put on the old one's; what differs becomes the offset.
        turn = complex(self.place.turn * np.exp(1j * (table.heading[now] - table.heading[new])))
        turn /= abs(turn)
        move = complex(self.place.turn * table.ground[now] + self.place.move - turn * table.ground[new])
        place = PlanarTransform.from_complex(turn, move)
        root, shown = self._placed(self.place, now)
        motion = table.motion
        new_root, new_turns = place.apply_frames(motion.root_positions[new], motion.rotations[new])
        self.offset = np.concatenate([[root - new_root], rotations.difference(new_turns, shown)])
        self.offset_speed = self.offset_speed + self._speeds(self.place, now) - self._speeds(place, new)
        self.frame, self.place = new, place
        self.cuts.append(self._steps)

    def _placed(self, place: PlanarTransform, frame: int) -> tuple[Array, Array]:
        """Place a frame, with the offset: root (3,) and turns (J, 4)."""
        motion = self.database.motion
        root, turns = place.apply_frames(motion.root_positions[frame], motion.rotations[frame])
        return root + self.offset[0], rotations.multiply(turns, rotations.from_rotvec(self.offset[1:]))

    def _speeds(self, place: PlanarTransform, frame: int) -> Array:
        """Give a frame's speeds (J + 1, 3), the root's turned as its place is."""
        speeds: Array = self.database.speeds[frame].copy()
        speeds[0] = rotations.rotate(rotations.about_y(place.angle), speeds[0])
        return speeds
