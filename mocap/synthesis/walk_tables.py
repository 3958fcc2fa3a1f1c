"""What a walk is made of: a table of its stretches of clips and its seams, with labels and licences."""

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import groupby
from pathlib import Path

from mocap._shared.records import NamedTuple
from mocap.errors import shortened
from mocap.files.named_tables import write_table
from mocap.graphs.edge_tables import Edge
from mocap.graphs.motion_graph import MotionGraph, Node
from mocap.quality.seam_measures import jumps
from mocap.synthesis.walk_to_motion import require_walk, to_motion

COLUMNS = ("second", "clip", "from", "to", "into", "at", "cost_cm", "jolt", "label", "licence")


class WalkPart(NamedTuple):
    """A part of a walk: a stretch of a clip, or a seam (a transition).

    Parameters
    ----------
    second : the time in the walk at which it starts.
    start, stop : the nodes (clip, frame) between which it plays. Those of a stretch are in one clip. A seam
        blends the frames of the first clip from `start` on with the frames of the second before `stop`.
    frames : their number.
    cost : the RMS distance of a seam, metres; None for a stretch.
    jolt : the largest jump of velocity in a seam, as of `quality.jumps`, m/s; None for a stretch.
    labels : the labels of its frames.
    licence : the licences of its clips, joined by " + ", "" if none is known.
    """

    second: float
    start: Node
    stop: Node
    frames: int
    cost: float | None
    jolt: float | None
    labels: Sequence[str]
    licence: str


def walk_parts(
    motion_graph: MotionGraph,
    walk: Sequence[Edge],
    licences: Mapping[str, str] | None = None,
    *,
    jolts: bool = True,
    held: Sequence[tuple[int, int]] = (),
) -> Iterator[WalkPart]:
    """Yield the parts of a walk in order. Stretches of a clip that follow each other are one part.

    Parameters
    ----------
    motion_graph, walk : as for `synthesis.to_motion`.
    licences : the licence of each clip, by name; by default none is known.
    jolts : whether to measure the jolts of seams.
    held : pairs of a frame of the walk and the number of frames that are added before it, by which the parts
        after it start later.

    Raises
    ------
    NoWalk : as for `synthesis.to_motion`.

    Examples
    --------
    A clip with a transition from frame 60 back to frame 20, and a walk that takes it:

    >>> from mocap import body, datasets, graphs, matching
    >>> clip = body.resample(datasets.sample("walk_circle"), 30)
    >>> back = matching.Transition(0, 60, 0, 10, 0.02, body.PlanarTransform(0, 0, 0))
    >>> graph = graphs.from_transitions([clip], [back], window=10)
    >>> stretch, seam = walk_parts(graph, [((0, 20), (0, 60), 0), ((0, 60), (0, 20), 0)])
    >>> stretch.frames, seam.start, seam.stop, seam.cost, round(seam.second, 2)
    (40, (0, 60), (0, 20), 0.02, 1.33)
    """
    require_walk(motion_graph, walk)
    edges = motion_graph.graph.edges
    numbered = enumerate(walk)
    frame = 0
    # A seam is a part of its own: the key counts seams, and differs between a seam and the stretch after it.
    for is_seam, group in groupby(numbered, lambda item: edges[item[1]]["kind"] == "transition"):
        members = list(group)
        for part in [[member] for member in members] if is_seam else [members]:
            first = part[0][0]
            of_part = [edge for _, edge in part]
            jolt = _jolt(motion_graph, walk, first) if is_seam and jolts else None
            added = sum(count for place, count in held if place <= frame)
            yield _part(motion_graph, of_part, (frame + added) / motion_graph.fps, jolt, licences or {})
            frame += sum(edges[edge]["frames"] for edge in of_part)


def _part(
    graph: MotionGraph,
    part: Sequence[Edge],
    second: float,
    jolt: float | None,
    licences: Mapping[str, str],
) -> WalkPart:
    """Describe edges of a walk, which start at a time."""
    edges = [graph.graph.edges[edge] for edge in part]
    start = part[0][0]
    stop = part[-1][1]
    names = dict.fromkeys(graph.clips[clip].name for clip, _ in (start, stop))
    licence = " + ".join(dict.fromkeys(licences.get(name) or "unknown" for name in names)) if licences else ""
    labels = sorted({label for edge in edges for label in edge["labels"]})
    frames = sum(edge["frames"] for edge in edges)
    return WalkPart(second, start, stop, frames, edges[0].get("cost"), jolt, labels, licence)


def _jolt(graph: MotionGraph, walk: Sequence[Edge], number: int) -> float:
    """Return the largest jump of velocity in a transition of a walk, between the edges around it, m/s."""
    lead = walk[max(number - 1, 0) : number]
    motion = to_motion(graph, [*lead, *walk[number : number + 2]])
    start = sum(graph.graph.edges[edge]["frames"] for edge in lead)
    stop = start + graph.window
    return float(jumps(motion)[max(start - 1, 0) : stop + 1].max())


def write_parts(path: str | Path, motion_graph: MotionGraph, parts: Iterable[WalkPart]) -> dict[str, float]:
    """Write the parts of a walk to a `.csv` table, and return the seconds of each licence.

    The columns are second, clip, from, to (the first frame of a stretch, and the one after its last), for a
    seam also into and at (the clip that it enters, and the first frame after the seam), cost_cm and jolt
    (m/s), label and licence. Frames are counted at the rate of the graph.

    Parameters
    ----------
    path : the file.
    motion_graph, parts : the graph, and the parts of a walk through it.
    """
    totals: dict[str, float] = defaultdict(float)
    names = [clip.name for clip in motion_graph.clips]

    def rows() -> Iterator[list[object]]:
        for part in parts:
            totals[part.licence] += part.frames / motion_graph.fps
            clip, frame = part.start
            to_clip, to_frame = part.stop
            row: list[object] = [f"{part.second:.3f}", names[clip], frame]
            if part.cost is None:
                row += [to_frame, "", "", "", ""]
            else:
                cost = f"{100 * part.cost:.2f}"
                jolt = "" if part.jolt is None else f"{part.jolt:.3f}"
                row += [frame + part.frames, names[to_clip], to_frame, cost, jolt]
            yield [*row, "+".join(part.labels), part.licence]

    write_table(path, COLUMNS, rows())
    return dict(totals)


def licence_report(totals: Mapping[str, float]) -> str:
    """Format the seconds of each licence in a walk, the longest first.

    Examples
    --------
    >>> licence_report({"CC0": 2.0, "CC BY-NC 4.0": 3.0})
    'CC BY-NC 4.0 3.0 s, CC0 2.0 s'
    """
    ordered = sorted(totals.items(), key=lambda item: -item[1])
    return ", ".join(f"{shortened(licence, 60) or 'unknown'} {seconds:.1f} s" for licence, seconds in ordered)
