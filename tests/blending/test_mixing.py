"""Blends of registered clips: what must come out exactly, the bars for walks, and the ways that fail."""

from dataclasses import replace

import numpy as np
import pytest
from walking import generate_walk

from mocap._shared.arrays import runs
from mocap.blending import crossfade, frame_times, ground_course, mix, register
from mocap.body import PlanarTransform, resample
from mocap.feet import clean_up
from mocap.matching.point_clouds import align, point_cloud
from tests.blending import registered
from tests.blending.registered import HALF, captured, skate, slides, turned, walks
from tests.refusals import quietly, refusals

LEFT_AND_RIGHT = (1.1, -120), (1.1, 120)


def generated(*which):
    return register([walks()[one] for one in which])


def of_parts(registration, measure):
    return np.array([measure(part) for part in registration.parts])


def largest_gap(first, second):
    """How far apart the points of two motions are, once the first frames lie on one another, metres."""
    a, b = point_cloud(first), point_cloud(second)
    return float(np.abs(a - align(a[0], b[0]).apply_points(b)).max())


def quarter_circles(frames=181, radius=2.0):
    """The ways of a walk to the left and one to the right, by a quarter of a circle: θ and z + ix, (2, F)."""
    angle = np.linspace(0, np.pi / 2, frames)
    turns = np.stack([angle, -angle])
    return turns, radius * np.stack([1j * (np.exp(-1j * angle) - 1), 1j * (1 - np.exp(1j * angle))])


def test_a_left_and_a_right_quarter_make_a_straight_line_as_long_as_they_are():
    """As in [KG03, blend]."""
    turns, centres = quarter_circles()
    course = ground_course(turns, centres, np.full((181, 2), 0.5))
    assert abs(course.centres[-1]) == pytest.approx(np.pi, abs=2e-5)
    assert np.abs(course.centres.imag).max() < 1e-12
    assert abs(centres.mean(axis=0)[-1]) == pytest.approx(2.0)  # the mean of the places: 0.64 of the way


@pytest.mark.parametrize("which", [0, 1])
def test_a_clip_with_all_the_weight_comes_back(which):
    registration = generated(*LEFT_AND_RIGHT)
    blend = mix(registration, np.eye(2)[which])
    seconds = float(registration.times[which](registration.span[0])) + np.arange(len(blend)) / 120
    assert largest_gap(blend, registered.at_times(registration.clips[which], seconds)) <= 1e-9


def test_a_blend_does_not_depend_on_where_its_clips_were_captured():
    """As in [KG03, blend]."""
    a, b = (walks()[which] for which in LEFT_AND_RIGHT)
    blend = mix(register([a, b]), HALF)
    moved = mix(register([a, PlanarTransform(2.0, 100.0, -50.0).apply_motion(b)]), HALF)
    np.testing.assert_allclose(point_cloud(moved), point_cloud(blend), atol=1e-9)


def test_generated_walks_to_the_left_and_the_right_make_one_straight_on():
    registration = generated(*LEFT_AND_RIGHT)
    blend = mix(registration, HALF)
    length = of_parts(registration, registered.way).mean()
    assert 0.98 <= registered.way(blend) / length <= 1.02
    assert turned(blend) == pytest.approx(of_parts(registration, turned).mean(), abs=1)
    assert skate(blend) <= 4 * of_parts(registration, skate).mean()
    assert slides(blend).mean() <= 0.7


PAIRS = [("16_15", "16_21"), ("16_31", "16_22"), ("16_47", "16_21")]
PAIRS += [("16_15", "16_22"), ("16_31", "16_21"), ("16_58", "16_22")]


def test_captured_walks_of_two_speeds_stay_in_step(real_data):
    ratios = []
    for names in PAIRS:
        a, b = (captured(real_data, name) for name in names)
        registration = register([a, b])
        own, knee = of_parts(registration, skate).mean(), of_parts(registration, registered.knees).mean()
        ways = (
            mix(registration, HALF),
            registered.frame_by_frame(a, b),
            registered.frame_by_frame(a, b, stretch=True),
        )
        ratios.append([*(skate(m) / own for m in ways), *(registered.knees(m) / knee for m in ways)])
    ours, frames, stretched, knee, knee_of_frames, knee_stretched = np.array(ratios).T
    assert ours.max() <= 1.0 and np.all(ours <= frames / 2)
    assert np.median(ours) <= np.median(frames) / 3 and np.median(ours) <= np.median(stretched) / 3
    assert knee.min() >= 0.9 > max(np.median(knee_of_frames), np.median(knee_stretched))


def swinging(u, t):
    left = 0.5 + 0.5 * np.sin(np.pi * t)
    return [0.2, 0.8 * left, 0.8 * (1 - left)]


def test_weights_may_swing_from_left_to_right_and_back(real_data):
    registration = register([captured(real_data, name) for name in ("16_15", "16_17", "16_19")])
    blend = mix(registration, swinging)
    assert skate(blend) <= 1.2 * of_parts(registration, skate).mean()
    assert jolts(blend, 95) <= np.mean([jolts(part, 95) for part in registration.parts])


def jolts(motion, percentile):
    """A percentile of the changes of velocity from frame to frame, RMS over the points, m/s."""
    changes = np.diff(point_cloud(motion), 2, axis=0) * motion.fps
    return float(np.percentile(np.sqrt((changes**2).sum(-1).mean(-1)), percentile))


def test_plants_of_captured_blends_stand_still_after_the_clean_up(real_data):
    for names in (("16_15", "16_21"), ("16_17", "16_19"), ("16_15", "16_17")):
        registration = register([captured(real_data, name) for name in names])
        blend = mix(registration, HALF)
        assert 11 <= len(registration.contacts) <= 16 and slides(blend).mean() <= 2.5
        clean = quietly(clean_up, blend)
        assert slides(clean).max() <= 1e-9
        assert np.abs(point_cloud(clean) - point_cloud(blend)).max() <= 0.08


def test_weights_may_move_while_a_blend_plays():
    """As in [KG03, continuous control]: it turns as one clip does, and then as the other."""
    registration = generated(*LEFT_AND_RIGHT)
    blend = mix(registration, lambda u, t: [1.0, 0.0] if u < np.mean(registration.span) else [0.0, 1.0])
    half = len(blend) // 2
    assert turned(blend[:half]) < -20 and turned(blend[half:]) > 20


@pytest.mark.filterwarnings("ignore:'walk' and 'sneak' may not")
def test_marks_are_the_matched_plants_and_the_labels_of_the_heaviest():
    """As in [KG03, blended plants]."""
    walk = generate_walk([[0, 0], [0, 5]], speed=1.0)
    sneak = generate_walk([[0, 0], [0, 5]], speed=0.8, style="sneak")
    registration = register([walk, sneak])
    for weights, label in (([0.6, 0.4], "walk"), ([0.4, 0.6], "sneak")):
        blend = mix(registration, weights)
        assert blend.labels[label].all() and set(blend.contacts) <= set(walk.contacts)
        times, _ = frame_times(registration, weights, fps=blend.fps)
        joint, plant = registration.contacts[1]
        ends = plant @ weights - times[blend.contacts[joint]][:, None]
        assert np.abs(ends).min(axis=0).max() < 1 / blend.fps
    bare = register([replace(clip, labels={}, contacts={}) for clip in (walk, sneak)])
    assert not mix(bare, HALF).labels and not mix(bare, HALF).contacts
    assert mix(bare, HALF).name == "walk + sneak"


def test_a_blend_may_have_another_rate_and_less_exact_rotations():
    registration = generated((0.8, 0), (1.4, 0))
    fine, coarse = mix(registration, HALF), mix(registration, HALF, fps=30.0)
    assert coarse.fps == 30 and largest_gap(resample(fine, 30.0), coarse) < 0.01
    assert largest_gap(fine, mix(registration, HALF, rounds=0)) < 0.001


FADES = [((0.8, 0), (1.4, 0)), ((1.1, -120), (1.1, 120))]


@pytest.fixture(scope="module", params=FADES, ids=["faster", "the other way"])
def registration(request):
    return generated(*request.param)


def test_it_starts_as_the_one_and_ends_as_the_other(registration):
    """As in [KG03, transition]."""
    made = crossfade(registration)
    first, second = registration.clips
    assert largest_gap(made[:60], first[:60]) < 1e-9
    late = float(registration.times[1].inverse(second.duration))
    assert late > registration.span[1]
    ends = [
        largest_gap(
            made[-60:], registered.at_times(second, second.duration - shift - np.arange(60)[::-1] / 120)
        )
        for shift in np.linspace(0, 1 / 120, 40)
    ]
    assert min(ends) < 1e-3
    assert made.duration < first.duration + second.duration and made.name == "walk to walk"


def test_the_longer_the_fade_the_less_its_plants_slide(registration):
    strays = [slides(crossfade(registration, seconds=seconds)).max() for seconds in (0.33, 1.0, 2.0)]
    assert strays == sorted(strays, reverse=True)
    assert strays[2] <= 2.5


def test_the_reference_is_left_and_the_other_entered():
    slow, brisk = walks()[0.8, 0], walks()[1.4, 0]
    slowing = crossfade(register([slow, brisk], reference=1))
    speeds = [registered.way(part) / part.duration for part in (slowing[:60], slowing[-60:])]
    assert speeds[0] > 1.2 and speeds[1] < 0.95


def test_plants_are_those_of_the_clips_and_of_both(registration):
    made = crossfade(registration)
    first, second = registration.clips
    assert set(made.contacts) == set(first.contacts)
    for joint in made.contacts:
        before = int(120 * (sum(registration.span) / 2 - 0.5))
        assert np.array_equal(made.contacts[joint][:before], first.contacts[joint][:before])
        count = len(runs(made.contacts[joint]))
        assert count <= len(runs(first.contacts[joint])) + len(runs(second.contacts[joint]))


def fade(**settings):
    return crossfade(generated(*FADES[0]), **settings)


test_what_is_no_fade_is_refused = refusals(
    ("longer than 0 s, got 0", lambda: fade(seconds=0)),
    ("longer than 0 s, got nan", lambda: fade(seconds=np.nan)),
    (
        r"A fade from -\d+.\d\d to \d+.\d\d s does not lie within the \d.\d\d to \d.\d\d s",
        lambda: fade(seconds=99.0),
    ),
)
