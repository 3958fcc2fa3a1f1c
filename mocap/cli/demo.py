"""The command `mocap demo`: clips in, a motion graph, pruned, and a new walk out."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from mocap import datasets, files, graphs, quality, synthesis, widgets
from mocap._shared.atomic import make_folder, require_folder
from mocap._shared.progress import Progress
from mocap.cli.options import Building, Seed, bar, number, require_other, tell, write_out
from mocap.errors import NoWalk

if TYPE_CHECKING:
    from mocap.body.motion import Motion
    from mocap.graphs.motion_graph import MotionGraph
    from mocap.synthesis.walks import Seam

SHOWN = 7  # names of clips


def demo(
    clips: Sequence[Path] = (),
    *,
    out: Path = Path("mocap-demo"),
    building: Building,
    seconds: Annotated[float, number(0.1, 3600)] = 12.0,
    seed: Seed = 0,
) -> None:
    """Make a new walk out of clips, as walk.bvh and walk.gif.

    Build a motion graph of some clips, prune it, walk through it at random, and write the new motion as
    walk.bvh (centimetres) and walk.gif.

    Parameters
    ----------
    clips : .amc, .bvh or AMASS .npz files, or folders of them (default: the bundled clips).
    out : folder to write to.
    seconds : duration of the new walk.
    """
    require_folder(out)
    require_other(out / "walk.bvh", files.find_files(clips) if clips else ())
    motions = building.load(clips) if clips else [datasets.sample(name) for name in datasets.SAMPLES]
    result = run(motions, building, seconds, seed, bar("comparing"))
    print(result.table())
    make_folder(out)
    write_out(result.walk, out / "walk.bvh")
    widgets.save_animation(result.walk, out / "walk.gif", progress=bar("drawing"))
    tell(wrote=out / "walk.gif")


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
        names = [clip.name for clip in clips]
        shown = ", ".join(names if len(names) <= SHOWN else [*names[:SHOWN], f"… {names[-1]}"])
        frames, fps = sum(map(len, clips)), clips[0].fps
        height, path = quality.inspect(clips[0]).height, quality.inspect(self.walk).path
        worst = 100 * max((seam.cost for seam in self.seams), default=0.0)
        rows = [
            ("clips", f"{len(clips)}: {shown}"),
            ("frames", f"{frames} at {fps:g} Hz, {frames / fps:.1f} s"),
            ("body", f"{len(clips[0].skeleton)} joints, {height:.2f} m tall"),
            ("candidates", f"{whole.count('transition') // 2} pairs of windows alike"),
            ("", f"{'whole':>8}{'pruned':>8}"),
            ("transitions", f"{whole.count('transition'):8}{pruned.count('transition'):8}"),
            ("nodes", f"{whole.graph.number_of_nodes():8}{pruned.graph.number_of_nodes():8}"),
            ("edges", f"{whole.graph.number_of_edges():8}{pruned.graph.number_of_edges():8}"),
            ("new walk", f"{self.walk.duration:.1f} s, {path:.1f} m"),
            ("seams", f"{len(self.seams)}, the worst {worst:.1f} cm RMS"),
        ]
        return "\n".join(f"{name:<12} {text}".rstrip() for name, text in rows)


def run(
    clips: "Sequence[Motion]", building: Building, seconds: float, seed: int, progress: Progress = iter
) -> Result:
    """Build the graph of some clips, prune it, and walk through it at random.

    Raises
    ------
    NoWalk : if the graph has no cycle; the message gives the smallest threshold at which it has one.
    MocapError : for clips that do not go together, or are shorter than the window.
    """
    whole = building.build(clips, progress)
    try:
        pruned = graphs.prune(whole)
    except NoWalk as error:
        least = graphs.smallest_threshold(whole.clips, window=building.frames())
        raise NoWalk(
            f"No walk is left at a threshold of {building.threshold:g} cm; "
            f"these clips need at least {math.ceil(1e4 * least) / 100:g} cm."
        ) from error
    edges = synthesis.random_walk(pruned, seconds=seconds, seed=seed)
    return Result(whole, pruned, synthesis.to_motion(pruned, edges), synthesis.seams(pruned, edges))
