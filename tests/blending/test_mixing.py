"""Known warps come back, strikes fall on strikes; what blends must be, the bars, and the ways that fail."""

import itertools
from dataclasses import replace

import numpy as np
import pytest
from walking import generate_walk

from mocap._shared.arrays import runs
from mocap.blending import crossfade, frame_times, ground_course, mix, register
from mocap.body import Motion, PlanarTransform, Skeleton, resample
from mocap.datasets import sample
from mocap.errors import SkeletonMismatch
from mocap.feet import clean_up
from mocap.matching.point_clouds import align, point_cloud
from tests.blending import registered
from tests.blending.registered import (
    HALF,
    at_times,
    captured,
    foot_sliding_speed,
    slides,
    strike_errors,
    turned,
    walks,
)
from tests.conftest import SWEEP
from tests.refusals import quietly, refusals, told, unwarned

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
    """Turned by one angle all along they would not [KG03, alignment]."""
    registration = generated(*LEFT_AND_RIGHT)
    blend = mix(registration, HALF)
    assert 0.98 <= registered.way(blend) / of_parts(registration, registered.way).mean() <= 1.02
    assert turned(blend) == pytest.approx(of_parts(registration, turned).mean(), abs=1)
    assert foot_sliding_speed(blend) <= 2.1 and slides(blend).mean() <= 0.45


PAIRS = [("16_15", "16_21"), ("16_31", "16_22"), ("16_47", "16_21")]
PAIRS += [("16_15", "16_22"), ("16_31", "16_21"), ("16_58", "16_22")]


def test_captured_walks_of_two_speeds_stay_in_step(real_data):
    ratios = []
    for names in PAIRS:
        a, b = (captured(real_data, name) for name in names)
        registration = register([a, b])
        own, knee = (
            of_parts(registration, foot_sliding_speed).mean(),
            of_parts(registration, registered.knees).mean(),
        )
        ways = [registered.frame_by_frame(a, b, stretch=stretch) for stretch in (False, True)]
        ways.insert(0, mix(registration, HALF))
        ratios.append(
            [*(foot_sliding_speed(m) / own for m in ways), *(registered.knees(m) / knee for m in ways)]
        )
    ours, frames, stretched, knee, knee_of_frames, knee_stretched = np.array(ratios).T
    assert ours.max() <= 1.0 and np.all(ours <= frames / 2)
    assert np.median(ours) <= np.median(frames) / 3 and np.median(ours) <= np.median(stretched) / 3
    assert knee.min() >= 0.9 > max(np.median(knee_of_frames), np.median(knee_stretched))


def swinging(u, t):
    left = 0.5 + 0.5 * np.sin(np.pi * t)
    return [0.2, 0.8 * left, 0.8 * (1 - left)]


def test_weights_may_swing_from_left_to_right_and_back(real_data):
    """Turns take a curve of angles: a straight line does not do [KG03, alignment]."""
    registration = register([captured(real_data, name) for name in ("16_15", "16_17", "16_19")])
    blend = mix(registration, swinging)
    assert foot_sliding_speed(blend) <= 1.2 * of_parts(registration, foot_sliding_speed).mean()
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
    start, end = registration.span
    for by, middle in ((0, (start + end) / 2), (1, (end - start) / 2)):  # the common clock, and its own time
        blend = mix(registration, lambda *now, by=by, middle=middle: np.eye(2)[int(now[by] >= middle)])
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
        changes = times[1:][np.diff(blend.contacts[joint])]
        assert np.abs(plant @ weights - changes[:, None]).min(axis=0).max() < 1 / blend.fps
    bare = mix(register([replace(clip, labels={}, contacts={}) for clip in (walk, sneak)]), HALF)
    assert bare.name == "walk + sneak" and not bare.labels and not bare.contacts


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
    """As in [KG03, transition; continuous control]."""
    made = crossfade(registration)
    first, second = registration.clips
    assert largest_gap(made[:60], first[:60]) < 1e-9
    assert registration.times[1].inverse(second.duration) > registration.span[1]
    shifts = (second.duration - shift - np.arange(60)[::-1] / 120 for shift in np.linspace(0, 1 / 120, 40))
    assert min(largest_gap(made[-60:], at_times(second, seconds)) for seconds in shifts) < 1e-3
    middle, shares = np.mean(registration.span), np.polynomial.Polynomial([0, 0, 3, -2])
    whole = replace(registration, span=(0.0, registration.span[1]))
    moving = mix(whole, lambda u, t: [1 - (s := shares(np.clip(u - middle + 0.5, 0, 1))), s])
    assert largest_gap(made[: len(moving)], moving) < 1e-6
    assert made.duration < first.duration + second.duration and made.name == "walk to walk"


def test_the_longer_the_fade_the_less_its_plants_slide(registration):
    # A fade that is shorter than a step may lie where one foot stands, and then hardly any plant slides.
    strays = [slides(crossfade(registration, seconds=seconds)).max() for seconds in (0.5, 1.0, 2.0)]
    assert strays == sorted(strays, reverse=True)
    assert strays[2] <= 2.2


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


def played_unevenly(clip, amount, angle=2.5):
    """The clip at 1 ± amount times its pace, turned and moved; and the clip's own time in each frame."""
    t = np.arange(len(clip)) / clip.fps
    own = t + amount * np.sin(4 * np.pi * t / clip.duration) * clip.duration / (4 * np.pi)
    return PlanarTransform(angle, 3.0, -2.0).apply_motion(at_times(clip, own)), own


def recovery(clip, amount):
    """How well a known warp comes back: RMS in ms, and the largest error of the angle in degrees."""
    warped, own = played_unevenly(clip, amount)
    registration = register([clip, warped], slack=0)
    u = np.linspace(*registration.span, 400)
    errors = np.interp(registration.times[1](u), np.arange(len(own)) / clip.fps, own) - u
    off = np.abs((registration.angles[1](u) + 2.5 + np.pi) % (2 * np.pi) - np.pi)
    return 1000 * np.sqrt((errors**2).mean()), np.degrees(off.max())


# From one compared frame to the next the bundled walk turns by up to 4.1°, and 16_15 by 2.3°.
@pytest.mark.parametrize(("amount", "ms", "bundled", "real"), [(0.3, 12, 3, 1.2), (0.6, 25, 6, 3)])
def test_a_known_warp_comes_back(real_data, amount, ms, bundled, real):
    for clip, degrees in ((walks()[1.1, 0], bundled), (captured(real_data, "16_15"), real)):
        late, off = recovery(clip, amount)
        assert late <= ms and off <= degrees


def test_a_clip_and_itself_turned_and_moved_are_registered_exactly():
    """As in [KG03, alignment]."""
    clip = walks()[1.1, 120]
    registration = register([clip, PlanarTransform(2.5, 80.0, -40.0).apply_motion(clip)], slack=0)
    u = np.linspace(*registration.span, 100)
    np.testing.assert_allclose(registration.times[1](u), u, atol=1e-9)
    np.testing.assert_allclose(registration.angles[1](u), -2.5, atol=1e-9)
    assert registration.span == pytest.approx((0, clip.duration), abs=1e-9)
    swerve = 2.5 + 0.3 * np.sin(np.arange(len(clip)) / clip.fps)  # no straight line comes nearer than 0.3
    swerving = register([clip, PlanarTransform(swerve, 80.0, -40.0).apply_motion(clip)], slack=0)
    np.testing.assert_allclose(swerving.angles[1](u), -2.5 - 0.3 * np.sin(u), atol=0.06)


def all_errors(clips, make):
    return np.array([e for a, b in itertools.permutations(clips, 2) for e in strike_errors(make(a, b))])


def laid(*clips, **settings):
    return quietly(register, clips, **settings)


def test_strikes_of_generated_walks_fall_on_strikes():
    """72 ordered pairs of nine walks; the strikes are exact by construction."""
    clips = list(walks().values())
    errors = all_errors(clips if SWEEP else clips[1::2], laid)
    assert len(errors) > (400 if SWEEP else 60)
    assert np.median(errors) <= 20 and np.percentile(errors, 90) <= 60 and errors.max() <= 100
    corners = all_errors(clips[::4], lambda a, b: laid(a, b, slack=0))
    free = all_errors(clips[::4], laid)
    assert np.mean(corners > 100) > np.mean(free > 100)


def test_the_reference_may_be_any_clip():
    """As in [KG03, several clips]."""
    clips = [walks()[speed, 0] for speed in (0.8, 1.1, 1.4)]
    strikes = [registered.strikes(clip)[0] for clip in clips]
    for reference in range(3):
        registration = register(clips, reference=reference)
        assert registration.reference == reference and registration.costs[reference] == 0
        u = np.linspace(*registration.span, 5)
        np.testing.assert_allclose(registration.times[reference](u), u, atol=1e-12)
        for clip, curve, own in zip(clips, registration.times, strikes, strict=True):
            assert curve(registration.span).min() >= -1e-9 <= clip.duration - curve(registration.span).max()
            assert np.abs(curve(strikes[reference][1:-1]) - own[:, None]).min(axis=0).max() < 0.05


def test_angles_run_on_over_whole_turns():
    """A walk of one and a half circles each way: the angle between them goes through three whole turns."""
    clip = sample("walk_circle")
    registration = laid(clip[:1200], clip[2160:3360])
    angles = registration.angles[1](np.linspace(*registration.span, 500))
    assert np.abs(np.diff(angles)).max() < 0.2
    assert np.ptp(angles) > 2 * np.pi


def test_clips_that_do_not_belong_together_are_told():
    apart = r"'walk' and 'walk' may not belong together: .* [23]\.\d cm/s.* 0\.\d\.$"
    told(apart, register, [walks()[1.4, -120], walks()[1.4, 120]])
    unwarned(register, [walks()[0.8, 0], walks()[1.1, 0]])


def test_the_mean_distance_says_what_may_be_blended():
    walk, brisk, jog = walks()[0.8, 0], walks()[1.4, 0], sample("jog")[1200:1800]
    assert register([walk, brisk]).costs[1] < 0.08
    unlike = r"'walk' and 'jog' may not be the same kind of motion: \d\d cm along"
    assert told(unlike, register, [walk, jog]).costs[1] > 0.12


def test_clips_with_little_in_common_are_laid_on_like_steps():
    """Three stretches of one walk, each of which starts nearly half its length after the one before."""
    clip = sample("walk_circle")
    registration = register([clip[start : start + 300] for start in (140, 0, 280)])
    assert np.ptp(registration.span) >= 1.2 and registration.costs.max() < 0.06


def dot(frames, fps=30.0, name="dot"):
    bone = Skeleton(["root", "tip"], [-1, 0], [[0, 0, 0], [0, 1, 0]])
    turns = np.tile([1.0, 0, 0, 0], (frames, 2, 1))
    return Motion(bone, np.zeros((frames, 3)), turns, fps, name)


def pair(**settings):
    return register([dot(60), dot(60)], **settings)


test_what_cannot_be_registered_is_refused = refusals(
    ("two clips or more, got 1", register, [dot(60)]),
    ("runs at 30 Hz", register, [dot(60), dot(60, 60.0)]),
    ("clips 0 to 1, got 2", lambda: pair(reference=2)),
    ("got -0.1 s", lambda: pair(slack=-0.1)),
    ("got nan s", lambda: pair(slack=np.nan)),
    ("'dot', at 30 Hz, has 4 frames, too few", register, [dot(60), dot(4)]),
    ("slope from 1 to 63", lambda: pair(slope=0)),
    ("471 frames cannot be laid on 90 with slope 2", lambda: register([dot(475), dot(94)], slack=0)),
    (SkeletonMismatch, "dot", register, [dot(60), sample("jog")]),
)
