"""A stand-alone page on which a figure walks along a line that a reader draws, without network or Python.

The page contains a motion graph as integers, and the layered search of `mocap.plain` in JavaScript.
"""

from __future__ import annotations

import base64
import html
import re
import zlib
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from mocap import plain
from mocap._shared.arrays import Mask
from mocap.body import rotations
from mocap.body.motion import Motion, resample
from mocap.datasets.samples import SAMPLES, sample
from mocap.graphs.motion_graph import MotionGraph, build
from mocap.graphs.pruning import prune
from mocap.widgets.embedding import joined, script_json
from mocap.widgets.walk_bending import Bendable, SmoothPath
from mocap.widgets.walk_figure import feet, figure
from mocap.widgets.walk_kinds import kinds_that_work, labels_throughout

HERE = Path(__file__).parent
Node = tuple[int, int]
# The units of whole numbers: metres of a root, 1 of a quaternion, radians and metres of a transition.
STEPS = {"root": 0.0005, "quaternion": 1 / 2048, "angle": 2 * np.pi / 65536, "translation": 0.0001}
SETTINGS = ("BEAM_WIDTH", "LAYER", "LOOK", "RESCUE", "SEAM")  # of the search in `mocap.plain`
# Scripts, each after those that it uses.
WALKING = (
    "search",
    "body",
    "bending",
    "pieces",
    "line",
    "camera",
    "scene",
    "saving",
    "small",
    "steps",
    "story",
    "hands",
    "page",
)
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
    bendable = Bendable.of(graph.clips)
    data = [_packed_clip(*of) for of in zip(graph.clips, bendable.paths, bendable.stands, strict=True)]
    data.append(numbers([clip for clip, _ in graph.graph], 1))
    data.append(numbers([frame for _, frame in graph.graph], 1))
    data += _packed_edges(graph, labels)
    return _description(graph, labels, bendable), b"".join(data)


def _packed_clip(clip: Motion, path: SmoothPath, stands: Mask) -> bytes:
    """Pack the root's positions, the rotations, the smooth path and the stances of a clip, by channels."""
    roots = np.rint(clip.root_positions / STEPS["root"])
    quaternions = np.rint(rotations.continuous(clip.rotations) / STEPS["quaternion"])
    headings = np.rint(path.heading / STEPS["angle"])
    points = np.rint(path.points / STEPS["translation"])
    channels = [*roots.T, *quaternions.reshape(len(clip), -1).T, headings, points.real, points.imag]
    bits = 1 << np.arange(len(stands))
    return b"".join(numbers(channel, 2) for channel in channels) + numbers(bits @ stands, 1)


def _packed_edges(graph: MotionGraph, labels: list[str]) -> list[bytes]:
    """Pack the columns of all edges: the indices of their nodes, and the numbers of `_row`."""
    index = {node: number for number, node in enumerate(graph.graph)}
    edges = list(graph.graph.edges(data=True))
    starts = [index[start] for start, _, _ in edges]
    ends = [index[end] for _, end, _ in edges]
    rows = np.array([_row(graph, labels, (start, end), edge) for start, end, edge in edges])
    return [numbers(starts, 1), numbers(ends, 1), *(numbers(column) for column in rows.T)]


def _description(graph: MotionGraph, labels: list[str], bendable: Bendable) -> dict[str, Any]:
    """Describe the numbers of a graph: its clips, skeleton and counts, and the settings of the search."""
    skeleton = graph.clips[0].skeleton
    edges = list(graph.graph.edges(data=True))
    description: dict[str, Any] = {"fps": graph.fps, "window": graph.window}
    description["clips"] = [{"name": clip.name, "frames": len(clip)} for clip in graph.clips]
    description["joints"] = list(skeleton.names)
    description["parents"] = skeleton.parents.tolist()
    description["offsets"] = skeleton.offsets.round(4).tolist()
    description["steps"] = STEPS
    description["figure"] = figure(skeleton)
    description["feet"] = feet(skeleton)
    description["limbs"] = [
        {"joints": limb.leg, "axis": limb.axis.round(4).tolist()} for limb in bendable.limbs
    ]
    description["search"] = {name.lower(): getattr(plain, name) for name in SETTINGS}
    description |= {"nodes": len(graph.graph), "edges": len(edges)}
    return description | {"labels": labels, "moving": kinds_that_work(graph, labels, bendable)}


def _row(graph: MotionGraph, labels: list[str], nodes: tuple[Node, Node], edge: dict[str, Any]) -> list[int]:
    """Return the integers of an edge: kind and labels, rotation, and translation between its roots.

    The lowest bit marks a transition, the next bits the labels that all its frames have, and the highest bit
    an edge without such a label.
    """
    kinds = labels_throughout(graph, nodes, edge)
    kind = sum(2 << labels.index(label) for label in kinds) or 2 << len(labels)
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


def bundled_graph() -> MotionGraph:
    """Build the graph of the bundled clips, at 30 frames per second, for a page."""
    clips = [resample(sample(name), 30) for name in SAMPLES]
    return prune(build(clips, window=10, threshold=0.04))


def _picture_tag(address: str) -> str:
    """Return the element that names the picture of links, or nothing."""
    return f'<meta property="og:image" content="{html.escape(address)}">' if address else ""


def _course_words(course: str) -> str:
    """Return the words that lead from the page to the course, by a link if its address is known."""
    if course:
        return f'<a class="go" href="{html.escape(course)}">Notebook 00 of the course</a>'
    return "Notebook 00 of the course does it in Python: <code>mocap lab</code> opens it."


def walk_page(graph: MotionGraph, *, picture: str = "", course: str = "") -> str:
    """Create a page on which a figure walks along drawn lines, through a motion graph without dead ends.

    Parameters
    ----------
    graph : a pruned graph. All its clips, at 30 frames per second, are in the page.
    picture : the address of the picture that links to the page show, if there is one.
    course : the address of the notebook to which the story of the page leads; else its command is named.

    Returns
    -------
    HTML that needs no other file, half a megabyte for the bundled clips.
    """
    description, data = pack_graph(graph)
    compressor = zlib.compressobj(9, zlib.DEFLATED, RAW_DEFLATE)
    compressed = compressor.compress(data) + compressor.flush()
    parts = {"ABOUT": script_json(description), "PICTURE": _picture_tag(picture)}
    parts["GRAPH"] = base64.b64encode(compressed).decode()
    parts["SCRIPT"] = joined(*(HERE / f"{part}.js" for part in PARTS))
    transitions = sum(kind == "transition" for _, _, kind in graph.graph.edges(data="kind"))
    parts |= {"COUNT": str(len(graph.clips)), "COURSE": _course_words(course)}
    parts |= {"NODES": f"{len(graph.graph):,}", "EDGES": f"{transitions:,}"}
    page = (HERE / "walk.html").read_text("utf-8")
    return re.sub("ABOUT|GRAPH|SCRIPT|PICTURE|COUNT|COURSE|NODES|EDGES", lambda match: parts[match[0]], page)
