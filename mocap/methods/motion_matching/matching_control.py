"""A character by motion matching: search, cut, and let what differs die away [Cla16, Hol20]."""

from typing import NamedTuple

import numpy as np

from mocap._shared.arrays import Array
from mocap.body import rotations
from mocap.body.planar import PlanarTransform
from mocap.body.skeleton import Skeleton
from mocap.errors import MocapError, NoWalk
from mocap.methods.motion_matching.frame_features import FUTURE
from mocap.methods.motion_matching.nearest_frames import FrameSearch, Wants, foresee, next_frame
from mocap.methods.motion_matching.pose_database import PoseDatabase, warn_of_speed
from mocap.methods.motion_matching.springs import fade
from mocap.steering.characters import Pose, place_frames, require_command


class Offset(NamedTuple):
    """What differs after a cut: `root` (3,) metres, `turns` (J, 3) rotation vectors, and their velocities.

    Examples
    --------
    >>> Offset(*(np.zeros(3), np.zeros((2, 3))) * 2).turns.shape
    (2, 3)
    """

    root: Array
    turns: Array
    root_speed: Array
    turn_speed: Array


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
    tree : as for `FrameSearch`.

    Raises
    ------
    MocapError : for wants that make no sense, and a start that is no frame.

    Examples
    --------
    >>> from mocap import body, datasets
    >>> from mocap.methods.motion_matching.pose_database import tabulate
    >>> clips = [body.resample(datasets.sample("walk_curve_1"), 30)]
    >>> matcher = MotionMatcher(tabulate(clips))
    >>> matcher.step(heading=0.0, speed=0.8).rotations.shape
    (38, 4)

    Notebook: 18-motion-matching
    """

    def __init__(
        self,
        database: PoseDatabase,
        wants: Wants | None = None,
        *,
        start: int | None = None,
        tree: bool | None = None,
    ) -> None:
        self.database, self.wants = database, wants or Wants()
        self.wants.check()
        self.frame = int(np.argmax(database.usable)) if start is None else start
        if not 0 <= self.frame < len(database):
            raise MocapError(f"The start is a frame from 0 to {len(database) - 1}, got {start}.")
        self._tree, self._searches = tree, {"": FrameSearch(database, future=self.wants.future, tree=tree)}
        self._near = round(self.wants.near * self.fps)
        turn = complex(np.exp(-1j * database.heading[self.frame]))
        self.place = PlanarTransform.from_complex(turn, -turn * complex(database.ground[self.frame]))
        joints = database.turns.shape[1]
        self.offset = Offset(np.zeros(3), np.zeros((joints, 3)), np.zeros(3), np.zeros((joints, 3)))
        self.cuts: list[int] = []  # at which steps it cut
        self._steps = self._wait = 0
        self._command: tuple[float, float, str] | None = None

    @property
    def skeleton(self) -> Skeleton:
        """The joints of the clips."""
        return self.database.clips[0].skeleton

    @property
    def fps(self) -> float:
        """Frames per second, those of the clips."""
        return self.database.fps

    @property
    def frames_left(self) -> int:
        """The frames until its next choice: it can choose in every frame."""
        return 0

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
        command = (heading, speed, label)
        if command != self._command:
            self._take(command)
        if self._wait <= 0 or self.frame >= self.database.last[self.frame]:
            self._wait = max(1, round(self.wants.every * self.fps))
            self._look(heading, speed, label)
        table = self.database
        root, turns = place_frames(self.place, table.roots[self.frame], table.turns[self.frame])
        offset = self.offset
        pose = Pose(
            root + offset.root,
            rotations.multiply(turns, rotations.from_rotvec(offset.turns)),
            blending=bool(self.cuts) and self._steps - self.cuts[-1] < 2 * self.wants.fade * self.fps,
            contacts={name: bool(mark[self.frame]) for name, mark in table.contacts.items()},
        )
        self._advance()
        return pose

    def _take(self, command: tuple[float, float, str]) -> None:
        """Take a new command, which is searched for at once."""
        heading, speed, label = command
        require_command(heading, speed)
        if self._command is None or speed != self._command[1]:
            warn_of_speed(self.database, speed)
        if label not in self._searches:
            if label not in self.database.labels:
                known = ", ".join(self.database.labels) or "none"
                raise NoWalk(f"No clip has the label '{label}'; there are: {known}.")
            among = self.database.usable & self.database.labels[label]
            self._searches[label] = FrameSearch(
                self.database, future=self.wants.future, tree=self._tree, among=among
            )
        self._command, self._wait = command, 0

    def _look(self, heading: float, speed: float, label: str) -> None:
        """Search, and cut where another frame is better."""
        table, now = self.database, self.frame
        goal = speed * complex(np.exp(1j * (heading - self.place.angle - table.heading[now])))
        query = table.values[now].copy()
        query[FUTURE] = foresee(table, now, goal, self.wants.halflife)
        stay = now < table.last[now] and (not label or bool(table.labels[label][now]))
        search = self._searches[label]
        staying = search.cost(query, now) - self.wants.bonus if stay else np.inf
        found = next_frame(search, query, now, near=self._near, staying=staying)
        if found != now:
            self._cut(found)

    def _cut(self, new: int) -> None:
        """Cut to another frame: put its track on the old one's; what differs becomes the offset."""
        table, old = self.database, self.frame
        turn = complex(self.place.turn * np.exp(1j * (table.heading[old] - table.heading[new])))
        turn /= abs(turn)
        move = complex(self.place.turn * table.ground[old] + self.place.move - turn * table.ground[new])
        place = PlanarTransform.from_complex(turn, move)
        root, turns = place_frames(self.place, table.roots[old], table.turns[old])
        new_root, new_turns = place_frames(place, table.roots[new], table.turns[new])
        shown = rotations.multiply(turns, rotations.from_rotvec(self.offset.turns))
        speed = _turned(table.root_speeds[old], self.place) - _turned(table.root_speeds[new], place)
        self.offset = Offset(
            self.offset.root + root - new_root,
            rotations.to_rotvec(rotations.multiply(rotations.inverse(new_turns), shown)),
            self.offset.root_speed + speed,
            self.offset.turn_speed + table.turn_speeds[old] - table.turn_speeds[new],
        )
        self.frame, self.place = new, place
        self.cuts.append(self._steps)

    def _advance(self) -> None:
        """Go on by one frame, and let the offset die away."""
        self.frame = min(self.frame + 1, int(self.database.last[self.frame]))
        self._steps, self._wait = self._steps + 1, self._wait - 1
        halflife, seconds = self.wants.fade, 1 / self.fps
        root, root_speed = fade(self.offset.root, self.offset.root_speed, halflife, seconds)
        turns, turn_speed = fade(self.offset.turns, self.offset.turn_speed, halflife, seconds)
        self.offset = Offset(root, turns, root_speed, turn_speed)


def _turned(speed: Array, place: PlanarTransform) -> Array:
    """Turn a velocity (3,) about the vertical, as a place does."""
    ground = complex(speed[2], speed[0]) * complex(place.turn)
    return np.array([ground.imag, speed[1], ground.real])
