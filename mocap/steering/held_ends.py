"""The ends of a walk brought to two poses: what they lack fades into the walk, and feet stand as asked."""

from __future__ import annotations

import warnings
from dataclasses import replace

import numpy as np

from mocap._shared.arrays import Array, Mask, runs
from mocap.body.kinematics import joint_positions
from mocap.body.limbs import legs_of
from mocap.body.motion import Motion
from mocap.editing.displacements import Displacement, difference, displaced
from mocap.editing.pins import Pins
from mocap.editing.retiming import at_frames
from mocap.errors import MocapWarning
from mocap.feet.footplants import least_frames
from mocap.feet.footskate import clean_up, settled_marks
from mocap.steering.moments import Moment

FADE = 0.5  # seconds over which a difference fades, at most; half of a walk that is shorter than two of it
NEAR = 0.3  # seconds from an end: a plant so near to it stands where it stands at its frame next to the end


def stand(motion: Motion) -> Motion:
    """Clean up the feet, and change nothing in the first and in the last frames.

    `feet.clean_up` puts a plant where it is on average, and lets what it changes fade over 0.2 s. A pose at
    an end would change. So plants near an end stand where they stand next to it, and from there to the end
    both joints of the foot are held on their own way, as if they stood.

    Parameters
    ----------
    motion : F frames with contacts, whose feet hardly slide at both ends.

    Returns
    -------
    The motion; plants that were let go are no longer marked.
    """
    legs = legs_of(motion.skeleton, None)
    marks = settled_marks(motion, legs)
    places, joints = joint_positions(motion), [(leg.ankle, leg.ball) for leg in legs]
    span = least_frames(motion.fps)
    held = [_held(places[:, pair], own, span, motion.fps) for pair, own in zip(joints, marks, strict=True)]
    columns = [joint for pair in joints for joint in pair]
    known = np.concatenate(held, axis=1)  # (F, P, 3), nan where nothing is held
    names = [motion.skeleton.names[joint] for joint in columns]
    own = dict(zip(names, marks.reshape(-1, len(motion)), strict=True))
    also = {name: own[name] | np.isfinite(known[:, n, 0]) for n, name in enumerate(names)}
    free = np.isnan(known)
    pins = Pins(tuple(columns), np.where(free, -np.inf, known), np.where(free, np.inf, known))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", MocapWarning)  # which would also list the frames that are held here
        found = clean_up(replace(motion, contacts={**motion.contacts, **also}), legs, pins=pins)
    contacts = {name: mark & own.get(name, mark) for name, mark in found.contacts.items()}
    return replace(found, contacts=contacts)


def _held(places: Array, marks: Mask, span: int, fps: float) -> Array:
    """Say where an ankle and its ball (F, 2, 3) are held near both ends; nan where they are not."""
    length = float(np.linalg.norm(places[0, 0] - places[0, 1]))
    held = np.full(places.shape, np.nan)
    near = max(span, round(NEAR * fps))
    for back in (False, True):  # the end, then the start, which is the end of the motion run backwards
        way = slice(None, None, -1 if back else None)
        _hold_end(held[way], places[way], marks[:, way], length, (span, near))
    return held


def _hold_end(held: Array, places: Array, marks: Mask, length: float, spans: tuple[int, int]) -> None:
    """Fill in where the joints are held at the end of a motion, and in the plant that is near to it."""
    count, (span, near) = len(places), spans
    stands = runs(marks[0] | marks[1])
    begin = count - span - 1
    if len(stands) and stands[-1][1] > count - near:
        first, begin = int(stands[-1][0]), int(stands[-1][1])
        _hold_plant(held, places, marks[:, :begin], length, first)
    held[begin:] = places[begin:]
    # Where one joint stands up to the end, the other is where the foot's own turn has it; also in the gaps so
    # short that a clean-up closes them.
    for kind in (0, 1):
        alone = np.isnan(held[:, kind, 0]) & ~np.isnan(held[:, 1 - kind, 0])
        alone[: min(begin, count - 1) - span] = False
        held[alone, kind] = held[alone, 1 - kind] + (places[:, kind] - places[:, 1 - kind])[alone]


def _hold_plant(held: Array, places: Array, marks: Mask, length: float, first: int) -> None:
    """Hold the last plant: what stands in its last frame is held there, the rest a foot's length away."""
    last = marks.shape[1] - 1
    kinds = sorted((0, 1), key=lambda kind: not marks[kind, last])
    for kind in kinds:
        for start, stop in runs(marks[kind]):
            if start < first:
                continue
            if stop > last:
                held[start:stop, kind] = places[last, kind]
                continue
            both = np.flatnonzero(np.isfinite(held[start:stop, 1 - kind, 0])) + start
            if len(both):
                away = (places[:, kind] - places[:, 1 - kind])[both].mean(axis=0)
                other = held[both[-1], 1 - kind]
                held[start:stop, kind] = other + length * away / np.linalg.norm(away)


def meet_poses(
    motion: Motion, start: Moment, end: Moment, *, speed: bool = True
) -> tuple[Motion, Displacement]:
    """Add what the first and the last frame lack to two poses, and let it fade into the walk.

    The differences fade as in `blending.inertialize`: by a quintic that starts with
    the speed by which they change at the pose, and ends at rest. At the end of the walk it runs backwards.

    Parameters
    ----------
    motion : F frames, which starts and ends near to the poses.
    start, end : the poses.
    speed : whether the fades start with the speed of the differences; else they are level.

    Returns
    -------
    The motion, and what was added.
    """
    window = max(1.0, min(FADE * motion.fps, (len(motion) - 1) / 2))
    frames, last = np.arange(len(motion)), len(motion) - 1
    begin = _fading(motion, start, (0, 1, speed), frames / window)
    finish = _fading(motion, end, (last, -1, speed), (last - frames) / window)
    added = Displacement(*(one + other for one, other in zip(begin, finish, strict=True)))
    return displaced(motion, added), added


def _fading(motion: Motion, moment: Moment, at: tuple[int, int, bool], u: Array) -> Displacement:
    """Let the difference at a frame fade: x(u) = (1 - u)⁴ (x + (4 x + v T) u), and 0 from u = 1 on.

    `at`: the frame, the way into the motion, 1 or -1, and whether v counts.
    """
    frame, way, speed = at
    here = difference(moment.placed(), motion[frame : frame + 1])
    drift = Displacement(0 * here.root, 0 * here.turns)
    if speed and moment.has(way):
        step = way * motion.fps / moment.motion.fps
        then = difference(moment.placed(way), at_frames(motion, [frame + step]))
        window = 1 / (abs(step) * abs(u[1] - u[0]))  # so many of the moment's frames
        drift = Displacement(*((b - a) * window for a, b in zip(here, then, strict=True)))
    late = np.minimum(u, 1)
    fade = (1 - late) ** 4

    def curve(x: Array, v: Array) -> Array:
        shape = (-1, *np.ones(x.ndim - 1, int))
        return fade.reshape(shape) * (x + (4 * x + v) * late.reshape(shape))

    return Displacement(*map(curve, here, drift))
