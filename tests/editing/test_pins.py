"""One box stands for holds, rails, floors and bars; joints keep how they turn, and knees are hinges."""

from dataclasses import replace

import numpy as np
import pytest

from mocap._shared.arrays import runs
from mocap.body import find_legs, rotations
from mocap.body.kinematics import forward_kinematics, hinge_of, joint_positions
from mocap.datasets.samples import sample
from mocap.editing import Pins, body_of, difference, edit, hierarchy, join_pins, pin, pin_errors, plant_pins
from mocap.editing.constraint_checks import require_reachable
from mocap.editing.pins import keep_turned, limit_turns, with_plants
from mocap.files.load_save import load
from tests.editing.wishes import bar, captured, far_hand, hand, shakes, smoothness, walk
from tests.refusals import refusals, refused
from tests.strategies import random_motion

INF = np.inf


def box(low, high=None, joint=1):
    low = np.asarray(low, float)
    return Pins((joint,), low.reshape(1, 1, 3), np.asarray(low if high is None else high).reshape(1, 1, 3))


BOXES = [
    ([1, 2, 3], [1, 2, 3], [1, 2, 3]),  # a hold
    ([1, 2, -INF], [1, 2, INF], [1, 2, 0]),  # a rail along z
    ([-INF, 0.5, -INF], [INF] * 3, [0, 0.5, 0]),  # a floor above the joint
    ([-INF] * 3, [INF, -0.5, INF], [0, -0.5, 0]),  # a bar below it
    ([-1, -1, -1], [1, 1, 1], [0, 0, 0]),  # a box that it is in
]


@pytest.mark.parametrize(("low", "high", "gap"), BOXES)
def test_the_gap_is_the_way_into_the_box(low, high, gap):
    """As in [Gle98, constraints]."""
    pins = box(low, high)
    assert pins.positions.residual(np.zeros((1, 1, 3)))[0, 0].tolist() == gap
    assert pins.held[0, 0].tolist() == [a == b for a, b in zip(low, high, strict=True)]
    assert pins.constrained.all()
    assert not box([-INF] * 3, [INF] * 3).constrained.any()


def test_a_pin_asks_in_its_frames_only():
    clip = random_motion(0, frames=9)
    for frames in (slice(3, 5), [3, 4], np.arange(9) // 2 == 2, np.array([4, 3])):
        pins = pin(clip, "joint2", frames, [0, 1, 2])
        rows = [4, 5] if np.asarray(frames).dtype == bool else [3, 4]
        assert np.flatnonzero(pins.constrained).tolist() == rows
        assert pins.joints == (2,) and pins.low[4, 0].tolist() == [0, 1, 2]
    path = np.arange(6.0).reshape(2, 3)
    assert pin(clip, 2, [3, 4], path).low[[3, 4], 0].tolist() == path.tolist()
    assert np.flatnonzero(pin(clip, 2, slice(0, 9), [0, 0, 0]).limited_to([2]).constrained).tolist() == [2]
    assert len(pin(clip, 2, slice(0, 9), [0, 0, 0])[2:4]) == 2


def test_pins_that_are_joined_with_no_others_stay_as_they_are():
    hold = box([1, 2, 3])
    joined = join_pins(hold)
    assert joined.joints == hold.joints
    assert np.array_equal(joined.low, hold.low)
    assert np.array_equal(joined.high, hold.high)


def test_a_clip_is_marked_only_where_it_is_not():
    clip = sample("walk_straight")[:60]
    assert with_plants(clip) is clip
    assert with_plants(replace(clip, contacts={})).contacts.keys() == clip.contacts.keys()


def test_of_two_holds_the_later_goes_before_and_a_hold_goes_before_a_box():
    hold, floor = box([1, 2, 3]), box([-INF, 9, -INF], [INF] * 3)
    for several in ((hold, floor), (floor, hold)):
        joined = join_pins(*several)
        assert joined.low.ravel().tolist() == joined.high.ravel().tolist() == [1, 2, 3]
    assert join_pins(hold, box([4, 5, 6])).low.ravel().tolist() == [4, 5, 6]
    under = join_pins(floor, box([-INF] * 3, [INF, 10, INF]))
    assert (under.low[0, 0, 1], under.high[0, 0, 1]) == (9, 10)
    above = join_pins(box([-INF] * 3, [INF, 8, INF]), floor)
    assert (above.low[0, 0, 1], above.high[0, 0, 1]) == (9, INF)  # they have nothing in common: the later one
    both = join_pins(hold, box([0, 0, 0], joint=4))
    assert both.joints == (1, 4) and both.held.all()


def test_plants_are_held_at_one_place_each():
    """As in [Gle98, constraints]."""
    clip = walk()
    pins = plant_pins(clip)
    assert [clip.skeleton.names[j] for j in pins.joints] == ["lfoot", "ltoes", "rfoot", "rtoes"]
    for column, joint in enumerate(pins.joints):
        marks = clip.contacts[clip.skeleton.names[joint]]
        assert np.array_equal(pins.held[:, column].all(axis=-1), marks)
        places = np.unique(pins.low[marks, column].round(6), axis=0)
        assert 3 <= len(places) <= 5  # one for each plant
    assert pin_errors(clip, pins).max() < 5e-9  # the clip is stored to half a nanometre
    sliding = replace(clip, root_positions=clip.root_positions * [1, 1, 1.05])
    for start, stop in runs(clip.contacts["lfoot"]):
        mean = joint_positions(sliding)[start:stop, pins.joints[0]].mean(axis=0)
        assert plant_pins(sliding).low[start, 0] == pytest.approx(mean)
    away = joint_positions(clip)[:, pins.joints[0]] + [0, 0.3, 0]
    np.testing.assert_allclose(pin_errors(clip, pin(clip, "lfoot", range(len(clip)), away))[:, 0], 0.3)


CLIP = random_motion(0, frames=9)
ONE = np.ones((1, 1, 3))

test_bad_pins_are_named = refusals(
    ("No joint 'hand'", pin, CLIP, "hand", [0], [0, 0, 0]),
    ("No joint 6: there are 6", pin, CLIP, 6, [0], [0, 0, 0]),
    ("No joint -1", pin, CLIP, -1, [0], [0, 0, 0]),
    ("'random0' has 9 frames, counted from 0", pin, CLIP, 2, [9], [0, 0, 0]),
    ("frames are their numbers, a slice", pin, CLIP, 2, [0.5], [0, 0, 0]),
    (r"'joint2': a place is \(3,\) or \(1, 3\) metres, got \(2,\)", pin, CLIP, "joint2", [3], [0, 0]),
    ("Frame 3, joint 2: a pin needs low ≤ high, got nan", pin, CLIP, 2, [3], [0, np.nan, 0]),
    ("Frame 3, joint 2: .* got inf", pin, CLIP, 2, [3], [0, INF, 0]),
    ("Frame 3, joint 2: .* got 2 and 1 for y", pin, CLIP, 2, [3], [0, 2, 0], [0, 1, 0]),
    ("Frame 0, joint 2", lambda: Pins((2,), np.ones((4, 1, 3)), np.zeros((4, 1, 3)))),
    ("2 different joints need", lambda: Pins((2, 2), np.ones((4, 2, 3)), np.ones((4, 2, 3)))),
    ("1 different joints need", lambda: Pins((2,), np.ones((4, 3)), np.ones((4, 3)))),
    ("same number of frames, got none", join_pins),
    ("same frames, got 1 and 9", lambda: Pins((2,), ONE, ONE, limit_turns(CLIP, ["joint2"]).rotations)),
    ("got 1, 9", join_pins, box([0, 0, 0]), pin(CLIP, 2, [3], [0, 0, 0])),
    ("'random0' has 9 frames, its pins have 1", pin_errors, CLIP, box([0, 0, 0])),
    ("No joint 8", pin_errors, CLIP[:1], box([0, 0, 0], joint=8)),
    ("No legs found", plant_pins, CLIP),
)


NECK = ["lowerneck", "upperneck", "head"]


def turned(motion, base, joint):
    """By how many degrees a joint is turned otherwise in the world, at most."""
    number = base.skeleton.index(joint)
    a, b = (rotations.from_matrix(forward_kinematics(m).matrices[:, number]) for m in (motion, base))
    return np.degrees(rotations.angle_between(a, b)).max()


@pytest.mark.parametrize("real", [False, True])
def test_a_hand_reaches_and_the_trunk_stays_as_it_is(real, request):
    """A joint keeps how it is turned [Gle98, orientations], [LS99, orientations]."""
    clip = captured(request.getfixturevalue("real_data")) if real else walk()
    held = hand(clip, slice(216, 264), 240)
    upright = join_pins(held, keep_turned(clip, "thorax", slice(None)))
    made = edit(clip, upright)
    assert pin_errors(made, upright).max() < 1e-5 and turned(made, clip, "thorax") < 0.01
    assert shakes(made, clip, held) <= 1.15 and smoothness(made, clip) <= 1.15
    assert turned(edit(clip, held), clip, "thorax") > 10


def test_a_neck_stays_within_its_limits_under_a_bar(real_data):
    """Joints bend as far as they may [Gle98, joint limits], [LS99, joint limits]."""
    clip = captured(real_data)
    low, free = bar(clip, 1.35, 230), keep_turned(clip, "thorax", slice(None))
    limits = limit_turns(clip, NECK, margin=5.0)
    folded, kept = (edit(clip, join_pins(low, free, *more)) for more in ((), (limits,)))
    assert pin_errors(folded, limits).max() > 0.05 and pin_errors(kept, limits).max() < 1e-5
    assert pin_errors(clip, limit_turns(clip, NECK, margin=0.0)).max() < 1e-12  # as far as the clip itself
    turns = np.linalg.norm(difference(kept, clip).turns, axis=-1).max(axis=0)
    assert np.degrees(turns[[clip.skeleton.index(name) for name in NECK]]).max() < 25
    assert pin_errors(kept, low)[:, :4].max() < 1e-9


def test_turns_are_pinned_in_some_frames_and_joined():
    clip = walk()[:60]
    pins = join_pins(plant_pins(clip), keep_turned(clip, "head", [1, 2]), limit_turns(clip, NECK))
    assert pins.rotations.indices == [clip.skeleton.index(n) for n in ("head", *NECK)]
    assert pin_errors(clip, pins).shape == (60, 4 + 4) and not pin_errors(clip, pins)[:, 4:].any()
    assert pins.constrained[:, 4].sum() == 2
    some = pins.limited_to([2, 3])[[1, 2, 3]]
    assert some.constrained[:, 4:].sum(axis=0).tolist() == [1, 2, 2, 2]


def test_levels_keep_a_trunk_upright():
    clip = walk(30.0)
    held = join_pins(plant_pins(clip), hand(clip, slice(54, 66), 60))
    upright = join_pins(held, keep_turned(clip, "thorax", slice(None)))
    tips = [turned(hierarchy(clip, pins)[0], clip, "thorax") for pins in (held, upright)]
    assert tips[0] > 5 and tips[1] < 1


test_limits_that_are_none_are_refused = refusals(
    ("neck", limit_turns, walk()[:9], ["neck"]),
    ("above 0, got {'root': 0}", lambda: body_of(walk(), plant_pins(walk()), prices={"root": 0})),
    ("above 0, got {'root': inf}", lambda: body_of(walk(), plant_pins(walk()), prices={"root": INF})),
    ("0 degrees or more .* got -1", lambda: limit_turns(walk()[:9], NECK, margin=-1.0)),
)


LEGS = find_legs(walk().skeleton)


def test_only_joints_above_a_pinned_one_take_part_and_the_price_is_what_they_move():
    clip = walk()
    plants = plant_pins(clip)
    body, one = body_of(clip, plants), Pins(plants.joints[:1], plants.low[:, :1], plants.high[:, :1])
    names = [clip.skeleton.names[j] for j in body.joints[np.diff(body.joints, prepend=-1) != 0]]
    assert names == ["root", "lfemur", "ltibia", "lfoot", "rfemur", "rtibia", "rfoot"]
    assert len(body.price) == 20 and body.price[:3].tolist() == [38.0] * 3
    root, hip, knee, ankle = body.price[[3, 6, 9, 10]]
    assert root > hip > knee > ankle > 1
    assert body_of(clip, one, prices={"lfemur": 4.0}).price[6] == pytest.approx(4 * hip)
    assert (body_of(sample("walk_circle"), one).joints == 0).sum() == 3  # the root is no hinge


def test_knees_are_hinges_and_hips_are_not():
    for clip in (walk(), walk(30.0), sample("jog")):
        for leg in LEGS:
            assert np.abs(hinge_of(clip, leg.knee)) @ [1, 0, 0] > 0.999
            assert hinge_of(clip, leg.hip) is None
    # One frame shows no axis; then the file's axes count, where it says them.
    bent = walk()[:1]
    assert hinge_of(bent, LEGS[0].knee) is None or np.abs(hinge_of(bent, LEGS[0].knee)) @ [1, 0, 0] > 0.999
    dofs = list(bent.skeleton.dofs)
    dofs[LEGS[0].knee], dofs[LEGS[0].hip] = "x", "xyz"
    named = replace(bent, skeleton=replace(bent.skeleton, dofs=dofs))
    assert np.allclose(hinge_of(named, LEGS[0].knee), [1, 0, 0])
    assert hinge_of(named, LEGS[0].hip) is None


def test_captured_knees_are_hinges(real_data):
    for name, hinges in (
        ("cmu/49/49_02.amc", True),
        ("bvh/bandai_namco/dataset-1_walk_normal_001.bvh", True),
        ("bvh/pymo/AV_8Walk_Meredith_HVHA_Rep1.bvh", True),
        ("bvh/olaf_bvh_toolbox/walk01.bvh", True),
        ("bvh/puppy0512_motion_graph/walk_normal_stright.bvh", False),
    ):
        clip = load(real_data / name)
        for leg in find_legs(clip.skeleton):
            assert (hinge_of(clip, leg.knee) is not None) == hinges, name
    assert hinge_of(captured(real_data), LEGS[0].knee) is not None


def test_pins_farther_apart_than_the_bones_between_are_refused():
    clip, wrist = walk(), "rwrist"
    far = r"^Frame 24\d: 'rwrist' would be 5.* m from '\w+', the bones"
    refused(far, require_reachable, clip, join_pins(plant_pins(clip), far_hand(clip)))
    require_reachable(clip, join_pins(plant_pins(clip), hand(clip, [240], 240)))
    # A hand under a bar, feet on a floor: boxes count by their nearest corners.
    high = join_pins(
        pin(clip, wrist, [0], [-np.inf, 9, -np.inf], [np.inf] * 3),
        pin(clip, "lfoot", [0], [-np.inf] * 3, [np.inf, 0.1, np.inf]),
    )
    refused(r"'lfoot' would be 8\.90 m from 'rwrist'", require_reachable, clip, high)
