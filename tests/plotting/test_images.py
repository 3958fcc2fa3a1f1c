"""A few pictures compared with those in `baseline`: no number says how a picture looks.

To draw them anew: `pytest tests/plotting/test_images.py --mpl-generate-path=tests/plotting/baseline`.
"""

import matplotlib.pyplot as plt
import networkx as nx
import pytest
from matplotlib.text import Text

from mocap.body import joint_positions
from mocap.plotting import PATH, graph_drawing, stick_figures
from tests.strategies import wave

pytest.importorskip("pytest_mpl", reason="pip install pytest-mpl")


# Letters differ between versions of matplotlib, and so does the layout around them: no text is drawn.
def alike(tolerance=1):
    return pytest.mark.mpl_image_compare(
        baseline_dir="baseline",
        tolerance=tolerance,
        remove_text=True,
        style="default",
        savefig_kwargs={"dpi": 40},
    )


def bare():
    """Give axes whose place does not depend on any text."""
    return plt.figure(figsize=(4, 4)).add_subplot()


def without_text(figure):
    for text in figure.findobj(Text):
        text.set_visible(False)
    return figure


@alike()
def test_ghosts_look_as_ever():
    motion = wave(60)
    points = joint_positions(motion)[[0, 25, 50]]
    low, high, way = points.min(axis=(0, 1)), points.max(axis=(0, 1)), motion.root_positions * [1, 0, 1]
    reach = max(1.2, *(high - low)[[0, 2]]) / 2 + 0.3
    ax = stick_figures.ground_axes((low + high)[[0, 2]] / 2, reach, tall=max(1.9, high[1]))
    stick_figures.keep_inside(ax, points)
    ax.plot(*stick_figures.to_picture(way).T, color=PATH, linewidth=1.5, zorder=1)
    for alpha, pose in zip((0.15, 0.15 + 0.35 / 3, 1.0), points, strict=True):
        stick_figures.StickFigure(motion.skeleton, ax, alpha).pose(pose)
    return ax.figure


@alike()
def test_a_small_graph_looks_as_ever():
    graph = nx.DiGraph([(1, 2), (2, 3), (3, 1), (3, 4), (2, 1)])
    graph_drawing.node_link(graph, kept=graph.subgraph([1, 2, 3]), ax=bare())
    return without_text(plt.gcf())
