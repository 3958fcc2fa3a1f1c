"""The diagrams draw what they drew when they were last looked at; tests/drawn.py says how to draw anew.

Of small_graphs, branching, layers, poses, windows, laying_clouds, ground, seams and pens.
"""

import numpy as np
import pytest
from matplotlib.figure import Figure

from mocap import Motion, datasets, graphs, resample
from mocap.blending import align_window, cubic_weights, join
from mocap.body import GroundPath, PlanarTransform, Skeleton, arcs, rotations
from mocap.course import diagrams
from mocap.course.diagrams.layers import STRIDE
from mocap.course.diagrams.windows import draw_matched, storyboard
from mocap.course.lab.choices import Choices, Pick
from mocap.course.seam_trials import Passage
from mocap.matching import point_cloud
from tests.drawn import hold

EIGHT = graphs.notes_example()
WALK = datasets.sample("walk_straight")
WINDOW = resample(WALK, 30)[100:110]
PAIR = [resample(datasets.sample(f"walk_curve_{n}"), 30)[at : at + 10] for n, at in ((1, 50), (2, 20))]
CORNER = GroundPath([[0, 0], [0, 3], [3, 3]])
CUT = arcs((0, 0), 0.0, [(1.5, 0), (0.75 * np.pi, np.pi / 2), (1.5, 0)])  # a quarter circle of 1.5 m


def drawn(draw, *settings):
    """Draw one figure again and again, as an experiment does."""
    return (draw(*each if isinstance(each, tuple) else [each]) for each in settings)


def threads():
    ax = Figure().add_subplot()
    draw_matched(ax, WINDOW, PlanarTransform(0.0, 0.0, 0.4).apply_motion(WINDOW))
    return ax


def fitted(points, angle):
    """Lay points on those of the pair's first, turned by so much."""
    turn, mean = PlanarTransform(angle, 0.0, 0.0), point_cloud(PAIR[0]).reshape(-1, 3).mean(0)
    return turn.apply_points(points) + (mean - turn.apply_points(points).mean(0)) * [1, 0, 1]


def added(*terms):
    parts = WALK[490:560], align_window(WALK, 500, WALK, 233, 12)[223:293]
    blended = Passage(join(WALK, 500, WALK, 233, 12)[490:560], *parts, 10, cubic_weights(12))
    return diagrams.added_by_blend(terms)(blended, *[blended.gap[1:-1]] * len(terms))


LINE = GroundPath([[0, 0], [0, 2.1], [0.7, 2.1], [0.7, 0]]).at(STRIDE * np.arange(8)) @ [1j, 1]
EVEN = np.linspace(0, 1, 5)
WAYS = {"even": rotations.about_y(EVEN), "late": rotations.about_y(EVEN**2)}
PRODUCTS = np.random.default_rng(0).integers(0, 10, (7, 9))
NAMES = ["lfoot", "head"]
MOVED = PlanarTransform(2.0, 1.5, -0.7)
CIRCLE = datasets.sample("walk_circle")


def boards():
    """Show a seam in panels, and one of a body without legs."""
    walks = [resample(datasets.sample(f"walk_curve_{n}"), 30)[:120] for n in (1, 2)]
    choices = Choices(tuple(walks), 10, Pick(0, 56, 1, 20, 20, 20))
    for depth in (1, 2, 3, 4):
        show = ["windows", "turn", "weights", "seam"][:depth]
        yield storyboard(lambda ax: ax.plot(0, 0), choices.pair, choices.seam, show)
    pair = Skeleton(["root", "tip"], [-1, 0], [[0, 0, 0], [0, 1, 0]])
    pole = Motion(pair, np.linspace(0, [0, 1, 2], 30), np.tile([1.0, 0, 0, 0], (30, 2, 1)), 30.0, "pole")
    choices = Choices((pole, pole), 2, Pick(0, 0, 1, 5, 0, 0))
    yield storyboard(lambda ax: None, choices.pair, choices.seam, ["windows", "turn", "weights"])


PICTURES = {
    "storyboard": boards,
    "tarjan": lambda: drawn(diagrams.tarjan_steps(EIGHT), *range(22), 99),
    "eight nodes": lambda: [
        diagrams.eight_node_graph(EIGHT, beside={1: "one"}, thick=[(3, 1)], parts=[{4}, {5}])
    ],
    "search": lambda: drawn(diagrams.search_steps(EIGHT, 6, 2), 0, 1, 4, 9, 99),
    "from above": lambda: [diagrams.from_above([1j * EVEN + EVEN**2], tried=[EVEN, 1j * EVEN], goal=3j)],
    "nodes and edges": lambda: map(diagrams.nodes_and_edges, range(6)),
    "layers": lambda: drawn(diagrams.layer_steps(LINE, 5), (0, 4, True), (18, 4, True), (99, 2, False)),
    "window": lambda: (diagrams.window_cloud(WINDOW, step=step) for step in (1, 2, 3, 4)),
    "threads": lambda: [threads()],
    "sums": lambda: (diagrams.diagonal_sums(PRODUCTS, window=4, step=step) for step in (1, 2, 3, 4)),
    "radius gaps": lambda: (diagrams.radius_gaps(*PAIR, NAMES, step=step) for step in (1, 2, 3)),
    "laying on": lambda: (diagrams.laying_on(*PAIR, step=step) for step in (1, 2, 3, 4)),
    "turning": lambda: drawn(diagrams.turning(*PAIR, fitted), 60, -90),
    "laid by hand": lambda: [diagrams.laid(*PAIR, lambda points: points + np.array([0, 0, 3]))],
    "alignment": lambda: (
        diagrams.alignment(CIRCLE[:200], CIRCLE[400:600], MOVED, shift_first=first) for first in (False, True)
    ),
    "half turns": lambda: (diagrams.half_turns(*how) for how in ((0,), (1,), (2,), (2, -170))),
    "orders": lambda: [diagrams.turns_in_order(WALK.skeleton, rotations.multiply)],
    "down the tree": lambda: drawn(diagrams.down_the_tree(WALK[100:120], 7), 0, 5, 37),
    "two distances": lambda: drawn(diagrams.two_distances(CORNER, CUT), 0, 4, 8),
    "seam": lambda: (diagrams.blended_seam(*how) for how in ((1,), (2,), (3,), (4,), (4, 5))),
    "ways": lambda: (diagrams.turning_paths(WAYS, share=share) for share in (0.25, 0.5)),
    "knee": lambda: (diagrams.knee_triangle(*how) for how in ((1,), (2, 0.7), (3,))),
    "added": lambda: [added(), added("term")],
}


@pytest.mark.parametrize("name", PICTURES)
def test_a_diagram_is_drawn_as_ever(name):
    hold(__file__, name, PICTURES[name]())
