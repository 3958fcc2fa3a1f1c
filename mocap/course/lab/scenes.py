"""All that a page needs to show the inspector: clips, maps to point at, colours."""

from __future__ import annotations

import zlib
from collections.abc import Sequence
from typing import Any

import numpy as np

from mocap._shared.arrays import Array
from mocap.course.lab.choices import CELLS, Choices, around
from mocap.course.lab.packing import packed_clip, packed_skeleton
from mocap.plotting.style import ASKED, COLOURS, CURVES, MARK, PATH, QUIET, SOURCES

TABS = ("windows", "turn", "weights", "seam")  # in the order in which the course meets them
KEY = "Solid lines: the first clip. Dashed: the second. Blue is left, orange-red is right."
WIDEST = 600  # rows and columns of a grid's picture; of more, blocks of cells become one


def scene(choices: Choices, show: Sequence[str], track: Array, asked: Array, alt: str) -> dict[str, Any]:
    """Give what the scripts draw; `data` holds the clips' numbers and the grid's shades, compressed.

    Parameters
    ----------
    choices : what can be looked at.
    show : the tabs, some of `TABS`.
    track, asked : of a walk, the root's path and the path asked for, shape (N, 2), points (x, z) in metres.
    alt : a sentence.
    """
    clips = choices.clips
    packed, data = _clips(choices)
    grid, shades = _shades(choices, len(data))
    return {
        "alt": alt,
        "fps": clips[0].fps,
        "window": choices.window,
        "around": around(clips[0].fps),
        "cells": CELLS,
        "tabs": list(show),
        "tab": show[-1] if show[-1] != "seam" else show[0],
        "skeleton": packed_skeleton(clips[0].skeleton),
        "clips": packed,
        "pick": {name: int(value) for name, value in choices.pick._asdict().items()},
        "grid": grid,
        "graph": _graph(choices),
        "walk": _walk(choices, track, asked),
        "colours": _colours(),
        "key": KEY + f" The grid by {choices.by}." * bool(choices.by),
        "data": zlib.compress(data + shades, 9),
    }


def _clips(choices: Choices) -> tuple[list[dict[str, Any]], bytes]:
    """Pack all clips, one after the other."""
    packed, data = [], b""
    for number, clip in enumerate(choices.clips):
        about, block = packed_clip(clip, len(data), choices.needed(number))
        packed.append(about)
        data += block
    return packed, data


def _colours() -> dict[str, Any]:
    return {
        "sides": [COLOURS[side] for side in ("middle", "left", "right")],
        "curves": list(CURVES),
        "sources": list(SOURCES),
        "seam": MARK,
        "path": PATH,
        "asked": ASKED,
        "quiet": QUIET,
    }


def _shades(choices: Choices, offset: int) -> tuple[dict[str, Any] | None, bytes]:
    """Turn a grid into shades from 0, the lowest distance, to 255; a block of cells has its lowest shade."""
    if choices.grid is None:
        return None, b""
    distances = np.sqrt(choices.grid)
    every = -(-max(distances.shape) // WIDEST)
    rows, columns = (-(-count // every) for count in distances.shape)
    whole = np.pad(
        distances, [(0, n * every - c) for n, c in zip((rows, columns), distances.shape, strict=True)], "edge"
    )
    least = whole.reshape(rows, every, columns, every).min(axis=(1, 3))
    shades = np.round(255 * (least - least.min()) / max(float(np.ptp(least)), 1e-9)).astype(np.uint8)
    about = {"rows": rows, "columns": columns, "every": every, "offset": offset, "minima": choices.minima}
    return about, shades.tobytes()


def _graph(choices: Choices) -> dict[str, Any] | None:
    """List a graph's transitions, and the stretches of its clips that it plays."""
    if choices.graph is None:
        return None
    pieces = sorted(
        (start, end) for start, end, kind in choices.graph.graph.edges(data="kind") if kind == "clip"
    )
    spans: list[list[int]] = []
    for (clip, start), (_, end) in pieces:
        if spans and spans[-1][0] == clip and spans[-1][2] == start:
            spans[-1][2] = int(end)
        else:
            spans.append([int(clip), int(start), int(end)])
    transitions = [
        [*map(int, pick[:4]), round(100 * cost, 2)]
        for pick, cost in zip(choices.transitions, choices.costs, strict=True)
    ]
    return {"transitions": transitions, "spans": spans}


def _walk(choices: Choices, track: Array, asked: Array) -> dict[str, Any] | None:
    """List a walk's places on the ground, and its seams."""
    if not choices.seams:
        return None
    seams = [
        {"pick": list(map(int, s[:4])), "before": s.before, "after": s.after, "frame": s.frame}
        for s in choices.seams
    ]
    return {"path": track.round(3).tolist(), "asked": asked.round(3).tolist(), "seams": seams}
