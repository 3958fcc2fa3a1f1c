"""A walk through a graph, along a path, as a direction says, or at random: `mocap walk`."""

import math
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, TypeVar

from mocap import graphs, steering
from mocap._shared.deadlines import OUT_OF_TIME
from mocap.cli import options
from mocap.cli.directing import Directing, describe, node_of, write_contents, write_seams
from mocap.cli.option_types import TURN, Clean, number
from mocap.cli.options import PathReading, Sources
from mocap.cli.outputs import check_out, print_rows, write_out
from mocap.cli.saved_graphs import BUILD_FIRST, MovedClips, load_graph
from mocap.cli.stages import bar, timed_stage
from mocap.cli.typed_commands import ONE_EACH, OptionalValue
from mocap.errors import MocapError

if TYPE_CHECKING:
    from mocap.body.ground_path import GroundPath
    from mocap.files.directions import Direction
    from mocap.graphs.edge_tables import Edge
    from mocap.steering.followed import Followed

Walk = TypeVar("Walk", "Followed", "steering.Directed")
UNITS = {"s": 1.0, "min": 60.0, "h": 3600.0}
MEASURED = 3600.0  # seconds of a random walk, up to which its seams are measured
INTERRUPTED = 130  # exit status
LONGEST = 24 * 3600.0  # longest random walk, seconds


def walk(
    graph: Path,
    *,
    path: Path | None = None,
    random: str | None = None,
    out: Path = Path("walk.bvh"),
    clips: MovedClips = (),
    sources: Sources,
    drawn: PathReading,
    directing: Directing,
    label: Annotated[Sequence[str], ONE_EACH] = (),
    bend: Annotated[float | None, TURN, OptionalValue(100.0)] = None,
    width: Annotated[int | None, number(1, 10_000, int)] = None,
    deadline: str | None = None,
    clean: Clean = False,
    seed: Annotated[int | None, number(0, 2**32 - 1, int)] = None,
) -> int:
    """Walk through a saved graph, along a path or at random.

    The motion is written as .bvh (centimetres), .glb (for engines and viewers), .npz (with labels and
    footplants) or .csv (positions of joints). A table beside it, as in walk.edges.csv, lists the stretches of
    clips and the seams of the walk. A path may also direct the walk: a .csv table with the columns x, z, and
    any of t (seconds), heading (degrees), label and wait (seconds), or a .toml file. Ctrl-C during the search
    for a walk along a path writes the best walk so far.

    Parameters
    ----------
    graph : an .npz file from `mocap graph`.
    path : the path, .csv with points x, z in metres, or .svg, or a direction, .csv or .toml.
    random (TIME) : duration of a random walk, such as 60s, 10min or 1h.
    out : file to write, .bvh, .glb, .npz or .csv.
    scale : metres per unit of length in the .bvh clips of --clips.
    label (METRES:LABEL) : kind of motion from this distance along the path, as in 6.5:sneak. This option may
        be repeated.
    bend (DEGREES) : bend the walk onto the path, by an angular speed of at most this many degrees per second
        in addition to that of the walk (without a number: 100).
    width : beam width, the number of walks that the search keeps at a time (default: 100).
    deadline (TIME) : duration, such as 5s, after which the search ends with the best walk so far.
    seed : seed of the random numbers (default: 0).

    Notes
    -----
    Example: mocap walk graph.npz --path line.csv --bend -o walk.bvh
    """
    _require_one(path, random, seed)
    of_paths = {"label": label, "width": width, "bend": bend, "deadline": deadline}
    if random is not None:
        _require_no_path_options(directing, drawn, of_paths)
    check_out("walk", out, [graph, *([path] if path else [])])
    directing.check_outputs(out)
    with timed_stage("loading packages"):
        from mocap.graphs.storage import licences_in  # the help needs no NumPy

    seconds = _seconds(random or "1s")
    longest_search = math.inf if deadline is None else _seconds(deadline)
    options.require_file(graph, BUILD_FIRST.format(graph))
    direction = directing.direction(path, drawn) if path else None
    _require_line(direction, label, bend)
    line = drawn.load(path) if path and direction is None else None
    request = steering.PathRequest(labels=[_label(text) for text in label])
    with timed_stage("reading the graph"):
        motions = load_graph(graph, sources, clips, out)
    writing = _Writing(out, licences_in(graph), clean)
    search = steering.Settings(width=width, progress=bar("searching"), deadline=longest_search)
    if direction is not None:
        return writing.direct(motions, direction, search, directing)
    if line is None:
        return writing.walk_at_random(motions, seconds, seed or 0)
    with timed_stage("following the path"), options.named_options({"bend": "--bend"}):
        settings = replace(search, width=width or 100)
        follow = _follower(line, request, settings, math.radians(bend or 0))
        followed = _without(directing.without, motions, follow)
    return writing.follow(followed, directing.inspect)


def _require_line(direction: "Direction | None", label: Sequence[str], bend: float | None) -> None:
    """Raise for options that a direction does not take."""
    if direction is not None and (label or bend):
        raise MocapError("A direction takes neither --bend nor --label: labels are a column of its table.")


def _require_no_path_options(directing: Directing, drawn: PathReading, values: Mapping[str, object]) -> None:
    """Raise if options of paths are given with --random."""
    if any(values.values()) or drawn.is_given() or directing.names():
        directions = "".join(f"{name}, " for name in directing.names()[:2])
        options_of_paths = f"{directions}--label, --bend, --width, --unit, --length, --id and --deadline"
        raise MocapError(f"{options_of_paths} belong to --path, not to --random.")


@dataclass(frozen=True)
class _Writing:
    """Writes a walk, and the table of its edges beside it.

    Parameters
    ----------
    out : the file of the motion.
    licences : the licences of the clips, by name.
    clean : whether to remove foot sliding.
    """

    out: Path
    licences: Mapping[str, str]
    clean: bool

    def walk_at_random(self, motions: "graphs.MotionGraph", seconds: float, seed: int) -> int:
        """Write a random walk."""
        from mocap.synthesis.random_walks import cut_walk, dump, wander  # the help needs no NumPy

        limits: dict[str, Any] = {"seconds": seconds, "seed": seed, "clean": self.clean}
        frames = dump(motions, self.out, **limits, progress=bar("writing"))
        print_rows(walked=f"{frames / motions.fps:.1f} s at random", wrote=self.out)
        walk = cut_walk(motions, wander(motions, seed=seed), seconds)
        write_contents(self.out, motions, walk, self.licences, jolts=seconds <= MEASURED)
        return 0

    def direct(
        self,
        motions: "graphs.MotionGraph",
        direction: "Direction",
        settings: "steering.Settings",
        directing: Directing,
    ) -> int:
        """Find and write a walk that follows a direction."""
        with timed_stage("following the direction"):
            standing = steering.with_standing(motions)

            def follow(graph: "graphs.MotionGraph", kept: "Sequence[Edge]") -> "steering.Directed":
                changed = replace(standing, graph=graph)
                return steering.direct(changed, direction, settings=settings, kept=kept)

            directed = _without(directing.without, standing.graph, follow)
        print_rows(walked=directed.report())
        for number_of_point, arrival in enumerate(directed.arrivals, 1):
            print_rows(**{f"point {number_of_point}": describe(arrival)})
        for end, angle in directed.rotated:
            turn = f"{abs(math.degrees(angle)):.0f}° about the root where it {end}"
            print_rows(rotated=f"{turn}, without steps of its own")
        with timed_stage("making the motion"):
            motion = directed.motion(clean=True if self.clean else None)
        write_out(motion, self.out)
        held = [(hold.frame, hold.added) for hold in directed.holds]
        write_contents(self.out, directed.graph, [directed.walk], self.licences, jolts=True, held=held)
        if directing.inspect:
            points = [(point.x, point.z) for point in direction.points]
            track = directed.fitted.root_positions[directed.walk_frames][:, [0, 2]]
            write_seams(directing.inspect, directed.graph, directed.walk, track, points)
        return 0 if directed.stopped in ("", OUT_OF_TIME) else INTERRUPTED

    def follow(self, followed: "Followed", page: Path | None) -> int:
        """Write a walk along a path, and a page that shows its seams."""
        print_rows(walked=followed.report())
        with timed_stage("making the motion"):
            motion = followed.motion(clean=self.clean or followed.bent is not None)
        write_out(motion, self.out)
        write_contents(self.out, followed.graph, [followed.walk], self.licences, jolts=True)
        if page:
            write_seams(page, followed.graph, followed.walk, followed.track, followed.path.points)
        return 0 if followed.found.stopped in ("", OUT_OF_TIME) else INTERRUPTED


def _follower(
    line: "GroundPath", request: "steering.PathRequest", settings: "steering.Settings", bend: float
) -> "Callable[[graphs.MotionGraph, Sequence[Edge]], Followed]":
    """Return a function that follows a line in a graph, and keeps the edges of another walk where it can."""

    def follow(graph: "graphs.MotionGraph", kept: "Sequence[Edge]") -> "Followed":
        keeping = replace(request, kept=kept)
        return steering.follow_path(graph, line, keeping, settings=settings, bend=bend)

    return follow


def _without(
    refused: Sequence[str],
    motions: "graphs.MotionGraph",
    follow: "Callable[[graphs.MotionGraph, Sequence[Edge]], Walk]",
) -> "Walk":
    """Find a walk, then again without each refused seam, with the rest of the walk kept where it can be.

    Parameters
    ----------
    refused : the seams, as in walk:120.
    motions : the graph.
    follow : finds a walk in a graph, which keeps the edges of another one where it can.
    """
    from mocap.steering.seam_replacing import fraction_kept, graph_without, transitions_from

    followed = follow(motions, ())
    for text in refused:
        seams = transitions_from(motions, followed.walk, node_of(text, motions))
        motions = graph_without(motions, seams)
        changed = follow(motions, followed.walk)
        part = fraction_kept(followed.walk, changed.walk, followed.graph)
        print_rows(without=f"{text}; {part:.0%} of the frames of the walk before are kept")
        followed = changed
    return followed


def _require_one(path: Path | None, random: str | None, seed: int | None) -> None:
    """Raise unless there is either a path or a duration, and a seed only with a duration."""
    if (path is None) == (random is None):
        raise MocapError("Give one of --path and --random: where to walk, or for how long.")
    if random is None and seed is not None:
        raise MocapError("--seed belongs to --random: a walk along a path leaves nothing to chance.")


def _seconds(text: str) -> float:
    """Parse a duration, in seconds.

    Examples
    --------
    >>> _seconds("60s"), _seconds("1.5min"), _seconds("2")
    (60.0, 90.0, 2.0)
    """
    parts = re.fullmatch(r"(\d+\.?\d*|\.\d+)\s*(s|min|h)?", text.strip())
    seconds = float(parts[1]) * UNITS[parts[2] or "s"] if parts else 0.0
    if not 0 < seconds <= LONGEST:
        raise MocapError(f"How long is '{text[:40]}'? Write 60s, 10min or 1h, up to 24h.")
    return seconds


def _label(text: str) -> tuple[float, str]:
    """Parse a label and the metres along the path at which it starts, as in 6.5:sneak."""
    metres, _, label = text.partition(":")
    try:
        return float(metres), label
    except ValueError:
        raise MocapError(f"From where on is '{text[:40]}'? Write METRES:LABEL, as in 6.5:sneak.") from None
