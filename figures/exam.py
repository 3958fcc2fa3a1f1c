"""The pictures of the exam questions: `python figures/exam.py` writes `notebooks/teaching/exam-*.png`."""

from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib import pyplot as plt

from mocap import datasets, matching, plotting, resample

FOLDER = Path(__file__).parents[1] / "notebooks" / "teaching"
WALKS = {"A": [4.1, 5.2, 6.0, 7.4, 9.9], "B": [3.9, 4.6, 5.1, 7.0, 11.2]}  # cm off, invented for the question


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
    for draw in (draw_grid, draw_curve):
        draw()
