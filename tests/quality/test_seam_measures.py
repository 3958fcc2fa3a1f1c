"""Seams are measured right where they are made to order, and bad seams of real clips are found."""

from dataclasses import replace

import numpy as np
import pytest
from walking import generate

from mocap.blending import join
from mocap.body.motion import Motion, concatenate, resample
from mocap.body.skeleton import Skeleton
from mocap.datasets.samples import sample
from mocap.errors import SkeletonMismatch
from mocap.feet.footplants import mark_plants
from mocap.feet.footskate import clean_up
from mocap.files.load_save import load
from mocap.matching.transitions import Transition, find_transitions
from mocap.quality.seam_measures import Spread, jumps, knee_turns, seam_quality, spread
from tests.refusals import refused
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
    walk = generate("walk_straight")  # as stored, feet tremble by a nanometre
    inside = [seam_quality(walk, (start, start + 40), USUAL) for start in range(40, 1100, 120)]
    assert np.mean([q.velocity_jump <= 1 for q in inside]) > 0.9
    assert max(q.slide for q in inside) < 1e-9


def test_a_cut_shows_and_a_blend_does_not():
    cut = concatenate([WALK[:500], WALK[320:]])
    assert seam_quality(cut, (500, 501), USUAL).velocity_jump > 20
    assert seam_quality(join(WALK, 500, WALK, 233, 40), (500, 540), USUAL).velocity_jump < 1


def test_plants_that_touch_the_seam_slide_and_no_plants_do_not():
    drift = (np.arange(len(WALK)) / 120)[:, None] * [0.1, 0, 0]
    drifting = replace(WALK, root_positions=WALK.root_positions + drift)
    # A plant of n frames drifts by 10 cm/s · n / 120 s: at its ends it is half as far from its middle.
    assert 1 < seam_quality(drifting, (600, 640), USUAL).slide < 5
    floating = replace(WALK, contacts=dict.fromkeys(WALK.contacts, False))
    assert seam_quality(floating, (600, 640), USUAL).slide == 0


@pytest.mark.parametrize("seam", [(-1, 5), (5, 5), (1190, 1202)])
def test_a_seam_must_lie_on_the_motion(seam):
    refused("1201 frames, and no seam", seam_quality, WALK, seam, USUAL)


def test_what_is_measured_must_go_together():
    refused("none were given", spread, [])
    refused("takes four frames; 'walk_straight' has 3", jumps, WALK[:3])
    with pytest.raises(SkeletonMismatch):
        spread([WALK, random_motion(0)])
    refused("'lfoot' stands; mark_plants", seam_quality, replace(WALK, contacts={}), (5, 9), USUAL)
    frozen = replace(WALK[:9], root_positions=np.repeat(WALK.root_positions[:1], 9, 0))
    frozen = replace(frozen, rotations=np.repeat(WALK.rotations[:1], 9, 0))
    refused("The clips do not move", seam_quality, WALK, (5, 9), spread([frozen]))


def test_a_leap_in_the_data_is_neither_usual_nor_hides_a_seam():
    root = WALK.root_positions.copy()
    root[700] += [0.0, 0.2, 0.1]
    usual = spread([replace(WALK, root_positions=root), WALK])
    assert np.flatnonzero(np.isnan(usual.velocity[0])).tolist() == [699, 700, 701]
    assert not np.isnan(usual.velocity[1]).any()
    assert usual.within(42)[-1] == USUAL.within(42)[-1]


def test_windows_are_compared_with_windows_as_long():
    one, many = (USUAL.within(frames) for frames in (1, 42))
    assert len(one) == len(WALK)
    assert len(many) == len(WALK) - 41
    assert np.median(many) > 1.5 * np.median(one)
    assert USUAL.within(10**6).tolist() == [one.max()]


def test_a_knee_that_is_turned_by_hand_turns_as_far():
    knee, rotations = WALK.skeleton.index("ltibia"), WALK.rotations.copy()
    rotations[600:, knee] = rotations[599, knee]
    assert knee_turns(replace(WALK, rotations=rotations))[600:, 0] == pytest.approx(0, abs=1e-5)
    half = np.sqrt(0.5)
    rotations[699:701, knee] = [1, 0, 0, 0], [half, half, 0, 0]
    assert knee_turns(replace(WALK, rotations=rotations))[699, 0] == pytest.approx(90)


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
        return any(np.isnan(usual.velocity[clip][max(a - 1, 0) : a + WINDOW + 1]).any() for clip, a in around)

    good, bad = ([t for t in every if low < t.cost < high] for low, high in ((0, 0.04), (0.2, 1)))
    whole = [[t for t in some if not leaps(t)] for some in (good, bad)]
    assert len(whole[0]) > 0.95 * len(good)  # few are left out
    return clips, usual, *whole


def measured(clips: list[Motion], usual: Spread, chosen: list[Transition]):
    """Return the qualities of seams before and after clean-up, (N, 2) each, and largest jumps, (2, N)."""
    rows, largest = [], []
    for t in chosen:
        start = max(0, t.leave - 15)
        skating = join(
            clips[t.source][start:], t.leave - start, clips[t.target][: t.enter + 25], t.enter, WINDOW
        )
        seam = (t.leave - start, t.leave - start + WINDOW)
        around = slice(max(seam[0] - 1, 0), seam[1] + 1)
        both = skating, clean_up(skating)
        rows.append([seam_quality(motion, seam, usual) for motion in both])
        largest.append([jumps(motion)[0][around].max() for motion in both])
    before, after = np.moveaxis(np.array(rows), 1, 0)
    return before, after, np.array(largest).T


def beyond(usual: Spread, largest: np.ndarray) -> np.ndarray:
    """Return by how many percent more seams than windows of the clips jump further than each of `SHARES`."""
    limits = np.percentile(usual.within(WINDOW + 2), SHARES)
    return 100 * (largest[:, None] > limits).mean(axis=0) - (100 - SHARES)


@pytest.mark.sweep
@pytest.mark.filterwarnings("ignore:.*let go")
@pytest.mark.parametrize("seed", range(3))
def test_two_hundred_seams_of_real_walks_are_as_smooth_as_the_clips(captured, seed):
    clips, usual, good, _ = captured
    some = np.random.default_rng(seed).permutation(len(good))[:200]
    before, after, largest = measured(clips, usual, [good[i] for i in some])
    velocity, slide = 0, 1
    assert before[:, velocity].max() <= 1
    assert after[:, velocity].max() <= 1
    for jump in largest:
        assert np.all(beyond(usual, jump) < 5)  # of 200, by chance
    assert before[:, slide].mean() > 1
    assert after[:, slide].max() < 0.1


@pytest.mark.filterwarnings("ignore:.*let go")
@pytest.mark.sweep
@pytest.mark.parametrize("seed", range(3))
def test_seams_over_a_bad_threshold_show(captured, seed):
    clips, usual, _, bad = captured
    some = np.random.default_rng(seed).permutation(len(bad))[:40]
    _, _, largest = measured(clips, usual, [bad[i] for i in some])
    for jump in largest:
        assert np.all(beyond(usual, jump)[:3] > 25)
