"""The command that fills the time between two motions: `mocap inbetween`."""

import math
import re
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from mocap import body, graphs
from mocap.cli.option_types import MOMENT, frame_at, number
from mocap.cli.options import Building, Sources
from mocap.cli.outputs import check_out, print_rows, write_out
from mocap.cli.saved_graphs import load_graph
from mocap.errors import MocapError
from mocap.files.conversion import find_files
from mocap.methods import in_betweening

if TYPE_CHECKING:
    from mocap.body.motion import Motion
    from mocap.graphs.motion_graph import MotionGraph
    from mocap.methods.in_betweening.end_bending import Arrived


def inbetween(
    start: Path,
    end: Path | None = None,
    *,
    seconds: Annotated[float | None, number(0.01, 60)] = None,
    gap: str | None = None,
    ahead: Annotated[float | None, number(0, 100)] = None,
    graph: Path | None = None,
    clips: Sequence[Path] = (),
    building: Building,
    alone: bool = False,
    out: Path = Path("inbetween.bvh"),
) -> None:
    """Fill the time between two clips, or a gap in one, with new motion.

    Create the motion from the last pose of START to the first pose of END, each at its position, in the given
    time, or, with --gap, replace a part of START. The motion is a walk through the motion graph of these
    clips, of --clips, or of --graph, which is bent and retimed so that it arrives. Gaps shorter than 0.33 s
    are interpolated, because they are too short for a step.

    Parameters
    ----------
    start (START) : a motion file, from whose last pose the new motion starts.
    end (END) : a motion file of the same body, at whose first pose the new motion arrives.
    seconds : duration from START to END, seconds.
    gap (FROM-TO) : the part of START to replace, in seconds as in 1.5s-2.5s, or in frames as in 45-75. The
        poses at both ends are kept.
    ahead (METRES) : place END this far ahead of START, with the same heading (default: at its own position).
    graph : an .npz file from `mocap graph` as the source of motion.
    clips (CLIP) : motion files, or folders of them, as the source of motion (default: START and END). With
        --graph, they are the clips of the graph, which are found by content if they have moved.
    alone : write only the new motion, without START and END.
    out : file to write, .bvh, .glb, .npz or .csv.

    Notes
    -----
    Example: mocap inbetween start.bvh end.bvh --seconds 1.5 --clips walks/ -o whole.bvh

    Example: mocap inbetween walk.bvh --gap 1.5s-2.5s -o mended.bvh
    """
    if (end is None) == (gap is None):
        raise MocapError("Give END and --seconds, or --gap with START alone: where the motion is missing.")
    if (end is None) != (seconds is None):
        raise MocapError("--seconds belongs to END: the time between two clips. A --gap has its own.")
    if ahead is not None and end is None:
        raise MocapError("--ahead belongs to END: a gap ends where START goes on.")
    files = [start, end] if end else [start]
    of_source = () if graph else clips
    sources = find_files(of_source) if of_source else []
    check_out("whole motion", out, [*files, *sources, *([graph] if graph else [])])
    motions, _ = building.load([*files, *sources], [*files, *of_source])
    first, second, time = _sides(motions[: len(files)], gap, seconds, ahead)
    frames = max(1, round(time * first.fps))
    if time < in_betweening.SHORTEST:
        between = in_betweening.interpolate(first, second, frames)
        print_rows(between=f"{time:.2f} s, interpolated")
    else:
        saved = _saved(graph, clips, building, out)
        whole_graph = saved or _built(motions[len(files) :], building, [first, second])
        filling = in_betweening.fill_gap(graphs.compile_graph(whole_graph), first, second, time)
        between = _at_rate(filling.motion, first.fps, frames)
        print_rows(between=f"{time:.2f} s, {_changes(filling.arrived)}")
    whole = between if alone else body.concatenate([first[:-1], between, second[1:]])
    write_out(whole, out, details=f": {len(whole)} frames, {whole.duration:.2f} s")


def _sides(
    motions: "Sequence[Motion]", gap: str | None, seconds: float | None, ahead: float | None
) -> "tuple[Motion, Motion, float]":
    """Return the motions on both sides of the gap, at one frame rate, and its duration in seconds."""
    first = motions[0]
    if gap is not None:
        begin, stop = _frames(gap, first)
        return first[: begin + 1], first[stop:], (stop - begin) / first.fps
    second = body.resample(motions[1], first.fps)
    if ahead is not None:
        heading = float(body.heading(first.rotations[-1, 0]))
        step = [ahead * math.sin(heading), ahead * math.cos(heading)]
        second = body.place(second, heading, first.root_positions[-1, [0, 2]] + step)
    return first, second, seconds or 0.0


def _frames(gap: str, clip: "Motion") -> tuple[int, int]:
    """Parse the frames at both ends of a gap.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> walk = sample("walk_straight")  # 120 Hz
    >>> _frames("1.5s-2.5s", walk), _frames("45-75", walk)
    ((180, 300), (45, 75))
    """
    parts = re.fullmatch(f"{MOMENT}-{MOMENT}", gap.strip())
    if not parts:
        raise MocapError(f"Where is the gap '{gap[:40]}'? Write FROM-TO, as in 1.5s-2.5s or frames 45-75.")
    begin, stop = (frame_at(moment, clip.fps) for moment in parts.groups())
    last = len(clip) - 1
    if not 0 <= begin < stop - 1 < last:
        held = f"'{clip.name[:60]}' has frames 0 to {last}, {clip.duration:.2f} s"
        raise MocapError(f"{held}: a gap lies within, with a frame or more to make, got {begin}-{stop}.")
    return begin, stop


def _saved(graph: Path | None, clips: Sequence[Path], building: Building, out: Path) -> "MotionGraph | None":
    """Load the graph that is the source of motion; None without one."""
    if graph is None:
        return None
    # Without clips, the options for reading are those of START and END.
    sources = building if clips else Sources(building.skeleton, joints=building.joints)
    return load_graph(graph, sources, clips, out)


def _built(clips: "Sequence[Motion]", building: Building, sides: "Sequence[Motion]") -> "MotionGraph":
    """Build the graph that is the source of motion, of some clips and both sides."""
    long = [side for side in sides if side.duration >= building.window]  # others have no transition
    motions = [*clips, *long]
    if not motions:
        window = f"a transition of {building.window:.2f} s"
        raise MocapError(f"START and END are shorter than {window}: give --clips to take motion from.")
    # Both sides of a gap have the same name, and a clip may also have it.
    return building.build([replace(clip, name=f"{n} {clip.name}") for n, clip in enumerate(motions)])


def _at_rate(motion: "Motion", fps: float, frames: int) -> "Motion":
    """Resample a motion to another number of frames and another rate."""
    import numpy as np  # the help needs no NumPy

    from mocap.editing.retiming import at_frames

    moments = np.linspace(0, len(motion) - 1, frames + 1)
    return replace(at_frames(motion, moments), fps=fps)


def _changes(arrived: "Arrived") -> str:
    """Format the changes of the walk."""
    turned = math.degrees(max(abs(arrived.turned.min()), abs(arrived.turned.max())))
    steps = f"steps × {arrived.steps.min():.2f} to {arrived.steps.max():.2f}"
    pace = f"pace × {arrived.pace.min():.2f} to {arrived.pace.max():.2f}"
    return f"a walk turned by up to {turned:.0f}° per second, {steps}, {pace}"
