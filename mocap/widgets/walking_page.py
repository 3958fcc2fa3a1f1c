"""A stand-alone page on which a figure walks along a line that a reader draws, without network or Python.

The page contains a motion graph as integers, and the layered search of `mocap.plain` in JavaScript.
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
from mocap.body.motion import Motion
from mocap.graphs.motion_graph import MotionGraph
from mocap.widgets.embedding import joined
from mocap.widgets.walk_figure import feet, figure

HERE = Path(__file__).parent
Node = tuple[int, int]
# The units of whole numbers: metres of a root, 1 of a quaternion, radians and metres of a transition.
STEPS = {"root": 0.0005, "quaternion": 1 / 2048, "angle": 2 * np.pi / 65536, "translation": 0.0001}
SETTINGS = ("BEAM_WIDTH", "LAYER", "LOOK", "RESCUE", "SEAM")  # of the search in `mocap.plain`
# Scripts, each after those that it uses.
WALKING = ("search", "body", "line", "camera", "scene", "saving", "small", "hands", "page")
PARTS = ("bodies", "canvas", *(f"walk_{part}" for part in WALKING))
ZX = [2, 0]  # columns of a position (x, y, z), for complex numbers z + ix
RAW_DEFLATE = -15  # window size of zlib, negative for a stream without a header


def numbers(values: ArrayLike, order: int = 0) -> bytes:
    r"""Pack integers for `reader` in `walk_search.js`: differences, zigzag encoding, bytes by significance.

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
    """Pack a motion graph. Return a description of its numbers, and the numbers before compression."""
    labels = sorted({label for clip in graph.clips for label in clip.labels})
    data = [_packed_clip(clip) for clip in graph.clips]
    data.append(numbers([clip for clip, _ in graph.graph], 1))
    data.append(numbers([frame for _, frame in graph.graph], 1))
    data += _packed_edges(graph, labels)
    return _description(graph, labels), b"".join(data)


def _packed_clip(clip: Motion) -> bytes:
    """Pack the root's positions and the rotations of a clip, channel by channel."""
    roots = np.rint(clip.root_positions / STEPS["root"])
    quaternions = np.rint(rotations.continuous(clip.rotations) / STEPS["quaternion"])
    channels = [*roots.T, *quaternions.reshape(len(clip), -1).T]
    return b"".join(numbers(channel, 2) for channel in channels)


def _packed_edges(graph: MotionGraph, labels: list[str]) -> list[bytes]:
    """Pack the columns of all edges: the indices of their nodes, and the numbers of `_row`."""
    index = {node: number for number, node in enumerate(graph.graph)}
    edges = list(graph.graph.edges(data=True))
    starts = [index[start] for start, _, _ in edges]
    ends = [index[end] for _, end, _ in edges]
    rows = np.array([_row(graph, labels, (start, end), edge) for start, end, edge in edges])
    return [numbers(starts, 1), numbers(ends, 1), *(numbers(column) for column in rows.T)]


def _description(graph: MotionGraph, labels: list[str]) -> dict[str, Any]:
    """Describe the numbers of a graph: its clips, skeleton and counts, and the settings of the search."""
    skeleton = graph.clips[0].skeleton
    edges = list(graph.graph.edges(data=True))
    moving = {label for _, _, edge in edges for label in edge["labels"]} - {"stand"}
    description: dict[str, Any] = {"fps": graph.fps, "window": graph.window}
    description["clips"] = [{"name": clip.name, "frames": len(clip)} for clip in graph.clips]
    description["joints"] = list(skeleton.names)
    description["parents"] = skeleton.parents.tolist()
    description["offsets"] = skeleton.offsets.round(4).tolist()
    description["steps"] = STEPS
    description["figure"] = figure(skeleton)
    description["feet"] = feet(skeleton)
    description["search"] = {name.lower(): getattr(plain, name) for name in SETTINGS}
    description |= {"nodes": len(graph.graph), "edges": len(edges)}
    return description | {"labels": labels, "moving": sorted(moving)}


def _row(graph: MotionGraph, labels: list[str], nodes: tuple[Node, Node], edge: dict[str, Any]) -> list[int]:
    """Return the integers of an edge: kind and labels, rotation, and translation between its roots.

    The lowest bit marks a transition, the next bits the labels, and the highest bit an edge without labels.
    """
    kind = sum(2 << labels.index(label) for label in edge["labels"]) or 2 << len(labels)
    if edge["kind"] == "clip":
        return [kind, 0, 0, 0]
    (source, leave), (target, enter) = nodes
    transform = edge["transform"]
    source_root = complex(*graph.clips[source].root_positions[leave, ZX])
    target_root = complex(*graph.clips[target].root_positions[enter - graph.window, ZX])
    offset = transform.rotation * target_root + transform.translation - source_root
    angle = round(np.angle(transform.rotation) / STEPS["angle"])
    step = STEPS["translation"]
    return [kind + 1, angle, round(offset.real / step), round(offset.imag / step)]


def walk_page(graph: MotionGraph) -> str:
    """Create a page on which a figure walks along drawn lines, through a motion graph without dead ends.

    Parameters
    ----------
    graph : a pruned graph. All its clips, at 30 frames per second, are in the page.

    Returns
    -------
    HTML that needs no other file, half a megabyte for the bundled clips.
    """
    description, data = pack_graph(graph)
    compressor = zlib.compressobj(9, zlib.DEFLATED, RAW_DEFLATE)
    compressed = compressor.compress(data) + compressor.flush()
    parts = {"ABOUT": json.dumps(description, separators=(",", ":")).replace("</", "<\\/")}
    parts["GRAPH"] = base64.b64encode(compressed).decode()
    parts["SCRIPT"] = joined(*(HERE / f"{part}.js" for part in PARTS))
    html = (HERE / "walk.html").read_text("utf-8")
    return re.sub("ABOUT|GRAPH|SCRIPT", lambda match: parts[match[0]], html)
