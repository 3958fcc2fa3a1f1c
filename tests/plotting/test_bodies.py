"""Pictures show what they showed when somebody last looked; bodies are inside them, however large these are.

`drawn.json` holds what is drawn, `baseline` a few pictures; tests/drawn.py says how to draw both anew.
"""

from dataclasses import replace
from functools import cache
from pathlib import Path

import matplotlib.pyplot as plt
import networkx as nx
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from matplotlib.text import Text
from mpl_toolkits.mplot3d import proj3d

from mocap import datasets, graphs, plotting, resample
from mocap.body import Skeleton, joint_positions
from mocap.matching import distance_grid
from mocap.plotting import stick_figures
from mocap.plotting.bodies import HIGH, LOW, WIDTH, bodies_along, film_strip
from mocap.plotting.stick_figures import to_picture
from tests.drawn import compare_with_baseline, hold
from tests.refusals import refusals
from tests.strategies import random_motion, seeds, wave

BASELINE = Path(__file__).parent / "baseline"
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
    discs, _ = plotting.node_link(small, positions=places, kept=small.subgraph([1, 2]))
    return discs


def plan():
    places = np.linspace(0, 6, 50)[:, None] + np.array([0j, 1.5j, -1.5j])
    figure = plotting.draw_group_plan(places, [6 + 0j, 9 + 1j], [(3 + 4j, 0.5)], radius=0.8)
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


drawn_in_default_style = plt.style.context("default", after_reset=True)


def bare():
    """Give axes whose place does not depend on any text."""
    return plt.figure(figsize=(4, 4)).add_subplot()


def without_text(figure):
    for text in figure.findobj(Text):
        text.set_visible(False)
    return figure


@drawn_in_default_style
def test_ghosts_look_as_ever(tmp_path):
    motion = wave(60)
    points = joint_positions(motion)[[0, 25, 50]]
    low, high, way = points.min(axis=(0, 1)), points.max(axis=(0, 1)), motion.root_positions * [1, 0, 1]
    reach = max(1.2, *(high - low)[[0, 2]]) / 2 + 0.3
    ax = stick_figures.ground_axes((low + high)[[0, 2]] / 2, reach, tall=max(1.9, high[1]))
    stick_figures.keep_inside(ax, points)
    ax.plot(*to_picture(way).T, color=plotting.PATH, linewidth=1.5, zorder=1)
    for alpha, pose in zip((0.15, 0.15 + 0.35 / 3, 1.0), points, strict=True):
        stick_figures.StickFigure(motion.skeleton, ax, alpha).pose(pose)
    compare_with_baseline(ax.figure, BASELINE / "test_ghosts_look_as_ever.png", tmp_path)


@drawn_in_default_style
def test_a_small_graph_looks_as_ever(tmp_path):
    graph = nx.DiGraph([(1, 2), (2, 3), (3, 1), (3, 4), (2, 1)])
    plotting.node_link(graph, kept=graph.subgraph([1, 2, 3]), ax=bare())
    without_text(plt.gcf())
    compare_with_baseline(plt.gcf(), BASELINE / "test_a_small_graph_looks_as_ever.png", tmp_path)


def on_picture(ax, points):
    """Give where points of the world are on the axes, from 0 to 1 each way."""
    ax.figure.draw_without_rendering()
    x, y, _ = proj3d.proj_transform(*to_picture(points).reshape(-1, 3).T, ax.get_proj())
    return ax.transAxes.inverted().transform(ax.transData.transform(np.stack([x, y], -1)))


def test_world_axes_are_not_mirrored():
    x, y, z = to_picture(np.eye(3))
    assert np.cross(x, y) == pytest.approx(z)
    assert y.tolist() == [0, 0, 1]  # up is up


def test_a_ground_may_be_too_small_for_its_lines():
    assert not len(stick_figures.ground_axes((0.2, 0.2), 0.1).collections[0]._segments3d)


@given(seeds, st.floats(0.2, 30), st.floats(-1000, 1000))
@settings(max_examples=15)
def test_poses_are_never_cut_off(seed, size, away):
    motion = random_motion(seed)
    motion = replace(motion, root_positions=np.abs(motion.root_positions) * size + [away, 0, -away])
    points = joint_positions(motion)[[0, 2, 4]]
    ax = stick_figures.ground_axes(points.mean(axis=(0, 1))[[0, 2]], size)
    stick_figures.keep_inside(ax, points)
    seen = on_picture(ax, points)
    plt.close(ax.figure)
    assert 0 <= seen.min() <= seen.max() <= 1


def test_nothing_zooms_in_on_points_that_are_inside_already():
    ax = stick_figures.ground_axes()
    before = on_picture(ax, np.eye(3))
    stick_figures.keep_inside(ax, np.array([[0.0, 0.9, 0.0]]))
    assert on_picture(ax, np.eye(3)) == pytest.approx(before)


@pytest.mark.parametrize("frames", [1, 2, 60, 3000])
def test_the_picture_fits_what_it_shows(frames):
    figure = bodies_along(wave(frames))
    wide, high = figure.get_size_inches()
    assert wide == WIDTH
    assert LOW <= high <= HIGH
    figure.canvas.draw()
    inside = figure.axes[0].get_window_extent().bounds
    assert inside[3] > 0.6 * high * figure.dpi or inside[2] > 0.9 * wide * figure.dpi


test_large_graphs_are_drawn_elsewhere = refusals(
    *(
        (
            r"1 to 100 nodes, this one has \d+: `plotting.timeline`",
            plotting.node_link,
            nx.empty_graph(nodes, nx.DiGraph),
        )
        for nodes in (0, 101)
    )
)
