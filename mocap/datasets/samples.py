"""The bundled clips by name, available without a network.

They are synthetic: footsteps planned along a path, a few harmonics for each joint, and inverse kinematics for
the legs (`figures/walking`). `clips.npz` stores their numbers in multiples of 2⁻³¹, each clip as the sixth
differences of its columns, which are small for smooth motions.
"""

from functools import cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from mocap._shared.archives import open_archive
from mocap.body.motion import Motion
from mocap.body.skeleton import Skeleton
from mocap.errors import MocapError, shortened

FPS = 120.0  # frames per second of all bundled clips
UNIT = 2.0**-31  # metres, or of a component of a quaternion: the unit of the stored numbers
ORDER = 6  # of the stored differences
ROOT_ROTATION = slice(3, 7)  # columns of a clip, after the position of the root
OTHER_ROTATIONS = slice(7, None)  # columns of a clip: (x, y, z) of the quaternions of all other joints
FEET = ["lfoot", "rfoot", "ltoes", "rtoes"]
STORE = Path(__file__).with_name("clips.npz")  # from `figures/bundled_clips.py`

SAMPLES = ("walk_circle", "walk_curve_1", "walk_curve_2", "walk_straight", "sneak", "jog", "stop_and_go")
"""The names of the bundled clips for motion graphs; `sample` returns further ones."""

FRAMES_IN_0_1 = {
    "walk_circle": 4711,
    "walk_curve_1": 4883,
    "walk_curve_2": 4954,
    "walk_straight": 1201,
    "sneak": 4021,
    "jog": 3853,
    "stop_and_go": 2932,
}
"""Lengths of the clips with these names in mocap 0.1, which were different motions."""

OURS = "the clips that come with mocap"

with open_archive(STORE, OURS) as _store:
    _names, _parents, _offsets = (_store[key].read() for key in ("names", "parents", "offsets"))
    _KEYS = [key.removesuffix("/moving") for key in _store if key.endswith("/moving")]
SKELETON = Skeleton(_names.tolist(), _parents, _offsets)


@cache
def sample(name: str = "walk_circle") -> Motion:
    """Return a bundled clip, at 120 Hz, with its footplants as contacts. Each call returns the same object.

    Parameters
    ----------
    name : one of `SAMPLES`, "jump", or "bend_sneak" and "bend_walk", which go around one bend. Or a walk of 5
        or 6 metres by its speed (m/s) and its change of heading (degrees to the left), such as
        "walk_5m_0.8_0" or "walk_6m_1.4_-180".

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
    columns = np.zeros((len(kind), len(moving)))
    columns[:, moving] = UNIT * _decode(digits).T
    quaternions = np.empty((len(kind), len(SKELETON), 4))
    quaternions[:, 0] = columns[:, ROOT_ROTATION]
    quaternions[:, 1:, 1:] = columns[:, OTHER_ROTATIONS].reshape(len(kind), -1, 3)
    quaternions[:, 0] /= np.linalg.norm(quaternions[:, 0], axis=-1, keepdims=True)
    quaternions[:, 1:, 0] = np.sqrt(1 - (quaternions[:, 1:, 1:] ** 2).sum(axis=-1))
    rotations = np.where(flipped.T[..., None], -quaternions, quaternions)
    title = name if name in (*SAMPLES, "jump") else str(labels[0])
    marks = {str(label): kind == number for number, label in enumerate(labels)}
    plants = dict(zip(FEET, contacts, strict=True))
    return Motion(SKELETON, columns[:, :3], rotations, FPS, title, marks, plants)


def _decode(digits: NDArray[np.uint8]) -> NDArray[np.int64]:
    """Decode the columns of a clip, shape (K, F), from the bytes of their differences, lowest byte first.

    The lowest bit of a difference is its sign (zigzag encoding), by which small negative numbers are short.
    """
    zigzag = np.zeros(digits.shape[1:], np.int64)
    for place, byte in enumerate(digits):
        zigzag += byte.astype(np.int64) << 8 * place
    numbers: NDArray[np.int64] = (zigzag >> 1) ^ -(zigzag & 1)
    for _ in range(ORDER):
        numbers = numbers.cumsum(axis=1)
    return numbers
