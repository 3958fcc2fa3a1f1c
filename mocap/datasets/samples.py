"""The bundled clips by name; they need no network.

They were generated: footsteps planned along a path, a few harmonics for each joint, and inverse kinematics
for the legs (`figures/walking`). `clips.npz` holds their numbers in multiples of 2⁻³¹, each clip as the sixth
differences of its columns: these are small where a motion is smooth.
"""

from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from mocap._shared.archives import open_archive
from mocap.body.motion import Motion
from mocap.body.skeleton import Skeleton
from mocap.errors import MocapError, shortened

FPS = 120.0  # frames per second of all bundled clips
UNIT = 2.0**-31  # metres, or parts of a quaternion: what the stored numbers count
ORDER = 6  # how often the stored numbers are differences
ROOT_ROTATION = slice(3, 7)  # columns of a clip: the root's position, its quaternion,
OTHER_ROTATIONS = slice(7, None)  # and (x, y, z) of the quaternions of all other joints
FEET = ["lfoot", "rfoot", "ltoes", "rtoes"]
STORE = Path(__file__).with_name("clips.npz")  # from `figures/bundled_clips.py`

SAMPLES = ("walk_circle", "walk_curve_1", "walk_curve_2", "walk_straight", "sneak", "jog", "stop_and_go")
"""The names of the bundled clips from which motion graphs are built; `sample` has some more."""

FRAMES_IN_0_1 = {
    "walk_circle": 4711,
    "walk_curve_1": 4883,
    "walk_curve_2": 4954,
    "walk_straight": 1201,
    "sneak": 4021,
    "jog": 3853,
    "stop_and_go": 2932,
}
"""Lengths of the clips that had these names in mocap 0.1, which walked otherwise."""

OURS = "the clips that come with mocap"

with open_archive(STORE, OURS) as _store:
    _names, _parents, _offsets = (_store[key].read() for key in ("names", "parents", "offsets"))
    _KEYS = [key.removesuffix("/moving") for key in _store if key.endswith("/moving")]
SKELETON = Skeleton(_names.tolist(), _parents, _offsets)


@cache
def sample(name: str = "walk_circle") -> Motion:
    """Give a bundled clip, at 120 Hz, with its footplants as contacts; the same at each call.

    Parameters
    ----------
    name : one of `SAMPLES`; "jump"; "bend_sneak" or "bend_walk", around one bend; or a walk of 5 or 6 metres
        by its speed (m/s) and its turn (degrees to the left), as in "walk_5m_0.8_0" and "walk_6m_1.4_-180".

    Raises
    ------
    MocapError : for another name.

    Examples
    --------
    >>> sample("walk_straight")
    Motion('walk_straight', 1158 frames at 120 Hz, 9.64 s, 38 joints)

    Notebook: 01-skeletons-and-clips
    """
    if name not in _KEYS:
        clips = ", ".join(_KEYS[:10])
        walks = len(_KEYS) - 10
        raise MocapError(f"No bundled clip '{shortened(name, 40)}'; there are {clips} and {walks} walks.")
    keys = ("digits", "moving", "flipped", "labels", "kind", "contacts")
    with open_archive(STORE, OURS) as store:
        digits, moving, flipped, labels, kind, contacts = (store[f"{name}/{key}"].read() for key in keys)
    folded = sum(plane.astype(np.int64) << 8 * place for place, plane in enumerate(digits))
    numbers: Any = (folded >> 1) ^ -(folded & 1)
    for _ in range(ORDER):
        numbers = numbers.cumsum(axis=1)
    columns = np.zeros((len(kind), len(moving)))
    columns[:, moving] = UNIT * numbers.T
    turns = np.empty((len(kind), len(SKELETON), 4))
    turns[:, 0] = columns[:, ROOT_ROTATION]
    turns[:, 1:, 1:] = columns[:, OTHER_ROTATIONS].reshape(len(kind), -1, 3)
    turns[:, 0] /= np.linalg.norm(turns[:, 0], axis=-1, keepdims=True)
    turns[:, 1:, 0] = np.sqrt(1 - (turns[:, 1:, 1:] ** 2).sum(axis=-1))
    rotations = np.where(flipped.T[..., None], -turns, turns)
    title = name if name in (*SAMPLES, "jump") else str(labels[0])
    marks = {str(label): kind == number for number, label in enumerate(labels)}
    plants = dict(zip(FEET, contacts, strict=True))
    return Motion(SKELETON, columns[:, :3], rotations, FPS, title, marks, plants)
