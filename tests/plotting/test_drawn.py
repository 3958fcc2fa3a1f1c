"""The pictures show what they showed when they were last looked at; tests/drawn.py says how to draw anew.

Of bodies, stick_figures, bodies_on_path, grids, ground_charts, charts and graph_drawing.
"""

from dataclasses import replace
from functools import cache

import networkx as nx
import numpy as np
import pytest

from mocap import datasets, graphs, plotting, resample
from mocap.body import Skeleton, joint_positions
from mocap.matching import distance_grid
from mocap.plotting.bodies import film_strip
from mocap.plotting.bodies_on_path import bodies_along
from tests.drawn import hold
from tests.strategies import wave

RANDOM = np.random.default_rng(0)
SAMPLES, ROWS = RANDOM.gamma(2.0, size=(5, 41)), RANDOM.random((10, 2))
WALKS = [resample(datasets.sample(f"walk_curve_{n}"), 30)[:120] for n in (1, 2)]


@cache
def graph():
    return graphs.build([wave(90, name="a"), wave(70, phase=1, name="b", seed=1)], window=8, threshold=0.05)


def flat(view):
    return plotting.flat_bodies(datasets.sample("walk_straight"), [0, 90], view=view)


def stick_figure():
    names = ["hips", "lleg", "rleg", "lfoot", "rfoot", "head"]
    body = Skeleton(names, [-1, 0, 0, 1, 2, 0], [[0, 0, 0]] + [[x, -0.4, 0] for x in (0.1, -0.1, 0, 0.01, 0)])
    motion = replace(wave(5), skeleton=body, rotations=np.tile([1.0, 0, 0, 0], (5, 6, 1)), contacts={})
    figure = plotting.StickFigure(body, plotting.ground_axes((0.3, 7.1), 1.0))
    figure.pose(joint_positions(motion)[2])
    return figure.bones


def lost_marker():
    """One frame beyond the horizon, as a lost marker gives it: it gets a coarser floor."""
    roots = wave(50).root_positions.copy()
    roots[20] = [0, 1, 1e7]
    return bodies_along(replace(wave(50), root_positions=roots))


def small_graph():
    small = nx.DiGraph([(1, 2), (2, 1), (2, 3), (3, 3)])
    places = {1: (0, 0), 2: (1, 0), 3: (1, 1)}
    discs, _ = plotting.node_link(small, places=places, kept=small.subgraph([1, 2]))
    return discs


def plan():
    places = np.linspace(0, 6, 50)[:, None] + np.array([0j, 1.5j, -1.5j])
    figure = plotting.draw_group_plan(places, [6 + 0j, 9 + 1j], [(3 + 4j, 0.5)], near=0.8)
    return plotting.draw_group_plan(np.ones((5, 1), complex), ax=figure.axes[0])


PICTURES = {
    "flat bodies": lambda: map(flat, ("side", "front")),
    "strip": lambda: [
        film_strip([wave(50, name="a"), wave(20, name="b", phase=2)], count=4),
        film_strip([wave(1)]),
    ],
    "stick figure": lambda: [stick_figure()],
    "bodies along": lambda: map(bodies_along, (wave(1), wave(100), wave(2000))),
    "lost marker": lambda: [lost_marker()],
    "sources": lambda: [bodies_along(wave(200), sources=[(0, "a"), (100, "b"), (150, "a")], seams=[95, 145])],
    "two and a path": lambda: [
        bodies_along(wave(100, name="a"), wave(100, phase=1, name="b"), path=[(0, 0), (1, 2)])
    ],
    "six": lambda: [bodies_along(*(wave(400, phase=phase, name="walk") for phase in range(6)))],
    "obstacle": lambda: [bodies_along(wave(30), discs=[[0, 1, 0.5]])],
    "joint curve": lambda: [plotting.joint_curve(ROWS, fps=10, labels=["x (m)", "y (m)"])[0]],
    "bands": lambda: [plotting.quartile_band(range(5), SAMPLES, label="slide", colour="#112233")],
    "distances": lambda: [
        plotting.distance_image(
            distance_grid(wave(40), wave(60, phase=1.0), window=10), fps=30, minima=[[3, 5]], names=("a", "b")
        )
    ],
    "rows": lambda: [plotting.walk_rows(np.array([[0.0, 150.0, np.nan], [300.0, 0.0, 0.0]]), highest=400.0)],
    "path": lambda: [plotting.path_from_above(wave(30))[0]],
    "plan": lambda: [plan()],
    "timeline": lambda: (plotting.timeline(graph(), **how) for how in ({}, {"most": 3}, {"each": 2})),
    "small graph": lambda: [small_graph()],
}


@pytest.mark.parametrize("name", PICTURES)
def test_a_picture_is_drawn_as_ever(name):
    hold(__file__, name, PICTURES[name]())
