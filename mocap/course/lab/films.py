"""Films as data for the browser, where the player's scripts draw them."""

from __future__ import annotations

import base64
import zlib
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from mocap.body.kinematics import joint_positions
from mocap.body.motion import Motion
from mocap.plotting.bodies import bones
from mocap.plotting.style import COLOURS

STEP = 0.002  # metres; coordinates are whole numbers of it. A pixel shows about four of them.
SIDES = ("middle", "left", "right")  # the scripts know a side by its number


class Packed(NamedTuple):
    """Films of one body: what all have as characters of the player, what each has, and the coordinates."""

    body: dict[str, Any]
    films: list[dict[str, Any]]
    data: str


def packed(films: Sequence[Motion]) -> Packed:
    """Pack films for the player's scripts.

    The numbers are second differences over time, as in the player, but in steps of two millimetres: these are
    small, and compress well.
    """
    skeleton = films[0].skeleton
    starts, ends, sides = bones(skeleton)
    joints, index = np.unique([0, *starts, *ends], return_inverse=True)
    pairs = index[1:].reshape(2, -1).T.tolist()
    heads = [n for n, joint in enumerate(joints) if "head" in skeleton.names[joint].lower()]
    body = {
        "bones": [[*pair, SIDES.index(side)] for pair, side in zip(pairs, sides, strict=True)],
        "head": heads[-1] if heads else None,
        "joints": len(joints),
        "fps": films[0].fps,
        "step": [STEP] * 3,
        "colour": COLOURS["middle"],
        "path_colour": COLOURS["middle"],
        **{"sources": [], "seams": [], "astray": [], "prints": []},
    }
    each: list[dict[str, Any]] = []
    data = b""
    for film in films:
        points = joint_positions(film)[:, joints]  # (F, J, 3)
        low = points.min(axis=(0, 1))
        numbers = np.round((points - low) / STEP).astype("<u2")
        zeros = np.zeros_like(numbers, shape=(2, *numbers.shape[1:]))
        each.append({"frames": len(film), "offset": len(data), "low": low.round(4).tolist()})
        data += np.moveaxis(np.diff(numbers, 2, axis=0, prepend=zeros), 0, -1).tobytes()
    return Packed(body, each, base64.b64encode(zlib.compress(data, 9)).decode())
