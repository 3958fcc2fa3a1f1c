"""The command `mocap`, or `python -m mocap`."""

import argparse
import sys
import warnings
from collections.abc import Sequence
from functools import partial
from pathlib import Path

from mocap.atomic import make_folder
from mocap.commands import add_convert, add_data, add_info
from mocap.course_command import add_course
from mocap.errors import MocapError, MocapWarning
from mocap.progress import bar
from mocap.show_commands import add_figures, add_view
from mocap.walk_command import add_walk


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="mocap", description="New human motion out of captured motion.")
    commands = parser.add_subparsers(title="commands", required=True, metavar="COMMAND")
    _add_demo(commands)
    _add_graph(commands)
    add_walk(commands)
    add_info(commands)
    add_convert(commands)
    add_data(commands)
    add_view(commands)
    add_figures(commands)
    add_course(commands)
    lab = commands.add_parser("lab", help="open the course in JupyterLab", description="Open the course.")
    lab.add_argument(
        "folder",
        nargs="?",
        type=Path,
        default=Path("mocap-course"),
        help="where an installed package puts its copy of the notebooks (default: %(default)s)",
    )
    lab.set_defaults(run=_lab)
    return parser


def _add_demo(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    demo = commands.add_parser(
        "demo",
        help="make a new walk out of clips, as walk.bvh and walk.gif",
        description="Build a motion graph of some clips, prune it, walk through it at random, and write the "
        "new motion as walk.bvh (centimetres) and walk.gif.",
    )
    add = demo.add_argument
    add(
        "clips",
        nargs="*",
        type=Path,
        help=".amc or .bvh files or folders of them (default: the bundled clips)",
    )
    add(
        "-o", "--out", type=Path, default=Path("mocap-demo"), help="folder to write to (default: %(default)s)"
    )
    _add_settings(demo)
    add("--seconds", type=float, default=12.0, help="length of the new walk (default: %(default)g)")
    add("--seed", type=int, default=0, help="another seed, another walk (default: %(default)s)")
    demo.set_defaults(run=_demo)


def _add_settings(command: argparse.ArgumentParser) -> None:
    """Add the options of how to read clips and build a graph of them."""
    add = command.add_argument
    add(
        "--skeleton",
        type=Path,
        help="the .asf file of the .amc clips (default: the one beside them that fits)",
    )
    add("--scale", type=float, help="metres in a unit of the .bvh clips (default: 0.01)")
    add("--fps", type=float, default=30.0, help="frames a second to work at (default: %(default)g)")
    add("--window", type=float, default=1 / 3, help="seconds of a transition (default: %(default).2f)")
    add("--threshold", type=float, default=4.0, help="worst match allowed, cm RMS (default: %(default)g)")


def _add_graph(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    graph = commands.add_parser(
        "graph",
        help="build a motion graph and save it, or tell about a saved one",
        usage="mocap graph [options] CLIPS... -o graph.npz\n       mocap graph info graph.npz",
        description="Build the motion graph of some clips, prune it and save it; or, with the word info "
        "and a saved graph, tell what it can play.",
    )
    add = graph.add_argument
    add("clips", nargs="+", type=Path, help=".amc or .bvh files or folders of them; or: info graph.npz")
    add("-o", "--out", type=Path, default=Path("graph.npz"), help="file to write (default: %(default)s)")
    _add_settings(graph)
    add("--by-labels", action="store_true", help="keep the largest component of each set of labels")
    add("--whole", action="store_true", help="do not prune")
    add("--graphml", type=Path, help="write the graph for other tools as well, as .graphml")
    graph.set_defaults(run=_graph)


def _graph(options: argparse.Namespace) -> int:
    from mocap import demo, graph_files, graph_summary, motion_graph
    from mocap.motion import resample

    if options.clips[0] == Path("info"):
        return _graph_info(options.clips[1:])
    graph_files.require_suffix(options.out, ".npz")
    graph_files.require_suffix(options.graphml or "x.graphml", ".graphml")
    window = demo.window_frames(options.window, options.fps)
    clips = demo.load_all(
        options.clips, skeleton=options.skeleton, scale=options.scale, progress=partial(bar, what="reading")
    )
    graph = motion_graph.build(
        [resample(clip, options.fps) for clip in clips],
        window=window,
        threshold=options.threshold / 100,
        progress=partial(bar, what="comparing"),
    )
    if not options.whole:
        graph = motion_graph.prune(graph, by_labels=options.by_labels)
    print(graph_summary.summary(graph.graph, fps=graph.fps).table())
    graph_files.save(graph, options.out)
    print(f"{'wrote':<12} {options.out}")
    if options.graphml:
        graph_files.write_graphml(graph, options.graphml)
        print(f"{'wrote':<12} {options.graphml}")
    return 0


def _graph_info(paths: Sequence[Path]) -> int:
    from mocap import graph_files, graph_summary

    if len(paths) != 1:
        raise MocapError(f"`mocap graph info` tells about one saved graph, got {len(paths)} files.")
    found = graph_files.read(paths[0])
    for name, frames in zip(found.names, found.frames, strict=True):
        print(f"{'clip':<12} {name}: {frames} frames at {found.fps:g} Hz, {frames / found.fps:.1f} s")
    print(f"{'window':<12} {found.window} frames, {found.window / found.fps:.2f} s")
    print(graph_summary.summary(found.graph, fps=found.fps).table())
    return 0


def _demo(options: argparse.Namespace) -> int:
    from mocap import demo, files, plotting

    if options.clips:
        progress = partial(bar, what="reading")
        clips = demo.load_all(
            options.clips, skeleton=options.skeleton, scale=options.scale, progress=progress
        )
    else:
        from mocap import datasets

        clips = [datasets.sample(name) for name in datasets.SAMPLES]
    settings = demo.Settings(
        options.fps, options.window, options.threshold / 100, options.seconds, options.seed
    )
    result = demo.run(clips, settings, partial(bar, what="comparing"))
    print(result.table())
    make_folder(options.out)
    files.save(result.walk, options.out / "walk.bvh")
    print(f"{'wrote':<12} {options.out / 'walk.bvh'}")
    plotting.save_animation(result.walk, options.out / "walk.gif", progress=partial(bar, what="drawing"))
    print(f"{'wrote':<12} {options.out / 'walk.gif'}")
    return 0


def _lab(options: argparse.Namespace) -> int:
    from mocap import lab

    return lab.open_course(options.folder)


def _tell(message: Warning | str, *_place: object, **_more: object) -> None:
    print(f"mocap: {message}", file=sys.stderr)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; give its exit status: 0, or 2 where the input is at fault, or 130 when interrupted."""
    options = _parser().parse_args(arguments)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("always", MocapWarning)
            warnings.showwarning = _tell
            return int(options.run(options))
    except MocapError as error:
        print(f"mocap: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print("mocap: interrupted; nothing half-written is left.", file=sys.stderr)
        return 130


if __name__ == "__main__":
    sys.exit(main())
