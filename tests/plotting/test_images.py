"""A few pictures compared with those in `baseline`: no number says how a picture looks.

To draw them anew: `pytest tests/plotting/test_images.py --mpl-generate-path=tests/plotting/baseline`.
"""

import matplotlib.pyplot as plt
import networkx as nx
import numpy as np
import pytest
from matplotlib.text import Text

from mocap.matching.distance_grids import distance_grid
from mocap.plotting import graph_drawing, grids, stick_figures
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
    return stick_figures.stick_figure(wave(60), [0, 25, 50])[0].dot.figure


@alike()
def test_two_motions_laid_over_each_other_look_as_ever():
    stick_figures.laid_over(wave(20), wave(20, phase=0.5), every=9)
    plt.gca().get_legend().remove()
    return plt.gcf()


@alike(tolerance=10)  # an image is scaled in another way by each version
def test_the_distance_image_looks_as_ever():
    grid = distance_grid(wave(80), wave(90, phase=1.0), window=10)
    grids.distance_image(grid, fps=30, minima=np.argwhere(grid == grid.min()), ax=bare())
    return without_text(plt.gcf())


@alike()
def test_a_small_graph_looks_as_ever():
    graph = nx.DiGraph([(1, 2), (2, 3), (3, 1), (3, 4), (2, 1)])
    graph_drawing.node_link(graph, kept=graph.subgraph([1, 2, 3]), ax=bare())
    return without_text(plt.gcf())
