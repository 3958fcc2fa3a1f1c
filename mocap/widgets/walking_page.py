"""A page on which a figure walks along the line that a reader draws: one file, without network or Python.

The page holds a motion graph as whole numbers, and the layered search of `mocap.plain` in JavaScript.
"""

from __future__ import annotations

import base64
import json
import re
import zlib
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from mocap import plain
from mocap.body import rotations
from mocap.graphs.motion_graph import MotionGraph
from mocap.widgets.embedding import joined
from mocap.widgets.walk_figure import feet, figure

HERE = Path(__file__).parent
Node = tuple[int, int]
STEPS = {"metres": 0.0005, "parts": 1 / 2048, "turn": 2 * np.pi / 65536, "move": 0.0001}
# What each uses comes before it.
SETTINGS = ("WIDTH", "LAYER", "LOOK", "RESCUE", "SEAM")  # of the search in `mocap.plain`
WALKING = ("search", "body", "line", "camera", "scene", "saving", "small", "hands", "page")
PARTS = ("bodies", *(f"walk_{part}" for part in WALKING))


def numbers(values: ArrayLike, order: int = 0) -> bytes:
    r"""Pack whole numbers for `reader` in `walk_search.js`: differenced, signs folded in, byte by byte.

    Examples
    --------
    >>> numbers([5, 6, 4], order=1)[:3]  # +5, +1, -2
    b'\n\x02\x03'
    """
    whole = np.asarray(values, np.int64)
    for _ in range(order):
        whole = np.diff(whole, prepend=0)
    folded = ((whole << 1) ^ (whole >> 63)).astype("<u4")
    return folded.view(np.uint8).reshape(-1, 4).T.tobytes()


def pack_graph(graph: MotionGraph) -> tuple[dict[str, Any], bytes]:
    """Pack a motion graph: what its numbers mean, and the numbers, not yet deflated."""
    edges, motion = list(graph.graph.edges(data=True)), b""
    for clip in graph.clips:
        roots = np.rint(clip.root_positions / STEPS["metres"])
        turns = np.rint(rotations.continuous(clip.rotations) / STEPS["parts"])
        channels = [*roots.T, *turns.reshape(len(clip), -1).T]
        motion += b"".join(numbers(channel, 2) for channel in channels)
    place = {node: number for number, node in enumerate(graph.graph)}
    labels = sorted({label for clip in graph.clips for label in clip.labels})
    rows = np.array([_row(graph, labels, (start, end), edge) for start, end, edge in edges])
    ends = np.array([(place[start], place[end]) for start, end, _ in edges])
    packed = [numbers(ends[:, 0], 1), numbers(ends[:, 1], 1), *(numbers(column) for column in rows.T)]
    nodes = [numbers([node[part] for node in graph.graph], 1) for part in (0, 1)]
    going = sorted({label for _, _, edge in edges for label in edge["labels"]} - {"stand"})
    skeleton = graph.clips[0].skeleton
    about = {
        "fps": graph.fps,
        "window": graph.window,
        "clips": [{"name": clip.name, "frames": len(clip)} for clip in graph.clips],
        "joints": list(skeleton.names),
        "parents": skeleton.parents.tolist(),
        "offsets": skeleton.offsets.round(4).tolist(),
        "steps": STEPS,
        "figure": figure(skeleton),
        "feet": feet(skeleton),
        "search": {name.lower(): getattr(plain, name) for name in SETTINGS},  # how it is set
        **{"nodes": len(place), "edges": len(edges), "labels": labels, "going": going},
    }
    return about, motion + b"".join([*nodes, *packed])


def _row(graph: MotionGraph, labels: list[str], ends: tuple[Node, Node], edge: dict[str, Any]) -> list[int]:
    """Give the whole numbers of an edge: kind and labels, turn, and how far apart its roots are laid."""
    kind = sum(2 << labels.index(label) for label in edge["labels"]) or 2 << len(labels)
    if edge["kind"] == "clip":
        return [kind, 0, 0, 0]
    (a, leave), (b, enter) = ends
    place = edge["transform"]
    here, there = (
        complex(*graph.clips[clip].root_positions[frame, [2, 0]])
        for clip, frame in ((a, leave), (b, enter - graph.window))
    )
    off = place.turn * there + place.move - here
    turned = round(np.angle(place.turn) / STEPS["turn"])
    return [kind + 1, turned, round(off.real / STEPS["move"]), round(off.imag / STEPS["move"])]


def walk_page(graph: MotionGraph) -> str:
    """Make a page that walks along drawn lines, through a motion graph whose walks can go on for ever.

    Parameters
    ----------
    graph : pruned; its clips, at 30 frames per second, are all in the page.

    Returns
    -------
    HTML that needs no other file: half a megabyte for the bundled clips.
    """
    about, data = pack_graph(graph)
    squeeze = zlib.compressobj(9, zlib.DEFLATED, -15)
    packed = base64.b64encode(squeeze.compress(data) + squeeze.flush()).decode()
    filled = {
        "ABOUT": json.dumps(about, separators=(",", ":")).replace("</", "<\\/"),
        "GRAPH": packed,
        "SCRIPT": joined(*(HERE / f"{part}.js" for part in PARTS)),
    }
    html = (HERE / "walk.html").read_text("utf-8")
    return re.sub("ABOUT|GRAPH|SCRIPT", lambda found: filled[found[0]], html)
