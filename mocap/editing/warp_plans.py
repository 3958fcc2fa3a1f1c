"""A warp written down in a small text file: which joints are moved when, and which moments happen when."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from difflib import SequenceMatcher
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

from mocap._shared.arrays import Array
from mocap.body import rotations
from mocap.body.kinematics import joint_positions
from mocap.body.limbs import find_legs
from mocap.body.motion import Motion
from mocap.body.planar import heading
from mocap.editing.displacements import displaced
from mocap.editing.keys import HALF_SECOND, Key, offsets
from mocap.editing.posing import posed
from mocap.editing.retiming import retime
from mocap.errors import FormatError, MocapError
from mocap.feet.footskate import clean_up
from mocap.files.text import lines, read_text, to_numbers

AT = "'at MOMENT JOINT LEFT UP AHEAD [level]', 'at MOMENT same' or 'at MOMENT level'"
LINE = f"{AT}, or 'time NEW OLD'"
WHEN = re.compile(r"(\d+\.?\d*|\.\d+)(s?)")


class Wish(NamedTuple):
    """One line about one moment: a joint that is moved, or `joint` "same" or "level" for the pose as it was.

    Parameters
    ----------
    line : its number in the file, for messages.
    moment : a frame, or a second where `in_seconds`.
    in_seconds : which of the two.
    joint : its name.
    move : metres to the body's left, up, and ahead of it.
    level : the change stands still there.

    Examples
    --------
    >>> Wish(1, 1.5, True, "lhand", (0.1, 0.2, 0.0)).frame(120.0)
    180
    """

    line: int
    moment: float
    in_seconds: bool
    joint: str
    move: tuple[float, ...] = ()
    level: bool = False

    def frame(self, fps: float) -> int:
        """Give the nearest frame at some rate."""
        return round(self.moment * fps if self.in_seconds else self.moment)


class TimeKey(NamedTuple):
    """One line about time: the `old` second of the clip is shown at the `new` one.

    Examples
    --------
    >>> TimeKey(3, new=2.5, old=2.0).new
    2.5
    """

    line: int
    new: float
    old: float


@dataclass(frozen=True)
class WarpPlan:
    """What a file of keys says: `wishes` about poses in its order, and `times`.

    Examples
    --------
    >>> WarpPlan("keys.txt", (), (TimeKey(1, 0.0, 0.0), TimeKey(2, 2.5, 2.0))).times[1].old
    2.0
    """

    path: str
    wishes: tuple[Wish, ...]
    times: tuple[TimeKey, ...]


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
    wishes, times = [], []
    for number, words in lines(read_text(path)):
        if words[0] == "at":
            wishes.append(_wish(path, number, words[1:]))
        elif words[0] == "time" and len(words) == 3:
            new, old = to_numbers(path, number, words[1:], "time NEW OLD, in seconds", 2).tolist()
            times.append(TimeKey(number, new, old))
        else:
            raise FormatError(path, number, LINE, f"'{' '.join(words)}'")
    if not wishes and not times:
        raise FormatError(path, None, LINE, "no key")
    _check_times(path, times)
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
    feet : keep feet that stand in their places, at the keys by `posed`, and between them by `feet.clean_up`;
        asks for the motion's `contacts`. The clean-up may raise the root, so arms and head are then brought
        to their places once more.

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
    _require_on_clip(motion, plan)
    moments = _by_frame(motion, plan)
    if not (math.isfinite(window) and window * motion.fps >= 1):
        raise MocapError(f"A window lasts a frame or longer, got {window} s at {motion.fps:g} Hz.")
    if moments:
        wanted = {frame: _places(motion, frame, wishes) for frame, wishes in moments.items()}
        keys = [_key(motion, plan, wanted[frame], moments[frame], feet) for frame in sorted(moments)]
        motion = _through(motion, keys, window)
        if feet:
            motion = clean_up(motion)
            motion = _through(motion, [_again(motion, key, wanted[key.frame]) for key in keys], window)
    if plan.times:
        last = motion.duration  # a second that was rounded up may lie half a frame behind it
        motion = retime(motion, [(time.new, min(time.old, last)) for time in plan.times])
        motion = clean_up(motion) if feet else motion
    return motion


def _wish(path: str | Path, number: int, words: list[str]) -> Wish:
    """Read what stands behind `at`."""
    level = words[-1:] == ["level"]
    rest = words[:-1] if level and len(words) > 2 else words  # "level" alone stands where a joint would
    moment = WHEN.fullmatch(rest[0]) if len(rest) in (2, 5) else None
    if not moment or (len(rest) == 2) != (rest[1] in ("same", "level")) or (level and rest[1] == "same"):
        raise FormatError(path, number, AT, f"'at {' '.join(words)}'")
    value = float(to_numbers(path, number, [moment[1]], "a moment", 1)[0])
    move = to_numbers(path, number, rest[2:], "LEFT UP AHEAD, in metres", len(rest) - 2)
    return Wish(number, value, bool(moment[2]), rest[1], tuple(move.tolist()), level)


def _check_times(path: str | Path, times: Sequence[TimeKey]) -> None:
    """Raise unless there are no times, or two or more that rise."""
    if len(times) == 1:
        raise FormatError(path, times[0].line, "two lines or more about time", "one")
    for before, after in pairwise(times):
        if not (before.new < after.new and before.old < after.old):
            expected = f"two seconds after {before.new:g} and {before.old:g}, those of line {before.line}"
            raise FormatError(path, after.line, expected, f"{after.new:g} and {after.old:g}")


def _require_on_clip(motion: Motion, plan: WarpPlan) -> None:
    """Raise for a second that the clip does not have."""
    for time in plan.times:
        if not 0 <= time.old <= motion.duration + 0.5 / motion.fps:
            last = f"an old second up to {motion.duration:g}, the clip's last"
            raise FormatError(plan.path, time.line, last, f"{time.old:g}")


def _by_frame(motion: Motion, plan: WarpPlan) -> dict[int, list[Wish]]:
    """Sort the wishes by their frames, and refuse those that the motion cannot have."""
    moments: dict[int, list[Wish]] = {}
    for wish in plan.wishes:
        frame = wish.frame(motion.fps)
        if frame >= len(motion):
            last = f"{len(motion) - 1}, or second {motion.duration:g}"
            raise FormatError(plan.path, wish.line, f"a moment up to frame {last}", f"frame {frame}")
        if wish.move and wish.joint not in motion.skeleton.names:
            names = ", ".join(_likest_first(wish.joint, motion.skeleton.names))
            raise FormatError(plan.path, wish.line, f"a joint, one of {names}", f"'{wish.joint}'")
        for other in moments.setdefault(frame, []):
            if not (wish.move and other.move) or wish.joint == other.joint:
                got = f"'{wish.joint}' beside '{other.joint}' of line {other.line}"
                raise FormatError(plan.path, wish.line, f"one wish for a joint at frame {frame}", got)
        moments[frame].append(wish)
    return moments


def _places(motion: Motion, frame: int, wishes: Sequence[Wish]) -> dict[str, Array]:
    """Give the places of the joints that are moved in one frame, (3,) each, metres."""
    now = motion[frame : frame + 1]
    at, turn = joint_positions(now)[0], rotations.about_y(heading(now.rotations[0, 0]))
    index = motion.skeleton.index
    return {w.joint: at[index(w.joint)] + rotations.rotate(turn, w.move) for w in wishes if w.move}


def _key(
    motion: Motion, plan: WarpPlan, places: Mapping[str, Array], wishes: Sequence[Wish], feet: bool
) -> Key:
    """Make the key of one frame."""
    frame, level = wishes[0].frame(motion.fps), any(wish.level for wish in wishes)
    if not places:
        return Key(frame, flat=level)
    try:
        return Key(frame, posed(motion, frame, places, feet=feet), level)
    except MocapError as error:
        raise MocapError(f"{plan.path}, line {wishes[0].line}: {error}") from None


def _again(motion: Motion, key: Key, places: Mapping[str, Array]) -> Key:
    """Make a key for the joints that no leg carries and that carry none: the root and the legs stay."""
    skeleton = motion.skeleton
    legs = {joint for leg in find_legs(skeleton) for joint in skeleton.path_to_root(leg.ball)}
    hips = {leg.hip for leg in find_legs(skeleton)}
    free = {
        name: place
        for name, place in places.items()
        if skeleton.index(name) not in legs and not hips & set(skeleton.path_to_root(skeleton.index(name)))
    }
    root = skeleton.names[:1]
    pose = posed(motion, key.frame, free, feet=False, still=root) if free else None
    return key._replace(pose=pose)


def _through(motion: Motion, keys: Sequence[Key], window: float) -> Motion:
    """Warp through keys; add those from which on the motion is as it was, where the plan has none."""
    poses = [key.frame for key in keys if key.pose is not None]
    if not poses:
        return motion
    half = round(window * motion.fps)
    ends = Key(poses[0] - half), Key(poses[-1] + half)
    before = [end for end in ends[:1] if end.frame >= 0 and keys[0].pose is not None]
    after = [end for end in ends[1:] if end.frame < len(motion) and keys[-1].pose is not None]
    return displaced(motion, offsets(motion, [*before, *keys, *after]))


def _likest_first(name: str, names: Sequence[str]) -> list[str]:
    """Sort names by how much they are like one that was typed.

    Examples
    --------
    >>> _likest_first("lhand", ["Hips", "LeftArm", "LeftHand", "RightHand"])
    ['LeftHand', 'RightHand', 'LeftArm', 'Hips']
    """
    typed = name.lower()[:80]
    return sorted(names, key=lambda known: SequenceMatcher(None, typed, known.lower()).ratio(), reverse=True)
