"""Lead a character by commands alone: along a path [ours].

A character that is steered does not know where it should be later. So a point is carried ahead of it, and the
command is to go there. What it cannot turn as sharply as asked, it makes up for afterwards.
"""

from typing import NamedTuple

import numpy as np

from mocap._shared.arrays import Array
from mocap.body.ground_path import GroundPath
from mocap.body.motion import Motion
from mocap.body.planar import PlanarTransform, heading, on_ground
from mocap.errors import MocapError
from mocap.steering.characters import Character, Pose, as_motion

NEAR = 1.5  # metres around where it was last, in which the nearest point of a path is looked for
AIM = 0.1  # metres of a path that tell in which direction it starts


class Pursued(NamedTuple):
    """A motion that was led along a path: `off` (F,), metres from the path, and how much of it was walked."""

    motion: Motion
    off: Array
    progress: float


def pursue(
    character: Character, path: GroundPath, *, speed: float = 1.1, ahead: float = 0.8, limit: float = 3.0
) -> Pursued:
    """Lead a character along a path by a point that is carried ahead of it: pure pursuit.

    Parameters
    ----------
    character : any; the motion is laid so that it faces along the path where both start.
    path : where to go.
    speed : metres per second.
    ahead : metres along the path from where the character is to where it is led. Less follows bends more
        closely, until it swings.
    limit : times the seconds that the path takes at this speed, after which it ends.

    Returns
    -------
    The motion, laid on the path; how far it is off; and how much was walked, 1 for all.

    Raises
    ------
    MocapError : for a speed or a distance that is not above 0.

    Examples
    --------
    >>> from mocap import body, datasets, graphs
    >>> from mocap.steering import Controller
    >>> clips = [body.resample(datasets.sample(name), 30) for name in ("walk_circle", "walk_curve_1")]
    >>> character = Controller(graphs.prune(graphs.build(clips, window=10, threshold=0.04)))
    >>> led = pursue(character, GroundPath([[0, 0], [0, 4]]))
    >>> led.progress, bool(led.off.mean() < 0.3)
    (1.0, True)
    """
    if not (np.isfinite([speed, ahead, limit]).all() and min(speed, ahead, limit) > 0):
        raise MocapError(f"Speed, distance ahead and limit are above 0, got {speed}, {ahead}, {limit}.")
    fine = path.resampled(0.02)
    line, along = on_ground(fine.points), fine.along
    poses: list[Pose] = [character.step(0.0, speed)]
    turn = np.exp(1j * (np.angle(on_ground(fine.at(AIM)) - line[0]) - heading(poses[0].rotations[0])))
    place = PlanarTransform.from_complex(turn, line[0] - turn * on_ground(poses[0].root_position))
    off, now = [0.0], 0.0
    for _ in range(round(limit * path.length / speed * character.fps)):
        here = complex(on_ground(place.apply_points(poses[-1].root_position)))
        near = np.flatnonzero((along >= now - 0.2) & (along <= now + NEAR))
        gaps = np.abs(line[near] - here)
        now, off[-1] = float(along[near[gaps.argmin()]]), float(gaps.min())
        if now >= path.length - 0.1:
            break
        goal = complex(on_ground(fine.at(now + ahead)))
        poses.append(character.step(float(np.angle((goal - here) / turn)), speed))
        off.append(off[-1])
    motion = place.apply_motion(as_motion(character, poses, "led"))
    return Pursued(motion, np.array(off), min(1.0, (now + 0.1) / path.length))
