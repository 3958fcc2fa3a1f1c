"""After a clean-up planted feet stand still, nothing pops, and a clean clip is left alone."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import minimize

from mocap import rotations
from mocap.datasets import SAMPLES, sample
from mocap.errors import MocapError
from mocap.files import load
from mocap.footskate import FADE, clean_up, place_plants, smooth_fill
from mocap.joining import inertialize, join
from mocap.kinematics import joint_positions
from mocap.legs import find_legs
from mocap.motion import Motion, resample
from mocap.plants import mark_plants, runs
from mocap.transforms import PlanarTransform
from tests.strategies import planar, random_motion, seeds

WALK = sample("walk_straight")
LEGS = find_legs(WALK.skeleton)
KNEES = [leg.knee for leg in LEGS]
SEAM = (500, 233)  # a good one: the same moment of two steps
JOINED = {way: way(WALK, *(SEAM[0], WALK, SEAM[1]), 40) for way in (join, inertialize)}


def slides(motion: Motion) -> np.ndarray:
    """Return how far each planted joint strays from its place during each plant, metres."""
    positions = joint_positions(motion)
    return np.array(
        [
            np.linalg.norm(at - at.mean(axis=0), axis=-1).max()
            for name, marks in motion.contacts.items()
            for at in (positions[a:b, motion.skeleton.index(name)] for a, b in runs(marks))
        ]
    )


def furthest(motion: Motion, other: Motion) -> float:
    """Return how far a joint of one motion ever is from where it is in another, metres."""
    return float(np.linalg.norm(joint_positions(motion) - joint_positions(other), axis=-1).max())


def accelerations(motion: Motion, joints: list[int]) -> np.ndarray:
    return np.linalg.norm(np.diff(joint_positions(motion)[:, joints], 2, axis=0), axis=-1) * motion.fps**2


@pytest.mark.parametrize("name", SAMPLES)
def test_a_clean_clip_is_left_alone(name):
    clip = sample(name)
    cleaned = clean_up(clip)
    assert furthest(cleaned, clip) < 1e-6
    assert all(np.array_equal(cleaned.contacts[joint], clip.contacts[joint]) for joint in clip.contacts)


@pytest.mark.parametrize("way", [join, inertialize])
def test_after_a_seam_planted_feet_stand_still_and_nothing_pops(way):
    skating = JOINED[way]
    cleaned = clean_up(skating)
    assert slides(skating).max() > 0.01
    assert slides(cleaned).max() < 1e-9
    moved = cleaned.root_positions - skating.root_positions
    assert 0.002 < np.abs(moved).max() < 0.012
    assert np.all(moved[:, [0, 2]] == 0)
    own = np.percentile(accelerations(WALK, KNEES), 99.9)
    assert accelerations(cleaned, KNEES)[490:550].max() <= own
    assert furthest(cleaned[:400], WALK[:400]) < 1e-6


def test_no_bone_is_stretched_and_knees_bend_forwards():
    cleaned = clean_up(JOINED[join])
    positions = joint_positions(cleaned)
    left = rotations.rotate(cleaned.rotations[:, 0], [1, 0, 0])
    for leg in LEGS:
        hip, knee, ankle, ball = (positions[:, joint] for joint in leg)
        bones = [np.linalg.norm(b - a, axis=-1) for a, b in ((hip, knee), (knee, ankle), (ankle, ball))]
        assert np.ptp(bones, axis=-1) == pytest.approx(0, abs=1e-9)
        assert np.mean(bones, axis=-1) == pytest.approx(leg.lengths(WALK.skeleton))
        assert (np.cross(knee - hip, ankle - knee) * left).sum(-1).min() > 0


@pytest.mark.parametrize("height", [0.004, 0.02])
def test_a_root_pushed_about_is_no_trouble_for_the_feet(height):
    t = np.arange(len(WALK)) / WALK.fps
    push = height * np.stack([np.sin(5 * t), np.sin(7 * t), np.sin(3 * t)], axis=-1)
    pushed = replace(WALK, root_positions=WALK.root_positions + push)
    assert slides(pushed).max() > height / 4
    assert slides(clean_up(pushed)).max() < 1e-9


@settings(max_examples=20)
@given(planar)
def test_where_a_motion_is_does_not_matter(transform):
    skating = JOINED[join][440:600]
    assert furthest(clean_up(transform.motion(skating)), transform.motion(clean_up(skating))) < 1e-6


def test_far_from_the_origin_it_works_as_well():
    far = PlanarTransform(1.0, 1e4, -1e4).motion(JOINED[join])
    assert slides(clean_up(far)).max() < 1e-6


def test_cleaning_twice_is_cleaning_once():
    once = clean_up(JOINED[join])
    assert furthest(clean_up(once), once) < 1e-6


@pytest.mark.parametrize("trial", ["16_15", "16_21", "16_58", "16_11"])
@pytest.mark.parametrize("fps", [120.0, 30.0])
def test_captured_feet_creep_and_afterwards_stand(real_data, trial, fps):
    clip = mark_plants(resample(load(real_data / "cmu" / "16" / f"{trial}.amc"), fps))
    cleaned = clean_up(clip)
    assert slides(clip).max() > 0.01
    assert slides(cleaned).max() < 1e-9
    moved = np.abs(cleaned.root_positions - clip.root_positions)
    assert np.sqrt((moved**2).sum(-1).mean()) < 0.006
    assert moved.max() < 0.018
    knees, own = (np.percentile(accelerations(m, KNEES), 99.9) for m in (cleaned, clip))
    assert knees <= 1.05 * own


def test_a_cartwheel_with_its_feet_in_the_air_is_no_trouble(real_data):
    clip = mark_plants(load(real_data / "cmu" / "49" / "49_08.amc"))
    assert slides(clean_up(clip)).max() < 1e-9


def curve(seed):
    random = np.random.default_rng(seed)
    known = random.random(14) < 0.4
    return random.normal(size=(14, 2)), known


@given(seeds)
def test_the_filled_curve_keeps_what_is_known_and_bends_least(seed):
    values, known = curve(seed)
    filled = smooth_fill(values, known, 30.0)
    assert np.array_equal(filled[known], values[known])

    def cost(c):
        c = c.reshape(-1, 2)
        return (np.diff(c, 2, axis=0) ** 2).sum() + (FADE * 30) ** -4 * (c**2).sum()

    random = np.random.default_rng(seed)
    for _ in range(5):
        other = filled + (~known)[:, None] * random.normal(size=filled.shape) * 1e-3
        assert cost(other) >= cost(filled)


def test_the_filled_curve_is_what_an_optimiser_finds():
    values, known = curve(3)

    def cost(free):
        c = np.where(known[:, None], values, 0.0)
        c[~known] = free.reshape(-1, 2)
        return (np.diff(c, 2, axis=0) ** 2).sum() + (FADE * 30) ** -4 * (c**2).sum()

    found = minimize(cost, np.zeros(2 * (~known).sum()), tol=1e-12).x
    assert smooth_fill(values, known, 30.0)[~known].ravel() == pytest.approx(found, abs=1e-4)


@pytest.mark.parametrize("frames", [1, 2, 3])
def test_few_frames_can_be_filled(frames):
    known = np.arange(frames) == 0
    filled = smooth_fill(np.ones((frames, 3)), known, 120.0)
    assert np.all(filled[0] == 1)
    assert np.isfinite(filled).all()
    assert np.all(smooth_fill(np.ones((frames, 3)), ~known & False, 120.0) == 0)


@given(seeds, st.floats(0.05, 0.3))
def test_plants_that_overlap_are_a_foot_s_length_apart(seed, length):
    random = np.random.default_rng(seed)
    ankle = random.normal(size=(40, 3)) * 0.01
    direction = random.normal(size=(40, 3)) * 0.1 + [0, 0, 1]
    ball = ankle + length * direction / np.linalg.norm(direction, axis=-1, keepdims=True)
    flat, down = np.zeros((2, 40), bool)
    flat[5:20], flat[26:33] = True, True
    down[10:30] = True
    places = place_plants((ankle, ball), (flat, down), length)
    both = flat & down
    assert np.linalg.norm((places[1] - places[0])[both], axis=-1) == pytest.approx(length)
    for kind, marks in enumerate((flat, down)):
        for start, stop in runs(marks):
            assert np.ptp(places[kind, start:stop], axis=0) == pytest.approx(0)
    assert places[0, 5:20] == pytest.approx(np.tile(ankle[5:20].mean(axis=0), (15, 1)))


def test_one_frame_and_no_plants_are_no_trouble():
    assert furthest(clean_up(WALK[7:8]), WALK[7:8]) < 1e-9
    none = replace(WALK, contacts=dict.fromkeys(WALK.contacts, False))
    assert furthest(clean_up(none), WALK) < 1e-9


def test_missing_marks_and_missing_legs_are_errors():
    with pytest.raises(MocapError, match="when these joints stand: lfoot, ltoes, rfoot, rtoes; mark_plants"):
        clean_up(replace(WALK, contacts={}))
    with pytest.raises(MocapError, match="No legs found among joint0"):
        clean_up(random_motion(0))


def test_a_plant_out_of_reach_is_an_error_not_a_stretched_leg():
    glued = replace(WALK, contacts=dict.fromkeys(WALK.contacts, True))
    with pytest.raises(MocapError, match=r"frame \d+: '[lr]foot' would have to be .* cm out of"):
        clean_up(glued)
