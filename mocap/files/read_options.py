"""The options of `load_save.load`, as readers of formats receive them."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple


class ReadOptions(NamedTuple):
    """The options of `load`, of which a reader uses those that apply to its format.

    skeleton : the file of the skeleton, for formats with separate skeletons.
    fps : frames per second, which replace those of the file.
    scale : metres in one unit of the file.
    stretch : the largest change of the length of a bone, metres.
    up : the axis that points up, such as "z".
    root_offset : "add" if the positions of the root in a `.bvh` file are relative to its OFFSET, or "ignore".
    body : the number of the body to read from a `.bvh` file of several, from 1; None for the first.
    """

    skeleton: Path | None
    fps: float | None
    scale: float | None
    stretch: float
    up: str | None = None
    root_offset: str | None = None
    body: int | None = None
