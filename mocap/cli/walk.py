"""The command `mocap walk`: a walk through a saved graph, along a path or at random."""

import argparse
import itertools
import math
import re
import warnings
from pathlib import Path
from typing import TYPE_CHECKING

from mocap import body, editing, files, graphs, steering, synthesis
from mocap._shared.atomic import require_writable
from mocap.cli.options import LENGTH, SEED, SKELETON, TURN, bar, require_other, whole
from mocap.datasets.clip_origins import find_again
from mocap.errors import MocapError, MocapWarning

if TYPE_CHECKING:
    from mocap.body.motion import Motion
    from mocap.cli.options import Commands
    from mocap.graphs.motion_graph import MotionGraph
    from mocap.graphs.storage import GraphFile
    from mocap.steering.followed import Followed

UNITS = {"s": 1.0, "min": 60.0, "h": 3600.0}
LONGEST = 24 * 3600.0  # seconds of a random walk


def add_walk(commands: "Commands") -> None:
    """Add `mocap walk`."""
    walk = commands.add_parser(
        "walk",
        help="walk through a saved graph, along a path or at random",
        description="Walk through a graph saved by `mocap graph`, along a path drawn on the ground or at "
        "random, and write the motion as .bvh (centimetres) or .glb (for engines and viewers). Ctrl-C "
        "while it searches writes the best walk so far.",
        epilog="Example: mocap walk graph.npz --path line.csv --bend -o walk.bvh",
    )
    add = walk.add_argument
    add("graph", type=Path, help="an .npz file from `mocap graph`")
    what = walk.add_mutually_exclusive_group(required=True)
    what.add_argument("--path", type=Path, help="a path: .csv with points x, z in metres, or an .svg picture")
    what.add_argument("--random", metavar="TIME", help="duration of a random walk, such as 60s, 10min or 1h")
    add("-o", "--out", type=Path, default=Path("walk.bvh"), help="file to write (default: %(default)s)")
    clips = "the clips of the graph (default: those that it was built of, where it remembers them)"
    add("--clips", nargs="+", type=Path, help=clips)
    add("--skeleton", type=Path, help=SKELETON)
    add("--scale", type=LENGTH, help="metres per unit of length in the .bvh clips that --clips names")
    add("--unit", type=LENGTH, help="metres per unit of length in the path (default: 1; for .svg 0.01)")
    wish = "kind of motion from that many metres along the path, as in 6.5:sneak; may be repeated"
    add("--label", action="append", default=[], metavar="METRES:LABEL", help=wish)
    bend = "lay the walk on the path, turned by up to so many degrees per second (without a number: 60)"
    add("--bend", type=TURN, nargs="?", const=60.0, metavar="DEGREES", help=bend)
    add("--width", type=whole(1, 10_000), help="walks that the search keeps at a time (default: 100)")
    add("--clean", action="store_true", help="clean up footskate: planted feet stand still")
    add("--seed", type=SEED, help="seed of the random walk (default: 0)")
    walk.set_defaults(run=_walk)


def _walk(options: argparse.Namespace) -> int:
    if options.out.suffix.lower() not in (".bvh", ".glb"):
        raise MocapError(f"A walk is written as .bvh or .glb, got '{options.out}'.")
    require_writable(options.out)
    _require_together(options)
    if options.random is not None:
        seconds, graph = _seconds(options.random), _graph(options)
        frames = synthesis.dump(
            graph,
            options.out,
            seconds=seconds,
            seed=options.seed or 0,
            clean=options.clean,
            progress=bar("writing"),
        )
        print(f"{'walked':<12} {frames / graph.fps:.1f} s at random")
    else:
        followed = _followed(options)
        print(f"{'walked':<12} {followed.report()}")
        files.save(followed.motion(clean=options.clean or bool(options.bend)), options.out)
    print(f"{'wrote':<12} {options.out}")
    return 130 if options.random is None and followed.found.stopped else 0


def _require_together(options: argparse.Namespace) -> None:
    """Raise for options that would have no effect."""
    if options.random is not None and (options.label or options.width or options.unit or options.bend):
        raise MocapError("--label, --bend, --width and --unit belong to --path, not to --random.")
    if options.random is None and options.seed is not None:
        raise MocapError("--seed belongs to --random: a walk along a path leaves nothing to chance.")
    if options.scale and not options.clips:
        raise MocapError("--scale belongs to --clips: the graph remembers the unit of its own clips.")


def _followed(options: argparse.Namespace) -> "Followed":
    path = files.load_path(options.path, scale=options.unit)
    wishes = steering.Wishes(labels=[_label(text) for text in options.label])
    beam = steering.Beam(width=options.width or 100, progress=bar("searching"))
    followed: Followed = steering.follow_path(
        _graph(options), path, wishes, beam=beam, bend=math.radians(options.bend or 0)
    )
    return followed


def _seconds(text: str) -> float:
    """Read a duration.

    Examples
    --------
    >>> _seconds("60s"), _seconds("1.5min"), _seconds("2")
    (60.0, 90.0, 2.0)
    """
    found = re.fullmatch(r"(\d+\.?\d*|\.\d+)\s*(s|min|h)?", text.strip())
    seconds = float(found[1]) * UNITS[found[2] or "s"] if found else 0.0
    if not 0 < seconds <= LONGEST:
        raise MocapError(f"How long is '{text[:40]}'? Write 60s, 10min or 1h, up to 24h.")
    return seconds


def _label(text: str) -> tuple[float, str]:
    """Read a label and where it starts, as in 6.5:sneak."""
    metres, _, label = text.partition(":")
    try:
        return float(metres), label
    except ValueError:
        raise MocapError(f"From where on is '{text[:40]}'? Write METRES:LABEL, as in 6.5:sneak.") from None


def _sources(options: argparse.Namespace, found: "GraphFile") -> list[Path]:
    """List the files of the graph's clips: those given, or remembered, or of their names beside the graph."""
    if options.clips:
        given: list[Path] = files.find_files(options.clips)
        return given
    folder, sources = options.graph.parent, list[Path]()
    for name, text in itertools.zip_longest(found.names, found.origins):
        origin = find_again(text, folder) if text else None
        sources.append(origin.path if origin else folder / f"{name}{options.out.suffix}")
    return [source for source in sources if source.is_file()]


def _graph(options: argparse.Namespace) -> "MotionGraph":
    """Read the graph, and the clips that it was built of."""
    found = graphs.read(options.graph)
    require_other(options.out, _sources(options, found))
    with warnings.catch_warnings():
        lopsided = ".* so its mirror image does not"  # `mocap graph` has said so
        warnings.filterwarnings("ignore", lopsided, MocapWarning)
        clips = _clips(options, found)
    graph: MotionGraph = graphs.load(options.graph, [body.resample(clip, found.fps) for clip in clips])
    return graph


def _clips(options: argparse.Namespace, found: "GraphFile") -> "list[Motion]":
    progress = bar("reading")
    if not options.clips:
        remembered: list[Motion] = graphs.find_clips(
            options.graph, skeleton=options.skeleton, progress=progress
        )
        return remembered
    clips: list[Motion] = files.load_all(
        options.clips, skeleton=options.skeleton, scale=options.scale, progress=progress
    )
    return clips + [editing.mirror(c) for c in clips if editing.mirrored_name(c.name) in found.names]
