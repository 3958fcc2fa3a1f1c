"""Graphs that several tests walk through."""

from functools import cache
from pathlib import Path

from mocap.body.motion import resample
from mocap.datasets import samples
from mocap.files.load_save import load
from mocap.graphs.compiled_graph import CompiledGraph, compile_graph
from mocap.graphs.motion_graph import MotionGraph, build
from mocap.graphs.pruning import prune


@cache
def bundled(*names: str) -> MotionGraph:
    """Return the graph of some bundled clips, at 30 Hz."""
    return prune(build([resample(samples.sample(n), 30) for n in names], window=10, threshold=0.04))


@cache
def walking() -> CompiledGraph:
    return compile_graph(bundled("walk_circle", "walk_curve_1"))


@cache
def sneaking() -> CompiledGraph:
    return compile_graph(bundled("walk_circle", "walk_curve_1", "sneak"))


@cache
def captured(folder: Path) -> CompiledGraph:
    """Return the graph of the walks of CMU's subject 16."""
    files = [folder / "cmu" / "16" / f"16_{n}.amc" for n in (*range(11, 35), 47, 58)]
    return compile_graph(prune(build([resample(load(f), 30) for f in files], window=10, threshold=0.04)))
