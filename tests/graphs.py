"""Graphs that several tests walk through."""

from functools import cache

from mocap import datasets
from mocap.compiling import CompiledGraph, compile_graph
from mocap.motion import resample
from mocap.motion_graph import MotionGraph, build, prune


@cache
def bundled(*names: str) -> MotionGraph:
    """Return the graph of some bundled clips, at 30 Hz."""
    return prune(build([resample(datasets.sample(n), 30) for n in names], window=10, threshold=0.04))


@cache
def walking() -> CompiledGraph:
    return compile_graph(bundled("walk_circle", "walk_curve_1"))


@cache
def sneaking() -> CompiledGraph:
    return compile_graph(bundled("walk_circle", "walk_curve_1", "sneak"))
