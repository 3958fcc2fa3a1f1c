"""Films as data for the browser, where the player's scripts draw them."""

from __future__ import annotations

import base64
import zlib
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from mocap.body.motion import Motion
from mocap.plotting.style import COLOURS
from mocap.widgets.packing import packed_character

STEP = 0.002  # metres; coordinates are whole numbers of it. A pixel shows about four of them.


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
    about: dict[str, Any] = {}
    each: list[dict[str, Any]] = []
    data = b""
    for film in films:
        about, block = packed_character(film, COLOURS["middle"], STEP)
        low = np.round(about["low"], 4).tolist()
        each.append({"frames": about["frames"], "offset": len(data), "low": low})
        data += block
    body = {name: value for name, value in about.items() if name not in ("name", "frames", "low")}
    return Packed(body, each, base64.b64encode(zlib.compress(data, 9)).decode())
