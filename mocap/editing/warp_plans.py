"""A warp written down in a small text file: which joints are moved when, and which moments happen when."""

import math
import re
from difflib import get_close_matches
from pathlib import Path

import numpy as np

from mocap._shared.arrays import Array
from mocap._shared.records import NamedTuple
from mocap.body import rotations
from mocap.body.kinematics import joint_positions
from mocap.body.motion import Motion
from mocap.body.planar import heading
from mocap.editing.displacements import displaced
from mocap.editing.edits import brought, clean_feet, plants_within
from mocap.editing.keys import HALF_SECOND, Key, keys_around, offsets
from mocap.editing.pins import Pins, join_pins, pin, plant_pins
from mocap.editing.poses import poses_of, with_frames_of
from mocap.editing.posing import posed_with
from mocap.editing.retiming import retime
from mocap.errors import FormatError, MocapError
from mocap.files.text import lines, read_text, to_numbers

AT = "'at MOMENT JOINT LEFT UP AHEAD [level]', 'at MOMENT same' or 'at MOMENT level'"
LINE = f"{AT}, or 'time NEW OLD'"
# A line about poses: a moment, and then one word, or a joint, three numbers, and perhaps `level`.
POSE = re.compile(
    r"at (?P<moment>\d+\.?\d*|\.\d+)(?P<seconds>s?) (?:(?P<word>same|level)"
    r"|(?P<joint>(?!(?:same|level) )\S+) (?P<move>\S+ \S+ \S+)(?P<level> level)?)"
)


class Wish(NamedTuple):
    """What one line, number `line`, asks of a frame: that a joint be at a place (3,).

    For the pose as it was the `joint` is "same" or "level", and the place None. With `level` the change
    stands still there.
    """

    line: int
    joint: str
    place: Array | None
    level: bool


class WarpPlan(NamedTuple):
    """What a file of keys says: `wishes` of poses, by frame, and `times`: (line, new second, old second)."""

    path: str
    wishes: dict[int, list[Wish]]
    times: list[tuple[int, float, float]]


def load_plan(path: str | Path, motion: Motion) -> WarpPlan:
    r"""Read how a motion shall be warped, from a text file with one key in each line.

    `at 1.5s lhand 0.10 0.25 0` moves the left hand, at second 1.5, by 10 cm to the body's left and by 25 cm
    up; without the s the moment is a frame. Several joints may be moved at one moment. `at 1s same` says that
    the pose is as it was there. A line that ends with `level` says that the change stands still as well, as
    at take-off and landing: `at 1s level`, or `at 1s lhand 0.10 0.25 0 level`. `time 2.5 2` shows the clip's
    second 2 at second 2.5. What follows a # is left out.

    Parameters
    ----------
    path : the file.
    motion : F frames.

    Raises
    ------
    MocapError : for a file that cannot be read.
    FormatError : for a line of another form, or with a joint or a moment that the motion does not have, with
        its number; and for a file without a key.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> from mocap.datasets import sample
    >>> with TemporaryDirectory() as folder:
    ...     file = Path(folder, "keys.txt")
    ...     _ = file.write_text("at 1.5s lhand 0.1 0.2 0  # to the post\nat 180 root 0 -0.1 0\n"
    ...                         "time 0 0\ntime 15 9.645")
    ...     plan = load_plan(file, sample("walk_straight"))
    >>> [(frame, wish.joint) for frame, wishes in plan.wishes.items() for wish in wishes]
    [(180, 'lhand'), (180, 'root')]
    >>> plan.times  # the clip lasts 9.642 s: less than half a frame later is its last frame
    [(3, 0.0, 0.0), (4, 15.0, 9.641666666666667)]
    """
    plan = WarpPlan(str(path), {}, [])
    for number, words in lines(read_text(path)):
        pose = POSE.fullmatch(" ".join(words))
        if pose:
            _add_wish(plan, motion, number, pose)
        elif words[0] == "time" and len(words) == 3:
            _add_time(plan, motion, number, words[1:])
        else:
            raise FormatError(path, number, AT if words[0] == "at" else LINE, f"'{' '.join(words)}'")
    if not plan.wishes and not plan.times:
        raise FormatError(path, None, LINE, "no key")
    if len(plan.times) == 1:
        raise FormatError(path, plan.times[0][0], "two lines or more about time", "one")
    return plan


def _add_time(plan: WarpPlan, motion: Motion, line: int, words: list[str]) -> None:
    """Add the new and the old second of a line to the plan."""
    new, old = to_numbers(plan.path, line, words, "time NEW OLD, in seconds", 2).tolist()
    line_of_last, *last = plan.times[-1] if plan.times else (0, -math.inf, -math.inf)
    if not (last[0] < new and last[1] < old):
        expected = f"two seconds after {last[0]:g} and {last[1]:g}, those of line {line_of_last}"
        raise FormatError(plan.path, line, expected, f"{new:g} and {old:g}")
    if not 0 <= old <= motion.duration + 0.5 / motion.fps:
        expected = f"an old second up to {motion.duration:g}, the clip's last"
        raise FormatError(plan.path, line, expected, f"{old:g}")
    plan.times.append((line, new, min(old, motion.duration)))


def _add_wish(plan: WarpPlan, motion: Motion, line: int, pose: re.Match[str]) -> None:
    """Add what a line asks of a pose to the plan."""
    moment = float(to_numbers(plan.path, line, [pose["moment"]], "a moment", 1)[0])
    frame = round(moment * motion.fps if pose["seconds"] else moment)
    if frame >= len(motion):
        last = f"{len(motion) - 1}, or second {motion.duration:g}"
        raise FormatError(plan.path, line, f"a moment up to frame {last}", f"frame {frame}")
    joint = pose["joint"] or pose["word"]
    names = motion.skeleton.names
    place: Array | None = None
    if pose["joint"]:
        move = to_numbers(plan.path, line, pose["move"].split(), "LEFT UP AHEAD, in metres", 3)
        if joint not in names:
            alike = ", ".join(get_close_matches(joint[:80], names, cutoff=0.0))
            raise FormatError(plan.path, line, f"a joint, such as {alike}", f"'{joint}'")
        chosen = motion[frame : frame + 1]
        turn = rotations.about_y(heading(chosen.rotations[0, 0]))
        place = joint_positions(chosen)[0, names.index(joint)] + rotations.rotate(turn, move)
    for wish in plan.wishes.setdefault(frame, []):
        if place is None or wish.place is None or joint == wish.joint:
            got = f"'{joint}' beside '{wish.joint}' of line {wish.line}"
            raise FormatError(plan.path, line, f"one wish for a joint at frame {frame}", got)
    level = pose["word"] == "level" or bool(pose["level"])
    plan.wishes[frame].append(Wish(line, joint, place, level))


def warp(motion: Motion, plan: WarpPlan, *, window: float = HALF_SECOND, feet: bool = True) -> Motion:
    """Carry out a plan: poses by `posed`, the curves between them by `offsets`, then the times by `retime`.

    Where the plan does not say from when on the motion is as it was, it is so `window` seconds before the
    first pose and after the last one. Up to there, and from there, no number of the motion changes.

    Parameters
    ----------
    motion : F frames.
    plan : as `load_plan` reads it for this motion.
    window : seconds.
    feet : keep feet that stand in their places, at keys by `posed`, and between them as `edit` does, which
        brings the joints to their places and nothing under the floor; asks for the motion's `contacts`.

    Raises
    ------
    MocapError : for places out of reach, missing contacts, and a window of no frame.

    Warns
    -----
    MocapWarning : for places that are missed by more than 5 mm, and plants that are let go.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> from mocap.body import joint_positions
    >>> walk = sample("walk_straight")
    >>> place = joint_positions(walk)[180, walk.skeleton.index("lhand")] + [0.1, 0.25, 0.0]
    >>> warp(walk, WarpPlan("keys.txt", {180: [Wish(1, "lhand", place, level=False)]}, []))
    Motion('walk_straight', 1158 frames at 120 Hz, 9.64 s, 38 joints)
    """
    if plan.wishes:
        motion = _warp_poses(motion, plan, window, feet)
    if plan.times:
        motion = retime(motion, [(new, old) for _, new, old in plan.times])
        motion = clean_feet(motion) if feet else motion
    return motion


def _warp_poses(motion: Motion, plan: WarpPlan, window: float, feet: bool) -> Motion:
    """Carry out what a plan asks of poses. Frames before and after those of the keys stay the same."""
    frames = _frames_between_keys(motion, plan, window)
    no_pins = Pins((), *np.zeros((2, len(motion), 0, 3)))
    poses = poses_of(motion)
    plants = plants_within(plant_pins(poses), poses, frames) if feet else no_pins
    keys: list[Key] = []
    pins: list[Pins] = []
    for frame, wishes in sorted(plan.wishes.items()):
        places = {wish.joint: wish.place for wish in wishes if wish.place is not None}
        try:
            pose = posed_with(poses, frame, places, plants) if places else None
        except MocapError as error:
            raise MocapError(f"{plan.path}, line {wishes[0].line}: {error}") from None
        keys.append(Key(frame, pose, any(wish.level for wish in wishes)))
        pins += [pin(motion, joint, [frame], place) for joint, place in places.items()]
    if not pins:
        return motion
    warped = displaced(motion, offsets(motion, keys_around(motion, keys, window)))
    if feet:
        return brought(poses_of(warped), poses, join_pins(*pins), frames=frames)
    stays = np.ones(len(motion), bool)
    stays[frames] = False
    return with_frames_of(warped, motion, stays)


def _frames_between_keys(motion: Motion, plan: WarpPlan, window: float) -> slice:
    """Find the frames that a plan changes: all between the first and the last key."""
    moved = {frame: any(wish.place is not None for wish in wishes) for frame, wishes in plan.wishes.items()}
    keys = [Key(frame, motion[:1] if moved[frame] else None) for frame in sorted(moved)]
    keys = keys_around(motion, keys, window)
    start = 0 if keys[0].pose is not None else keys[0].frame + 1
    stop = len(motion) if keys[-1].pose is not None else keys[-1].frame
    return slice(start, max(start, stop))
