"""Draw the pictures of the README and of the notebooks' headers: `python figures/draw.py`."""

from pathlib import Path

import matplotlib

matplotlib.use("agg")

import matplotlib.pyplot as plt
import numpy as np

import mocap
from mocap import datasets, motion_graph, plotting, synthesis

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


if __name__ == "__main__":
    draw_walk()
