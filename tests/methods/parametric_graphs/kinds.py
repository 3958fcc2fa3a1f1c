"""Seven kinds of strides: walk, sneak and jog, and the changes between them."""

from functools import cache

import numpy as np
from walking import generate_walk
from walking.footsteps import winding

from mocap.body.motion import resample
from mocap.methods.parametric_graphs.examples import Examples
from mocap.methods.parametric_graphs.kinds_of_strides import changing_strides
from mocap.methods.parametric_graphs.parametric_edges import Sampling
from mocap.methods.parametric_graphs.parametric_motion_graphs import ParametricGraph, build_parametric
from mocap.methods.parametric_graphs.stride_spaces import Space, make_space
from mocap.methods.parametric_graphs.strides import cut_strides

SPEEDS = {"walk": (0.8, 1.1, 1.4), "sneak": (0.5, 0.7), "jog": (2.2, 2.4, 2.6, 2.8)}
TURNS = {"walk": (-150, -75, 0, 75, 150), "sneak": (-150, -75, 0, 75, 150)}
CHANGES = (("walk", "sneak"), ("sneak", "walk"), ("walk", "jog"), ("jog", "walk"))
EDGES = [(kind, kind) for kind in SPEEDS]
EDGES += [pair for a, b in CHANGES for pair in ((a, f"{a} to {b}"), (f"{a} to {b}", b))]


@cache
def cut(kind: str) -> Examples:
    turns = TURNS.get(kind, (-150, -100, -50, 0, 50, 100, 150))
    lines = [(speed, winding([(1.0, 0), (5.0, turn)]), turn) for speed in SPEEDS[kind] for turn in turns]
    walks = [
        generate_walk(line, style=kind, speed=speed, seed=int(10 * speed) + abs(turn))
        for speed, line, turn in lines
    ]
    return cut_strides([resample(walk, 30) for walk in walks])


@cache
def kinds() -> dict[str, Space]:
    examples = {kind: cut(kind) for kind in SPEEDS}
    examples |= {f"{a} to {b}": changing_strides(cut(a), cut(b)) for a, b in CHANGES}
    limit, spaces = np.radians(30), {}
    for name, strides in examples.items():
        low, high = np.clip(np.percentile(strides.values[:, 0], [4, 96]), -limit, limit)
        spaces[name] = make_space(strides, np.radians(10), low, high)
    return spaces


@cache
def many_kinds() -> ParametricGraph:
    return build_parametric(kinds(), EDGES, good=0.055, sampling=Sampling(sources=25, targets=250))
