"""Options of `mocap walk` beside its path, and what it writes beside the motion."""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

from mocap._shared.atomic import write_file
from mocap.cli.option_types import number
from mocap.cli.options import PathReading
from mocap.cli.outputs import check_out, print_rows, require_output
from mocap.cli.stages import timed_stage
from mocap.cli.typed_commands import ONE_EACH
from mocap.errors import MocapError, warn

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from mocap._shared.arrays import Array
    from mocap.files.directions import Direction
    from mocap.graphs.edge_tables import Edge
    from mocap.graphs.motion_graph import MotionGraph, Node
    from mocap.steering.directed_walk import Arrived


@dataclass(frozen=True)
class Directing:
    """Options that direct a walk along its path."""

    start: Annotated[Literal["stand"] | None, "start standing"] = None
    end: Annotated[Literal["stand"] | None, "end standing"] = None
    facing: Annotated[
        float | None, number(-360, 360), "heading of the body at the end, degrees: 0 faces +z, 90 faces +x"
    ] = None
    # reads: name: the option's name
    around: Annotated[Path | None, "a .csv file with discs not to enter, x, z, radius in metres"] = None
    without: Annotated[
        Sequence[str],
        ONE_EACH,
        "refuse the seams that leave this frame of a clip, as in the table of the walk; the rest of the walk "
        "stays where it can; may be repeated",
    ] = ()
    inspect: Annotated[Path | None, "second file to write, .html, the seams of the walk to look at"] = None

    def names(self) -> list[str]:
        """Return the options that are given."""
        values = {name: getattr(self, name) for name in self.__dataclass_fields__}
        return [f"--{name}" for name, value in values.items() if value not in (None, ())]

    def check_outputs(self, out: Path) -> None:
        """Raise, before any work is done, if a file beside the motion cannot be written."""
        require_output(table_of(out))
        if self.inspect:
            check_out("page of seams", self.inspect, [], [".html"])

    def direction(self, path: Path, drawn: PathReading) -> "Direction | None":
        """Read the path as a direction, with what the options ask for; None for a bare line."""
        from mocap.files.directions import DirectedPoint, Direction, is_direction, load_direction

        is_given = any((self.start, self.end, self.facing is not None, self.around))
        if is_direction(path):
            if drawn.is_given():
                refused = "--unit, --length and --id"
                raise MocapError(f"{path} is a direction in metres, which takes none of {refused}.")
            direction = load_direction(path)
        elif is_given:
            line = drawn.load(path)
            direction = Direction([DirectedPoint(x, z) for x, z in line.points.tolist()])
        else:
            return None
        ends = {name: getattr(self, name) or getattr(direction, name) for name in ("start", "end")}
        facing = direction.facing if self.facing is None else math.radians(self.facing)
        discs = [*direction.around, *_discs(self.around)]
        return replace(direction, **ends, facing=facing, around=discs)


def _discs(path: Path | None) -> list[tuple[float, float, float]]:
    """Read discs from a `.csv` file, none without one."""
    if path is None:
        return []
    from mocap.files.text import load_rows  # the help needs no NumPy

    return [(x, z, radius) for x, z, radius in load_rows(path, ("x", "z", "radius")).tolist()]


def node_of(text: str, graph: "MotionGraph") -> "Node":
    """Parse a frame of a clip, as in walk:120, and return the node."""
    name, _, frame = text.rpartition(":")
    names = [clip.name for clip in graph.clips]
    if name not in names or not frame.isdecimal() or len(frame) > len("1000000000"):
        shown = ", ".join(names[:3])
        raise MocapError(f"Which seam is '{text[:60]}'? Write CLIP:FRAME as in the table; clips are {shown}.")
    return names.index(name), int(frame)


def write_contents(
    out: Path,
    graph: "MotionGraph",
    walk: "Iterable[Sequence[Edge]]",
    licences: Mapping[str, str],
    *,
    jolts: bool,
    held: Sequence[tuple[int, int]] = (),
) -> None:
    """Write the table of a walk beside its motion, and print the licences of its clips.

    Parameters
    ----------
    out : the file of the motion.
    graph, licences : the graph, and the licences of its clips by name.
    walk : the edges, in pieces.
    jolts : whether to measure the seams, which takes some milliseconds for each.
    held : pairs of a frame of the walk and the number of frames that are added before it.
    """
    from itertools import chain

    from mocap.datasets.clip_licences import is_non_commercial
    from mocap.synthesis.walk_tables import licence_report, walk_parts, write_parts

    table = table_of(out)
    edges = list(chain.from_iterable(walk))
    with timed_stage("listing the edges"):
        totals = write_parts(table, graph, walk_parts(graph, edges, licences, jolts=jolts, held=held))
    if licences:
        print_rows(licences=licence_report(totals))
    print_rows(wrote=table)
    barred = sorted(licence for licence in totals if is_non_commercial(licence))
    if barred and len(totals) > 1:
        warn(
            f"The walk mixes clips under other licences with {barred[0][:80]}: it is not for commercial use."
        )


def write_seams(
    page: Path, graph: "MotionGraph", walk: "Sequence[Edge]", track: "Array", points: "ArrayLike"
) -> None:
    """Write a page that shows the seams of a walk, its track from above, and the points asked for."""
    import numpy as np  # the help needs no NumPy

    from mocap.course.lab.choices import of_walk
    from mocap.course.lab.showing import TABS, Inspector

    write_file(page, Inspector(of_walk(graph, list(walk)), TABS, track, np.asarray(points, float)).page())
    print_rows(wrote=page)


def table_of(out: Path) -> Path:
    """Return the file of the table beside a motion.

    Examples
    --------
    >>> table_of(Path("out/walk.bvh")).name
    'walk.edges.csv'
    """
    return out.with_name(f"{out.stem}.edges.csv")


def describe(arrival: "Arrived") -> str:
    """Describe how a walk arrives at a point of its direction."""
    turned = "" if math.isnan(arrival.turned) else f", {math.degrees(arrival.turned):+.0f}° from the heading"
    late = "" if math.isnan(arrival.late) else f", {arrival.late:+.1f} s from the time asked"
    waits = "" if math.isnan(arrival.waited) else f", waits {arrival.waited:.1f} s"
    return f"{arrival.second:.1f} s, {100 * arrival.off:.0f} cm off{turned}{late}{waits}"
