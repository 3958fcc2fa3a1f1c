"""Trials of the constants of parametric graphs: `python figures/tune/parametric_graphs.py [--quick]`.

Strides of the clips, as a space by their turn, and an edge from this space to itself.

- Strides: how many are cut from the clips, and the spread of their seconds, percent of the mean.
- Space: the range of turns that it reaches. Missed: the largest error of a turn that is asked for.
- Edge. Good: the percentage of targets that are in a box, on average. Bad: the percentage of fresh samples
  whose box holds a bad target. Cost: the mean RMS distance of the transitions in the boxes.
- Fitting: the range of turns of strides fitted to the clips, and the T_GOOD that their edge needs.
- Changes from walking to jogging, of the bundled clips. Examples: how many there are. Slide: the mean foot
  sliding distance of the changes.
"""

from functools import cache
from typing import Any

import numpy as np
from _trials import BUNDLED_WALKS, CAPTURED_WALKS, Clips, Collection, Row, Study, Trial

from mocap.methods.match_webs import weights_for
from mocap.methods.parametric_graphs import (
    build_edge,
    cut_strides,
    fit_strides,
    make_space,
    measure_mixes,
    tuned,
)
from mocap.methods.parametric_graphs.examples import Examples
from mocap.methods.parametric_graphs.made_motions import optimal_transitions
from mocap.methods.parametric_graphs.stride_changes import changing_strides
from mocap.methods.parametric_graphs.stride_spaces import draw_parameters
from mocap.quality import foot_sliding
from mocap.quality.seam_measures import mean_foot_sliding

WIDTH = np.radians(14)  # of the bell of a space
WIDEST = np.radians(75)  # of the turns of a space
GOOD = 0.03  # metres
FRESH = (40, 120)  # sources and targets that test an edge
CHANGES = 12  # that are measured, evenly chosen
JOG = Collection("a jog", ("jog",))


def strides(clips: Clips) -> Examples:
    """Cut strides; their margin is a default argument, so it is handed over."""
    return cut_strides(clips, margin=tuned.TUNED.margin)


@cache
def strides_once(clips: Clips) -> Examples:
    """Cut strides with the chosen constants."""
    return strides(clips)


def cutting(clips: Clips) -> Row:
    """Count strides, and measure their durations."""
    examples = strides(clips)
    seconds = examples.seconds[:, examples.ends[1]] - examples.seconds[:, examples.ends[0]]
    return {"strides": len(examples), "spread, %": 100 * float(seconds.std() / seconds.mean())}


def spaces(clips: Clips) -> Row:
    """Sample a space of turns, and ask it for turns."""
    space = make_space(strides_once(clips), WIDTH, -WIDEST, WIDEST)
    goals = np.linspace(space.low, space.high, 15)
    errors = np.abs(measure_mixes(space.examples, weights_for(space, goals))[:, :1] - goals)
    row = {"range, °": float(np.degrees(space.high - space.low)[0])}
    return row | {"missed, °": float(np.degrees(errors.max()))}


@cache
def space_of(clips: Clips) -> Any:  # noqa: ANN401 (a space of examples)
    """Make a space with the chosen constants."""
    return make_space(strides_once(clips), WIDTH, -WIDEST, WIDEST)


def edges(clips: Clips) -> Row:
    """Build an edge, and test its boxes on fresh samples."""
    space = space_of(clips)
    edge = build_edge(space, space, good=GOOD, sampling=tuned.TUNED.sampling)
    random = np.random.default_rng(99)
    sources = draw_parameters(space, FRESH[0], random)
    goals = draw_parameters(space, FRESH[1], random)
    boxes = [edge.look_up(parameters) for parameters in sources]
    cost, _, _ = optimal_transitions(space, space, sources, goals)
    inside = np.array([((goals >= box.low) & (goals <= box.high)).all(axis=1) for box in boxes])
    bad = ((cost > BAD * GOOD) & inside).any(axis=1)
    row = {"in a box, %": 100 * float(inside.mean()), "bad boxes, %": 100 * float(bad.mean())}
    return row | {"cost, cm": 100 * float(cost[inside].mean())}


def fitting(clips: Clips) -> Row:
    """Fit a graph of strides."""
    graph = fit_strides(list(clips), feet=("lrl",))
    space = graph.nodes["lrl"]["space"]
    needed = graph.edges["lrl", "lrl"]["edge"].smallest_good
    return {"range, °": float(np.degrees(space.high - space.low)[0]), "T_GOOD, cm": 100 * needed}


def changes(clips: Clips) -> Row:
    """Change from walking to jogging."""
    jogs = cut_strides(JOG.load() or (), label="jog")
    changing = changing_strides(strides_once(clips), jogs)
    slides = []
    for number in range(0, len(changing), max(1, len(changing) // CHANGES)):
        slides.append(mean_foot_sliding(foot_sliding(changing.blend(np.eye(len(changing))[number]))))
    return {"examples": len(changing), "slide, cm": float(np.mean(slides))}


BAD = 1.35  # times `GOOD`: what counts as bad in the test of boxes, whatever `bad` is
STEP_RANGES = ((0.4, 0.7), (0.1, 1.0), (0.23, 2.0))

# reads: statement: a table
TRIALS = {
    "step_seconds": Trial(cutting, STEP_RANGES),
    "calm": Trial(cutting, (np.radians(5), np.radians(30))),
    "straight": Trial(cutting, (np.radians(5), np.radians(60))),
    "straight_speed": Trial(cutting, (0.0, 0.8)),
    "margin": Trial(cutting, (0.2, 0.5)),
    "samples": Trial(spaces, (10, 30, 60, 240)),
    "span": Trial(edges, (0, 1, 6)),
    "neighbours": Trial(edges, (1, 2, 8)),
    "bad": Trial(edges, (2.0, 1.0, 1.2)),
    "sampling": Trial(edges, ((10, 100), (25, 400), (80, 1500))),
    "distance_from_bad": Trial(edges, (0.05, 0.0, 0.02)),
    "worst": Trial(fitting, (1.0, 2.0)),
    "pose_change": Trial(fitting, (1 / 30, 1 / 10)),
    "beyond_worst": Trial(fitting, (1.0, 1.5)),
    "most_range": Trial(fitting, (0.0, 1.0)),
    "fitting": Trial(fitting, ((15, 60), (100, 400))),
    "rotation_width": Trial(fitting, (np.radians(7), np.radians(28))),
    "change_from": Trial(changes, (0.45, 0.0, 0.3)),
    "change_to": Trial(changes, (0.55, 0.7, 1.0)),
    "step_phases": Trial(changes, ((0.3, 0.7), (0.0, 1.0), (0.15, 0.85))),
    "strike_phases": Trial(changes, (0, 5)),
    "rotation_beyond": Trial(changes, (0.0, np.radians(20))),
    "change_examples": Trial(changes, (20, 200)),
}
FIXED = {
    "good": "the threshold of motion graphs: larger seams show",
    "largest_rotation": "a stride that turns further is a turn on the spot; users set `limit`",
    "step_fraction": "a step turns by half of what a stride does, or a little more",
    "speed_width": "a third of the difference between a slow and a brisk walk, or less",
    "rotations_from": "examples that vary less than their Gaussian is wide are alike",
    "speeds_from": "examples that vary less than their Gaussian is wide are alike",
    "least_range": "a character of which less is left hardly obeys",
    "reported_loss": "a tenth of a range is not missed",
    "position_rounds": "an iteration that ends by itself; `settled` says when",
    "settled": "far below the centimetre by which a hand may miss its target",
}
STUDY = Study(tuned, TRIALS, FIXED, (BUNDLED_WALKS, CAPTURED_WALKS))

if __name__ == "__main__":
    STUDY.main(__doc__)
