"""Slopes agree with finite differences; knees are hinges; pins that no body joins are refused."""

from dataclasses import replace

import numpy as np
import pytest

from mocap.body.limbs import find_legs
from mocap.datasets.samples import sample
from mocap.editing import body_of
from mocap.editing.bodies import hinge_of, require_reachable
from mocap.editing.pins import join_pins, pin, plant_pins
from mocap.files.load_save import load
from tests.editing.wishes import captured, far_hand, hand, walk
from tests.refusals import refused

LEGS = find_legs(walk().skeleton)


def test_only_joints_above_a_pinned_one_take_part_and_the_price_is_what_they_move():
    clip = walk()
    body = body_of(clip, [joint for leg in LEGS for joint in (leg.ankle, leg.ball)])
    names = [clip.skeleton.names[j] for j in body.joints[np.diff(body.joints, prepend=-1) != 0]]
    assert names == ["root", "lfemur", "ltibia", "lfoot", "rfemur", "rtibia", "rfoot"]
    assert len(body.price) == 20 and body.price[:3].tolist() == [38.0] * 3
    root, hip, knee, ankle = body.price[[3, 6, 9, 10]]
    assert root > hip > knee > ankle > 1
    dear = body_of(clip, [LEGS[0].ankle], prices={"lfemur": 4.0})
    assert dear.price[6] == pytest.approx(4 * hip)
    round_and_round = body_of(sample("walk_circle"), [LEGS[0].ankle])
    assert (round_and_round.joints == 0).sum() == 3  # the root is no hinge, however far it turns about y


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
