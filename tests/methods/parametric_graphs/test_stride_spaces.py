"""What is asked is got; what is near in parameters is near in motion; and two traps are traps."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mocap.errors import MocapError, MocapWarning
from mocap.methods.parametric_graphs.made_strides import near_strike
from mocap.methods.parametric_graphs.stride_spaces import (
    StrideSpace,
    draw_parameters,
    make_space,
    measure_mixes,
    neighbours,
)
from mocap.methods.parametric_graphs.strides import cut_strides
from tests.methods.parametric_graphs.built import clips, space, strides


def asked_and_got(tested, goals):
    got = measure_mixes(tested.strides, tested.weights(goals))[:, tested.columns]
    return np.degrees(np.abs(got - goals))


@pytest.mark.parametrize("feet", ["lrl", "lr", "rl"])
def test_what_is_asked_is_got(feet):
    """As in [HG07, nodes]."""
    tested = space(feet)
    off = asked_and_got(tested, draw_parameters(tested, 300, np.random.default_rng(5)))
    assert off.max() <= 1.0 and off.mean() <= 0.3


def test_two_parameters_are_met_where_clips_fill_them():
    both = make_space(strides(), [0.2, 0.1], [-0.8, 0.7], [0.8, 0.9], parameters=("turn", "speed"))
    goals = draw_parameters(both, 200, np.random.default_rng(1))
    got = measure_mixes(both.strides, both.weights(goals))
    assert np.degrees(np.abs(got - goals)[:, 0]).mean() < 1.5
    assert np.abs(got - goals)[:, 1].mean() < 0.01


@given(st.lists(st.floats(0.01, 10), min_size=3, max_size=6))
def test_weights_of_neighbours_add_up_to_one_and_the_farthest_has_none(gaps):
    near, weights = neighbours(np.zeros((1, 1)), np.array(gaps)[:, None], np.ones(1), len(gaps))
    assert weights.sum() == pytest.approx(1) and (weights >= 0).all()
    if max(gaps) > min(gaps):
        assert weights[0, -1] == 0
    assert (np.diff(np.array(gaps)[near[0]]) >= 0).all()


def test_the_formula_of_the_paper():
    """As in [HG07, Eqs. 1-2]."""
    _, weights = neighbours(np.zeros((1, 1)), np.array([[1.0], [2], [4]]), np.ones(1), 3)
    np.testing.assert_allclose(weights, [[0.75, 0.25, 0]])
    _, weights = neighbours(np.zeros((1, 1)), np.array([[1.0], [2]]), np.ones(1), 2)
    np.testing.assert_allclose(weights, [[1, 0]])


def test_the_range_is_cut_to_what_the_strides_come_to():
    wide = make_space(strides(), 0.2, -9.0, 9.0)
    assert wide.low[0] > -2.5 and wide.high[0] < 2.5
    np.testing.assert_array_equal(wide.clipped([[-9.0], [9.0]]), [wide.low, wide.high])


@pytest.mark.parametrize(
    ("settings", "sentence"),
    [
        ({"parameters": ("height",)}, "asked by 'turn', 'speed' or both, got height"),
        ({"parameters": ()}, "got none"),
        ({"parameters": ("turn", "turn")}, "asked by"),
        ({"width": 0.0}, "a width above 0"),
        ({"low": 0.5, "high": 0.5}, "A range has ends low < high"),
        ({"low": [0.1, 0.2]}, "A range has ends low < high"),
        ({"high": np.nan}, "A range has ends low < high"),
        ({"low": 20.0, "high": 21.0}, r"Only 0 of 120 .*: they come to a turn of 97° to 97°\."),
    ],
)
def test_what_makes_no_sense_is_refused(settings, sentence):
    asked = {"width": 0.2, "low": -0.5, "high": 0.5, **settings}
    with pytest.raises(MocapError, match=sentence):
        make_space(strides(), asked.pop("width"), asked.pop("low"), asked.pop("high"), **asked)


def some(count, spread=1.0):
    """Strides evenly spread over the turns, as many as asked for."""
    turns = strides().values[:, 0]
    wanted = np.linspace(-spread, spread, count)
    return strides().take(np.isin(np.arange(len(turns)), np.abs(turns - wanted[:, None]).argmin(axis=1)))


def test_too_few_strides_are_refused_with_what_helps():
    with pytest.raises(
        MocapError, match=r"asked by turn takes 3 strides or more, got 2: add clips, or longer"
    ):
        make_space(some(2), 0.2, -0.5, 0.5)
    with pytest.raises(MocapError, match="asked by turn and speed takes 4 strides or more, got 3"):
        make_space(some(3), [0.2, 0.1], [-0.5, 0.7], [0.5, 0.9], parameters=("turn", "speed"))


def test_a_range_of_two_parameters_that_hardly_any_sample_lies_in_is_refused():
    with pytest.raises(
        MocapError, match=r"Only \d of 400 samples lie in the range: they come to a turn of .* and a speed of"
    ):
        make_space(strides(), [0.2, 0.1], [0.3, 0.7], [0.301, 0.71], parameters=("turn", "speed"))


def test_strides_that_do_not_vary_are_refused():
    straight = cut_strides([clips()[3]])
    with pytest.raises(MocapError, match=r"hardly vary, with a turn of -1° to 1°: ask by something else"):
        make_space(straight, np.radians(14), -0.5, 0.5)
    with pytest.warns(MocapWarning, match="of 7 strides are near a speed of 1"):
        by_speed = make_space(straight, 0.02, 1.0, 1.2, parameters=("speed",))
    assert by_speed.high[0] > 1.1


def test_a_range_with_gaps_is_said():
    with pytest.warns(MocapWarning, match=r"Only \d of \d+ strides are near a turn of -?\d+°: blends there"):
        make_space(some(8, 1.2), 0.1, -1.2, 1.2)


def test_weights_never_reach_beyond_the_outermost_samples():
    tested = space()
    far = tested.weights([[-9.0], [9.0]])
    np.testing.assert_allclose(far.sum(axis=1), 1)
    ends = measure_mixes(tested.strides, far)[:, 0]
    assert tested.values.min() - 0.02 <= ends[0] < ends[1] <= tested.values.max() + 0.02


def test_corners_of_a_box_of_two_parameters_hold_strides_that_no_clip_has():
    """Asked for anything in the box, degrees are off; drawn among the samples, a tenth of that."""
    both = make_space(strides(), [0.2, 0.1], [-1.2, 0.6], [1.2, 1.1], parameters=("turn", "speed"))
    random = np.random.default_rng(2)
    anywhere = random.uniform(both.low, both.high, (200, 2))
    among = draw_parameters(both, 200, random)
    off = [np.abs(measure_mixes(both.strides, both.weights(a)) - a)[:, 0] for a in (anywhere, among)]
    assert np.degrees(off[0].max()) > 10 and off[0].mean() > 4 * off[1].mean()


def test_a_change_of_two_degrees_changes_the_clip_by_millimetres():
    """Where windows are compared: a bell's space, a narrow bell's, and raw strides, the nearest few."""
    smooth, changes = space(), []
    raw = StrideSpace(
        smooth.strides, ("turn",), smooth.strides.values[:, :1], np.eye(98), smooth.low, smooth.high
    )
    asked = np.linspace(-1.1, 1.1, 60)[:, None]
    for tested in (smooth, raw):
        one, other = (near_strike(tested, a, 0.0)[0] for a in (asked, asked + np.radians(2)))
        changes.append(100 * np.median(np.sqrt(((one - other) ** 2).sum(axis=-1).mean(axis=(1, 2)))))
    assert changes[0] < 0.4 and changes[1] > 1.2 > 4 * changes[0]
