"""Warps from a text file: positions of joints at given frames, and time keys."""

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
from mocap.editing.constraints import Pins
from mocap.editing.displacements import displaced
from mocap.editing.edits import brought
from mocap.editing.foot_cleaning import clean_feet
from mocap.editing.keys import Key, keys_around, offsets
from mocap.editing.pins import join_pins, pin
from mocap.editing.poses import poses_of, with_frames_of
from mocap.editing.posing import posed_with
from mocap.editing.retiming import retime
from mocap.editing.standing import plants_within, source_of
from mocap.editing.tuned import TUNED
from mocap.errors import FormatError, MocapError
from mocap.files.text import lines, read_text, to_numbers

AT = "'at MOMENT JOINT LEFT UP AHEAD [level]', 'at MOMENT same' or 'at MOMENT level'"
LINE = f"{AT}, or 'time NEW OLD'"
# A line about poses: a moment, and then one word, or a joint, three numbers, and perhaps `level`.
POSE = re.compile(
    r"at (?P<moment>\d+\.?\d*|\.\d+)(?P<seconds>s?) (?:(?P<word>same|level)"
    r"|(?P<joint>(?!(?:same|level) )\S+) (?P<move>\S+ \S+ \S+)(?P<level> level)?)"
)


class Target(NamedTuple):
    """The position of a joint at a frame, from a line of a plan.

    Parameters
    ----------
    line : the number of the line.
    joint : the name of the joint; "same" or "level" for the pose of the motion.
    position : shape (3,), metres; None for the pose of the motion.
    level : whether the derivative of the change is 0 at the frame.
    """

    line: int
    joint: str
    position: Array | None
    level: bool


class WarpPlan(NamedTuple):
    """The keys of a file.

    Parameters
    ----------
    path : the file.
    targets : the targets of joints, by frame.
    times : the time keys: (line, new second, old second).
    """

    path: str
    targets: dict[int, list[Target]]
    times: list[tuple[int, float, float]]


def load_plan(path: str | Path, motion: Motion) -> WarpPlan:
    r"""Read a plan of a warp from a text file with one key in each line.

    `at 1.5s lhand 0.10 0.25 0` moves the left hand, at second 1.5, by 10 cm to the body's left and by 25 cm
    up; without the s the moment is a frame. Several joints may be moved at one moment. `at 1s same` keeps the
    pose of the motion there. At a line that ends with `level`, the derivative of the change is also 0, as at
    take-off and landing: `at 1s level`, or `at 1s lhand 0.10 0.25 0 level`. `time 2.5 2` shows the clip's
    second 2 at second 2.5. The rest of a line after # is a comment.

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
    >>> [(frame, target.joint) for frame, targets in plan.targets.items() for target in targets]
    [(180, 'lhand'), (180, 'root')]
    >>> plan.times  # the clip lasts 9.642 s: less than half a frame later is its last frame
    [(3, 0.0, 0.0), (4, 15.0, 9.641666666666667)]
    """
    plan = WarpPlan(str(path), {}, [])
    for number, words in lines(read_text(path)):
        pose = POSE.fullmatch(" ".join(words))
        if pose:
            _add_target(plan, motion, number, pose)
        elif words[0] == "time" and len(words) == 3:
            _add_time(plan, motion, number, words[1:])
        else:
            raise FormatError(path, number, AT if words[0] == "at" else LINE, f"'{' '.join(words)}'")
    if not plan.targets and not plan.times:
        raise FormatError(path, None, LINE, "no key")
    if len(plan.times) == 1:
        raise FormatError(path, plan.times[0][0], "two lines or more about time", "one")
    return plan


def _add_time(plan: WarpPlan, motion: Motion, line: int, words: list[str]) -> None:
    """Add the time key of a line to a plan."""
    new, old = to_numbers(plan.path, line, words, "time NEW OLD, in seconds", 2).tolist()
    line_of_last, *last = plan.times[-1] if plan.times else (0, -math.inf, -math.inf)
    if not (last[0] < new and last[1] < old):
        expected = f"two seconds after {last[0]:g} and {last[1]:g}, those of line {line_of_last}"
        raise FormatError(plan.path, line, expected, f"{new:g} and {old:g}")
    if not 0 <= old <= motion.duration + 0.5 / motion.fps:
        expected = f"an old second up to {motion.duration:g}, the clip's last"
        raise FormatError(plan.path, line, expected, f"{old:g}")
    plan.times.append((line, new, min(old, motion.duration)))


def _add_target(plan: WarpPlan, motion: Motion, line: int, pose: re.Match[str]) -> None:
    """Add the target of a line about a pose to a plan."""
    moment = float(to_numbers(plan.path, line, [pose["moment"]], "a moment", 1)[0])
    frame = round(moment * motion.fps if pose["seconds"] else moment)
    if frame >= len(motion):
        last = f"{len(motion) - 1}, or second {motion.duration:g}"
        raise FormatError(plan.path, line, f"a moment up to frame {last}", f"frame {frame}")
    joint = pose["joint"] or pose["word"]
    position = _target_position(plan, motion[frame : frame + 1], line, pose) if pose["joint"] else None
    for target in plan.targets.setdefault(frame, []):
        if position is None or target.position is None or joint == target.joint:
            got = f"'{joint}' beside '{target.joint}' of line {target.line}"
            raise FormatError(plan.path, line, f"one target for a joint at frame {frame}", got)
    level = pose["word"] == "level" or bool(pose["level"])
    plan.targets[frame].append(Target(line, joint, position, level))


def _target_position(plan: WarpPlan, frame: Motion, line: int, pose: re.Match[str]) -> Array:
    """Compute the position to which a line moves a joint, (3,), metres, from a motion of that frame."""
    move = to_numbers(plan.path, line, pose["move"].split(), "LEFT UP AHEAD, in metres", 3)
    joint = pose["joint"]
    names = frame.skeleton.names
    if joint not in names:
        similar = ", ".join(get_close_matches(joint[:80], names, cutoff=0.0))
        raise FormatError(plan.path, line, f"a joint, such as {similar}", f"'{joint}'")
    rotation = rotations.about_y(heading(frame.rotations[0, 0]))
    position = joint_positions(frame)[0, names.index(joint)]
    return np.asarray(position + rotations.rotate(rotation, move))


def warp(motion: Motion, plan: WarpPlan, *, window: float = TUNED.key_margin, feet: bool = True) -> Motion:
    """Warp a motion by a plan: poses by `posed`, curves between them by `offsets`, then times by `retime`.

    The plan changes the motion between its first and its last key without a target, or else from `window`
    seconds before its first target until as long after its last one. All other frames stay as they are.

    Parameters
    ----------
    motion : F frames.
    plan : as `load_plan` reads it for this motion.
    window : seconds.
    feet : whether to hold planted feet, at keys by `posed`, and between them as `edit` does, which meets the
        targets with nothing under the floor. It needs the motion's `contacts`.

    Raises
    ------
    MocapError : for targets out of reach, missing contacts, and a window of no frame.

    Warns
    -----
    MocapWarning : for targets that are missed by more than 5 mm, and footplants that are released.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> from mocap.body import joint_positions
    >>> walk = sample("walk_straight")
    >>> position = joint_positions(walk)[180, walk.skeleton.index("lhand")] + [0.1, 0.25, 0.0]
    >>> warp(walk, WarpPlan("keys.txt", {180: [Target(1, "lhand", position, level=False)]}, []))
    Motion('walk_straight', 1158 frames at 120 Hz, 9.64 s, 38 joints)
    """
    if plan.targets:
        motion = _warp_poses(motion, plan, window, feet)
    if plan.times:
        motion = retime(motion, [(new, old) for _, new, old in plan.times])
        motion = clean_feet(motion) if feet else motion
    return motion


def _warp_poses(motion: Motion, plan: WarpPlan, window: float, feet: bool) -> Motion:
    """Warp the poses of a motion by a plan. Frames outside its keys stay the same."""
    frames = _frames_between_keys(motion, plan, window)
    no_pins = Pins((), *np.zeros((2, len(motion), 0, 3)))
    poses = poses_of(motion)
    source = source_of(poses) if feet else None
    plants = plants_within(source.plants, poses, frames, source.feet.legs) if source else no_pins
    keys: list[Key] = []
    pins: list[Pins] = []
    for frame, targets in sorted(plan.targets.items()):
        positions = {target.joint: target.position for target in targets if target.position is not None}
        try:
            pose = posed_with(poses, frame, positions, plants) if positions else None
        except MocapError as error:
            raise MocapError(f"{plan.path}, line {targets[0].line}: {error}") from None
        keys.append(Key(frame, pose, any(target.level for target in targets)))
        pins += [pin(motion, joint, [frame], position) for joint, position in positions.items()]
    if not pins:
        return motion
    warped = displaced(motion, offsets(motion, keys_around(motion, keys, window)))
    if source:
        return brought(warped, source, join_pins(*pins), frames=frames)
    is_outside = np.ones(len(motion), bool)
    is_outside[frames] = False
    return with_frames_of(warped, motion, is_outside)


def _frames_between_keys(motion: Motion, plan: WarpPlan, window: float) -> slice:
    """Return the frames that a plan changes: all between the first and the last key."""
    keys = []
    for frame, targets in sorted(plan.targets.items()):
        is_moved = any(target.position is not None for target in targets)
        keys.append(Key(frame, motion[:1] if is_moved else None))
    keys = keys_around(motion, keys, window)
    start = 0 if keys[0].pose is not None else keys[0].frame + 1
    stop = len(motion) if keys[-1].pose is not None else keys[-1].frame
    return slice(start, max(start, stop))
