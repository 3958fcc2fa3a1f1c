"""Feet are held where they stand: by a closed-form leg, exactly, and let go by a spring."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from mocap.body import Leg, Motion, forward_kinematics, joint_positions, rotations
from mocap.datasets import sample
from mocap.steering import HeldFeet
from mocap.steering.characters import Pose
from mocap.steering.held_feet import HeldFoot, fade
from mocap.steering.leg_reach import (
    JointedLeg,
    hinge_angle,
    knee_axis,
    soft_reach,
)
from mocap.steering.plain_vectors import axis_rotation, multiply, rotate, shortest_arc
from mocap.steering.tuned import TUNED
from tests.bundled import clips
from tests.refusals import refusals

WALK = sample("walk_straight")
LEG = Leg(2, 3, 4, 5)
KNEE_BENDS = rotations.angle_between(WALK.rotations[:, LEG.knee], rotations.IDENTITY)
BENT = WALK.root_positions[KNEE_BENDS.argmax()], WALK.rotations[KNEE_BENDS.argmax()]  # no limit is near
STANDS = WALK.contacts["lfoot"] & WALK.contacts["ltoes"]
STANDING = int(np.flatnonzero(STANDS)[np.argmin(KNEE_BENDS[STANDS])])
UPRIGHT = WALK.root_positions[STANDING], WALK.rotations[STANDING]  # on a flat left foot, its leg straight
numbers = st.floats(-2, 2)
vectors = st.tuples(numbers, numbers, numbers).filter(lambda v: np.linalg.norm(v) > 0.1)


def moved(pose, joints=(LEG.hip, LEG.knee, LEG.ankle, LEG.ball), skeleton=WALK.skeleton):
    """Return the positions of joints in a pose."""
    root, turns = pose
    return joint_positions(Motion(skeleton, root[None], turns[None], 30.0))[0, list(joints)]


def bent(frame, offset, yaw=0.0):
    """Bend the left leg of a frame; return the pose before and after."""
    before = WALK.root_positions[frame], WALK.rotations[frame]
    leg = JointedLeg(WALK.skeleton, LEG, knee_axis(WALK, LEG))
    turns = before[1].copy()
    for joint, rotation in leg.bend(leg.place(*before), offset, yaw).items():
        turns[joint] = rotation
    return before, (before[0], turns)


@given(vectors, vectors, st.floats(-3, 3))
def test_plain_numbers_agree_with_the_arrays_of_rotations(axis, vector, angle):
    unit = tuple(np.divide(axis, np.linalg.norm(axis)).tolist())
    turn = axis_rotation(unit, angle)
    other = axis_rotation((0.0, 0.0, 1.0), 0.7)
    np.testing.assert_allclose(turn, rotations.from_rotvec(angle * np.array(unit)), atol=1e-12)
    np.testing.assert_allclose(rotate(turn, vector), rotations.rotate(turn, vector), atol=1e-12)
    np.testing.assert_allclose(multiply(turn, other), rotations.multiply(turn, other), atol=1e-12)


@given(vectors, vectors)
def test_the_shortest_arc_turns_one_direction_into_the_other(start, end):
    cosine = np.dot(start, end) / np.linalg.norm(start) / np.linalg.norm(end)
    if cosine > -0.99:
        turned = np.array(rotate(shortest_arc(start, end), start)) / np.linalg.norm(start)
        np.testing.assert_allclose(turned, np.divide(end, np.linalg.norm(end)), atol=1e-9)


@given(vectors, vectors, vectors, st.floats(0, 1))
def test_a_hinge_brings_the_end_of_its_segment_to_the_distance(axis, base, segment, share):
    """All distances between the nearest and the farthest end of the circle, found by turning it."""
    unit = tuple(np.divide(axis, np.linalg.norm(axis)).tolist())

    def distance(angle):
        return math.dist(base, rotate(axis_rotation(unit, angle), segment))

    within = [distance(angle) for angle in np.linspace(-np.pi, np.pi, 100)]
    goal = min(within) + share * (max(within) - min(within))
    assert distance(hinge_angle(unit, base, segment, goal)) == pytest.approx(goal, abs=1e-6)


@settings(max_examples=30)
@given(
    st.integers(0, len(WALK) - 1),
    st.tuples(*[st.floats(-0.05, 0.05)] * 3),
    st.floats(-0.7, 0.7),
)
def test_an_ankle_reaches_its_target_and_all_bones_keep_their_lengths(frame, offset, yaw):
    before, after = (moved(pose) for pose in bent(frame, offset, yaw))
    lengths = [np.linalg.norm(np.diff(points, axis=0), axis=1) for points in (before, after)]
    np.testing.assert_allclose(*lengths, atol=1e-12)
    np.testing.assert_array_equal(before[0], after[0])  # the hip
    leg = sum(lengths[0][:2])
    if math.dist(before[0], before[2] + offset) <= max(
        TUNED.soft_reach * leg, math.dist(before[0], before[2])
    ):
        np.testing.assert_allclose(after[2], before[2] + offset, atol=1e-9)
    foot = before[3] - before[2]
    np.testing.assert_allclose(after[3] - after[2], rotations.rotate(rotations.about_y(yaw), foot), atol=1e-9)


def test_no_change_is_asked_for_so_nothing_changes():
    for frame in range(0, len(WALK), 50):
        before, after = (moved(pose) for pose in bent(frame, (0.0, 0.0, 0.0)))
        np.testing.assert_allclose(before, after, atol=1e-9)


def test_a_leg_is_stretched_softly_and_never_straight():
    targets = np.linspace(0.8, 1.3, 200)
    reached = np.array([soft_reach(target, 0.9, 1.0) for target in targets])
    slopes = np.diff(reached) / np.diff(targets)
    assert (slopes >= 0).all() and np.diff(slopes).max() < 1e-9  # it only slows down
    assert reached.max() < TUNED.longest_reach
    unchanged = targets <= TUNED.soft_reach
    assert (reached[unchanged] == targets[unchanged]).all()
    assert soft_reach(1.2, 1.0, 1.0) == 1.0  # a straight leg of the clip stays as it is


def test_the_spring_is_the_solution_of_its_equation():
    """x'' = -y² x - 2 y x', solved by steps."""
    stiffness = 2 * math.log(2) / 0.2
    times = np.linspace(0, 0.6, 7)
    solved = solve_ivp(
        lambda _, x: [x[1], -(stiffness**2) * x[0] - 2 * stiffness * x[1]],
        (0, 0.6),
        [0.1, -0.5],
        t_eval=times,
        rtol=1e-10,
        atol=1e-12,
    )
    faded = [fade(0.1, -0.5, 0.2, time) for time in times]
    np.testing.assert_allclose(np.transpose(faded), solved.y, atol=1e-8)


def test_a_foot_that_lifts_fades_as_its_spring_says():
    foot = HeldFoot(0.2, 1 / 30)
    for place in (0.0, 0.01, 0.02):
        foot.follow(place + 0j, 0.1 + 0j, ankle_stands=True, ball_stands=True)
    held = foot.offset, foot.offset_velocity
    assert held == (pytest.approx(-0.02), pytest.approx(-0.3))
    for frame in range(1, 10):
        foot.follow(0.02 + 0j, 0.1 + 0j, ankle_stands=False, ball_stands=False)
        assert foot.offset == pytest.approx(fade(*held, 0.2, frame / 30)[0])


def standing_still(pose, moves):
    """Hold the left foot, flat, while the body moves and turns about its root: the poses shown."""
    feet = HeldFeet(WALK)
    stands = {"lfoot": True, "ltoes": True, "rfoot": False, "rtoes": False}
    for place, yaw in moves:
        turns = pose[1].copy()
        turns[0] = rotations.multiply(rotations.about_y(yaw), turns[0])
        yield feet.hold(Pose(pose[0] + place, turns, blending=False, contacts=stands))


def test_a_foot_is_held_to_a_micrometre_while_the_body_turns_and_moves():
    moves = [(np.array([0.002 * n, 0.0, 0.001 * n]), 0.02 * n) for n in range(15)]
    shown = [moved((held.root_position, held.rotations))[2:] for held in standing_still(BENT, moves)]
    assert np.ptp(shown, axis=0)[:, [0, 2]].max() < 1e-6


def test_a_foot_whose_ankle_lifts_pivots_about_the_ball_where_it_stood():
    feet = HeldFeet(WALK)
    balls = []
    for number in range(14):
        turns = BENT[1].copy()
        turns[0] = rotations.multiply(rotations.about_y(0.03 * min(number, 7)), turns[0])
        stands = {"lfoot": number < 7, "ltoes": True}
        held = feet.hold(Pose(BENT[0], turns, blending=False, contacts=stands))
        balls.append(moved((held.root_position, held.rotations))[3])
    assert np.ptp(balls, axis=0)[[0, 2]].max() < 1e-6
    turned_back = fade(-0.03 * 6, -0.03 * WALK.fps, 0.2, 7 / WALK.fps)[0]
    assert feet.feet[0].yaw == pytest.approx(turned_back)


def test_a_ball_that_comes_down_before_its_ankle_stays_where_it_is():
    """The clip moves on by 3 cm in the frame in which the ankle takes over."""
    foot = HeldFoot(0.2, 1 / 30)
    foot.follow(0.00 + 0j, 0.1 + 0j, ankle_stands=False, ball_stands=True)
    foot.follow(0.03 + 0j, 0.1 + 0j, ankle_stands=True, ball_stands=True)
    assert foot.anchor == "ankle" and foot.offset == pytest.approx(-0.03)


def leading(distance):
    """Move the body ahead of a flat left foot by a distance within half a second: the poses shown."""
    moves = [(np.array([0.0, 0.0, distance * n / 15]), 0.0) for n in range(16)]
    return [(held.root_position, held.rotations) for held in standing_still(UPRIGHT, moves)]


def test_a_heel_lifts_and_the_hips_sink_where_the_leg_is_too_short():
    """The body goes ahead by 30 cm: the ball stays, neither in the air nor in the floor."""
    shown = leading(0.30)
    ankles, balls = np.transpose([moved(pose)[2:] for pose in shown], (1, 0, 2))
    assert np.ptp(balls, axis=0).max() < 0.01
    assert ankles[-1, 1] - ankles[0, 1] > 0.03
    assert 0.005 < UPRIGHT[0][1] - shown[-1][0][1] <= TUNED.lowest_hips


def test_nothing_sinks_or_lifts_within_reach():
    root, turns = leading(0.02)[-1]
    assert root[1] == pytest.approx(UPRIGHT[0][1], abs=1e-3)
    before, after = (moved(pose)[2:] for pose in (UPRIGHT, (root, turns)))
    np.testing.assert_allclose(before, after, atol=2e-3)


@pytest.mark.parametrize("lift", [0.0, 0.2, 0.5])
def test_a_lifted_heel_turns_the_foot_about_its_ball_and_not_the_toes(lift):
    leg = JointedLeg(WALK.skeleton, LEG, knee_axis(WALK, LEG))
    turns = BENT[1].copy()
    for joint, rotation in leg.bend(leg.place(*BENT), (0.0, 0.0, 0.0), 0.0, lift).items():
        turns[joint] = rotation
    before = forward_kinematics(Motion(WALK.skeleton, BENT[0][None], BENT[1][None], 30.0))
    after = forward_kinematics(Motion(WALK.skeleton, BENT[0][None], turns[None], 30.0))
    for unchanged in (old[0, LEG.ball] - new[0, LEG.ball] for old, new in zip(before, after, strict=True)):
        np.testing.assert_allclose(unchanged, 0, atol=1e-9)
    feet = [points[0, LEG.ankle] - points[0, LEG.ball] for points in (before[0], after[0])]
    cosine = feet[0] @ feet[1] / np.linalg.norm(feet[0]) ** 2
    assert math.acos(min(1.0, cosine)) == pytest.approx(lift, abs=1e-6)
    assert feet[1][1] >= feet[0][1] - 1e-12


@pytest.mark.parametrize("name", ["walk_curve_1", "jog"])
def test_feet_that_are_not_moved_stay_as_in_the_clip(name):
    (clip,) = clips(name)
    feet = HeldFeet(clip)
    for frame in range(60):
        contacts = {joint: bool(marks[frame]) for joint, marks in clip.contacts.items()}
        pose = Pose(clip.root_positions[frame], clip.rotations[frame], blending=False, contacts=contacts)
        shown = feet.hold(pose)
        off = moved((shown.root_position, shown.rotations)) - moved((pose.root_position, pose.rotations))
        assert np.abs(off).max() < 0.005


test_nonsense_is_refused = refusals(
    *(
        ("positive number of seconds", lambda halflife=h: HeldFeet(WALK, halflife=halflife))
        for h in (0, -1, np.nan)
    )
)
