"""The measure of a seam: right on seams made to order, fair on clips as they are, telling on real ones."""

from dataclasses import replace

import numpy as np
import pytest

from mocap.datasets import sample
from mocap.errors import MocapError, SkeletonMismatch
from mocap.files import load
from mocap.footskate import clean_up
from mocap.joining import join
from mocap.kinematics import joint_positions
from mocap.legs import find_legs
from mocap.motion import Motion, concatenate, resample
from mocap.plants import mark_plants
from mocap.quality import jumps, seam_quality, spread
from mocap.skeleton import Skeleton
from mocap.transitions import Transition, find_transitions
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
    # A plant of n frames, drifting at 10 cm/s, strays by 5 cm/s from its middle, for n / 120 s.
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


# CMU 16's walks in which no marker was lost or swapped: a leap in the data would be "usual" otherwise.
TRIALS = (13, 14, 20, 21, 25, 26, 30, 58)
WINDOW = 10


def measured(clips: list[Motion], chosen: list[Transition]):
    """Return the qualities of seams before and after clean-up, (N, 5) each, and knees' accelerations."""
    usual = spread(clips)
    knees = [leg.knee for leg in find_legs(clips[0].skeleton)]
    rows, bends = [], []
    for t in chosen:
        start = max(0, t.leave - 15)
        skating = join(
            clips[t.source][start:], t.leave - start, clips[t.target][: t.enter + 25], t.enter, WINDOW
        )
        cleaned = clean_up(skating)
        seam = (t.leave - start, t.leave - start + WINDOW)
        rows.append([seam_quality(skating, seam, usual), seam_quality(cleaned, seam, usual, before=skating)])
        at = joint_positions(cleaned)[max(seam[0] - 2, 0) : seam[1] + 2, knees]
        bends.append(np.linalg.norm(np.diff(at, 2, axis=0), axis=-1).ravel() * cleaned.fps**2)
    before, after = np.moveaxis(np.array(rows), 1, 0)
    return before, after, np.concatenate(bends)


def test_two_hundred_seams_of_real_walks_are_as_smooth_as_the_clips(real_data):
    walks = [load(real_data / "cmu" / "16" / f"16_{trial}.amc") for trial in TRIALS]
    clips = [mark_plants(resample(walk, 30.0)) for walk in walks]
    random = np.random.default_rng(0)
    every = find_transitions(clips, window=WINDOW, below=1.0)
    good, bad = ([t for t in every if low < t.cost < high] for low, high in ((0, 0.04), (0.12, 1)))
    good, bad = ([some[i] for i in random.permutation(len(some))[:n]] for some, n in ((good, 200), (bad, 40)))
    assert (len(good), len(bad)) == (200, 40)
    before, after, knees = measured(clips, good)
    velocity, slide, deviation = 0, 2, 4
    assert before[:, velocity].max() <= 1
    assert after[:, velocity].max() <= 1
    assert before[:, slide].mean() > 1
    assert after[:, slide].max() < 0.1
    assert after[:, deviation].max() == 0
    both = [leg.knee for leg in find_legs(clips[0].skeleton)]
    own = np.concatenate([np.diff(joint_positions(clip)[:, both], 2, axis=0) for clip in clips])
    assert np.percentile(knees, 99) <= np.percentile(np.linalg.norm(own, axis=-1) * 900, 99.9)
    worse, still_worse, _ = measured(clips, bad)
    assert np.median(worse[:, velocity]) > 1.25 * np.median(before[:, velocity])
    assert np.median(still_worse[:, velocity]) > 1.25 * np.median(after[:, velocity])
    assert (still_worse[:, velocity] > 1).mean() > 0.1
    assert np.median(worse[:, slide]) > 2 * np.median(before[:, slide])
