"""The command `mocap graph`: build a motion graph and save it, or describe a saved one."""

import argparse
import warnings
from pathlib import Path
from typing import TYPE_CHECKING

from mocap import body, datasets, editing, files, graphs, quality
from mocap._shared.atomic import require_npz, require_writable
from mocap.cli.options import add_building, bar, require_other, window_frames
from mocap.errors import MocapError, MocapWarning

if TYPE_CHECKING:
    from mocap.body.motion import Motion
    from mocap.cli.options import Commands

ACTIONS = ("build", "info", "-h", "--help")  # before any other word, `build` may be left out


def add_graph(commands: "Commands") -> None:
    """Add `mocap graph build` and `mocap graph info`."""
    graph = commands.add_parser(
        "graph",
        help="build a motion graph and save it, or describe a saved one",
        usage="mocap graph [build] CLIPS... -o graph.npz\n       mocap graph info graph.npz",
        description="Build the motion graph of some clips, prune it and save it; or describe a saved graph. "
        "The graph remembers where its clips are. "
        "The word `build` may be left out. For a folder of clips that is called info, write ./info.",
        epilog="Example: mocap graph clips/ --mirror -o graph.npz",
    )
    actions = graph.add_subparsers(prog="mocap graph", title="actions", required=True, metavar="ACTION")
    build = actions.add_parser(
        "build",
        help="build a motion graph, prune it and save it",
        description="Build the motion graph of some clips, prune it and save it.",
        epilog="Example: mocap graph clips/ --mirror -o graph.npz",
    )
    add = build.add_argument
    add("clips", nargs="+", type=Path, help=".amc, .bvh or AMASS .npz files, or folders of them")
    add("-o", "--out", type=Path, default=Path("graph.npz"), help="file to write (default: %(default)s)")
    add_building(build)
    add("--by-labels", action="store_true", help="keep the largest component of each set of labels")
    add("--whole", action="store_true", help="do not prune")
    add("--mirror", action="store_true", help="add the mirror image of every clip: turns to both sides")
    add("--graphml", type=Path, help="a second file to write, .graphml, for other tools")
    build.set_defaults(run=_build)
    lists = "List a saved graph's clips and what it can play."
    info = actions.add_parser("info", help="describe a saved graph", description=lists)
    info.add_argument("file", type=Path, help="an .npz file from `mocap graph`")
    info.set_defaults(run=_info)


def _build(options: argparse.Namespace) -> int:
    require_npz(options.out)
    for target in filter(None, (options.out, options.graphml)):
        require_writable(target)
    if options.graphml and options.graphml.suffix.lower() != ".graphml":
        raise MocapError(f"--graphml writes .graphml, got '{options.graphml}'.")
    if options.by_labels and options.whole:
        raise MocapError("--by-labels says how to prune, --whole not to prune: give one of them.")
    window = window_frames(options.window, options.fps)
    found = files.find_files(options.clips)
    require_other(options.out, found)
    clips, origins = _clips(options, found)
    graph = graphs.build(
        [body.resample(clip, options.fps) for clip in clips],
        window=window,
        threshold=options.threshold / 100,
        progress=bar("comparing"),
    )
    if not options.whole:
        graph = graphs.prune(graph, by_labels=options.by_labels)
    print(graphs.summary(graph.graph, fps=graph.fps).table())
    graphs.save(graph, options.out, origins)
    print(f"{'wrote':<12} {options.out}")
    if options.graphml:
        graphs.write_graphml(graph, options.graphml)
        print(f"{'wrote':<12} {options.graphml}")
    return 0


def _clips(options: argparse.Namespace, found: list[Path]) -> "tuple[list[Motion], list[datasets.Origin]]":
    """Read the clips, with their mirror images where these are asked for, and remember where they are."""
    clips = files.load_all(found, skeleton=options.skeleton, scale=options.scale, progress=bar("reading"))
    quality.warn_of_size(clips)
    origins = [datasets.Origin(file, options.skeleton, options.scale) for file in found]
    if options.mirror:
        clips += _mirrored(clips)
        origins += [origin._replace(mirrored=True) for origin in origins]
    return clips, origins


def _mirrored(clips: "list[Motion]") -> "list[Motion]":
    """Mirror all clips; where bodies are lopsided, one warning is enough."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", MocapWarning)
        images = [editing.mirror(clip) for clip in clips]
    if caught:
        more = f" So it is with {len(caught) - 1} more." if len(caught) > 1 else ""
        warnings.warn(f"{caught[0].message}{more}", MocapWarning, stacklevel=2)
    return images


def _info(options: argparse.Namespace) -> int:
    found = graphs.read(options.file)
    for name, frames in zip(found.names, found.frames, strict=True):
        print(f"{'clip':<12} {name}: {frames} frames at {found.fps:g} Hz, {frames / found.fps:.1f} s")
    print(f"{'window':<12} {found.window} frames, {found.window / found.fps:.2f} s")
    print(graphs.summary(found.graph, fps=found.fps).table())
    return 0
