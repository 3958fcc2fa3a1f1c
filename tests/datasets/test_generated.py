"""The bundled clips: captured people bound them, the jump falls freely, feet stand and joints keep limits."""

from functools import cache
from itertools import pairwise

import numpy as np
import pytest
from bundled_clips import bundled_clips
from scipy.signal import find_peaks
from walking import generate, generate_walk
from walking.jumping import generate_jump, plan_jump
from walking.walking_body import FOOT, SKELETON

import mocap
from mocap._shared.arrays import runs
from mocap.body import Motion, circle, rotations
from mocap.body.kinematics import forward_kinematics, joint_positions
from mocap.datasets import SAMPLES, sample, samples
from mocap.graphs import motion_graph, pruning
from mocap.quality import centre_of_mass, gravity, inspect
from tests.editing.wishes import between
from tests.refusals import refusals


def check_floor(motion, heel):
    """No joint goes through the floor, and no heel further than so many metres."""
    poses = forward_kinematics(motion)
    assert poses.positions[..., 1].min() > 0
    for ankle in (SKELETON.index("lfoot"), SKELETON.index("rfoot")):
        heels = poses.positions[:, ankle] + poses.matrices[:, ankle] @ [0, -FOOT.ankle, -FOOT.heel]
        assert heels[:, 1].min() > -heel


def check_limits(motion, hip, ankle):
    """Knees and elbows are hinges; joints turn within the limits given, degrees."""
    for side in "lr":
        turn = {
            bone: np.degrees(rotations.to_rotvec(motion.rotations[:, SKELETON.index(side + bone)]))
            for bone in ("femur", "tibia", "foot", "toes", "radius")
        }
        for bone, (least, most) in {
            "tibia": (0.5, 125),
            "femur": hip,
            "foot": ankle,
            "toes": (-70, 1e-6),
        }.items():
            assert least < turn[bone][:, 0].min() < turn[bone][:, 0].max() < most, bone
        assert np.abs(turn["tibia"][:, 1:]).max() < 1e-6
        elbow = np.linalg.norm(turn["radius"], axis=-1)
        assert 10 < elbow.min() < elbow.max() < 140
        assert np.ptp(turn["radius"] / elbow[:, None], axis=0).max() < 0.05  # a hinge


def check_stored(stored, made):
    """A clip is stored to the nanometre, with the marks and the name of what was made."""
    np.testing.assert_allclose(stored.root_positions, made.root_positions, rtol=0, atol=1e-9)
    np.testing.assert_allclose(stored.rotations, made.rotations, rtol=0, atol=1e-9)
    assert (stored.name, stored.fps) == (made.name, made.fps)
    for mine, theirs in ((stored.labels, made.labels), (stored.contacts, made.contacts)):
        assert list(mine) == list(theirs)
        assert all(np.array_equal(mark, theirs[key]) for key, mark in mine.items())


every_clip = pytest.mark.parametrize("name", SAMPLES)


@cache
def places(name: str) -> np.ndarray:
    """Return where a clip's joints are, (F, J, 3)."""
    return joint_positions(sample(name))


@cache
def made() -> dict[str, Motion]:
    """Make all clips from the figures."""
    return dict(bundled_clips())


def parts(motion: Motion, label: str) -> list[Motion]:
    """Cut out the stretches of a label, without the second at both ends where a style still changes."""
    edges = np.flatnonzero(np.diff(motion.labels[label].astype(int))) + 1
    stretches = pairwise([0, *edges.tolist(), len(motion)])
    return [motion[i + 120 : j - 120] for i, j in stretches if motion.labels[label][i]]


def spread(values: np.ndarray) -> float:
    return float(np.subtract(*np.percentile(values, [99, 1])))


def measure(motion: Motion) -> dict[str, float]:
    """Measure a walk: metres a second, steps a minute, metres, cm, degrees, percent of the time."""
    at = dict(zip(motion.skeleton.names, np.moveaxis(joint_positions(motion), 1, 0), strict=True))
    root, fps = at["root"], motion.fps
    left = (at["lfemur"] - at["rfemur"])[:, [0, 2]]
    left /= np.linalg.norm(left, axis=-1, keepdims=True)
    ahead = left[:, ::-1] * [-1, 1]  # a quarter turn from left, seen from above
    bones = {side: [at[side + b] for b in ("femur", "tibia", "foot", "toes")] for side in "lr"}
    arms = {side: [at[side + b] for b in ("humerus", "radius", "wrist")] for side in "lr"}
    strikes = [
        find_peaks(((at[s + "foot"] - root)[:, [0, 2]] * ahead).sum(-1), distance=0.4 * fps, prominence=0.1)[
            0
        ]
        for s in "lr"
    ]
    strides = [np.diff(s) / fps for s in strikes]
    seconds = float(np.mean(np.concatenate(strides)))
    speed = float(np.linalg.norm(np.diff(root[:, [0, 2]], axis=0), axis=-1).mean() * fps)
    thighs = [b[1] - b[0] for b in bones.values()]
    swing = [np.degrees(np.arctan2((t[:, [0, 2]] * ahead).sum(-1), -t[:, 1])) for t in thighs]
    elbow = np.concatenate([between(a[1] - a[0], a[2] - a[1]) for a in arms.values()])
    bob = [np.ptp(root[i:j, 1]) for s in strikes for i, j in pairwise(s)]
    window = np.ones(round(seconds * fps)) / round(seconds * fps)
    middle = slice((len(window) - 1) // 2, (len(window) - 1) // 2 + len(root) - len(window) + 1)
    way = np.stack([np.convolve(root[:, axis], window, "valid") for axis in (0, 2)], axis=-1)
    slow = [
        np.min([np.linalg.norm(np.gradient(b[k], 1 / fps, axis=0), axis=-1) for k in (2, 3)], axis=0) < 0.35
        for b in bones.values()
    ]
    return {
        "speed": speed,
        "cadence": 120 / seconds,
        "stride": speed * seconds,
        "bob": 100 * float(np.mean(bob)),
        "sway": 100 * spread(((root[middle][:, [0, 2]] - way) * left[middle]).sum(-1)),
        "knee": float(np.mean([spread(between(b[1] - b[0], b[2] - b[1])) for b in bones.values()])),
        "hip": float(np.mean([spread(s) for s in swing])),
        "ankle": float(np.mean([spread(between(b[2] - b[1], b[3] - b[2])) for b in bones.values()])),
        "elbow straightest": float(np.percentile(elbow, 1)),
        "elbow most bent": float(np.percentile(elbow, 99)),
        "stance": 100 * float(np.mean(slow)),
        "double support": 100 * float((slow[0] & slow[1]).mean()),
    }


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


@pytest.mark.parametrize(("name", "limits"), KINDS.items())
def test_a_clip_moves_as_captured_people_do(name, limits):
    for motion in parts(sample("jog"), "jog") if name == "jog" else [sample(name)]:
        measured = measure(motion)
        outside = {
            key: measured[key] for key, (low, high) in limits.items() if not low <= measured[key] <= high
        }
        assert outside == {}


@every_clip
def test_a_clip_is_as_smooth_as_captured_ones_and_its_frames_and_feet_keep_apart(name):
    motion, at = sample(name), places(name)
    push = np.linalg.norm(np.diff(at, 2, axis=0), axis=-1) * motion.fps**2
    for bone, most in (JOG_PUSH if name == "jog" else WALK_PUSH).items():
        for joint in {bone, "l" + bone, "r" + bone} & set(SKELETON.names):
            assert np.percentile(push[:, SKELETON.index(joint)], 99) < most, joint
    check_floor(motion, heel=8e-3 if name == "jog" else 5e-3)
    check_limits(motion, hip=(-70, 35), ankle=(-45, 50))
    left, right = at[:, SKELETON.index("lfoot")], at[:, SKELETON.index("rfoot")]
    assert np.linalg.norm(left - right, axis=-1).min() > 0.04
    frames = motion.rotations.reshape(len(motion), -1)
    assert len(np.unique(frames.round(6), axis=0)) == len(frames)


@every_clip
def test_a_planted_joint_stands_still_and_what_is_stored_is_what_the_figures_give(name):
    motion = made()[name]
    check_stored(sample(name), motion)
    at = joint_positions(motion)
    for joint, mark in motion.contacts.items():
        changes = np.flatnonzero(np.diff(mark.astype(int)))
        assert np.diff(changes).min() >= 6, joint  # frames: a twentieth of a second
        track, stretches = at[:, SKELETON.index(joint)], runs(mark)
        assert len(stretches) >= motion.duration / 4
        for start, stop in stretches:
            assert np.ptp(track[start:stop], axis=0).max() < 1e-9
            height = FOOT.ankle if "foot" in joint else FOOT.ball
            assert track[start:stop, 1] == pytest.approx(height, abs=1e-9)


def test_the_short_walks_are_what_the_figures_give():
    assert samples.SKELETON.require_same(SKELETON) is None
    assert list(made()) == samples._KEYS
    for name in samples._KEYS[len(SAMPLES) :]:
        check_stored(sample(name), made()[name])


@pytest.mark.parametrize("name", ["sneak", "jog"])
def test_a_clip_walks_into_its_style_and_out_again_twice(name):
    motion = sample(name)
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


def test_at_4_cm_the_graph_leads_into_every_style_and_out_again():
    clips = [mocap.resample(sample(name), 15) for name in SAMPLES]  # at 30 Hz it is the same, and takes 6 s
    graph = pruning.prune(motion_graph.build(clips, window=5, threshold=0.04))
    kept = [np.zeros(len(clip), bool) for clip in clips]
    leaving = [0] * len(clips)
    for (clip, start), (other, end), kind in graph.graph.edges(data="kind"):
        if kind == "clip":
            kept[clip][start:end] = True
        leaving[clip] += kind == "transition" and clip != other
    assert min(leaving) > 50
    for clip, frames in zip(clips, kept, strict=True):
        assert all(frames[mask].mean() > 0.85 for mask in clip.labels.values()), clip.name
    assert np.concatenate(kept).mean() > 0.95


test_bad_wishes_are_told = refusals(
    ("No bundled clip 'waltz'; there are walk_circle, .*, bend_walk and 24 walks", sample, "waltz"),
    ("there are: walk, sneak, jog", lambda: generate_walk([[0, 0], [0, 5]], style="hop")),
    ("a speed above 0, got -1", lambda: generate_walk([[0, 0], [0, 5]], speed=-1)),
    ("No bundled clip 'waltz'; there are: walk_circle", generate, "waltz"),
    ("longer than the legs", lambda: generate_walk([[0, 0], [0, 50]], speed=6)),
)


JUMP = sample("jump")
PLAN = plan_jump(0.3)
AIR = slice(int(PLAN.take_off * 120) + 2, int(PLAN.landing * 120))


@pytest.mark.parametrize("rise", [0.15, 0.5])
def test_in_the_air_the_centre_of_mass_falls_freely_and_rises_as_asked(rise):
    jump, plan = generate_jump(rise), plan_jump(rise)
    first, last = int(plan.take_off * 120) + 1, int(plan.landing * 120)
    assert gravity(jump, first, last) == pytest.approx(9.81, abs=1e-4)
    centre = centre_of_mass(jump)
    assert centre[first:last, 1].max() - 1.055 == pytest.approx(rise, abs=1e-3)
    assert np.ptp(centre[first:last, [0, 2]], axis=0).max() < 1e-6


def test_the_jump_as_it_is_made_keeps_to_the_ground_and_the_limits():
    made = generate_jump()
    push = np.gradient(np.gradient(centre_of_mass(made)[:, 1])) * 120**2
    assert push.min() > -9.82  # the ground never pulls
    check_floor(made, heel=1e-9)
    check_limits(made, hip=(-100, 35), ankle=(-45, 60))
    places = joint_positions(made)
    for joint, mark in made.contacts.items():
        track = places[:, SKELETON.index(joint)]
        assert np.ptp(track[mark], axis=0).max() < 1e-9
        assert track[mark, 1] == pytest.approx(FOOT.ankle if "foot" in joint else FOOT.ball, abs=1e-9)
        assert len(np.flatnonzero(np.diff(mark.astype(int)))) == 2
        assert not mark[AIR].any()
    assert list(JUMP.labels) == ["stand", "jump"]
    assert np.array_equal(JUMP.labels["stand"], ~JUMP.labels["jump"])
    assert not inspect(JUMP).flaws
    frames = JUMP.rotations.reshape(len(JUMP), -1)
    assert len(np.unique(frames.round(6), axis=0)) == len(frames)
