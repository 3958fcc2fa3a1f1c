"""The bundled clips: real walks bound them, the jump falls freely, feet stand and joints keep limits."""

from functools import cache
from itertools import pairwise

import numpy as np
import pytest
from bundled_clips import bundled_clips
from jumping import generate_jump, plan_jump
from scipy.signal import find_peaks
from walking import generate_walk
from walking.walking_body import FOOT, SKELETON

import mocap
from mocap._shared.arrays import runs
from mocap.body import Motion, rotations
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


def check_limits(motion, hip, ankle, knee=(4, 125), toes=(-65, 1e-6)):
    """Knees and elbows are hinges; joints turn within the limits given, degrees."""
    for side in "lr":
        turn = {
            bone: np.degrees(rotations.to_rotvec(motion.rotations[:, SKELETON.index(side + bone)]))
            for bone in ("femur", "tibia", "foot", "toes", "radius")
        }
        for bone, (least, most) in {
            "tibia": knee,
            "femur": hip,
            "foot": ankle,
            "toes": toes,
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


# The least and the most that `measure` finds in real clips: subject 16 of the CMU Graphics Lab Motion
# Capture Database, and for the winding walks also the homework's three clips.
REAL = {  # of winding walks, straight ones, and runs
    "speed": ((0.61, 1.05), (0.93, 1.32), (2.3, 4.2)),
    "cadence": ((80, 106), (99, 110), (149, 178)),
    "stride": ((0.84, 1.22), (1.02, 1.47), (1.8, 2.9)),
    "bob": ((2.1, 2.9), (2.9, 3.9), (7.4, 11.6)),
    "sway": (None, (4.5, 5.1), None),
    "knee": ((52, 66), (56, 62), (70, 93)),
    "hip": ((42, 51), (46, 56), (51, 76)),
    "ankle": ((32, 39), (33, 44), (48, 62)),
    "elbow straightest": ((17, 27), (16, 20), (87, 106)),
    "elbow most bent": ((37, 48), (36, 43), (116, 144)),
    "stance": ((50, 63), (46, 60), None),
    "double support": ((4, 26), (1, 22), (0, 0)),
}
WINDING, STRAIGHT, RUNNING = range(3)
KINDS = {"walk_circle": WINDING, "walk_curve_1": WINDING, "walk_curve_2": WINDING}
KINDS |= {"walk_straight": STRAIGHT, "jog": RUNNING}


@pytest.mark.parametrize(("name", "kind"), KINDS.items())
def test_a_clip_moves_as_real_people_do(name, kind):
    for motion in parts(sample("jog"), "jog") if name == "jog" else [sample(name)]:
        measured = measure(motion)
        limits = {key: row[kind] for key, row in REAL.items() if row[kind]}
        outside = {k: measured[k] for k, (low, high) in limits.items() if not low <= measured[k] <= high}
        assert outside == {}


# The 99th percentile of accelerations in m/s²: the median over CMU's walks 15, 16, 31, 32, 47, 58 and
# its runs 35, 36, 45. What noise there is in captured data adds to these, so they bound from above only.
PUSH = {
    "walk": {"root": 25, "head": 51, "foot": 51, "tibia": 47, "wrist": 71},
    "run": {"root": 88, "head": 68, "foot": 130, "tibia": 115, "wrist": 184},
}


@every_clip
def test_a_clip_is_as_smooth_as_real_ones_and_its_frames_and_feet_keep_apart(name):
    motion, at = sample(name), places(name)
    push = np.linalg.norm(np.diff(at, 2, axis=0), axis=-1) * motion.fps**2
    for bone, most in PUSH["run" if name == "jog" else "walk"].items():
        for joint in {bone, "l" + bone, "r" + bone} & set(SKELETON.names):
            assert np.percentile(push[:, SKELETON.index(joint)], 99) < most, joint
    check_floor(motion, heel=1e-3)
    check_limits(motion, hip=(-70, 35), ankle=(-45, 45))
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
        assert all(frames[mask].mean() > 0.9 for mask in clip.labels.values()), clip.name


test_bad_wishes_are_told = refusals(
    ("No bundled clip 'waltz'; there are walk_circle, .*, bend_walk and 24 walks", sample, "waltz"),
    ("there are: walk, sneak, jog", lambda: generate_walk([[0, 0], [0, 5]], style="hop")),
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
