"""Which frames belong together: known warps come back, strikes fall on strikes, and naive ways fail."""

import itertools

import numpy as np
import pytest

from mocap.blending.registering import register
from mocap.body import Motion, PlanarTransform, Skeleton
from mocap.datasets import sample
from mocap.errors import SkeletonMismatch
from tests.blending.registered import at_times, captured, strike_errors, walks
from tests.conftest import SWEEP
from tests.refusals import quietly, refusals, told, unwarned


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


@pytest.mark.parametrize(("amount", "ms", "degrees"), [(0.3, 15, 1.2), (0.6, 25, 3)])
def test_a_known_warp_comes_back(real_data, amount, ms, degrees):
    for clip in (walks()[1.1, 0], captured(real_data, "16_15")):
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
    for reference in range(3):
        registration = register(clips, reference=reference)
        assert registration.reference == reference and registration.costs[reference] == 0
        u = np.linspace(*registration.span, 5)
        np.testing.assert_allclose(registration.times[reference](u), u, atol=1e-12)
        for clip, curve in zip(clips, registration.times, strict=True):
            assert curve(registration.span).min() >= -1e-9
            assert curve(registration.span).max() <= clip.duration + 1e-9


def test_angles_run_on_over_whole_turns():
    """A walk of one and a half circles each way: the angle between them goes through three whole turns."""
    clip = sample("walk_circle")
    left, right = clip[:1200], clip[2160:3360]
    registration = laid(left, right)
    u = np.linspace(*registration.span, 500)
    angles = registration.angles[1](u)
    assert np.abs(np.diff(angles)).max() < 0.2
    assert np.ptp(angles) > 2 * np.pi


def test_clips_that_do_not_belong_together_are_told():
    apart = r"'walk' and 'walk' may not belong together: .* 4.\d cm/s.* 0.\d\.$"
    told(apart, register, [walks()[1.4, -120], walks()[1.4, 120]])
    unwarned(register, [walks()[0.8, 0], walks()[1.1, 0]])


def test_the_mean_distance_says_what_may_be_blended():
    walk, brisk, jog = walks()[0.8, 0], walks()[1.4, 0], sample("jog")[1200:1800]
    assert register([walk, brisk]).costs[1] < 0.08
    unlike = r"'walk' and 'jog' may not be the same kind of motion: \d\d cm along"
    costs = told(unlike, register, [walk, jog]).costs
    assert costs[1] > 0.12


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
