"""Seams are measured right where they are made to order, and bad seams of real clips are found."""

from dataclasses import replace

import numpy as np
import pytest

from mocap.blending.joining import join
from mocap.body.motion import Motion, concatenate, resample
from mocap.body.skeleton import Skeleton
from mocap.datasets.samples import sample
from mocap.errors import MocapError, SkeletonMismatch
from mocap.feet.footplants import mark_plants
from mocap.feet.footskate import clean_up
from mocap.files.load_save import load
from mocap.matching.transitions import Transition, find_transitions
from mocap.quality.seam_measures import Spread, jumps, seam_quality, spread
from tests.strategies import random_motion

WALK = sample("walk_straight")
USUAL = spread([WALK])


def glide(path: np.ndarray, fps: float = 30.0) -> Motion:
    dot = Skeleton(["root"], [-1], [[0, 0, 0]])
    return Motion(
        dot, path[:, None] * [1.0, 0, 0] + [0, 1, 0], np.tile([1.0, 0, 0, 0], (len(path), 1, 1)), fps
    )


def test_jumps_are_those_of_curves_known_in_closed_form():
    t = np.arange(20) / 30
    velocity, acceleration = jumps(glide(t**3))
    assert velocity[1:-1] == pytest.approx(6 * t[1:-1] / 30)
    assert acceleration[2:-1] == pytest.approx(6 / 30)
    bent = np.maximum(t - t[10], 0) * 3  # 3 m/s from frame 10 on
    assert jumps(glide(bent))[0] == pytest.approx(3.0 * (np.arange(20) == 10))


def test_a_clip_s_own_frames_are_nothing_special():
    inside = [seam_quality(WALK, (start, start + 40), USUAL) for start in range(40, 1100, 40)]
    assert np.mean([q.velocity_jump <= 1 for q in inside]) > 0.9
    assert max(q.slide for q in inside) < 1e-9
    assert max(q.depth for q in inside) == 0
    assert max(q.deviation for q in inside) == 0


def test_a_cut_shows_and_a_blend_does_not():
    cut = concatenate([WALK[:500], WALK[320:]])
    assert seam_quality(cut, (500, 501), USUAL).velocity_jump > 20
    assert seam_quality(join(WALK, 500, WALK, 233, 40), (500, 540), USUAL).velocity_jump < 1


def test_slide_depth_and_deviation_are_what_was_done_to_the_clip():
    seam, frames = (600, 640), np.arange(len(WALK))
    touched = (frames >= 560) & (frames < 680)
    root = WALK.root_positions.copy()
    root[touched] += [0.03, -0.02, 0.04]
    pushed = replace(WALK, root_positions=root)
    quality = seam_quality(pushed, seam, USUAL, before=WALK)
    assert quality.deviation == pytest.approx(5.0)
    assert quality.depth == pytest.approx(2.0, abs=0.01)
    drift = replace(WALK, root_positions=WALK.root_positions + (frames / 120)[:, None] * [0.1, 0, 0])
    # A plant of n frames drifts by 10 cm/s · n / 120 s: at its ends it is half as far from its middle.
    assert 1 < seam_quality(drift, seam, USUAL).slide < 5


def test_a_motion_without_plants_does_not_slide():
    floating = replace(WALK, contacts=dict.fromkeys(WALK.contacts, False))
    assert seam_quality(floating, (600, 640), USUAL).slide == 0


@pytest.mark.parametrize("seam", [(-1, 5), (5, 5), (1190, 1202)])
def test_a_seam_must_lie_on_the_motion(seam):
    with pytest.raises(MocapError, match="1201 frames, and no seam"):
        seam_quality(WALK, seam, USUAL)


def test_what_is_measured_must_go_together():
    with pytest.raises(MocapError, match="none were given"):
        spread([])
    with pytest.raises(MocapError, match="No legs found"):
        spread([random_motion(0)])
    with pytest.raises(MocapError, match="takes four frames; 'walk_straight' has 3"):
        jumps(WALK[:3])
    with pytest.raises(MocapError, match="Before there were 1200 frames, now 1201"):
        seam_quality(WALK, (5, 9), USUAL, before=WALK[:1200])
    with pytest.raises(SkeletonMismatch):
        spread([WALK, random_motion(0)])
    with pytest.raises(MocapError, match="'lfoot' stands; mark_plants"):
        seam_quality(replace(WALK, contacts={}), (5, 9), USUAL)
    frozen = replace(WALK[:9], root_positions=np.repeat(WALK.root_positions[:1], 9, 0))
    frozen = replace(frozen, rotations=np.repeat(WALK.rotations[:1], 9, 0))
    with pytest.raises(MocapError, match="The clips do not move"):
        seam_quality(WALK, (5, 9), spread([frozen]))


def test_a_leap_in_the_data_is_neither_usual_nor_hides_a_seam():
    root = WALK.root_positions.copy()
    root[700] += [0.0, 0.2, 0.1]
    usual = spread([replace(WALK, root_positions=root), WALK])
    assert np.flatnonzero(np.isnan(usual.velocity[0])).tolist() == [699, 700, 701]
    assert not np.isnan(usual.velocity[1]).any()
    assert usual.within(42)[0][-1] == USUAL.within(42)[0][-1]
    assert usual.within(42)[1][-1] == pytest.approx(USUAL.within(42)[1][-1], rel=0.05)


def test_windows_are_compared_with_windows_as_long():
    one, many = (USUAL.within(frames)[0] for frames in (1, 42))
    assert len(one) == len(WALK)
    assert len(many) == len(WALK) - 41
    assert np.median(many) > 1.5 * np.median(one)
    assert USUAL.within(10**6)[0].tolist() == [one.max()]


TRIALS = (*range(11, 35), 47, 58)  # CMU 16's walks, all of them
WINDOW = 10
SHARES = np.array([50, 75, 90, 95])


@pytest.fixture(scope="module")
def captured(real_data) -> tuple[list[Motion], Spread, list[Transition], list[Transition]]:
    """Return CMU 16's walks, what is usual in them, and transitions below 4 cm and far above."""
    walks = [load(real_data / "cmu" / "16" / f"16_{trial}.amc") for trial in TRIALS]
    clips = [mark_plants(resample(walk, 30.0)) for walk in walks]
    usual = spread(clips)
    every = find_transitions(clips, window=WINDOW, below=1.0)

    def leaps(t: Transition) -> bool:
        """Tell whether the data leap in one of the windows: then the seam has it from them."""
        around = ((t.source, t.leave), (t.target, t.enter))
        return any(
            np.isnan(usual.velocity[clip][max(at - 1, 0) : at + WINDOW + 1]).any() for clip, at in around
        )

    good, bad = ([t for t in every if low < t.cost < high] for low, high in ((0, 0.04), (0.2, 1)))
    whole = [[t for t in some if not leaps(t)] for some in (good, bad)]
    assert len(whole[0]) > 0.95 * len(good)  # few are left out
    return clips, usual, *whole


def measured(clips: list[Motion], usual: Spread, chosen: list[Transition]):
    """Return the qualities of seams before and after clean-up, (N, 5) each, and largest jumps, (2, N)."""
    rows, largest = [], []
    for t in chosen:
        start = max(0, t.leave - 15)
        skating = join(
            clips[t.source][start:], t.leave - start, clips[t.target][: t.enter + 25], t.enter, WINDOW
        )
        seam = (t.leave - start, t.leave - start + WINDOW)
        around = slice(max(seam[0] - 1, 0), seam[1] + 1)
        both = skating, clean_up(skating)
        rows.append([seam_quality(motion, seam, usual, before=skating) for motion in both])
        largest.append([jumps(motion)[0][around].max() for motion in both])
    before, after = np.moveaxis(np.array(rows), 1, 0)
    return before, after, np.array(largest).T


def beyond(usual: Spread, largest: np.ndarray) -> np.ndarray:
    """Return by how many percent more seams than windows of the clips jump further than each of `SHARES`."""
    limits = np.percentile(usual.within(WINDOW + 2)[0], SHARES)
    return 100 * (largest[:, None] > limits).mean(axis=0) - (100 - SHARES)


@pytest.mark.filterwarnings("ignore:.*let go")
@pytest.mark.parametrize("seed", range(3))
def test_two_hundred_seams_of_real_walks_are_as_smooth_as_the_clips(captured, seed):
    clips, usual, good, _ = captured
    some = np.random.default_rng(seed).permutation(len(good))[:200]
    before, after, largest = measured(clips, usual, [good[i] for i in some])
    velocity, slide, deviation = 0, 2, 4
    assert before[:, velocity].max() <= 1
    assert after[:, velocity].max() <= 1
    for jump in largest:
        assert np.all(beyond(usual, jump) < 5)  # of 200, by chance
    assert before[:, slide].mean() > 1
    assert after[:, slide].max() < 0.1
    assert after[:, deviation].max() == 0


@pytest.mark.filterwarnings("ignore:.*let go")
@pytest.mark.parametrize("seed", range(3))
def test_seams_over_a_bad_threshold_show(captured, seed):
    clips, usual, _, bad = captured
    some = np.random.default_rng(seed).permutation(len(bad))[:40]
    _, _, largest = measured(clips, usual, [bad[i] for i in some])
    for jump in largest:
        assert np.all(beyond(usual, jump)[:3] > 25)


def test_all_seams_below_four_centimetres_keep_to_what_is_usual(captured):
    clips, usual, good, _ = captured
    limit = np.percentile(usual.within(WINDOW + 2)[0], 99.9)
    some = [good[i] for i in range(0, len(good), 10)]
    largest = []
    for t in some:
        start = max(0, t.leave - 3)
        leave, clip = t.leave - start, clips[t.source]
        joined = join(clip[start:], leave, clips[t.target][: t.enter + WINDOW + 3], t.enter, WINDOW)
        largest.append(jumps(joined)[0][max(leave - 1, 0) : leave + WINDOW + 1].max())
    assert (np.array(largest) > limit).mean() <= 0.001
