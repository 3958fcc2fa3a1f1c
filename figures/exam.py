"""The pictures of the exam questions: `python figures/exam.py` writes `notebooks/teaching/exam-*.png`."""

from pathlib import Path

import matplotlib as mpl
import networkx as nx
import numpy as np
from matplotlib import pyplot as plt

from mocap import datasets, matching, plotting, resample

FOLDER = Path(__file__).parents[1] / "notebooks" / "teaching"
EDGES = {(1, 2): 1, (2, 3): 1, (3, 1): 1, (3, 4): 1, (4, 5): 3, (5, 6): 1, (6, 4): 1, (6, 7): 1}  # seconds
SLOW_EDGE = (4, 5)  # its seconds are written beside it
PLACES = {1: (0, 0.5), 2: (1, 1), 3: (1, 0), 4: (2.2, 0), 5: (2.7, 1), 6: (3.3, 0), 7: (4.3, 0.5)}
WALKS = {"A": [4.1, 5.2, 6.0, 7.4, 9.9], "B": [3.9, 4.6, 5.1, 7.0, 11.2]}  # cm off, invented for the question


def draw_graph() -> None:
    """Draw the graph that is to be pruned."""
    figure, ax = plt.subplots(figsize=(6.4, 2.2), layout="constrained")
    plotting.node_link(nx.DiGraph(list(EDGES)), positions=PLACES, ax=ax)
    x, z = PLACES[SLOW_EDGE[0]]
    u, v = PLACES[SLOW_EDGE[1]]
    seconds = str(EDGES[SLOW_EDGE])
    ax.text((x + u) / 2 - 0.05, (z + v) / 2, seconds, ha="right", va="center", fontsize=12)
    figure.savefig(FOLDER / "exam-graph.png", dpi=100)


def draw_grid() -> None:
    """Draw the distances of two walks, with its bands and islands."""
    a, b = (resample(datasets.sample(f"walk_{name}"), 30)[30:130] for name in ("straight", "curve_1"))
    drawn = plotting.distance_image(matching.distance_grid(a, b, window=10), fps=30)
    drawn.axes.figure.savefig(FOLDER / "exam-grid.png", dpi=80)


def draw_curve() -> None:
    """Draw medians and quartiles of five walks each."""
    figure, ax = plt.subplots(figsize=(3.2, 2.6), layout="constrained")
    low, middle, high = np.percentile(list(WALKS.values()), [25, 50, 75], axis=1)
    ax.errorbar(list(WALKS), middle, [middle - low, high - middle], fmt="o", capsize=6, color="black")
    ax.set(ylabel="off the line (cm)", ylim=(0, 12), xlim=(-0.5, 1.5))
    figure.savefig(FOLDER / "exam-curve.png", dpi=100)


if __name__ == "__main__":
    mpl.use("agg")
    for draw in (draw_graph, draw_grid, draw_curve):
        draw()
