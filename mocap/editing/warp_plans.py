"""A warp written down in a small text file: which joints are moved when, and which moments happen when."""

import math
import re
from collections.abc import Sequence
from difflib import get_close_matches
from pathlib import Path
from typing import NamedTuple

from mocap._shared.arrays import Array
from mocap.body import rotations
from mocap.body.kinematics import joint_positions
from mocap.body.motion import Motion
from mocap.body.planar import heading
from mocap.editing.displacements import displaced
from mocap.editing.edits import edit, posed
from mocap.editing.keys import HALF_SECOND, Key, offsets
from mocap.editing.pins import join_pins, pin, plant_pins
from mocap.editing.retiming import retime
from mocap.errors import FormatError, MocapError
from mocap.feet.footskate import clean_up
from mocap.files.text import lines, read_text, to_numbers

AT = "'at MOMENT JOINT LEFT UP AHEAD [level]', 'at MOMENT same' or 'at MOMENT level'"
LINE = f"{AT}, or 'time NEW OLD'"
# A line about poses: a moment, and then one word, or a joint, three numbers, and perhaps `level`.
POSE = re.compile(
    r"at (?P<moment>\d+\.?\d*|\.\d+)(?P<seconds>s?) (?:(?P<word>same|level)"
    r"|(?P<joint>(?!(?:same|level) )\S+) (?P<move>\S+ \S+ \S+)(?P<level> level)?)"
)


class Wish(NamedTuple):
    """One line about one moment: a joint that is moved, or `joint` "same" or "level" for the pose as it was.

    `line` is its number in the file, `moment` a frame, or a second where `in_seconds`; `move` are metres to
    the body's left, up, and ahead of it. With `level` the change stands still there.
    """

    line: int
    moment: float
    in_seconds: bool
    joint: str
    move: tuple[float, ...] = ()
    level: bool = False


class WarpPlan(NamedTuple):
    """What a file of keys says: `wishes` about poses in its order, and `times`: (line, new, old second)."""

    path: str
    wishes: tuple[Wish, ...]
    times: tuple[tuple[int, float, float], ...]


def load_plan(path: str | Path) -> WarpPlan:
    """Read a warp from a text file with one key in each line; what follows a # is left out.

    `at 1.5s lhand 0.10 0.25 0` moves the left hand, at second 1.5, by 10 cm to the body's left and by 25 cm
    up; without the s the moment is a frame. Several joints may be moved at one moment. `at 1s same` says that
    the pose is as it was there. A line that ends with `level` says that the change stands still as well, as
    at take-off and landing: `at 1s level`, or `at 1s lhand 0.10 0.25 0 level`. `time 2.5 2` shows the clip's
    second 2 at second 2.5.

    Parameters
    ----------
    path : the file.

    Raises
    ------
    MocapError : for a file that cannot be read.
    FormatError : for a line of another form, with its number, and for a file without a key.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     file = Path(folder, "keys.txt")
    ...     _ = file.write_text("at 1.5s lhand 0.1 0.25 0  # to the post")
    ...     load_plan(file).wishes[0].move
    (0.1, 0.25, 0.0)
    """
    wishes: list[Wish] = []
    times: list[tuple[int, float, float]] = []
    for number, words in lines(read_text(path)):
        found = POSE.fullmatch(" ".join(words))
        if found:
            at = float(to_numbers(path, number, [found["moment"]], "a moment", 1)[0])
            move = (found["move"] or "").split()
            metres = to_numbers(path, number, move, "LEFT UP AHEAD, in metres", len(move)).tolist()
            joint = found["joint"] or found["word"]
            level = found["word"] == "level" or bool(found["level"])
            wishes.append(Wish(number, at, bool(found["seconds"]), joint, tuple(metres), level))
        elif words[0] == "time" and len(words) == 3:
            new, old = to_numbers(path, number, words[1:], "time NEW OLD, in seconds", 2).tolist()
            if times and not (times[-1][1] < new and times[-1][2] < old):
                line, *last = times[-1]
                expected = f"two seconds after {last[0]:g} and {last[1]:g}, those of line {line}"
                raise FormatError(path, number, expected, f"{new:g} and {old:g}")
            times.append((number, new, old))
        else:
            raise FormatError(path, number, AT if words[0] == "at" else LINE, f"'{' '.join(words)}'")
    if not wishes and not times:
        raise FormatError(path, None, LINE, "no key")
    if len(times) == 1:
        raise FormatError(path, times[0][0], "two lines or more about time", "one")
    return WarpPlan(str(path), tuple(wishes), tuple(times))


def warp(motion: Motion, plan: WarpPlan, *, window: float = HALF_SECOND, feet: bool = True) -> Motion:
    """Carry out a plan: poses by `posed`, the curves between them by `offsets`, then the times by `retime`.

    Where the plan does not say from when on the motion is as it was, it is so `window` seconds before the
    first pose and after the last one.

    Parameters
    ----------
    motion : F frames.
    plan : as `load_plan` reads it.
    window : seconds.
    feet : keep feet that stand in their places, at the keys by `posed`, and between them by `edit`, which
        brings the joints to their places as well; asks for the motion's `contacts`.

    Raises
    ------
    FormatError : for a joint or a moment that the motion does not have, with the plan's line.
    MocapError : for places out of reach, times that do not rise, missing contacts, and a window of no frame.

    Warns
    -----
    MocapWarning : for places that are missed by more than 5 mm, and plants that are let go.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> walk = sample("walk_straight")
    >>> plan = WarpPlan("keys.txt", (Wish(1, 1.5, True, "lhand", (0.1, 0.25, 0.0)),), ())
    >>> warp(walk, plan)
    Motion('walk_straight', 1201 frames at 120 Hz, 38 joints)
    """
    if not (math.isfinite(window) and window * motion.fps >= 1):
        raise MocapError(f"A window lasts a frame or longer, got {window} s at {motion.fps:g} Hz.")
    last = motion.duration
    for line, _, old in plan.times:
        if not 0 <= old <= last + 0.5 / motion.fps:
            raise FormatError(plan.path, line, f"an old second up to {last:g}, the clip's last", f"{old:g}")
    moments = _by_frame(motion, plan)
    if moments:
        wanted, keys = {frame: _places(motion, frame, wishes) for frame, wishes in moments.items()}, []
        for frame, wishes in moments.items():
            try:
                pose = posed(motion, frame, wanted[frame], feet=feet) if wanted[frame] else None
            except MocapError as error:
                raise MocapError(f"{plan.path}, line {wishes[0].line}: {error}") from None
            keys.append(Key(frame, pose, any(wish.level for wish in wishes)))
        motion = _through(motion, keys, window)
        if feet:
            places = ((joint, frame, to) for frame, own in wanted.items() for joint, to in own.items())
            asked = [pin(motion, joint, [frame], place) for joint, frame, place in places]
            motion = edit(motion, join_pins(plant_pins(motion), *asked))
    if plan.times:
        motion = retime(motion, [(new, min(old, last)) for _, new, old in plan.times])
        motion = clean_up(motion) if feet else motion
    return motion


def _by_frame(motion: Motion, plan: WarpPlan) -> dict[int, list[Wish]]:
    """Sort the wishes by their frames, and refuse those that the motion cannot have."""
    moments: dict[int, list[Wish]] = {}
    for wish in plan.wishes:
        frame = round(wish.moment * motion.fps if wish.in_seconds else wish.moment)
        names = motion.skeleton.names
        if frame >= len(motion):
            last = f"{len(motion) - 1}, or second {motion.duration:g}"
            raise FormatError(plan.path, wish.line, f"a moment up to frame {last}", f"frame {frame}")
        if wish.move and wish.joint not in names:
            alike = ", ".join(get_close_matches(wish.joint[:80], names, cutoff=0.0))
            raise FormatError(plan.path, wish.line, f"a joint, such as {alike}", f"'{wish.joint}'")
        for other in moments.setdefault(frame, []):
            if not (wish.move and other.move) or wish.joint == other.joint:
                got = f"'{wish.joint}' beside '{other.joint}' of line {other.line}"
                raise FormatError(plan.path, wish.line, f"one wish for a joint at frame {frame}", got)
        moments[frame].append(wish)
    return dict(sorted(moments.items()))


def _places(motion: Motion, frame: int, wishes: Sequence[Wish]) -> dict[str, Array]:
    """Give the places of the joints that are moved in one frame, (3,) each, metres."""
    now = motion[frame : frame + 1]
    at, turn = joint_positions(now)[0], rotations.about_y(heading(now.rotations[0, 0]))
    index = motion.skeleton.index
    return {w.joint: at[index(w.joint)] + rotations.rotate(turn, w.move) for w in wishes if w.move}


def _through(motion: Motion, keys: Sequence[Key], window: float) -> Motion:
    """Warp through keys; add those from which on the motion is as it was, where the plan has none."""
    if all(key.pose is None for key in keys):
        return motion
    half = round(window * motion.fps)
    ends = [Key(key.frame + way) for key, way in ((keys[0], -half), (keys[-1], half)) if key.pose is not None]
    known = [*keys, *(end for end in ends if 0 <= end.frame < len(motion))]
    return displaced(motion, offsets(motion, sorted(known, key=lambda key: key.frame)))
