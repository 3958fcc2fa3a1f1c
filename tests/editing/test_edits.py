"""One call: stones, bars, hands, rails, poses; feet stand to the last digit, and what cannot be is said."""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest

from mocap.body import joint_positions, resample, rotations
from mocap.datasets.samples import sample
from mocap.editing.constraint_checks import pin_errors
from mocap.editing.constraints import Pins
from mocap.editing.displacements import difference, displaced, spline_basis
from mocap.editing.edits import edit
from mocap.editing.keys import Key, keys_around, offsets
from mocap.editing.levels import hierarchy, scattered_fit
from mocap.editing.path_editing import plants_kept
from mocap.editing.pins import join_pins, pin, plant_pins
from mocap.editing.posing import posed
from mocap.errors import MocapError
from mocap.feet.footskate import clean_up
from tests.editing import wishes
from tests.editing.test_path_editing import slide
from tests.editing.wishes import bar, captured, hand, shakes, smoothness, stone, walk
from tests.refusals import refusals, told

pytestmark = pytest.mark.filterwarnings("error::mocap.errors.MocapWarning")


def all_stand(motion, base):
    """Whether every planted frame is still planted."""
    return all((motion.contacts[name] >= mark).all() for name, mark in base.contacts.items())


def check(motion, base, pins, most):
    assert pin_errors(motion, pins).max() < 1e-8
    assert all_stand(motion, base)
    assert smoothness(motion, base) <= most
    assert wishes.bones(motion) < 1e-12


GENERATED = product((120.0, 30.0), (0.15, 0.5))
CAPTURED = product(("cmu/16/16_15.amc", "hw3/walk_fwd_curve1.AMC"), (0.2, 0.5))  # the second one's knee jumps


@pytest.mark.parametrize(("clip", "height"), [*GENERATED, *CAPTURED])
def test_a_stone_under_a_step(request, clip, height):
    real = isinstance(clip, str)
    clip = captured(request.getfixturevalue("real_data"), clip) if real else walk(clip)
    pins = stone(clip, height)
    check(edited := edit(clip, pins), clip, pins, 1.15)
    assert shakes(edited, clip, pins) <= 1.15


def test_a_bar_to_duck_under(real_data):
    for clip, middle, height in ((captured(real_data), 230, 1.35), (walk(), 250, 1.4)):
        pins = bar(clip, height, middle)
        edited = edit(clip, pins)
        errors = pin_errors(edited, pins)
        assert errors[:, :4].max() < 1e-9 and errors.max() < 1e-5
        assert all_stand(edited, clip)
        assert smoothness(edited, clip) < (1.05 if clip.name == "16_15" else 1.2)
        assert shakes(edited, clip, pins) <= 1.15
        assert (wishes.between(*wishes.neck(edited)) - wishes.between(*wishes.neck(clip))).max() < 45
        head = joint_positions(edited)[:, clip.skeleton.index("head")]
        low = pins.high[:, pins.joints.index(clip.skeleton.index("head")), 1]
        assert (head[:, 1] - low).max() < 1e-5


def test_a_hand_held_while_the_body_walks_on(real_data):
    for clip, around in ((captured(real_data), 240), (walk(), 250)):
        still = hand(clip, slice(around - 24, around + 24), around)
        pins = join_pins(plant_pins(clip), still)
        check(edited := edit(clip, still), clip, pins, 1.25)
        assert shakes(edited, clip, pins) <= 1.15
        assert wishes.between(wishes.neck(edited)[0], wishes.neck(clip)[0]).max() < 15


def test_a_hand_on_a_rail_slides_along_it(real_data):
    clip = captured(real_data)
    wrist, frames = clip.skeleton.index("rwrist"), slice(180, 300)
    place = joint_positions(clip)[frames, wrist].mean(axis=0) + np.array([0.05, 0.15, 0])
    low, high = (np.where([False, False, True], end, place) for end in (-np.inf, np.inf))
    rail = pin(clip, wrist, frames, low, high)
    assert 0.1 < pin_errors(clip, rail).max() < 0.3
    check(edited := edit(clip, rail), clip, join_pins(plant_pins(clip), rail), 1.1)
    assert np.ptp(joint_positions(edited)[frames, wrist, 2]) > 0.5


def test_frames_more_than_a_second_from_a_pin_stay_the_same_to_the_last_bit():
    clip = walk()  # at 120 Hz
    places = joint_positions(clip)[:, clip.skeleton.index("lwrist")] + [0.0, 0.1, 0.05]
    pins = pin(clip, "lwrist", [200, 201], places[200:202])
    edited = edit(clip, pins)
    stays = np.r_[0:80, 322 : len(clip)]
    assert (edited.rotations[stays] == clip.rotations[stays]).all()
    assert (edited.root_positions[stays] == clip.root_positions[stays]).all()
    assert pin_errors(edited, pins).max() < 1e-9
    assert all_stand(edited, clip)
    whole = edit(clip, pins, frames=slice(None))
    assert (whole.rotations[0:80] != clip.rotations[0:80]).any()


def test_two_hands_far_apart_are_edited_each_by_itself():
    clip = walk()
    places = joint_positions(clip)[:, clip.skeleton.index("lwrist")] + [0.0, 0.1, 0.05]
    first, second = (pin(clip, "lwrist", [frame], places[[frame]]) for frame in (100, 400))
    both = edit(clip, join_pins(first, second))
    assert (both.rotations[:250] == edit(clip, first).rotations[:250]).all()
    alone = joint_positions(edit(clip, second))
    assert np.abs(joint_positions(both) - alone)[250:].max() < 1e-3  # prices follow the first edit


def test_nothing_asked_changes_nothing():
    clip = walk()
    assert edit(clip, pin(clip, "lwrist", [], [0, 0, 0])) is clip


@pytest.mark.parametrize("frames", [1, 2, 3, 5])
def test_a_few_frames_are_enough(frames):
    clip = walk()[240 : 240 + frames]
    wrist = joint_positions(clip)[0, clip.skeleton.index("lwrist")]
    pins = pin(clip, "lwrist", [0], wrist + np.array([0, 0.1, 0]))
    assert pin_errors(edit(clip, pins), pins).max() < 1e-4  # no frame shows the elbow's hinge


def test_what_cannot_be_is_said():
    clip = walk()
    wrist, elbow = (clip.skeleton.index(name) for name in ("rwrist", "rradius"))
    at = joint_positions(clip)
    apart = [pin(clip, j, [240], at[240, j] + np.array([0, y, 0])) for j, y in ((wrist, 0.1), (elbow, -0.1))]
    both = told(r"frame 240: 'r\w+' is \d+\S* mm off its pin", edit, clip, join_pins(*apart))
    errors = [pin_errors(both, one)[240, 0] for one in apart]
    assert min(errors) > 0.03 and max(errors) < 1.3 * min(errors)  # each gives way by as much


def test_errors_and_warnings_count_frames_from_the_first_of_the_clip():
    clip = sample("walk_straight")
    at = joint_positions(clip[800:801])[0]
    elbow, wrist = (clip.skeleton.index(name) for name in ("rradius", "rwrist"))
    raised = pin(clip, wrist, [800], at[wrist] + [0, 0.1, 0])
    told("frame 800: ", edit, clip, join_pins(raised, pin(clip, elbow, [800], at[elbow] - [0, 0.1, 0])))
    with pytest.raises(MocapError, match=r"^Frame 800: 'rwrist' would be"):
        edit(clip, pin(clip, wrist, [800], at[wrist] + [0, 9, 0]))


def test_the_fit_of_one_datum_and_of_two_has_the_papers_values():
    """As in [LS99, scattered data]."""
    basis = spline_basis(11, 5)
    one = scattered_fit(basis, np.array([[1.0]]), np.array([5]))
    np.testing.assert_allclose(one[1:4, 0], [1 / 3, 4 / 3, 1 / 3], atol=1e-12)
    np.testing.assert_allclose((basis @ one)[[5, 6], 0], [1, 0.9636], atol=1e-4)
    two = scattered_fit(basis, np.array([[1.0], [0.0]]), np.array([5, 6]))
    np.testing.assert_allclose((basis @ two)[[5, 6], 0], [0.527, 0.491], atol=1e-3)


@pytest.mark.parametrize("fps", [120.0, 30.0])
def test_each_level_more_than_halves_what_a_stone_leaves(fps):
    """As in [LS99, levels]."""
    clip = walk(fps)
    pins = stone(clip, 0.15)
    motion, told = hierarchy(clip, pins)
    left = np.array([level.rms for level in told])
    assert (left[1:-1] * 2 <= left[:-2]).all()
    assert left[-1] < 0.001 and wishes.rms(pin_errors(motion, pins), pins) == pytest.approx(left[-1], rel=0.3)
    assert smoothness(motion, clip) < 1.2
    assert told[-1].worst == pytest.approx(pin_errors(motion, pins).max())
    assert [level.knots for level in told] == [0.5, 0.25, 0.125, 0.06, 0.03][: len(told)]


def test_levels_do_not_fold_a_neck_under_a_bar(real_data):
    for clip, height, middle in ((walk(), 1.4, 250), (captured(real_data), 1.35, 230)):
        pins = bar(clip, height, middle)
        motion, _ = hierarchy(clip, pins)
        turns = np.degrees(np.linalg.norm(difference(motion, clip).turns, axis=-1)).max()
        assert turns < 40
        below = pins.high[..., 1] - joint_positions(motion)[:, pins.joints, 1]
        under = np.where(pins.high[..., 1] < 2, below, np.inf).min(axis=1)
        assert np.median(under[np.isfinite(under)]) < 0.04


def test_the_levels_end_where_the_pins_are_met():
    """As in [LS99, levels]."""
    clip = walk()
    for pins in (plant_pins(clip), pin(clip, "lwrist", [], [0, 0, 0])):
        motion, told = hierarchy(clip, pins)
        assert motion is clip and not told


def levels(*knots):
    return hierarchy(walk(), plant_pins(walk()), knots=knots)


test_what_cannot_be_edited_is_refused = refusals(
    (r"Frame 24\d: 'rwrist' would be 5.\d+ m from '\w+', the bones", edit, walk(), wishes.far_hand(walk())),
    ("500 frames, its pins have 499", lambda: edit(walk(), hand(walk(), [240], 240)[:499])),
    ("No joint 99: there are 38", lambda: edit(walk(), Pins((99,), *np.zeros((2, len(walk()), 1, 3))))),
    ("mark_plants finds out", edit, replace(walk(), contacts={}), hand(walk(), [240], 240)),
    ("knots come nearer", levels),
    (r"got \(0.25, 0.5\)", levels, 0.25, 0.5),
    ("above 0 s", levels, 0.25, 0.0),
)


UP = np.array([0.0, 1.0, 0.0])


def post(motion, frame):
    """Return a place for the right hand, 32 cm from where it is: to the right, up, and ahead."""
    side, ahead = (rotations.rotate(motion.rotations[frame, 0], v) for v in ([-1.0, 0, 0], [0, 0, 1.0]))
    hand = joint_positions(motion[frame : frame + 1])[0, motion.skeleton.index("rhand")]
    return hand + 0.15 * side + 0.25 * UP + 0.10 * ahead


@pytest.mark.parametrize("frame", [150, 238])
def test_a_hand_to_a_post(frame):
    motion = sample("walk_straight")[:480]
    hand, target = motion.skeleton.index("rhand"), post(motion, frame)
    pose = posed(motion, frame, {"rhand": target})
    ratios = []
    for seconds in (0.15, 0.5):
        keys = keys_around(motion, [Key(frame, pose)], seconds)
        change = offsets(motion, keys)
        warped = displaced(motion, change)
        assert np.linalg.norm(joint_positions(warped)[frame, hand] - target) < 1e-5  # 0.01 mm
        outside = np.r_[0 : keys[0].frame + 1, keys[2].frame : len(motion)]
        assert np.abs(change.root[outside]).max() == np.abs(change.turns[outside]).max() == 0
        inside = slice(keys[0].frame, keys[2].frame)
        pushes = (np.diff(joint_positions(m), 2, axis=0)[inside, wishes.body(m)] for m in (motion, warped))
        before, after = (np.percentile(np.linalg.norm(push, axis=-1), 99) for push in pushes)
        ratios.append(after / before)
    assert ratios[0] > 1.5 and ratios[1] < 1.1  # too short a window jolts
    left = rotations.multiply(rotations.from_rotvec(change.turns), motion.rotations)
    miss = joint_positions(replace(motion, rotations=left))[frame, hand] - target
    assert np.linalg.norm(miss) > 0.01  # on the other side
    cleaned = clean_up(warped)
    assert slide(cleaned) < 1e-6 and plants_kept(cleaned, motion) >= 0.99


def test_an_elbow_folds_as_it_does():
    """Near its shoulder: in one leap it would fold by more than half a turn, and so backwards."""
    motion = resample(sample("walk_straight"), 30)[:60]
    upper, elbow = (motion.skeleton.index(name) for name in ("lhumerus", "lradius"))
    own = rotations.to_rotvec(motion.rotations[:, elbow]).mean(axis=0)
    for away in ([-0.16, 0.22, 0.36], [-0.11, 0.23, 0.31]):
        place = joint_positions(motion)[30, upper] + away
        made = edit(motion, pin(motion, "lwrist", [30], place))[30:31], posed(motion, 30, {"lwrist": place})
        assert all(rotations.to_rotvec(pose.rotations[0, elbow]) @ own > 0 for pose in made)


def test_a_height_alone_may_be_asked_for_without_feet():
    bare = replace(sample("walk_straight")[:120], contacts={})
    assert len(posed(bare, 0, {"lhand": [np.nan, 1.2, np.nan]}, feet=False)) == 1


SHORT = sample("walk_straight")[:120]

test_poses_that_cannot_be = refusals(
    ("'walk_straight' has 120 frames", posed, SHORT, 999, {"lhand": [0, 1, 0]}),
    ("No joint 'left hand'", posed, SHORT, 5, {"left hand": [0, 1, 0]}),
    (r"'lhand': a place is \(3,\)", posed, SHORT, 5, {"lhand": [0, 1]}),
    (r"Frame 5: '\w+' would be [\d.]+ m from '\w+', the bones", posed, SHORT, 5, {"lhand": [0, 6, 0]}),
    ("needs low ≤ high", posed, SHORT, 5, {"lhand": [0, np.inf, 0]}),
    ("mark_plants finds out", posed, replace(SHORT, contacts={}), 60, {"lhand": [0, 1.2, 0]}),
)
