"""Graphs that several tests walk through."""

from functools import cache
from pathlib import Path

from mocap.body.motion import Motion, resample
from mocap.datasets import samples
from mocap.files.load_save import load
from mocap.graphs import MotionGraph, build, prune
from mocap.graphs.compiled_graph import CompiledGraph, compile_graph

WALKS = ("walk_circle", "walk_curve_1", "walk_curve_2", "walk_straight")


@cache
def clips(*names: str) -> tuple[Motion, ...]:
    """Return some bundled clips, or four walks, at 30 Hz."""
    return tuple(resample(samples.sample(name), 30) for name in names or WALKS)


@cache
def bundled(*names: str) -> MotionGraph:
    """Return the graph of some bundled clips, at 30 Hz."""
    return prune(build(clips(*names), window=10, threshold=0.04))


@cache
def walking() -> CompiledGraph:
    return compile_graph(bundled("walk_circle", "walk_curve_1"))


@cache
def sneaking() -> CompiledGraph:
    return compile_graph(bundled("walk_circle", "walk_curve_1", "sneak"))


def walks_of_16(folder: Path) -> list[Motion]:
    """Load the walks of CMU's subject 16, at their own rate."""
    return [load(folder / "cmu" / "16" / f"16_{n}.amc") for n in (*range(11, 35), 47, 58)]


@cache
def captured(folder: Path) -> CompiledGraph:
    """Return the graph of these walks at 30 Hz."""
    clips = [resample(clip, 30) for clip in walks_of_16(folder)]
    return compile_graph(prune(build(clips, window=10, threshold=0.04)))
