"""Small corrections spread over a walk, so that it stands exactly where and as it should.

A search chooses between captured steps, and ends some centimetres and degrees off. As in path editing
[Gle01], the error is spread over the steps before: each is rotated and lengthened by a little, in proportion
to its length, so that standing bodies do not move.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from mocap._shared.arrays import Array, Points
from mocap._shared.easing import quintic_step
from mocap._shared.records import NamedTuple
from mocap.body import rotations
from mocap.body.legs import heading_by_hips
from mocap.body.limbs import find_legs
from mocap.body.motion import Motion
from mocap.body.planar import on_ground
from mocap.editing.bending import LIMIT

PEAK = 15 / 8  # the largest slope of `quintic_step`
TURN_SECONDS = 0.8  # seconds, the least time of a rotation. Shorter, small rotations are a jolt
MOVES = 0.2  # m/s of the root, above which a body moves
STILL = 0.2  # metres travelled between two anchors, below which a correction is spread over time


class Anchor(NamedTuple):
    """A frame of a motion at which the root is to be at a position, and the body to have a heading.

    Examples
    --------
    >>> Anchor(90, 4 + 0j, 0.0).frame
    90
    """

    frame: int
    position: complex  # z + ix, metres
    heading: float  # radians


class Correction(NamedTuple):
    """The correction between two anchors: a distance, an angle (radians), and the metres travelled."""

    metres: float
    radians: float
    travelled: float


def corrections(motion: Motion, anchors: Sequence[Anchor]) -> list[Correction]:
    """Return what `fit_to_anchors` corrects between each two anchors.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> walk = sample("walk_straight")
    >>> start, end = (complex(z, x) for x, _, z in walk.root_positions[[0, -1]])
    >>> first, last = headings_in(walk)[[0, -1]]
    >>> [part] = corrections(walk, [Anchor(0, start, first), Anchor(len(walk) - 1, end + 0.1, last)])
    >>> round(part.metres, 2), round(part.radians, 2), round(part.travelled)
    (0.1, 0.0, 13)
    """
    track = on_ground(motion.root_positions)
    turns = _turns(motion, anchors)
    parts = []
    for number, (first, last) in enumerate(pairwise(anchors)):
        piece = track[first.frame : last.frame + 1]
        turn = turns[number] + _fractions(piece) * (turns[number + 1] - turns[number])
        missing = last.position - _turned_steps(piece, turn, first.position)[-1]
        travelled = float(np.abs(np.diff(piece)).sum())
        parts.append(Correction(float(abs(missing)), float(turns[number + 1] - turns[number]), travelled))
    return parts


def _turns(motion: Motion, anchors: Sequence[Anchor]) -> Array:
    """Return the rotation that each anchor needs, without jumps of 2π, radians."""
    facing = headings_in(motion[[anchor.frame for anchor in anchors]])
    wanted = [anchor.heading for anchor in anchors]
    return np.unwrap([wrapped(heading - angle) for heading, angle in zip(wanted, facing, strict=True)])


def headings_in(motion: Motion) -> Array:
    """Return the heading of the body by its hips in each frame (F,), radians."""
    return heading_by_hips(motion.positions, find_legs(motion.skeleton))


def fit_to_anchors(motion: Motion, anchors: Sequence[Anchor]) -> Motion:
    """Rotate and stretch a motion on the ground so that it meets all anchors.

    Between two anchors, the rotation grows with the distance travelled, each step is rotated by it, and the
    distance that is still missing is added in the same proportion. Before the first anchor and after the last
    one, the motion moves rigidly.

    Parameters
    ----------
    motion : F frames.
    anchors : one or more, in the order of their frames, which differ.

    Returns
    -------
    The motion, whose contacts are no longer exact: `feet.clean_up` restores them.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> walk = sample("walk_straight")
    >>> start = complex(walk.root_positions[0, 2], walk.root_positions[0, 0])
    >>> fitted = fit_to_anchors(walk, [Anchor(0, start, 0.0), Anchor(len(walk) - 1, 11 + 1j, 0.5)])
    >>> fitted.root_positions[-1, [0, 2]].round(6), float(headings_in(fitted)[-1].round(6))
    (array([ 1., 11.]), 0.5)
    """
    track = on_ground(motion.root_positions)
    frames = [anchor.frame for anchor in anchors]
    turns = _turns(motion, anchors)
    turn = np.empty(len(track))
    place = np.empty(len(track), complex)
    turn[: frames[0] + 1] = turns[0]
    turn[frames[-1] :] = turns[-1]
    for start, end in ((0, frames[0] + 1), (frames[-1], len(track))):
        anchor = anchors[0] if start == 0 else anchors[-1]
        rotation = np.exp(1j * turn[start])
        place[start:end] = anchor.position + rotation * (track[start:end] - track[anchor.frame])
    for number, (first, last) in enumerate(pairwise(anchors)):
        part = slice(first.frame, last.frame + 1)
        fraction = _fractions(track[part])
        turn[part] = turns[number] + fraction * (turns[number + 1] - turns[number])
        place[part] = _stretched(track[part], turn[part], fraction, first.position, last.position)
    roots = motion.root_positions.copy()
    roots[:, 0] = place.imag
    roots[:, 2] = place.real
    local = motion.rotations.copy()
    local[:, 0] = rotations.multiply(rotations.about_y(turn), local[:, 0])
    return replace(motion, root_positions=roots, rotations=local)


def _fractions(track: Points) -> Array:
    """Return the fraction of the distance travelled in each frame, or of time if the body hardly moves."""
    travelled = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(track)))])
    if travelled[-1] < STILL:
        return np.linspace(0.0, 1.0, len(track))
    return np.asarray(travelled / travelled[-1])


def _stretched(track: Points, turn: Array, fraction: Array, start: complex, end: complex) -> Points:
    """Rotate each step of a track by its turn, and add what is missing from its start to its end."""
    turned = _turned_steps(track, turn, start)
    return np.asarray(turned + fraction * (end - turned[-1]))


def _turned_steps(track: Points, turn: Array, start: complex) -> Points:
    """Rotate each step of a track by its turn, from a start on."""
    steps = np.diff(track) * np.exp(0.5j * (turn[1:] + turn[:-1]))
    return np.asarray(start + np.concatenate([[0.0], np.cumsum(steps)]))


def wrapped(angle: float) -> float:
    """Wrap an angle to [-π, π)."""
    return float((angle + np.pi) % (2 * np.pi) - np.pi)


def rotate_at_ends(motion: Motion, first: float, last: float) -> Motion:
    """Rotate a body about its root as it starts and as it stops, and leave its track as it is.

    Clips mostly start and stop straight ahead. People who stop to face another way turn in their last steps,
    at about 100° per second. The rotation grows smoothly over as much time as this takes, from the first
    frame in which the body moves, and until the last one.

    Parameters
    ----------
    motion : F frames.
    first, last : the angles by which its first and its last frame are rotated, radians.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> walk = sample("walk_straight")
    >>> turned = headings_in(rotate_at_ends(walk, 0.0, 1.0)) - headings_in(walk)
    >>> turned[[0, -1]].round(6)
    array([0., 1.])
    """
    return rotated_about_root(motion, end_rotations(motion, first, last))


def rotated_about_root(motion: Motion, rotation: Array) -> Motion:
    """Return a motion whose body is rotated about its root by an angle in each frame, on the same track.

    Parameters
    ----------
    motion : F frames.
    rotation : shape (F,), radians.
    """
    local = motion.rotations.copy()
    local[:, 0] = rotations.multiply(rotations.about_y(rotation), local[:, 0])
    return replace(motion, rotations=local)


def end_rotations(motion: Motion, first: float, last: float) -> Array:
    """Return the angle by which `rotate_at_ends` rotates each frame, shape (F,), radians."""
    speed = np.abs(np.diff(on_ground(motion.root_positions), append=np.nan)) * motion.fps
    moving = np.flatnonzero(speed > MOVES)
    start = int(moving[0]) if len(moving) else 0
    stop = int(moving[-1]) if len(moving) else len(motion) - 1
    frames = np.arange(len(motion))

    in_frames, out_frames = (_frames_of(angle, motion.fps) for angle in (first, last))
    # Both turns share the time, if it is short; a body that hardly moves turns within a frame.
    factor = min(1.0, max(1, stop - start) / (in_frames + out_frames))
    turn_in = first * (1 - quintic_step((frames - start) / (factor * in_frames)))
    turn_out = last * quintic_step((frames - stop) / (factor * out_frames) + 1)
    return np.asarray(turn_in + turn_out)


def passing_rotation(motion: Motion, frame: int, angle: float) -> Array:
    """Return the angle in each frame, shape (F,), of a body that is rotated to an angle in a frame, and back.

    Parameters
    ----------
    motion : F frames.
    frame : the frame in which the body is rotated by `angle`.
    angle : radians.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> turn = passing_rotation(sample("walk_straight")[:200], 100, 0.5)
    >>> turn[[0, 100, 199]].round(6).tolist()
    [0.0, 0.5, 0.0]
    """
    distance = np.abs(np.arange(len(motion)) - frame)
    return np.asarray(angle * quintic_step(1 - distance / _frames_of(angle, motion.fps)))


def _frames_of(angle: float, fps: float) -> float:
    """Return the number of frames of a rotation whose highest speed is `LIMIT`."""
    return max(TURN_SECONDS, PEAK * abs(angle) / LIMIT) * fps
