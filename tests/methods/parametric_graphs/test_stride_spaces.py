"""What is asked is got; what is near in parameters is near in motion; and two traps are traps."""

from dataclasses import replace

import numpy as np
import pytest

from mocap.methods.match_webs import weights_for
from mocap.methods.parametric_graphs import cut_strides, make_space, measure_mixes
from mocap.methods.parametric_graphs.made_motions import near_end
from mocap.methods.parametric_graphs.stride_spaces import draw_parameters, place_evenly
from tests.methods.parametric_graphs.built import BOTH, by_turn_and_speed, clips, missed, space, strides
from tests.refusals import refused

WIDE = ((0.2, 0.1), (-1.2, 0.6), (1.2, 1.1))


@pytest.mark.parametrize("feet", ["lrl", "lr", "rl"])
def test_what_is_asked_is_got(feet):
    """As in [HG07, nodes]."""
    tested = space(feet)
    off = missed(tested, draw_parameters(tested, 300, np.random.default_rng(5)))
    assert off.max() <= 0.1 and off.mean() <= 0.01


def test_two_parameters_are_met_where_clips_fill_them_and_corners_hold_strides_that_no_clip_has():
    """Asked for anything in the box, degrees are off; drawn among the samples, a tenth of that."""
    both, random = by_turn_and_speed(*WIDE), np.random.default_rng(2)
    anywhere = random.uniform(both.low, both.high, (200, 2))
    corners, among = missed(both, anywhere), missed(both, draw_parameters(both, 200, random))
    assert among.mean(axis=0)[0] < 1.5 and among.mean(axis=0)[1] < 0.01
    assert corners[:, 0].max() > 10 and corners[:, 0].mean() > 4 * among[:, 0].mean()


def test_sources_are_placed_evenly_and_at_the_ends():
    """For several parameters only where the space reaches: the corners of its range may hold no stride."""
    one, both = space(), by_turn_and_speed(*WIDE)
    np.testing.assert_allclose(place_evenly(one, 9), np.linspace(one.low, one.high, 9))
    at = place_evenly(both, 40)
    assert missed(both, at)[:, 0].max() < 2
    for end in ("min", "max"):
        np.testing.assert_array_equal(getattr(at, end)(axis=0), getattr(both.reached, end)(axis=0))

    def nearest(some):
        gaps = np.linalg.norm((both.reached[:, None] - some) / both.scale, axis=-1)
        return gaps.min(axis=1).max()

    drawn = [draw_parameters(both, 40, np.random.default_rng(seed)) for seed in range(10)]
    assert nearest(at) < 0.7 * min(map(nearest, drawn))


def test_the_range_is_cut_to_what_the_strides_come_to_and_weights_never_reach_beyond():
    wide, tested = make_space(strides(), 0.2, -9.0, 9.0), space()
    assert wide.low[0] > -2.5 and wide.high[0] < 2.5
    far = weights_for(tested, [[-9.0], [9.0]])
    np.testing.assert_allclose(far.sum(axis=1), 1)
    ends = measure_mixes(tested.examples, far)[:, 0]
    assert tested.values.min() - 0.02 <= ends[0] < ends[1] <= tested.values.max() + 0.02


def test_a_change_of_two_degrees_changes_the_clip_by_millimetres():
    """Where windows are compared: a bell's space, and raw strides, the nearest few."""
    smooth, changes = space(), []
    count = len(smooth.examples)
    raw = replace(smooth, weights=np.eye(count), values=smooth.examples.values[:, :1])
    asked = np.linspace(-1.1, 1.1, 60)[:, None]
    for tested in (smooth, raw):
        one, other = (near_end(tested, a, 0.0)[0] for a in (asked, asked + np.radians(2)))
        changes.append(100 * np.median(np.sqrt(((one - other) ** 2).sum(axis=-1).mean(axis=(1, 2)))))
    assert changes[0] < 0.4 and changes[1] > 1.2 > 4 * changes[0]


def some(count, spread=1.0):
    """Strides evenly spread over the turns, as many as asked for."""
    turns = strides().values[:, 0]
    wanted = np.linspace(-spread, spread, count)
    return strides().take(np.isin(np.arange(len(turns)), np.abs(turns - wanted[:, None]).argmin(axis=1)))


@pytest.mark.parametrize(
    ("settings", "sentence"),
    [
        ({"parameters": ("height",)}, "asked by 'turn', 'speed' or both, got height"),
        ({"parameters": ()}, "got none"),
        ({"parameters": ("turn", "turn")}, "asked by"),
        ({"low": 0.5, "high": 0.5}, "A range has ends low < high"),
        ({"high": np.nan}, "A range has ends low < high"),
        ({"low": 20.0, "high": 21.0}, r"Only 0 of 120 .*: they come to a turn of 97° to 97°\."),
        ({"strides": 2}, "takes 3 strides or more that vary, got 2 with a turn of"),
        (
            {"width": (0.2, 0.1), "low": (0.3, 0.7), "high": (0.301, 0.71), "parameters": BOTH},
            r"Only \d of 400 samples lie in the range: they come to a turn of .* and a speed of",
        ),
        ({"strides": "straight"}, "that vary, got 7 with a turn of -1° to 1°: add clips"),
    ],
)
def test_what_makes_no_sense_is_refused(settings, sentence):
    asked = {"strides": strides(), "width": 0.2, "low": -0.5, "high": 0.5, **settings}
    asked["strides"] = {2: lambda: some(2), "straight": lambda: cut_strides([clips()[3]])}.get(
        settings.get("strides"), strides
    )()
    refused(sentence, make_space, **asked)
