"""Spaces and graphs that several tests walk with."""

from functools import cache

import numpy as np

from mocap.body.motion import Motion, resample
from mocap.datasets import samples
from mocap.methods.parametric_graphs.made_strides import optimal_transitions
from mocap.methods.parametric_graphs.parametric_edges import Sampling
from mocap.methods.parametric_graphs.parametric_motion_graphs import ParametricGraph, build_parametric
from mocap.methods.parametric_graphs.stride_spaces import StrideSpace, draw_parameters, make_space
from mocap.methods.parametric_graphs.strides import Strides, cut_strides

WALKS = ("walk_circle", "walk_curve_1", "walk_curve_2", "walk_straight")
SMALL = Sampling(sources=12, targets=120)
SHARE = {"lrl": 1.0, "lr": 0.55, "rl": 0.55}  # a step turns by half of what a stride does, or little more


@cache
def clips() -> tuple[Motion, ...]:
    return tuple(resample(samples.sample(name), 30) for name in WALKS)


def strides(feet: str = "lrl", by: str = "strikes") -> Strides:
    return _strides(feet, by)


@cache
def _strides(feet: str, by: str) -> Strides:
    return cut_strides(clips(), feet=feet, by=by)


def space(feet: str = "lrl") -> StrideSpace:
    return _space(feet)


@cache
def _space(feet: str) -> StrideSpace:
    width, high = np.radians([12, 75]) * SHARE[feet]
    return make_space(strides(feet), width, -high, high)


def walking(good: float = 0.03) -> ParametricGraph:
    return _walking(good)


@cache
def _walking(good: float) -> ParametricGraph:
    return build_parametric({"walk": space()}, good=good)


def stepping(good: float = 0.03) -> ParametricGraph:
    return _stepping(good)


@cache
def _stepping(good: float) -> ParametricGraph:
    spaces = {"left": space("lr"), "right": space("rl")}
    few = Sampling(sources=30, targets=300)
    return build_parametric(spaces, [("left", "right"), ("right", "left")], good=good, sampling=few)


def fresh(source, target, edge, bad, seed=99):
    """Test boxes on fresh samples: the shares of boxes with a bad target, and of bad ones inside."""
    random = np.random.default_rng(seed)
    at, to = draw_parameters(source, 100, random), draw_parameters(target, 300, random)
    ways = [edge.look_up(asked) for asked in at]
    cost = optimal_transitions(source, target, at, to).cost
    inside = np.array([((to >= way.low) & (to <= way.high)).all(axis=1) for way in ways])
    worst = (cost > bad) & inside
    return worst.any(axis=1).mean(), worst.sum() / inside.sum()


def walk_anywhere(character, count, speed=0.8):
    """Ask for targets drawn anywhere in the boxes; give the nodes and the parameters that it left."""
    random, left = np.random.default_rng(4), []

    def anywhere(space, heading, speed):
        way = next(iter(character.way.values()))
        left.append((character.node, character.parameters))
        return random.uniform(np.minimum(way.low, way.high), np.maximum(way.low, way.high))

    character._wish = anywhere
    while len(character.chosen) < count:
        character.step(0.0, speed)
    return left
