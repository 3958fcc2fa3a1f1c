"""The gait that will make the bundled clips: captured people bound it, feet stand, joints keep limits."""

from functools import cache

import numpy as np
import pytest
from striding import generate, generate_walk
from striding.generated import CLIPS
from striding.walking_body import FOOT, SKELETON

from mocap._shared.arrays import runs
from mocap.body import Motion, circle, joint_positions, rotations
from mocap.datasets import samples
from tests.datasets.test_generated import check_floor, check_limits, measure, parts
from tests.refusals import refusals

# The least and the most that `measure` finds in clips of the CMU Graphics Lab Motion Capture Database: walks
# of subjects 02, 16 and 49, runs of subject 16; for the winding walks also the homework's three clips.
WINDING = {
    "speed": (0.61, 1.65),
    "cadence": (80, 136),
    "stride": (0.84, 1.53),
    "bob": (2.1, 5.9),
    "knee": (52, 71),
    "hip": (42, 62),
    "ankle": (29, 50),
    "elbow straightest": (6, 27),
    "elbow most bent": (37, 64),
    "stance": (38, 63),
    "double support": (0, 26),
}
STRAIGHT = {
    "speed": (0.88, 1.70),
    "cadence": (87, 125),
    "stride": (1.02, 1.64),
    "bob": (1.8, 5.7),
    "sway": (2.9, 5.5),
    "knee": (56, 73),
    "hip": (46, 64),
    "ankle": (29, 51),
    "elbow straightest": (8, 29),
    "elbow most bent": (36, 89),
    "stance": (42, 60),
    "double support": (0, 22),
}
RUNNING = {
    "speed": (2.3, 4.2),
    "cadence": (149, 178),
    "stride": (1.8, 2.9),
    "bob": (7.4, 11.6),
    "knee": (70, 93),
    "hip": (51, 76),
    "ankle": (48, 62),
    "elbow straightest": (87, 106),
    "elbow most bent": (116, 144),
    "double support": (0, 0),
}
KINDS = {
    "walk_circle": WINDING,
    "walk_curve_1": WINDING,
    "walk_curve_2": WINDING,
    "walk_straight": STRAIGHT,
    "jog": RUNNING,
}
# The 99th percentile of accelerations, m/s²: the median over walks 15, 16, 31, 32, 47, 58 and runs 35, 36, 45
# of CMU's subject 16. A walk at 1.3 m/s, where those are at 1.1, may push its feet a tenth more.
WALK_PUSH = {"root": 25, "head": 51, "foot": 56, "tibia": 47, "wrist": 71}
JOG_PUSH = {"root": 88, "head": 68, "foot": 130, "tibia": 115, "wrist": 184}

made = cache(generate)
every_clip = pytest.mark.parametrize("name", CLIPS)


def test_it_makes_the_bundled_clips_for_the_bundled_body():
    assert tuple(CLIPS) == samples.SAMPLES
    SKELETON.require_same(samples.SKELETON)


@pytest.mark.parametrize(("name", "limits"), KINDS.items())
def test_a_clip_moves_as_captured_people_do(name, limits):
    for motion in parts(made("jog"), "jog") if name == "jog" else [made(name)]:
        measured = measure(motion)
        outside = {
            key: measured[key] for key, (low, high) in limits.items() if not low <= measured[key] <= high
        }
        assert outside == {}


@every_clip
def test_a_clip_is_as_smooth_as_captured_ones_and_keeps_the_limits_of_joints_and_floor(name):
    motion = made(name)
    positions = joint_positions(motion)
    push = np.linalg.norm(np.diff(positions, 2, axis=0), axis=-1) * motion.fps**2
    for bone, most in (JOG_PUSH if name == "jog" else WALK_PUSH).items():
        for joint in {bone, "l" + bone, "r" + bone} & set(SKELETON.names):
            assert np.percentile(push[:, SKELETON.index(joint)], 99) < most, joint
    check_floor(motion, heel=8e-3 if name == "jog" else 5e-3)
    check_limits(motion, hip=(-70, 35), ankle=(-45, 50), knee=(0.5, 125), toes=(-70, 1e-6))
    ankles = positions[:, [SKELETON.index("lfoot"), SKELETON.index("rfoot")]]
    assert np.linalg.norm(ankles[:, 0] - ankles[:, 1], axis=-1).min() > 0.04


@every_clip
def test_a_planted_joint_stands_still(name):
    motion = made(name)
    positions = joint_positions(motion)
    for joint, mark in motion.contacts.items():
        track = positions[:, SKELETON.index(joint)]
        stretches = runs(mark)
        assert len(stretches) >= motion.duration / 4
        for start, stop in stretches:
            assert np.ptp(track[start:stop], axis=0).max() < 1e-9
            height = FOOT.ankle if "foot" in joint else FOOT.ball
            assert track[start:stop, 1] == pytest.approx(height, abs=1e-9)


@pytest.mark.parametrize("name", ["sneak", "jog"])
def test_a_clip_goes_into_its_style_and_out_again_twice(name):
    motion = made(name)
    assert list(motion.labels) == ["walk", name]
    assert np.array_equal(motion.labels["walk"], ~motion.labels[name])
    assert motion.labels["walk"][[0, -1]].all()
    assert len(parts(motion, name)) == 2
    assert motion.labels[name].mean() > 0.5


def knee_bends(motion: Motion) -> np.ndarray:
    """Return how far the left knee is bent in each frame, degrees."""
    turns = rotations.to_rotvec(motion.rotations[:, SKELETON.index("ltibia")])
    return np.degrees(np.linalg.norm(turns, axis=-1))


def test_legs_swing_bent_and_stand_nearly_straight():
    walk = generate_walk([[0, 0], [0, 9]])
    bends = knee_bends(walk)
    standing = bends[walk.contacts["lfoot"]]  # the sole is flat
    assert 57 < bends.max() < 67
    assert 10 < np.median(standing) < 17
    assert 4 < bends.min() < 9


def test_people_slow_down_in_curves_unless_the_speed_is_given():
    def speed(motion: Motion) -> float:
        return float(np.linalg.norm(np.diff(motion.root_positions[:, [0, 2]], axis=0), axis=1).mean() * 120)

    straight = speed(generate_walk([[0, 0], [0, 9]]))
    wide = speed(generate_walk(circle(2.0).points))
    narrow = speed(generate_walk(circle(1.0).points))
    assert 1.2 < straight < 1.4
    assert 0.9 < narrow < wide - 0.05 < straight - 0.1
    assert speed(generate_walk(circle(1.0).points, speed=1.3)) > narrow + 0.15


test_bad_requests_are_refused = refusals(
    ("No bundled clip 'waltz'; there are: walk_circle", generate, "waltz"),
    ("there are: walk, sneak, jog", lambda: generate_walk([[0, 0], [0, 5]], style="hop")),
    ("a speed above 0, got -1", lambda: generate_walk([[0, 0], [0, 5]], speed=-1)),
    ("longer than the legs", lambda: generate_walk([[0, 0], [0, 50]], speed=6)),
)
