"""BVH files: a hierarchy of joints, and the values of their channels in every frame.

Position channels replace the offset of a joint, or, in files of some programs, are relative to that of the
root. Rotation channels are intrinsic Euler angles in the given
order: Zrotation Xrotation Yrotation is R = Rz Rx Ry. The format has no unit: it is `scale` metres, by default
a centimetre. `bvh_hierarchy` explains the names of joints.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import replace
from itertools import chain
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from mocap._shared.arrays import Array
from mocap._shared.atomic import replacing
from mocap.body import euler, rotations
from mocap.body.joint_trees import world_positions
from mocap.body.motion import Motion
from mocap.body.skeleton import Skeleton
from mocap.errors import FormatError, MocapError, Remedy, shortened, warn
from mocap.files import frame_rates, spaces
from mocap.files.bvh_hierarchy import POSITIONS, ROTATIONS, Hierarchy, Joint, read_hierarchy, write_hierarchy
from mocap.files.decimals import parse_numbers
from mocap.files.loose_joints import without_loose_joints
from mocap.files.read_options import ReadOptions
from mocap.files.recordings import Recording
from mocap.files.rigid_bones import fit
from mocap.files.space_evidence import Evidence, frames_to_look_at, gather
from mocap.files.text import LARGEST, check_room, read_text, to_numbers, without_commas
from mocap.files.tuned import TUNED

SCALE = 0.01  # metres in a unit of files that are written, and of those whose frames do not show it
STILL = 1e-5  # metres: the largest movement of a fixed joint in its parent's frame, by rounding in the file
SHORTEST = 1e-5  # seconds: the smallest frame time
LONGEST = 10.0  # seconds: the largest frame time
FRAMES_AT_ONCE = 256  # whose angles are converted: their arrays fit into the cache of a processor
# The parts of a file that hold numbers: statements of joints, the frame time, and all rows of frames.
NUMBERS = re.compile(
    r"(?:^|[{}])[ \t]*(?:OFFSET|CHANNELS)\b[^{}\n]*"
    r"|^[ \t]*Frame[ \t]+Time[ \t]*:[^\n]*"
    r"|^(?=[ \t]*[-+.\d])(?s:.*)\Z",
    re.IGNORECASE | re.MULTILINE,
)
ABOVE = re.compile(r"[^{}]*?(?=^[ \t]*HIERARCHY\b)", re.IGNORECASE | re.MULTILINE)
COMMENT = re.compile(r"^[ \t]*(?:#|//).*", re.MULTILINE)
TIMES = re.compile(
    r"\s*Frames[ \t]*:[ \t]*(\S+)[ \t]*\n\s*Frame[ \t]+Time[ \t]*:[ \t]*(\S+)[ \t]*(?:\n|\Z)", re.IGNORECASE
)


def read(path: str | Path, options: ReadOptions) -> Recording:
    """Read a BVH file.

    Position channels below the root are allowed. If they vary, rigid bones are fitted by `rigid_bones`, as
    long as no length changes by more than `stretch`. If the root has a single child and that child moves
    (some files have a reference point above the hips), both are merged into one joint, with the name of the
    child.
    Joints that move apart from the body are left out by `loose_joints`.

    Parameters
    ----------
    path : the file.
    options : those of `files.load`. By default `spaces` finds the unit, the vertical axis and whether to add
        the root's OFFSET to its positions. The motion is rotated so that y is up.

    Raises
    ------
    FormatError : with the line that breaks the format.

    Warns
    -----
    MocapWarning : if the header counts other frames than those that follow; if the frame time has too few
        digits for one frame rate; and if bones were fitted, with the changes of their lengths and the
        distances of the joints from the file.
    """
    hierarchy, values, rate = _channels(path, options)
    joints = hierarchy.joints
    angles = {joint.name: values[:, joint.columns(ROTATIONS)] for joint in joints}
    positions, local = _poses(joints, values)
    offset = _root_offset(joints[0])
    is_open = None in (options.scale, options.up) or (options.root_offset is None and offset.any())
    evidence = _evidence(joints, positions, local, rate, offset) if is_open else None
    space = spaces.decide(
        [evidence] if evidence else [],
        (SCALE, "y"),
        scale=options.scale,
        up=options.up,
        root_offset=options.root_offset,
    )
    if space.root_offset == "add":
        positions[:, 0] += offset
    joints, positions, local = _without_reference(path, joints, space.scale * positions, local)
    joints, positions, local = without_loose_joints(path, joints, positions, local)
    stretches = _stretches(joints, positions)
    offsets, local = _rigid(path, joints, (positions, local), options.stretch)
    names = [joint.name for joint in joints]
    parents = np.array([joint.parent for joint in joints])
    dofs = [joint.axes()[::-1] for joint in joints]
    skeleton = Skeleton(names, parents, offsets, dofs=dofs)
    motion = spaces.upright(Motion(skeleton, positions[:, 0], local, rate, Path(path).stem), space.up)
    is_chosen = options.body is not None
    bodies = () if is_chosen else hierarchy.roots
    return Recording(motion, angles, stretches, space=space, evidence=evidence, bodies=bodies)


def _evidence(
    joints: list[Joint], positions: Array, local: Array, rate: float, root_offset: Array
) -> Evidence | None:
    """Gather the evidence of the space from poses in the unit of the file."""
    frames, rate = frames_to_look_at(positions[:, 0], rate)
    parents = np.array([joint.parent for joint in joints])
    return gather(parents, world_positions(parents, positions[frames], local[frames]), rate, root_offset)


def _root_offset(root: Joint) -> Array:
    """Return the OFFSET of the root, (3,), along the axes of its position channels, and 0 along others."""
    assert root.offset is not None  # since its brace is closed
    has_position = [channel in root.channels for channel in POSITIONS]
    return np.where(has_position, root.offset, 0.0)


def _poses(joints: list[Joint], values: Array) -> tuple[Array, Array]:
    """Convert channels to positions in the parents' frames (F, J, 3), in the file's unit, and rotations.

    Joints whose rotation channels have the same order are converted together.
    """
    frames = len(values)
    positions = np.tile(np.array([joint.offset for joint in joints]), (frames, 1, 1))
    local = np.tile(rotations.IDENTITY, (frames, len(joints), 1))
    joints_of: dict[str, list[int]] = {}  # by the order of their rotation channels
    for index, joint in enumerate(joints):
        for column in joint.columns(POSITIONS):
            axis = POSITIONS.index(joint.channels[column - joint.column])
            positions[:, index, axis] = values[:, column]
        joints_of.setdefault(joint.axes().upper(), []).append(index)
    joints_of.pop("", None)
    for order, indices in joints_of.items():
        columns = [joints[index].columns(ROTATIONS) for index in indices]
        for start in range(0, frames, FRAMES_AT_ONCE):
            angles = np.radians(values[start : start + FRAMES_AT_ONCE, columns])
            local[start : start + FRAMES_AT_ONCE, indices] = euler.from_euler(order, angles)
    return positions, local


def _stretches(joints: list[Joint], positions: Array) -> dict[str, float]:
    """Return the change of the length of each bone, in the unit of the positions in the parents' frames."""
    stretches = dict.fromkeys([joint.name for joint in joints[1:]], 0.0)
    for index in np.flatnonzero(np.ptp(positions[:, 1:], axis=0).any(axis=1)) + 1:
        lengths = np.linalg.norm(positions[:, index], axis=-1)
        stretches[joints[index].name] = float(np.ptp(lengths))
    return stretches


def _without_reference(
    path: str | Path, joints: list[Joint], positions: Array, local: Array
) -> tuple[list[Joint], Array, Array]:
    """Merge the root with its only child if that moves: p = p_root + R_root p_child, R = R_root R_child.

    A warning states that the root is left out, and whether it moves, once for all files of a folder.
    """
    parents = [joint.parent for joint in joints]
    if parents.count(0) != 1 or np.ptp(positions[:, 1], axis=0).max() <= STILL:
        return joints, positions, local
    moves = bool(np.ptp(positions[:, 0], axis=0).max() > STILL)
    _warn_of_reference(Path(path), joints[0].name, joints[1].name, moves=moves)
    positions[:, 1] = positions[:, 0] + rotations.rotate(local[:, 0], positions[:, 1])
    local[:, 1] = rotations.multiply(local[:, 0], local[:, 1])
    joints = [replace(joint, parent=joint.parent - 1) for joint in joints[1:]]
    return joints, positions[:, 1:], local[:, 1:]


REFERENCES: set[tuple[Path, str, str, bool]] = set()  # that were stated: folder, root, child, and motion


def _warn_of_reference(path: Path, root: str, child: str, *, moves: bool) -> None:
    """Warn that a root is left out, once for all files of a folder."""
    reference = (path.parent, root, child, moves)
    if reference in REFERENCES:
        return
    REFERENCES.add(reference)
    root = f"'{shortened(root, 40)}'"
    child = f"'{shortened(child, 40)}'"
    reason = f"the moving root {root} is left out: {child} carries its travel"
    if not moves:
        reason = f"the still root {root} is left out: {child} is the root"
    warn(f"{path}: {reason}.")


def _channels(path: str | Path, options: ReadOptions) -> tuple[Hierarchy, Array, float]:
    """Read the hierarchy, the numbers of all channels (F, C), and the frame rate, unless it is given."""
    text = without_commas(path, _without_comments(path, read_text(path)), NUMBERS)
    start = re.search(r"^[ \t]*MOTION[ \t]*$", text, re.MULTILINE | re.IGNORECASE)
    if start is None:
        raise FormatError(path, None, "a line 'MOTION'", "none")
    hierarchy = read_hierarchy(path, text[: start.start()], options.body)
    times = TIMES.match(text, start.end())
    if times is None:
        line = text.count("\n", 0, start.end()) + 2
        got = f"'{' '.join(text[start.end() :][:200].split()[:4])}'"
        raise FormatError(path, line, "'Frames: <count>' and 'Frame Time: <seconds>'", got)
    values = _values(path, text, times, hierarchy.width)
    check_room(path, len(values) * len(hierarchy.joints), values.size)
    return hierarchy, values, options.fps or _rate(path, text, times)


def _without_comments(path: str | Path, text: str) -> str:
    """Return a text with blank lines in place of comments, and of what is above HIERARCHY, and warn of it."""
    comments: list[str] = []

    def blank(part: re.Match[str]) -> str:
        comments.extend(line.strip() for line in part[0].split("\n") if line.strip())
        return "\n" * part[0].count("\n")

    if "#" in text or "//" in text:
        text = COMMENT.sub(blank, text)
    above = ABOVE.match(text)
    if above and above[0].strip():
        text = blank(above) + text[above.end() :]
    if comments:
        shown = shortened(comments[0], 40)
        warn(f"{path}: comments are left out, {len(comments)} in all, such as '{shown}'.")
    return text


def _values(path: str | Path, text: str, times: re.Match[str], width: int) -> Array:
    """Read the frames (F, channels); `times` is the match with their count."""
    line = text.count("\n", 0, times.start(1)) + 1
    count = to_numbers(path, line, [times[1]], "a number of frames", 1)[0]
    if width == 0:
        raise FormatError(path, line, "channels, which have numbers in every frame", "none")
    values = parse_numbers(text[times.end() :])
    is_cut = False
    if values is None or values.size != count * width or not np.all(np.abs(values) < LARGEST):
        values, is_cut = _rows(path, text, times, width)
    frames = values.size // width
    if frames == 0:
        raise FormatError(path, line, "one frame or more", "none")
    if frames != count and not (is_cut and frames + 1 == count):
        warn(f"{path}: the header says {count:.15g} frames, and {frames} whole ones follow: all are read.")
    return values.reshape(frames, width)


def _rows(path: str | Path, text: str, times: re.Match[str], width: int) -> tuple[Array, bool]:
    """Read the frames one line at a time, and raise at the first line that is not a whole frame.

    The last line may be a part of one, where a recording was interrupted: it is left out with a warning.

    Returns
    -------
    The numbers of all whole frames, and whether a part of one was left out.
    """
    rows: list[Array] = []
    first_line = text.count("\n", 0, times.end()) + 1
    lines = [(number, row.split()) for number, row in enumerate(text[times.end() :].split("\n"), first_line)]
    lines = [(number, words) for number, words in lines if words]
    is_cut = len(lines) > 1 and len(lines[-1][1]) < width
    if is_cut:
        last_line, words = lines.pop()
        warn(f"{path}: line {last_line}, the last one, ends after {len(words)} of {width} numbers: left out.")
    for number, words in lines:
        expected = f"{width} numbers after {len(rows)} complete frames"
        rows.append(to_numbers(path, number, words, expected, width))
    return np.concatenate([np.empty(0), *rows]), is_cut


def _rate(path: str | Path, text: str, times: re.Match[str]) -> float:
    """Read the frame rate, an integer if the frame time is its reciprocal, rounded or truncated."""
    line = text.count("\n", 0, times.start(2)) + 1
    seconds = float(to_numbers(path, line, [times[2]], "seconds", 1)[0])
    if not SHORTEST <= seconds <= LONGEST:
        expected = f"a frame time from {SHORTEST:g} to {LONGEST:g} s"
        raise FormatError(path, line, expected, times[2], remedy=Remedy("give {}", "fps"))
    rate, is_certain = frame_rates.rate_of(times[2])
    if not is_certain:
        warn(f"{path}: a frame time of {times[2]} s has few digits: it is read as {rate:g} Hz.")
    return rate


def _rigid(
    path: str | Path, joints: list[Joint], poses: tuple[Array, Array], limit: float
) -> tuple[Array, Array]:
    """Fit rigid bones if joints move in their parents' frames. Raise if they stretch by more than `limit`.

    Returns
    -------
    Offsets (J, 3), metres, and rotations (F, J, 4).
    """
    positions, local = poses
    movements = np.ptp(positions[:, 1:], axis=0).max(axis=1)  # metres, of each joint except the root
    if not (movements > STILL).any():
        return np.vstack([np.zeros((1, 3)), positions[0, 1:]]), local
    parents = np.array([joint.parent for joint in joints])
    offsets, fitted, stretch, distances = fit(parents, positions, local)
    if stretch.max() > limit or distances.max() > TUNED.strayed * limit:
        mover = joints[1 + int(movements.argmax())]
        expected = f"'{mover.name}' in one place below its parent, but for {limit:g} m"
        raise FormatError(path, mover.line, expected, f"one that moves by {movements.max():.2g} m")
    worst = shortened(joints[int(stretch.argmax())].name, 40)
    change = f"bones change length by up to {1000 * stretch.max():.2g} mm ({worst})"
    distance = f"joints lie up to {1000 * distances.max():.2g} mm from their places in the file"
    warn(f"{path}: {change}; fitted to rigid bones, {distance}.")
    return offsets, fitted


def write(
    pieces: Iterable[Motion], path: str | Path, *, frames: int, rotates: NDArray[np.bool_], precision: int = 6
) -> None:
    """Write consecutive motions to a BVH file, in centimetres, with only one of them in memory at a time.

    Joints are written depth first. A leaf that never rotates, and has the name that reading would give it,
    becomes an End Site. Any other leaf is a joint with an End Site of length zero. Of equivalent Euler
    angles, those nearest to the previous frame are written, therefore every curve is continuous.

    Parameters
    ----------
    pieces : motions of one skeleton and rate, with a total of `frames` frames.
    path : the file. An existing file is replaced once the new one is complete.
    frames : the number of frames in the header of the file.
    rotates : shape (J,), whether a joint rotates in any frame, from `body.motion.rotating_joints`.
    precision : the number of decimals. With 6, the error of joint positions is at most 1e-7 m.

    Raises
    ------
    MocapError : for a name or frame rate that the format cannot represent, or a folder that cannot be written
        to.
    """
    motions = iter(pieces)
    first = next(motions)
    seconds = 1 / first.fps
    if not SHORTEST <= seconds <= LONGEST:
        name = shortened(first.name)
        raise MocapError(f"'{name}' at {first.fps:g} Hz does not fit a BVH file: resample it first.")
    offsets = np.round(first.skeleton.offsets / SCALE, precision) + 0.0  # no -0.000000
    hierarchy, order = write_hierarchy(first.skeleton, offsets, rotates, precision)
    previous = np.empty((0, len(order), 3))  # angles of the last frame of the previous motion
    with replacing(path) as unfinished, unfinished.open("w", encoding="utf-8", newline="\n") as file:
        file.write(f"{hierarchy}MOTION\nFrames: {frames}\nFrame Time: {seconds!r}\n")
        for motion in chain([first], motions):
            angles = np.concatenate([previous, euler.to_euler("ZXY", motion.rotations[:, order])])
            angles = euler.continuous("ZXY", angles)[-len(motion) :]
            previous = angles[-1:]
            file.write(_frame_rows(motion, angles, precision))


def _frame_rows(motion: Motion, angles: Array, precision: int) -> str:
    """Format the frames of a motion as lines; `angles` are those of its joints (F, J, 3), radians."""
    degrees = np.degrees(angles).reshape(len(motion), -1)
    values = np.hstack([motion.root_positions / SCALE, degrees])
    if np.any(np.abs(values) >= LARGEST):
        reason = f"goes {LARGEST:g} units far, or turns by as many degrees"
        raise MocapError(f"'{shortened(motion.name)}' {reason}: no file holds it.")
    values = np.round(values, precision) + 0.0  # no -0.0
    row = " ".join([f"%.{precision}f"] * values.shape[1]) + "\n"
    return (row * len(values)) % tuple(values.ravel().tolist())
