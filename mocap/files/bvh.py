"""BVH files: a hierarchy of joints, and the numbers of their channels in every frame.

Position channels replace a joint's offset. Rotation channels turn about the joint's own axes in the order
given: Zrotation Xrotation Yrotation is R = Rz Rx Ry. A file has no unit: it is `scale` metres, by default a
centimetre. `bvh_hierarchy` says how joints are named.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import replace
from decimal import Decimal
from itertools import chain
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from mocap._shared.arrays import Array
from mocap._shared.atomic import replacing
from mocap.body import euler, rotations
from mocap.body.kinematics import joint_positions
from mocap.body.limbs import find_pair
from mocap.body.motion import Motion
from mocap.body.rotations import Z_UP
from mocap.body.skeleton import Skeleton
from mocap.errors import FormatError, MocapError, shortened, warn
from mocap.files.bvh_hierarchy import POSITIONS, ROTATIONS, Joint, read_hierarchy, write_hierarchy
from mocap.files.recordings import Recording
from mocap.files.rigid_bones import APART, STRETCH, fit
from mocap.files.text import LARGEST, check_room, quick_numbers, read_text, to_numbers

SCALE = 0.01  # metres in one unit of the files that are written, and by default of those that are read
STILL = 1e-5  # metres that a fixed joint may move in its parent's frame: rounding of printed numbers
SHORTEST, LONGEST = 1e-5, 10.0  # seconds a frame may last
ALONG = 0.8  # how much of a leg's length is along z where the file has z up
TIMES = re.compile(
    r"\s*Frames[ \t]*:[ \t]*(\S+)[ \t]*\n\s*Frame[ \t]+Time[ \t]*:[ \t]*(\S+)[ \t]*(?:\n|\Z)", re.IGNORECASE
)


def read(
    path: str | Path, *, scale: float = SCALE, fps: float | None = None, stretch: float = STRETCH
) -> Recording:
    """Read a BVH file.

    Position channels below the root are allowed. Where they move, and no bone's length changes by more than
    `stretch`, the bones are fitted to rigid ones: see `rigid_bones`. If the root has only one child, and that
    child moves (some files have a reference point above the hips), both become one joint, named as the child.

    Parameters
    ----------
    path : the file.
    scale : metres in one unit of the file.
    fps : frames per second; by default from the frame time, a whole number where its digits allow it.
    stretch : metres by which a bone's length may change.

    Raises
    ------
    FormatError : with the line that breaks the format.

    Warns
    -----
    MocapWarning : where bones were fitted, with how much they stretch, and how far joints moved; and where
        legs, found by their names, stand along z at rest and in most frames: then y is made to point up.
    """
    joints, blocks, rate = _channels(path, fps=fps)
    angles = {joint.name: block[:, _turning(joint)] for joint, block in zip(joints, blocks, strict=True)}
    joints, places, local = _poses(joints, blocks, scale)
    lengths = np.ptp(np.linalg.norm(places, axis=-1), axis=0).tolist()
    names, parents = [joint.name for joint in joints], np.array([joint.parent for joint in joints])
    offsets, local = _rigid(path, joints, (places, local), stretch)
    skeleton = Skeleton(names, parents, offsets, dofs=[_turns(joint)[::-1] for joint in joints])
    motion = Motion(skeleton, places[:, 0], local, rate, Path(path).stem)
    return Recording(_upright(path, motion), angles, dict(zip(names[1:], lengths[1:], strict=True)))


def _upright(path: str | Path, motion: Motion) -> Motion:
    """Turn all axes so that y is up, where both legs stand along z at rest and in most frames."""
    skeleton = motion.skeleton
    if not (legs := find_pair(skeleton, "legs")):
        return motion
    (hips, _, ankles), poses = np.transpose(legs), np.vstack([skeleton.rest[None], joint_positions(motion)])
    up = poses[:, hips] - poses[:, ankles]
    along_z = (up[..., 2] > ALONG * np.linalg.norm(up, axis=-1)).all(axis=1)
    if not along_z[0] or along_z[1:].mean() < 0.5:
        return motion
    warn(f"{path}: the body stands along z: turned so that y is up.")
    roots, offsets = (rotations.rotate(Z_UP, way) for way in (motion.root_positions, skeleton.offsets))
    local = rotations.multiply(rotations.multiply(Z_UP, motion.rotations), rotations.inverse(Z_UP))
    upright = replace(skeleton, offsets=offsets, axes=np.tile(Z_UP, (len(skeleton), 1)))
    return replace(motion, skeleton=upright, root_positions=roots, rotations=local)


def _poses(joints: list[Joint], blocks: list[Array], scale: float) -> tuple[list[Joint], Array, Array]:
    """Turn channels into joints, their places below their parents (F, J, 3), metres, and rotations."""
    frames = len(blocks[0])
    places = np.tile(np.array([joint.offset for joint in joints]), (frames, 1, 1))
    local = np.tile(rotations.IDENTITY, (frames, len(joints), 1))
    for index, (joint, block) in enumerate(zip(joints, blocks, strict=True)):
        for channel, numbers in zip(joint.channels, block.T, strict=True):
            if channel in POSITIONS:
                places[:, index, POSITIONS.index(channel)] = numbers
        if order := _turns(joint):
            local[:, index] = euler.from_euler(order.upper(), np.radians(block[:, _turning(joint)]))
    parents = [joint.parent for joint in joints]
    if parents.count(0) == 1 and np.ptp(places[:, 1], axis=0).max() * scale > STILL:
        # The only child takes the root's place: p = p_root + R_root p_child, R = R_root R_child.
        places[:, 1] = places[:, 0] + rotations.rotate(local[:, 0], places[:, 1])
        local[:, 1] = rotations.multiply(local[:, 0], local[:, 1])
        joints = [replace(joint, parent=joint.parent - 1) for joint in joints[1:]]
        places, local = places[:, 1:], local[:, 1:]
    return joints, scale * places, local


def _channels(path: str | Path, *, fps: float | None = None) -> tuple[list[Joint], list[Array], float]:
    """Read the joints, each one's numbers (F, channels), and the frame rate, which `fps` replaces."""
    text = read_text(path)
    start = re.search(r"^[ \t]*MOTION[ \t]*$", text, re.MULTILINE | re.IGNORECASE)
    if start is None:
        raise FormatError(path, None, "a line 'MOTION'", "none")
    joints = read_hierarchy(path, text[: start.start()])
    times = TIMES.match(text, start.end())
    if times is None:
        line = text.count("\n", 0, start.end()) + 2
        got = f"'{' '.join(text[start.end() :][:200].split()[:4])}'"
        raise FormatError(path, line, "'Frames: <count>' and 'Frame Time: <seconds>'", got)
    counts = [len(joint.channels) for joint in joints]
    values = _values(path, text, times, sum(counts))
    check_room(path, len(values) * len(joints), values.size)
    return joints, np.split(values, np.cumsum(counts)[:-1], axis=1), fps or _rate(path, text, times)


def _values(path: str | Path, text: str, times: re.Match[str], width: int) -> Array:
    """Read the frames (F, channels); `times` is the match with their count."""
    line = text.count("\n", 0, times.start(1)) + 1
    count = to_numbers(path, line, [times[1]], "a number of frames", 1)[0]
    if count < 1 or width == 0:
        raise FormatError(path, line, "one frame or more", f"{times[1]}, of {width} channels")
    words = text[times.end() :].split()
    if len(words) == count * width and (values := quick_numbers(words)) is not None:
        return values.reshape(-1, width)
    found = 0  # complete frames before the line that is wrong
    for number, row in enumerate(text[times.end() :].split("\n"), text.count("\n", 0, times.end()) + 1):
        if words := row.split():
            to_numbers(path, number, words, f"{width} numbers after {found} complete frames", width)
            found += 1
    raise FormatError(path, line, f"'Frames: {found}', as many as follow", f"'Frames: {times[1]}'")


def _rate(path: str | Path, text: str, times: re.Match[str]) -> float:
    """Read the frame rate; a whole number where the frame time is 1 / that number, rounded or cut off."""
    line = text.count("\n", 0, times.start(2)) + 1
    seconds = float(to_numbers(path, line, [times[2]], "seconds", 1)[0])
    if not SHORTEST <= seconds <= LONGEST:
        raise FormatError(path, line, f"a frame time from {SHORTEST:g} to {LONGEST:g} s", times[2])
    last_digit = 10.0 ** int(Decimal(times[2]).as_tuple().exponent)
    whole = max(1, round(1 / seconds))
    return float(whole) if abs(1 / whole - seconds) < max(0.999 * last_digit, 1e-12) else 1 / seconds


def _turning(joint: Joint) -> list[int]:
    return [place for place, channel in enumerate(joint.channels) if channel in ROTATIONS]


def _turns(joint: Joint) -> str:
    """Name the axes of a joint's rotation channels, in their order."""
    return "".join(joint.channels[place][0] for place in _turning(joint))


def _rigid(
    path: str | Path, joints: list[Joint], poses: tuple[Array, Array], most: float
) -> tuple[Array, Array]:
    """Give the offsets of rigid bones (J, 3) and rotations (F, J, 4); bones may stretch by `most` metres."""
    places, local = poses
    moved = np.ptp(places[:, 1:], axis=0).max(axis=1)  # metres, of each joint but the root
    if not (moved > STILL).any():
        return np.vstack([np.zeros((1, 3)), places[0, 1:]]), local
    offsets, fitted, stretch, apart = fit(np.array([joint.parent for joint in joints]), places, local)
    worst = int(stretch.argmax())
    if stretch.max() > most or apart.max() > APART * most:
        mover = joints[1 + int(moved.argmax())]
        expected = f"'{mover.name}' in one place below its parent, but for {most:g} m"
        raise FormatError(path, mover.line, expected, f"one that moves by {moved.max():.2g} m")
    change = f"{1000 * stretch[worst]:.2g} mm ({shortened(joints[worst].name, 40)})"
    off = f"fitted to rigid bones, joints lie up to {1000 * apart.max():.2g} mm from their places"
    warn(f"{path}: bones change length by up to {change}; {off} in the file.")
    return offsets, fitted


def write(
    pieces: Iterable[Motion], path: str | Path, *, frames: int, turns: NDArray[np.bool_], precision: int = 6
) -> None:
    """Write a BVH file of motions that follow one another, in centimetres, one of them in memory at a time.

    Joints are written depth first. A leaf that never turns, and has the name that reading would give it,
    becomes an End Site; any other leaf is a joint with an End Site of zero length. Of all equal angles the
    nearest to those of the frame before are written, so every curve is continuous.

    Parameters
    ----------
    pieces : motions of one skeleton and rate, with `frames` frames together.
    path : the file; one that exists is replaced when the new one is whole.
    frames : the count in the file's header.
    turns : shape (J,), which joints ever turn, as by `body.motion.turning`.
    precision : digits after the point; 6 keep joints to 1e-7 m.

    Raises
    ------
    MocapError : for a name or frame rate that a BVH file cannot hold, or a folder that cannot be written to.
    """
    first = next(pieces := iter(pieces))
    seconds, name = 1 / first.fps, shortened(first.name)
    if not SHORTEST <= seconds <= LONGEST:
        raise MocapError(f"'{name}' at {first.fps:g} Hz does not fit a BVH file: resample it first.")
    offsets = np.round(first.skeleton.offsets / SCALE, precision) + 0.0  # no -0.000000
    hierarchy, order = write_hierarchy(first.skeleton, offsets, turns, precision)
    before = np.empty((0, len(order), 3))
    with replacing(path) as beside, beside.open("w", encoding="utf-8", newline="\n") as file:
        file.write(f"{hierarchy}MOTION\nFrames: {frames}\nFrame Time: {seconds!r}\n")
        for motion in chain([first], pieces):  # the angles go on from those of the frame before
            angles = np.concatenate([before, euler.to_euler("ZXY", motion.rotations[:, order])])
            angles = euler.continuous("ZXY", angles)[-len(motion) :]
            before = angles[-1:]
            values = np.hstack([motion.root_positions / SCALE, np.degrees(angles).reshape(len(motion), -1)])
            if np.any(np.abs(values) >= LARGEST):
                far = f"goes {LARGEST:g} units far, or turns by as many degrees"
                raise MocapError(f"'{shortened(motion.name)}' {far}: no file holds it.")
            values = np.round(values, precision) + 0.0  # no -0.0
            row = " ".join([f"%.{precision}f"] * values.shape[1]) + "\n"
            file.write((row * len(values)) % tuple(values.ravel().tolist()))
