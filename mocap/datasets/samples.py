"""The bundled clips by name; they need no network."""

from functools import cache
from pathlib import Path

import numpy as np

from mocap.body.motion import Motion
from mocap.datasets.generated import CLIPS, generate
from mocap.datasets.walking_body import FPS, SKELETON

SAMPLES: tuple[str, ...] = tuple(CLIPS)
"""The names of the bundled walks, from which motion graphs are built; `sample("jump")` is a jump."""


@cache
def sample(name: str = "walk_circle") -> Motion:
    """Give a bundled clip, at 120 Hz, with its footplants as contacts; the same at each call.

    Parameters
    ----------
    name : one of `SAMPLES`, or "jump".

    Raises
    ------
    MocapError : for another name.

    Examples
    --------
    >>> sample("walk_straight").skeleton
    Skeleton(38 joints, root 'root')

    Notebook: 01-skeletons-and-clips
    """
    if name != "jump":
        return generate(name)
    with np.load(Path(__file__).with_name("jump.npz")) as stored:  # from `figures/jumping.py`
        arrays = dict(stored)
    roots, turns, jumping = (arrays.pop(key) for key in ("root_positions", "rotations", "jump"))
    labels = {"stand": ~jumping, "jump": jumping}
    return Motion(SKELETON, roots, turns, FPS, name, labels, arrays)
