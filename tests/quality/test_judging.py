"""Each flaw that is put into a clip, a joint or a walk is found by its own measure; captured people pass."""

import re
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings

from mocap.blending.joining import join
from mocap.body import GroundPath, Motion, concatenate, euler, find_legs, resample, rotations
from mocap.datasets import sample
from mocap.files import load_save
from mocap.quality.clip_flaws import inspect
from mocap.quality.joint_limits import joint_bends
from mocap.quality.judging import Judgement, Measure, judge, judgement_table
from tests.refusals import refused
from tests.strategies import planar, wave

WALK = resample(sample("walk_straight"), 60)


def stand_out(judged):
    """Name the measures beyond their limits, the worst first."""
    return [m.name for m in sorted(judged.measures, key=lambda m: -m.ratio) if m.ratio > 1]


def turned(joint, angles, axis):
    """Turn one joint of the walk by angles (F,), degrees, about an axis."""
    local = WALK.rotations.copy()
    place = WALK.skeleton.index(joint)
    turn = rotations.from_rotvec(np.outer(np.radians(angles), axis))
    local[:, place] = rotations.multiply(local[:, place], turn)
    return replace(WALK, rotations=local)


def trembling():
    noise = np.random.default_rng(0).normal(size=(*WALK.rotations.shape[:2], 3))
    return replace(WALK, rotations=rotations.multiply(WALK.rotations, rotations.from_rotvec(0.01 * noise)))


def lopsided():
    offsets = WALK.skeleton.offsets.copy()
    offsets[WALK.skeleton.index("lradius")] *= 1.1
    return replace(WALK, skeleton=replace(WALK.skeleton, offsets=offsets))


def measured(motion, name, **more):
    """Give one of the measures of a motion."""
    (found,) = (measure for measure in judge(motion, **more).measures if measure.name == name)
    return found


def held(motion, seconds):
    """Hold a pose in mid-walk."""
    counts = np.ones(len(motion), int)
    counts[200] += round(seconds * motion.fps)
    frames = np.repeat(np.arange(len(motion)), counts)
    roots, local = motion.root_positions[frames], motion.rotations[frames]
    return replace(motion, root_positions=roots, rotations=local, contacts={}, labels={})


def shortened_by(motion, seconds):
    """Leave out frames in mid-walk, without a blend."""
    middle = len(motion) // 2
    frames = np.delete(np.arange(len(motion)), slice(middle, middle + round(seconds * motion.fps)))
    roots, local = motion.root_positions[frames], motion.rotations[frames]
    return replace(motion, root_positions=roots, rotations=local, contacts={}, labels={})


def dipping(metres):
    """Lower the body for half a second."""
    seconds = np.abs(np.arange(len(WALK)) - 200) / WALK.fps
    depths = metres * np.clip(2 - 8 * seconds, 0, 1)
    return replace(WALK, root_positions=WALK.root_positions - depths[:, None] * [0, 1, 0])


FLAWS = {
    "jolt": lambda: concatenate([WALK[:200], WALK[240:]]),
    "cut": lambda: shortened_by(WALK, 0.05),
    "snap": lambda: turned("lfemur", np.where(np.arange(len(WALK)) < 100, 0.0, 25.0), [1, 0, 0]),
    "frozen": lambda: held(WALK, 0.3),
    "slip": lambda: replace(WALK, root_positions=WALK.root_positions * [1.3, 1, 1.3]),
    "toes": lambda: dipping(0.09),
    "tremble": trembling,
    "aloft": lambda: replace(WALK, root_positions=WALK.root_positions + 0.4 * np.eye(3)[1]),
    "sunk": lambda: replace(WALK, root_positions=WALK.root_positions - [0, 0.1, 0]),
    "rotation": lambda: turned("lwrist", 90.0 * (np.arange(len(WALK)) == 100), [1, 0, 0]),
    "lopsided": lopsided,
    "foot_sliding": lambda: replace(WALK, root_positions=WALK.root_positions * [0.8, 1, 0.8]),
    "sliding_speed": lambda: replace(WALK, root_positions=WALK.root_positions * [0.5, 1, 0.5]),
    "bent": lambda: turned("ltibia", np.where(np.arange(len(WALK)) % 120 < 30, -40.0, 0.0), [1, 0, 0]),
}


TRIED_ELSEWHERE = {"bones", "path", "size"}  # below, and in tests/cli/test_clips.py


def test_each_measure_is_explained_in_the_docstring_and_has_a_flaw_that_it_finds():
    explained = set(re.findall(r"^    - (\w+):", judge.__doc__, re.MULTILINE))
    assert explained == set(FLAWS) | TRIED_ELSEWHERE
    path = GroundPath(WALK.root_positions[:, [0, 2]])
    for motion in (WALK, FLAWS["aloft"]()):
        assert {measure.name for measure in judge(motion, path=path, stretch={}).measures} <= explained


@pytest.mark.parametrize("name", FLAWS)
def test_each_flaw_is_found_by_its_own_measure(name):
    good, bad = judge(WALK), judge(FLAWS[name]())
    assert stand_out(good) == []
    assert name in stand_out(bad)
    assert bad.score > good.score == 0


@pytest.mark.parametrize("name", ["walk_circle", "walk_curve_1", "sneak", "jog", "stop_and_go"])
def test_the_bundled_clips_pass_at_any_rate(name):
    for fps in (30, 60):
        assert stand_out(judge(resample(sample(name), fps)[: 20 * fps])) == []


@pytest.mark.parametrize(
    "name", ["jolt", "snap", "frozen", "slip", "foot_sliding", "sunk", "toes", "rotation"]
)
def test_a_flaw_is_as_large_at_each_frame_rate(name):
    flawed = FLAWS[name]()
    ratios = [measured(resample(flawed, fps), name).ratio for fps in (30, 60, 120)]
    assert min(ratios) > 1
    assert max(ratios) < 1.3 * min(ratios)


@pytest.mark.parametrize("fps", [30, 60, 120])
def test_a_cut_of_a_twentieth_second_is_seen_at_each_rate_and_after_resampling(fps):
    walk = resample(sample("walk_straight"), fps)[: 6 * fps]
    assert measured(walk, "cut").ratio < 0.6
    cut = shortened_by(walk, 0.05)
    middle = len(walk) // 2
    assert measured(cut, "cut").ratio > 1.2
    frame = int(measured(cut, "cut").where.removeprefix("frame "))
    assert abs(frame - middle) < fps / 30 + 1
    assert measured(resample(cut, 120), "cut").ratio > 1.2


def test_a_limb_that_leaps_alone_and_a_halt_are_no_cuts():
    leaping = turned("lfemur", np.where(np.arange(len(WALK)) < 100, 0.0, 40.0), [1, 0, 0])
    assert measured(leaping, "cut").ratio < 0.6 < 1 < measured(leaping, "snap").ratio
    assert measured(held(WALK, 0.3), "cut").ratio < 1


@pytest.mark.parametrize("factor", [0.8, 0.9, 1.3])
def test_the_foot_sliding_distance_does_not_depend_on_the_frame_rate(factor):
    sliding = replace(WALK, root_positions=WALK.root_positions * [factor, 1, factor], contacts={})
    values = [measured(resample(sliding, fps), "foot_sliding").value for fps in (30, 60, 120)]
    assert max(values) < 1.1 * min(values)


def test_fingers_and_toes_may_flip_and_sink():
    flip = 150.0 * (np.arange(len(WALK)) % 50 == 20)
    for joint in ("lthumb", "lfingers", "ltoes"):
        flipping = judge(turned(joint, flip, [1, 0, 0]))
        assert "rotation" not in stand_out(flipping) and "jolt" not in stand_out(flipping), joint


def test_a_low_frame_rate_shows_no_trembling():
    judged = judge(resample(WALK, 15))
    assert "tremble" not in [measure.name for measure in judged.measures]
    assert judged.left_out == ("tremble: 15 frames per second are too few to show it",)


def test_who_stands_or_comes_to_rest_is_not_frozen():
    standing = concatenate([replace(WALK[200:201], contacts={}, labels={})] * 60)
    assert measured(standing, "frozen").value == 0
    slower = np.cumsum(np.linspace(1, 0, 200) ** 2)  # frames of the walk, more and more slowly
    frames = (100 + slower).astype(int)
    fractions = (100 + slower - frames)[:, None]
    roots = WALK.root_positions[frames] * (1 - fractions) + WALK.root_positions[frames + 1] * fractions
    local = rotations.slerp(WALK.rotations[frames], WALK.rotations[frames + 1], fractions)
    resting = replace(WALK, root_positions=roots, rotations=local, contacts={}, labels={})
    assert measured(resting, "frozen").value == 0
    assert 0.28 < measured(held(WALK, 0.3), "frozen").value < 0.38


def test_the_slip_ratio_is_that_of_the_lengths_of_path_and_steps():
    for factor in (0.8, 1.1, 1.3, 1.8):
        longer = replace(WALK, root_positions=WALK.root_positions * [factor, 1, factor])
        slip = measured(longer, "slip")
        assert slip.value == pytest.approx(100 * abs(1 - 1 / factor), abs=1)
        assert slip.where == ("feet slide forwards" if factor > 1 else "feet slide backwards")
    assert measured(WALK[:12], "slip").where == "too short a walk to tell"


def swinging_arm(degrees, sideways=0.0):
    """Let the walk's left elbow bend by angles (F,), degrees, about an axis, and about one across it."""
    elbow = WALK.skeleton.index("lradius")
    upper, lower = WALK.skeleton.offsets[[elbow, WALK.skeleton.index("lwrist")]]
    axis = np.cross(upper, [0.0, 0.0, 1.0])
    axes = np.stack([axis, np.cross(axis, upper)])
    axes /= np.linalg.norm(axes, axis=-1, keepdims=True)
    vectors = np.radians(np.stack(np.broadcast_arrays(degrees, sideways), axis=-1)) @ axes
    bends = rotations.from_rotvec(vectors)
    local = WALK.rotations.copy()
    local[:, elbow] = rotations.multiply(bends, rotations.between(lower, upper))
    arm = replace(WALK, rotations=local)
    return next(bend for bend in joint_bends(arm) if bend.joint == "lradius")


def test_feet_that_hang_in_the_air_do_not_slide():
    frames = np.arange(len(WALK))
    is_sliding = frames >= 0.2 * len(WALK)  # to walk on a path twice as long
    shift = np.where(is_sliding, frames - frames[is_sliding][0], 0)[:, None] / WALK.fps * [0, 0, 1.2]
    sliding = replace(WALK, root_positions=WALK.root_positions + shift)
    raised = replace(sliding, root_positions=sliding.root_positions + is_sliding[:, None] * [0, 0.4, 0])
    for name in ("slip", "sliding_speed"):
        assert measured(sliding, name).ratio > 1
        assert measured(raised, name).ratio < 1


def test_an_arm_that_is_nearly_straight_has_no_backwards():
    wave = np.sin(0.1 * np.arange(len(WALK)))
    nearly_straight = swinging_arm(2 + 15 * wave)
    assert nearly_straight.smallest == -np.inf and nearly_straight.fraction.max() < 0.2
    bent = swinging_arm(30 + 45 * wave)
    assert bent.angles.min() == pytest.approx(-15, abs=0.1)
    assert bent.fraction.max() == pytest.approx(1.5, abs=0.01)
    # A few bends to the side are no bends backwards, however large.
    aside = swinging_arm(np.where(wave > -0.99, 30.0, -1.0), np.where(wave > -0.99, 0.0, 31.0))
    assert aside.smallest == -10 and -5 < aside.angles.min() < 0


def test_an_elbow_that_bends_backwards_is_found():
    bent, straight = (measured(turned("lradius", np.full(len(WALK), a), [1, 0, 0]), "bent") for a in (-25, 0))
    swung = np.where(np.arange(len(WALK)) % 200 < 20, 60.0, 0.0)
    broken = measured(turned("lradius", swung, [1, 0, 0]), "bent")
    assert broken.ratio > 1 > straight.ratio
    assert broken.where.startswith("'lradius' bent by -")
    assert bent.ratio < broken.ratio


@given(planar)
@settings(max_examples=5)
def test_where_it_happens_and_which_way_makes_no_difference(place):
    walk = FLAWS["foot_sliding"]()[:200]
    values, there = ({m.name: m.value for m in judge(m).measures} for m in (walk, place.apply_motion(walk)))
    # A plant may end a frame sooner.
    assert there.pop("foot_sliding") == pytest.approx(values.pop("foot_sliding"), rel=0.02)
    assert there == pytest.approx(values, rel=1e-6, abs=1e-6)


def test_a_cut_stands_out_against_the_clips_and_a_blend_does_not():
    cut, blend = concatenate([WALK[:200], WALK[240:]]), join(WALK, 250, WALK, 116, 20)
    ratios = [judge(motion, against=[WALK]).measures[0].ratio for motion in (cut, blend)]
    assert ratios[0] > 1 > ratios[1]


def test_the_path_is_measured_where_one_is_given():
    x, z = WALK.root_positions[:, [0, 2]].T
    beside = GroundPath(np.stack([x + 0.3, z], axis=1))
    (off,) = (m for m in judge(WALK, path=beside).measures if m.name == "path")
    assert 25 < off.value <= 30 + 1e-6
    assert off.ratio > 1
    assert "path" not in [measure.name for measure in judge(WALK).measures]


def test_a_body_without_known_names_is_measured_as_one_with_them():
    names = tuple(f"b{number}" for number in range(len(WALK.skeleton)))
    skeleton = replace(WALK.skeleton, names=names)
    judged = judge(Motion(skeleton, WALK.root_positions, WALK.rotations, WALK.fps))
    assert judged.left_out == ()
    usual = {measure.name: measure.value for measure in judge(WALK).measures}
    for measure in judged.measures:
        assert measure.value == pytest.approx(usual[measure.name], rel=1e-6, abs=1e-6)


def test_a_body_without_legs_is_measured_without_its_feet():
    judged = judge(wave(60))
    names = {measure.name for measure in judged.measures}
    assert {"jolt", "tremble", "sunk", "rotation", "bent", "size"} <= names
    assert not names & {"foot_sliding", "sliding_speed"}
    assert judged.left_out[0].startswith("feet and knees: No legs found")
    table = judgement_table([judged, judge(WALK)])
    assert {"sliding_speed", "bent"} <= set(table.splitlines()[0].split())
    assert " - " in table


def test_one_who_does_not_move_is_no_fault():
    assert stand_out(judge(concatenate([replace(WALK[:1], contacts={}, labels={})] * 30))) == []


def test_the_score_counts_doublings_beyond_the_limits():
    measures = (Measure("a", 4, 1, ""), Measure("b", 0.1, 1, ""), Measure("c", 2, 1, ""))
    judged = Judgement("x", 9, 30.0, measures, (), 1.7, {})
    assert (judged.score, judged.worst.name, stand_out(judged)) == (3.0, "a", ["a", "c"])


def test_too_short_a_motion_is_refused():
    refused("To judge 'wave' takes 12 frames or more, it has 11", judge, wave(11))
    assert judge(wave(12)).frames == 12


def test_captured_people_pass_and_flaws_are_ranked_behind_them(real_data):
    good = ["cmu/02/02_01.amc", "cmu/16/16_35.amc", "bvh/olaf_bvh_toolbox/walk01.bvh"]
    good += ["bvh/bandai_namco/dataset-2_walk_normal_001.bvh"]
    for name in good:
        assert stand_out(judge(load_save.load(real_data / name))) == [], name
    inches = real_data / "bvh/pymo/AV_8Walk_Meredith_HVHA_Rep1.bvh"
    assert stand_out(judge(load_save.load(inches, scale=0.0254))) == []
    (size,) = (m for m in judge(load_save.load(inches, scale=0.01)).measures if m.ratio > 1)
    assert (size.name, size.where) == ("size", "0.582 m tall; 1.48 m if it is in inches")
    # Smoothed limbs slide, compared with the same take; a body that stands along z has no hands in the floor.
    ratios = {
        name: {m.name: m.ratio for m in judge(load_save.load(real_data / name)).measures}
        for name in ("bvh/imusim/16_15.bvh", "cmu/16/16_15.amc", "bvh/pybvh/bvh_test1.bvh")
    }
    smoothed, captured = (
        ratios[name]["sliding_speed"] for name in ("bvh/imusim/16_15.bvh", "cmu/16/16_15.amc")
    )
    assert 1 > smoothed > 1.3 * captured
    assert ratios["bvh/pybvh/bvh_test1.bvh"]["sunk"] < 1


@pytest.mark.parametrize("metres", [0.01, 68.0])
def test_a_body_of_another_size_gets_no_perfect_score(metres):
    walk = WALK[:120]
    times = metres / judge(walk).height
    small = replace(
        walk,
        root_positions=times * walk.root_positions,
        skeleton=replace(walk.skeleton, offsets=times * walk.skeleton.offsets),
    )
    judged = judge(small)
    assert judged.score > 1 and "size" in stand_out(judged)
    assert f"{judged.height:.3g} m" in judgement_table([judged])


def test_one_who_lies_down_is_as_long_as_tall():
    walk = WALK[:60]
    lying = walk.rotations.copy()
    lying[:, 0] = rotations.multiply(rotations.from_rotvec([-np.pi / 2, 0, 0]), lying[:, 0])
    down = judge(replace(walk, rotations=lying))
    assert down.height < 0.75 and "size" not in stand_out(down)


def test_bones_that_stretch_are_a_flaw_and_their_lengths_are_given():
    stretched = measured(WALK[:60], "bones", stretch={"lfoot": 0.002, "rtibia": 0.012})
    assert (stretched.value, stretched.ratio, stretched.where) == (12.0, 2.4, "'rtibia'")
    assert measured(WALK[:60], "bones", stretch={}).value == 0
    bones = judge(WALK[:60]).as_dict()["bones"]
    assert len(bones) == len(WALK.skeleton) - 1
    assert bones["ltibia"] == pytest.approx(0.245 * 1.75)


@pytest.fixture
def clean():
    return replace(wave(120), fps=120.0)


def kinds(motion, angles=None):
    return {flaw.kind: flaw.frames for flaw in inspect(motion, angles).flaws}


def test_a_clean_clip_has_no_flaws_and_true_measures(clean):
    report = inspect(clean)
    assert report.flaws == []
    assert "flaws    none found" in report.table()
    assert report.path == pytest.approx(119 * 0.02, rel=0.1)
    assert report.height == pytest.approx(0.6, abs=0.1)
    turns = clean.rotations.copy()
    turns[:, 0] = rotations.about_y(np.linspace(0, 4, 120))
    report = inspect(replace(clean, rotations=turns))
    assert report.heading_change == pytest.approx(4)
    assert "turns left by 229° in all" in report.table()


def test_frozen_frames(clean):
    frames = np.arange(120)
    frames[30:34] = 29
    frames[60:62] = 59  # two repeats are too few to tell
    frames[116:] = 115
    assert kinds(clean[:1]) == {}
    frozen = replace(clean, root_positions=clean.root_positions[frames], rotations=clean.rotations[frames])
    assert kinds(frozen) == {"frozen": [30, 31, 32, 33, 116, 117, 118, 119], "teleport": [34]}
    assert "frozen in frame 30-33, 116-119" in inspect(frozen).table()


def test_a_teleport(clean):
    roots = clean.root_positions.copy()
    roots[50:] += [0, 0, 0.2]
    report = inspect(replace(clean, root_positions=roots))
    assert [str(flaw) for flaw in report.flaws] == ["teleport in frame 50 (0.22 m at most)"]


def test_a_snap_and_an_euler_flip(clean):
    angles = np.degrees(euler.to_euler("xyz", clean.rotations[:, 1]))
    assert kinds(clean, {"elbow": angles, "stranger": angles * 9}) == {}
    flipped = angles.copy()
    flipped[40:80] = flipped[40:80] * [1, -1, 1] + 180
    assert kinds(clean, {"elbow": flipped}) == {"Euler flip": [40, 80]}
    turns = clean.rotations.copy()
    turns[70:, 1] = rotations.multiply(turns[70:, 1], rotations.about_y(1.5))
    report = inspect(replace(clean, rotations=turns))
    assert [str(flaw) for flaw in report.flaws] == ["snap in frame 70 ('elbow' by 85° at most)"]


@pytest.mark.parametrize("fps", [30, 60, 120])
def test_a_leap_out_of_a_rest_pose_is_a_snap_at_each_rate(fps):
    slow = resample(WALK, 30)
    turns = slow.rotations.copy()
    arm = slow.skeleton.index("lhumerus")
    turns[:2, arm] = rotations.multiply(turns[:2, arm], rotations.from_rotvec([0, 0, np.radians(85)]))
    (frames,) = kinds(resample(replace(slow, rotations=turns), fps)).values()
    assert frames == list(range(fps // 30 + 1, 2 * fps // 30 + 1))
    assert kinds(resample(slow, fps)) == {}


def test_zeros_and_feet_under_the_floor(clean):
    roots, turns = clean.root_positions.copy(), clean.rotations.copy()
    roots[5], turns[5] = 0, rotations.IDENTITY
    assert kinds(replace(clean, root_positions=roots, rotations=turns))["nothing but zeros"] == [5]
    low = replace(clean, root_positions=clean.root_positions - [0, 1.1, 0])
    assert kinds(low)["under the floor"] == list(range(120))
    assert "under the floor in frame 0-119 ('root' by 12 cm at most)" in inspect(low).table()


REAL = [
    ("cmu/03/03_02.amc", None, {"frozen": (11, 23, 13), "teleport": (24, 24, 1)}),
    ("cmu/49/49_04.amc", None, {"frozen": (245, 250, 6)}),
    ("cmu/16/16_17.amc", None, {"Euler flip": (430, 430, 1)}),
    ("cmu/02/02_01.amc", None, {}),
    ("odd/encadyma/null.amc", "odd/golf.asf", {"nothing but zeros": (0, 0, 1)}),
    ("cmu/127/127_30.amc", None, {"under the floor": (0, 52, 24)}),
    ("bvh/olaf_bvh_toolbox/walk01.bvh", None, {}),
]


@pytest.mark.parametrize(("name", "skeleton", "flaws"), REAL)
def test_real_flaws(real_data, name, skeleton, flaws):
    skeleton = skeleton and real_data / skeleton
    motion = load_save.load(real_data / name, skeleton=skeleton)
    found = kinds(motion, load_save.read_angles(real_data / name, skeleton=skeleton))
    for kind, expected in flaws.items():
        assert (found[kind][0], found[kind][-1], len(found[kind])) == expected
    assert set(found) - set(flaws) <= {"snap", "under the floor"} if flaws else found == {}


SHORT = resample(sample("walk_straight"), 30)[:90]


def worst(motion, turns=()):
    """Give the name of the joint that is most beyond its limit, the way, and its share."""
    local = motion.rotations.copy()
    for name, degrees, axis in turns:
        joint = motion.skeleton.index(name)
        local[:, joint] = rotations.multiply(
            rotations.from_rotvec(np.radians(degrees) * np.array(axis, float)), local[:, joint]
        )
    turned = replace(motion, rotations=local)
    bend = max(joint_bends(turned, find_legs(motion.skeleton)), key=lambda bend: bend.fraction.max())
    return bend.joint, bend.direction, bend.fraction.max()


def test_a_walk_stays_within_all_limits():
    assert worst(SHORT)[2] < 0.6


BEYOND = [
    ([("lfemur", 60, (1, 0, 0))], "lfemur", "back"),
    ([("lfemur", 100, (0, 0, 1))], "lfemur", "out"),
    ([("rfemur", -100, (0, 0, 1))], "rfemur", "out"),
    ([("rfemur", 85, (0, 0, 1))], "rfemur", "out"),  # across the other leg
    ([("lowerneck", 60, (1, 0, 0)), ("upperneck", 60, (1, 0, 0))], "lowerneck", "nodding"),
    ([("lwrist", 100, (1, 0, 0))], "lwrist", "bent"),
    ([("ltibia", -100, (1, 0, 0))], "ltibia", "bent"),  # backwards in all frames
]


@pytest.mark.parametrize(("turns", "joint", "way"), BEYOND)
def test_a_joint_turned_beyond_its_limit_is_found(turns, joint, way):
    assert worst(SHORT, turns)[:2] == (joint, way)
    assert worst(SHORT, turns)[2] > 1
    few = [(name, degrees / 2, axis) for name, degrees, axis in turns if name != "ltibia"]
    assert worst(SHORT, few)[2] < 1


def test_without_legs_or_names_the_rest_is_measured():
    assert {bend.joint for bend in joint_bends(SHORT)} == {"lradius", "lwrist", "rradius", "rwrist"}
    names = [f"joint {number}" for number in range(len(SHORT.skeleton))]
    nameless = replace(SHORT, skeleton=replace(SHORT.skeleton, names=names), contacts={})
    assert joint_bends(nameless) == []
    knees = joint_bends(nameless, find_legs(SHORT.skeleton))
    assert len(knees) == 2
