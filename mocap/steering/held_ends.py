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
    marks, places = settled_marks(motion, legs), joint_positions(motion)
    columns = [joint for leg in legs for joint in (leg.ankle, leg.ball)]
    known = np.full((len(motion), len(columns), 3), np.nan)  # nan where nothing is held
    for n, own in enumerate(marks):
        foot = slice(2 * n, 2 * n + 2)
        for way in (slice(None), slice(None, None, -1)):  # the start is the end of the motion run backwards
            _hold_end(known[way, foot], places[way][:, columns[foot]], own[:, way], motion.fps)
    names = [motion.skeleton.names[joint] for joint in columns]
    own = dict(zip(names, marks.reshape(-1, len(motion)), strict=True))
    also = {name: own[name] | np.isfinite(known[:, n, 0]) for n, name in enumerate(names)}
    where = dict(zip(columns, np.swapaxes(known, 0, 1), strict=True))
    # Its warnings would also list the frames that are held here.
    with warnings.catch_warnings(action="ignore", category=MocapWarning):
        found = clean_up(replace(motion, contacts={**motion.contacts, **also}), legs, held=where)
    contacts = {name: mark & own.get(name, mark) for name, mark in found.contacts.items()}
    return replace(found, contacts=contacts)


def _hold_end(held: Array, places: Array, marks: Mask, fps: float) -> None:
    """Fill in where the joints are held at the end of a motion, and in the plant that is near to it.

    What stands in the plant's last frame is held there, the rest a foot's length away.
    """
    away = places - places[:, ::-1]  # of each joint from the other one
    span, length = least_frames(fps), np.linalg.norm(away[0, 0])
    stands, begin = runs(marks[0] | marks[1]), len(places) - span - 1
    if len(stands) and stands[-1][1] > len(places) - max(span, round(NEAR * fps)):
        first, begin = stands[-1].tolist()
        for kind in sorted((0, 1), key=lambda kind: not marks[kind, begin - 1]):
            for start, stop in runs(marks[kind, :begin]):
                both = np.flatnonzero(np.isfinite(held[start:stop, 1 - kind, 0])) + start
                if stop == begin:
                    held[start:stop, kind] = places[begin - 1, kind]
                elif start >= first and len(both):
                    way = away[both, kind].mean(axis=0)
                    held[start:stop, kind] = held[both[-1], 1 - kind] + length * way / np.linalg.norm(way)
    held[begin:] = places[begin:]
    # Where one joint stands up to the end, the other is where the foot's own turn has it; also in the gaps so
    # short that a clean-up closes them.
    for kind in (0, 1):
        alone = np.isnan(held[:, kind, 0]) & ~np.isnan(held[:, 1 - kind, 0])
        alone[: min(begin, len(places) - 1) - span] = False
        held[alone, kind] = held[alone, 1 - kind] + away[alone, kind]


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
    begin, finish = _fading(motion, start, 1, speed=speed), _fading(motion, end, -1, speed=speed)
    added = Displacement(*(one + other for one, other in zip(begin, finish, strict=True)))
    return displaced(motion, added), added


def _fading(motion: Motion, moment: Moment, way: int, *, speed: bool) -> Displacement:
    """Let the difference at an end fade: x(u) = (1 - u)⁴ (x + (4 x + v T) u), and 0 from u = 1 on.

    `way` into the motion: 1 from its first frame, -1 from its last one.
    """
    last = len(motion) - 1
    frame, window = (0 if way > 0 else last), max(1.0, min(FADE * motion.fps, last / 2))
    late = np.minimum(np.abs(np.arange(last + 1) - frame) / window, 1)
    here = difference(moment.placed(), motion[frame : frame + 1])
    drift = [0 * part for part in here]
    if speed and moment.has(way):
        step = way * motion.fps / moment.motion.fps
        then = difference(moment.placed(way), at_frames(motion, [frame + step]))
        drift = [(b - a) * window / abs(step) for a, b in zip(here, then, strict=True)]
    faded = []
    for x, v in zip(here, drift, strict=True):
        u = late.reshape(-1, *np.ones(x.ndim - 1, int))
        faded.append((1 - u) ** 4 * (x + (4 * x + v) * u))
    return Displacement(*faded)
