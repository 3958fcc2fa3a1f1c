"""Weights that sliders change while a blend plays, without a browser."""

import numpy as np
import pytest

from mocap.blending import register
from mocap.body.kinematics import joint_positions
from mocap.errors import MocapError
from mocap.widgets.live_mixing import Mixer
from tests.blending.registered import turned, walks

pytest.importorskip("anywidget")


@pytest.fixture
def mixer():
    return Mixer(register([walks()[1.1, 120], walks()[1.1, -120]]), [1, 0])


def shown(mixer):
    return mixer.player.player.motions[0]


def test_what_was_played_stays_and_the_rest_changes(mixer):
    before = shown(mixer)
    mixer.player.at = [mixer.player.scene["number"], 45]  # as the browser sends it
    mixer.sliders[1].value = 1.0
    mixer.sliders[0].value = 0.0
    after = shown(mixer)
    np.testing.assert_allclose(joint_positions(after)[:45], joint_positions(before)[:45], atol=1e-6)
    assert np.abs(joint_positions(after)[-1] - joint_positions(before)[-1]).max() > 0.3
    assert turned(before) > 60 and turned(after) < 0.5 * turned(before)


def test_the_player_goes_on_from_the_frame_that_it_showed(mixer):
    mixer.player.frame = 40
    mixer.sliders[1].value = 0.5
    assert mixer.player.frame == 40
    assert mixer.player.move == [mixer.player.scene["number"], 40]
    assert mixer.player.scene["autoplay"] and mixer.player.scene["reports"]


def test_changes_after_the_frame_are_forgotten(mixer):
    for frame, value in ((60, 1.0), (20, 0.5), (25, 0.0)):
        mixer.player.frame = frame
        mixer.sliders[1].value = value
    assert [change.time for change in mixer.changes] == pytest.approx([20 / 30, 25 / 30])
    assert mixer.weights(0, 9).tolist() == [1, 0]
    assert mixer.weights(0, 20 / 30).tolist() == [1, 0]
    weights = np.array([mixer.weights(0, t) for t in np.linspace(0, 3, 200)])
    np.testing.assert_allclose(weights.sum(axis=1), 1)


def test_all_sliders_at_0_change_nothing(mixer):
    mixer.sliders[0].value = 0.0
    assert not mixer.changes and "2 clips" in repr(mixer)


def test_clips_of_one_name_are_numbered():
    mixer = Mixer(register([walks()[1.1, 120], walks()[1.1, -120]]))
    assert [slider.description for slider in mixer.sliders] == ["walk 1", "walk 2"]
    assert mixer.start.tolist() == [0.5, 0.5]


@pytest.mark.parametrize(
    ("weights", "ease", "message"), [([1, 1], 0.4, "add up to 1"), ([1, 0], 0.0, "more than 0 s")]
)
def test_what_cannot_be_steered_is_refused(weights, ease, message):
    with pytest.raises(MocapError, match=message):
        Mixer(register([walks()[1.1, 120], walks()[1.1, -120]]), weights, ease=ease)
