import numpy as np
import pytest
from walking import generate_walk

from mocap.blending.mixing import mix
from mocap.blending.registering import register
from mocap.errors import MocapError
from mocap.methods.match_webs import blend_of, mean_speed, sample_space
from tests.methods.match_webs.spaces_of_walks import gait, space


@pytest.fixture(scope="module")
def three():
    return register([generate_walk([[0, 0], [0, 3]], speed=speed) for speed in (0.8, 1.0, 1.2)])


def test_examples_are_samples_and_all_samples_are_what_their_blends_do():
    """As in [KG04, sampling]."""
    made = space(100)
    count = len(made.registration.clips)
    assert np.array_equal(made.weights[:count], np.eye(count))
    assert repr(made) == f"MotionSpace({count} examples, {count + 100} samples of 2 numbers)"
    for number in (0, 5, count, count + 50):
        blend = blend_of(made.registration, made.weights[number], fps=30)
        assert gait(blend) == pytest.approx(made.values[number], abs=0.3)
    with pytest.raises(ValueError, match="read-only"):
        made.values[0] = 0


def test_a_blend_by_few_is_the_blend_of_all(three):
    few = blend_of(three, [0, 0.3, 0.7])
    every = mix(three, [0, 0.3, 0.7])
    assert np.abs(few.rotations - every.rotations)[:, 1:].max() < 1e-9
    assert few.contacts.keys() == every.contacts.keys()
    step = [np.linalg.norm(np.diff(motion.root_positions, axis=0), axis=1) for motion in (few, every)]
    assert np.allclose(*step, atol=1e-9)
    assert len(blend_of(three, [0, 1, 0])) == len(mix(three, [0, 1, 0]))


def test_without_a_scale_numbers_count_by_how_much_they_vary(three):
    made = sample_space(three, lambda motion: (mean_speed(motion), 7.0), count=4)
    assert made.scale == pytest.approx([made.values[:, 0].std(), 1.0])


@pytest.mark.parametrize(
    ("measure", "settings", "message"),
    [
        (lambda m: (1.0, 2.0, 3.0), {}, "A measure of 3 numbers needs 4 examples, got 3"),
        (lambda m: np.nan, {}, r"A measure gives 1 finite numbers for each blend; .* gave \[nan\]"),
        (lambda m: [1.0] * (1 + (mean_speed(m) > 1)), {}, "A measure gives 1 finite numbers for each blend"),
        (lambda m: [[1.0]], {}, "finite numbers for each blend"),
        (mean_speed, {"count": -1}, "Take 0 samples or more, got -1"),
        (mean_speed, {"scale": [0]}, "A scale is 1 numbers above 0"),
        (mean_speed, {"scale": [1, 2]}, "A scale is 1 numbers above 0"),
    ],
)
def test_hostile_input_is_one_sentence(three, measure, settings, message):
    with pytest.raises(MocapError, match=message) as caught:
        sample_space(three, measure, **{"count": 3, **settings})
    assert len(str(caught.value)) <= 200


def test_a_blend_needs_as_many_weights_as_clips(three):
    with pytest.raises(MocapError, match="A blend of 3 clips needs 3 weights"):
        blend_of(three, [0.5, 0.5])
