"""The main job in one function: clips in, a motion graph, pruned, and a new walk out."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from mocap import files, motion_graph, synthesis
from mocap.errors import MocapError, NoWalk
from mocap.kinematics import joint_positions
from mocap.motion import Motion, resample
from mocap.motion_graph import MotionGraph
from mocap.progress import Progress
from mocap.synthesis import Seam


@dataclass(frozen=True)
class Settings:
    """What a demo may choose: `fps` of the graph, `window` (seconds), `threshold` (metres), and the walk."""

    fps: float = 30.0
    window: float = 1 / 3
    threshold: float = 0.04
    seconds: float = 12.0
    seed: int = 0


@dataclass(frozen=True)
class Result:
    """What a demo made: the graph before and after pruning, the new walk, and its seams."""

    whole: MotionGraph
    pruned: MotionGraph
    walk: Motion
    seams: list[Seam]

    def table(self) -> str:
        """Say what was done, in a few aligned lines."""
        clips, whole, pruned = self.whole.clips, self.whole, self.pruned
        frames = sum(map(len, clips))
        height = np.median(np.ptp(joint_positions(clips[0])[..., 1], axis=1))
        steps = np.diff(self.walk.root_positions[:, [0, 2]], axis=0)
        rows = [
            ("clips", f"{len(clips)}: {_shortened([clip.name for clip in clips])}"),
            ("frames", f"{frames} at {clips[0].fps:g} Hz, {frames / clips[0].fps:.1f} s"),
            ("body", f"{len(clips[0].skeleton)} joints, {height:.2f} m tall"),
            ("candidates", f"{whole.count('transition') // 2} pairs of windows alike"),
            ("", f"{'whole':>8}{'pruned':>8}"),
            ("transitions", f"{whole.count('transition'):8}{pruned.count('transition'):8}"),
            ("nodes", f"{whole.graph.number_of_nodes():8}{pruned.graph.number_of_nodes():8}"),
            ("edges", f"{whole.graph.number_of_edges():8}{pruned.graph.number_of_edges():8}"),
            ("new walk", f"{self.walk.duration:.1f} s, {np.hypot(*steps.T).sum():.1f} m"),
            ("seams", f"{len(self.seams)}, the worst {self._worst():.1f} cm RMS"),
        ]
        return "\n".join(f"{name:<12} {text}".rstrip() for name, text in rows)

    def _worst(self) -> float:
        return 100 * max((seam.cost for seam in self.seams), default=0.0)


def _shortened(names: list[str], most: int = 7) -> str:
    shown = ", ".join(names[:most])
    return shown if len(names) <= most else f"{shown}, … {names[-1]}"


def window_frames(seconds: float, fps: float) -> int:
    """Count the frames of a window; it must last at least two.

    Examples
    --------
    >>> window_frames(1 / 3, 30.0)
    10
    """
    frames = seconds * fps
    if not (np.isfinite(frames) and round(frames) >= 2):
        raise MocapError(f"A window needs two frames or more, got {seconds:g} s at {fps:g} Hz.")
    return round(frames)


def run(clips: Sequence[Motion], settings: Settings, progress: Progress = iter) -> Result:
    """Build the graph of some clips, prune it, and walk through it at random.

    Raises
    ------
    NoWalk : where the threshold leaves no cycle, naming the smallest one that does.
    MocapError : for clips that do not go together, or are shorter than the window.
    """
    window = window_frames(settings.window, settings.fps)
    clips = [resample(clip, settings.fps) for clip in clips]
    whole = motion_graph.build(clips, window=window, threshold=settings.threshold, progress=progress)
    try:
        pruned = motion_graph.prune(whole)
    except NoWalk as error:
        least = motion_graph.smallest_threshold(clips, window=window)
        raise NoWalk(
            f"No walk is left at a threshold of {100 * settings.threshold:g} cm; "
            f"these clips need at least {np.ceil(1e4 * least) / 100:g} cm."
        ) from error
    edges = synthesis.random_walk(pruned, seconds=settings.seconds, seed=settings.seed)
    return Result(whole, pruned, synthesis.to_motion(pruned, edges), synthesis.seams(pruned, edges))


def load_all(
    paths: Sequence[Path], *, skeleton: Path | None, scale: float | None, progress: Progress
) -> list[Motion]:
    """Load files, and of folders every `.amc` and `.bvh` file in them."""
    found: list[Path] = []
    for path in paths:
        inside = (
            sorted(p for p in path.iterdir() if p.suffix.lower() in (".amc", ".bvh"))
            if path.is_dir()
            else [path]
        )
        if not inside:
            raise MocapError(f"The folder {path} holds no .amc or .bvh file.")
        found += inside
    return [files.load(path, skeleton=skeleton, scale=scale) for path in progress(found)]
