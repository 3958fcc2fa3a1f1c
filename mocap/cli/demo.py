"""The command `mocap demo`: clips in, a motion graph, pruned, and a new walk out."""

import argparse
import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from mocap import body, datasets, files, graphs, quality, synthesis, widgets
from mocap._shared.atomic import make_folder, require_folder
from mocap._shared.progress import Progress
from mocap.cli.options import SEED, add_building, bar, number, require_other, window_frames
from mocap.errors import NoWalk

if TYPE_CHECKING:
    from mocap.body.motion import Motion
    from mocap.cli.options import Commands
    from mocap.graphs.motion_graph import MotionGraph
    from mocap.synthesis.walks import Seam


def add_demo(commands: "Commands") -> None:
    """Add `mocap demo`."""
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
        help=".amc, .bvh or AMASS .npz files, or folders of them (default: the bundled clips)",
    )
    add(
        "-o", "--out", type=Path, default=Path("mocap-demo"), help="folder to write to (default: %(default)s)"
    )
    add_building(demo)
    add(
        "--seconds",
        type=number(0.1, 3600),
        default=12.0,
        help="duration of the new walk (default: %(default)g)",
    )
    add("--seed", type=SEED, default=0, help="seed of the random walk (default: %(default)s)")
    demo.set_defaults(run=_demo)


def _demo(options: argparse.Namespace) -> int:
    require_folder(options.out)
    if options.clips:
        require_other(options.out / "walk.bvh", files.find_files(options.clips))
        clips = files.load_all(
            options.clips, skeleton=options.skeleton, scale=options.scale, progress=bar("reading")
        )
    else:
        clips = [datasets.sample(name) for name in datasets.SAMPLES]
    settings = Settings(options.fps, options.window, options.threshold / 100, options.seconds, options.seed)
    result = run(clips, settings, bar("comparing"))
    print(result.table())
    make_folder(options.out)
    files.save(result.walk, options.out / "walk.bvh")
    print(f"{'wrote':<12} {options.out / 'walk.bvh'}")
    widgets.save_animation(result.walk, options.out / "walk.gif", progress=bar("drawing"))
    print(f"{'wrote':<12} {options.out / 'walk.gif'}")
    return 0


@dataclass(frozen=True)
class Settings:
    """The numbers of a demo: frame rate, window (seconds) and threshold (metres) of the graph; the walk."""

    fps: float = 30.0
    window: float = 1 / 3
    threshold: float = 0.04
    seconds: float = 12.0
    seed: int = 0


@dataclass(frozen=True)
class Result:
    """What a demo made: the graph before and after pruning, the new walk, and its seams."""

    whole: "MotionGraph"
    pruned: "MotionGraph"
    walk: "Motion"
    seams: "list[Seam]"

    def table(self) -> str:
        """Write the numbers in a few aligned lines."""
        clips, whole, pruned = self.whole.clips, self.whole, self.pruned
        frames = sum(map(len, clips))
        height, path = quality.inspect(clips[0]).height, quality.inspect(self.walk).path
        rows = [
            ("clips", f"{len(clips)}: {_shortened([clip.name for clip in clips])}"),
            ("frames", f"{frames} at {clips[0].fps:g} Hz, {frames / clips[0].fps:.1f} s"),
            ("body", f"{len(clips[0].skeleton)} joints, {height:.2f} m tall"),
            ("candidates", f"{whole.count('transition') // 2} pairs of windows alike"),
            ("", f"{'whole':>8}{'pruned':>8}"),
            ("transitions", f"{whole.count('transition'):8}{pruned.count('transition'):8}"),
            ("nodes", f"{whole.graph.number_of_nodes():8}{pruned.graph.number_of_nodes():8}"),
            ("edges", f"{whole.graph.number_of_edges():8}{pruned.graph.number_of_edges():8}"),
            ("new walk", f"{self.walk.duration:.1f} s, {path:.1f} m"),
            ("seams", f"{len(self.seams)}, the worst {self._worst():.1f} cm RMS"),
        ]
        return "\n".join(f"{name:<12} {text}".rstrip() for name, text in rows)

    def _worst(self) -> float:
        return 100 * max((seam.cost for seam in self.seams), default=0.0)


def _shortened(names: list[str], most: int = 7) -> str:
    shown = ", ".join(names[:most])
    return shown if len(names) <= most else f"{shown}, … {names[-1]}"


def run(clips: "Sequence[Motion]", settings: Settings, progress: Progress = iter) -> Result:
    """Build the graph of some clips, prune it, and walk through it at random.

    Raises
    ------
    NoWalk : if the graph has no cycle; the message gives the smallest threshold at which it has one.
    MocapError : for clips that do not go together, or are shorter than the window.
    """
    window = window_frames(settings.window, settings.fps)
    clips = [body.resample(clip, settings.fps) for clip in clips]
    whole = graphs.build(clips, window=window, threshold=settings.threshold, progress=progress)
    try:
        pruned = graphs.prune(whole)
    except NoWalk as error:
        least = graphs.smallest_threshold(clips, window=window)
        raise NoWalk(
            f"No walk is left at a threshold of {100 * settings.threshold:g} cm; "
            f"these clips need at least {math.ceil(1e4 * least) / 100:g} cm."
        ) from error
    edges = synthesis.random_walk(pruned, seconds=settings.seconds, seed=settings.seed)
    return Result(whole, pruned, synthesis.to_motion(pruned, edges), synthesis.seams(pruned, edges))
