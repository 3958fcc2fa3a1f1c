"""Draw the pictures of the README and of the notebooks' headers: `python figures/draw.py`."""

from pathlib import Path

import matplotlib

matplotlib.use("agg")

import matplotlib.pyplot as plt
import networkx as nx
import numpy as np

import mocap
from mocap import datasets, motion_graph, plotting, pruning, synthesis

FOLDER = Path(__file__).parent


def draw_walk() -> None:
    """Draw a new walk: poses along its path."""
    clips = [mocap.resample(datasets.sample(name), 30) for name in datasets.SAMPLES]
    graph = motion_graph.prune(motion_graph.build(clips, window=10, threshold=0.04))
    walk = synthesis.to_motion(graph, synthesis.random_walk(graph, seconds=9, seed=3515))
    low, high = (f(walk.root_positions[:, [0, 2]], axis=0) for f in (np.min, np.max))
    figure = plt.figure(figsize=(9, 4))
    ax = figure.add_axes((0, -0.6, 1, 2.2), projection="3d")
    plotting.stage((low + high) / 2, max(high - low) / 2 + 0.9, ax=ax)
    ax.view_init(elev=15, azim=-97)
    plotting.stick_figure(walk, range((len(walk) - 1) % 18, len(walk), 18), ax=ax)
    figure.savefig(FOLDER / "walk.png", dpi=110)
    plt.close(figure)


def draw_pruning() -> None:
    """Draw the eight-node graph of the notes: what stays in colour, and what goes, with the reason."""
    graph = pruning.notes_example()
    found = pruning.prune_graph(graph)
    places = {
        1: (0, 1),
        2: (1, 2),
        3: (1, 0),
        4: (-0.2, -0.5),
        5: (3.6, 2.3),
        6: (2.2, 2),
        7: (3, 1),
        8: (2.2, 0),
    }
    figure, ax = plt.subplots(figsize=(6, 3.6), layout="constrained")
    stays = [plotting.COLOURS["left"] if node in found.graph else plotting.QUIET for node in graph]
    drawn = [edge for edge in graph.edges(keys=True) if edge not in found.removed]
    look = {"ax": ax, "node_size": 500, "arrowsize": 14, "connectionstyle": "arc3,rad=0.08"}
    nx.draw_networkx_nodes(graph, places, node_color=stays, ax=ax, node_size=500)
    nx.draw_networkx_labels(graph, places, font_color="white", ax=ax)
    nx.draw_networkx_edges(graph, places, drawn, width=1.8, edge_color=plotting.COLOURS["left"], **look)
    nx.draw_networkx_edges(graph, places, list(found.removed), style=":", edge_color=plotting.QUIET, **look)
    ax.annotate("a sink: it reaches only itself", places[4], (18, -4), textcoords="offset points")
    ax.annotate("a dead end: on no cycle", places[5], (-14, 12), textcoords="offset points", ha="right")
    ax.set_axis_off()
    ax.margins(0.12)
    figure.savefig(FOLDER / "pruning.png", dpi=110)
    plt.close(figure)


if __name__ == "__main__":
    draw_walk()
    draw_pruning()
