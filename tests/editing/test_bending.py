"""A walk laid on a line slows and leans, and keeps to it; the line is rounded where it must be."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mocap.body import GroundPath, Motion, Skeleton, find_legs, joint_positions, resample
from mocap.body.ground_path import SHAPES, arcs, circle, s_curve
from mocap.datasets.samples import sample
from mocap.editing.bending import bend
from mocap.editing.line_rounding import _smoothed, round_line
from mocap.editing.path_editing import Ride, moving_frames, plants_kept, ride_of
from mocap.editing.turning import lean, places_on, slow_down
from mocap.feet.footplants import mark_plants
from mocap.files.load_save import load
from tests.editing.test_path_editing import off, slide
from tests.editing.wishes import smoothness
from tests.refusals import refusals, told

CLIPS = ("walk_straight", "walk_circle", "sneak", "jog")
CORNER = GroundPath([[0, 0], [0, 4], [2, 0.6]])  # of 150°


@cache
def clip(name):
    motion = sample(name)
    return resample(motion[: 20 * 120], 30)


def straight_parts(bent):
    return bent.off[~bent.rounded]


@pytest.mark.parametrize("name", CLIPS)
@pytest.mark.parametrize(
    "path", [s_curve(12), circle(2.5), SHAPES["letter S"](1.6)], ids=["S", "circle", "letter"]
)
def test_a_walk_keeps_to_any_line(name, path):
    """As in [Gle01, 5]."""
    bent = bend(clip(name), path)
    assert straight_parts(bent).mean() <= 0.025 or name == "jog"
    assert straight_parts(bent).max(initial=0) <= 0.08
    assert slide(bent.motion) <= 1e-6
    assert slide(bent.laid) > 0.005
    assert plants_kept(bent.motion, bent.laid) >= (0.92 if name == "jog" else 0.99)
    assert smoothness(bent.motion, clip(name)) <= 1.15
    assert np.abs(bent.off - off(bent.motion, path)).max() < 0.008


def test_it_begins_where_the_line_does_and_ends_there():
    path = arcs((3, 4), 1.0, [(3.0, 1.0)])
    bent = bend(clip("walk_straight"), path)
    assert bent.motion.root_positions[[0, -1]][:, [0, 2]] == pytest.approx(path.points[[0, -1]], abs=0.06)
    assert bent.along[-1] > 0.98 * path.length
    assert len(bent.motion) == len(bent.along) == len(bent.turned) + 1 == len(bent.rounded)
    long = bend(clip("walk_straight"), GroundPath([[0, 0], [0, 40]]))
    assert long.motion.duration == pytest.approx(clip("walk_straight").duration, rel=0.01)
    assert long.along[-1] == pytest.approx(long.ride.path.length, abs=0.05)
    assert f"along {long.along[-1] / 40:.0%} of 40.0 m" in long.report()
    assert "rounded" not in long.report()


def test_it_says_where_the_line_was_rounded():
    bent = bend(clip("walk_straight"), CORNER)
    ((start, end, _),) = bent.line.roundings
    assert f"elsewhere, rounded at {start:.1f} to {end:.1f} m by up to" in bent.report()
    assert bent.rounded[(bent.along > start) & (bent.along < end)].all()
    assert bent.off.max() < 0.11
    assert straight_parts(bent).max() < 0.05
    zigzag = GroundPath([[4 * (n % 2), n] for n in range(8)])
    assert " more; turned by" in bend(clip("walk_straight"), zigzag).report()
    saw = bend(clip("walk_straight"), GroundPath([[0.7 * (n % 2), 0.2 * n] for n in range(9)]))
    assert saw.rounded.mean() > 0.9


def test_a_tighter_limit_rounds_more():
    slow, fast, free = (bend(clip("walk_straight"), CORNER, limit=np.radians(r)) for r in (30, 100, np.inf))
    assert slow.off.max() > 2 * fast.off.max() > 2 * free.off.max()
    for bent, rate in ((slow, 30), (fast, 100)):
        assert np.abs(bent.turned).max() <= np.radians(rate + 1)
    assert np.abs(free.turned).max() > np.radians(130)


@pytest.mark.parametrize(("name", "degrees", "end"), [("jog", 150, 0.5), ("walk_straight", 120, 0.2)])
def test_the_limit_holds_at_a_corner_near_the_end_of_a_line(name, degrees, end):
    """The walk is slowed to half of its speed there, so that its frames are between those of the clip."""
    angle = np.radians(degrees)
    line = GroundPath([[0, 0], [0, 4], [end * np.sin(angle), 4 + end * np.cos(angle)]])
    motion = clip(name)
    rounded = round_line(line, ride_of(motion), motion.fps, LIMIT)
    along = slow_down(motion, ride_of(motion), rounded.path, LIMIT).along
    rates = np.diff(moving_frames(rounded.path, along).angle) * motion.fps
    assert 0.85 * LIMIT < np.abs(rates[along[1:] <= rounded.path.length]).max() <= 1.01 * LIMIT


def test_who_goes_to_and_fro_is_turned_at_once_and_that_is_said():
    walk = clip("walk_straight")[:90]
    roots = walk.root_positions * [0, 1, 0]
    roots[:, 2] = 0.6 * np.sin(np.arange(90) * np.pi / 30)
    fast = r"'walk_straight' is turned by up to 5400° per second: where it stands"
    told(fast, bend, replace(walk, root_positions=roots), GroundPath([[0, 0], [0, 3]]))


test_what_cannot_be_bent_is_refused = refusals(
    *((f"limit={limit}", lambda n=limit: bend(clip("jog"), circle(2.0), limit=n)) for limit in (0, np.nan)),
    ("it stands; there is no path to edit", bend, clip("walk_straight")[:9], circle(2.0)),
)


@pytest.mark.filterwarnings("ignore::mocap.errors.MocapWarning")
@pytest.mark.parametrize(
    "name", ["16_15", *(pytest.param(name, marks=pytest.mark.sweep) for name in ("16_17", "02_01", "49_01"))]
)
def test_captured_walks_keep_to_any_line(real_data, name):
    motion = load(real_data / "cmu" / name.split("_")[0] / f"{name}.amc")[12:]
    for path in (arcs((0, 0), 0, [(2, 1.5), (2, -1.5)]), circle(1.5)):
        bent = bend(motion, path)
        assert straight_parts(bent).mean() <= 0.025
        # 16_17 lurches by 6 cm where it stops; to reach its plants takes 4 more.
        sway = off(motion, bent.ride.path).max()
        assert straight_parts(bent).max() <= max(0.08, sway + 0.04)
        assert slide(bent.motion) <= 1e-6
        assert plants_kept(bent.motion, bent.laid) >= 0.93  # 16_17 lurches at its end
        assert smoothness(bent.motion, motion) <= 1.25


def law(curvature):
    return (1 + (1.2 * curvature) ** 2) ** -0.25


@pytest.mark.parametrize("radius", [0.5, 1.0, 2.0])
def test_a_steady_walk_slows_by_the_law_half_by_steps_and_half_by_the_clock(radius):
    along = np.arange(0, 9, 0.04)
    straight = Ride(GroundPath([[0, 0], [0, 9]]), along)
    ring = GroundPath(np.vstack([circle(radius).points] * 4))
    places, ratio = places_on(ring, straight, 30.0)
    inside = (places > 1) & (places < ring.length - 1)
    assert ratio[inside] == pytest.approx(law(1 / radius), rel=0.01)
    assert np.diff(places)[inside[1:]] == pytest.approx(0.04 * law(1 / radius) ** 0.5, rel=0.01)
    ride = ride_of(clip("walk_straight"))
    slowed = slow_down(clip("walk_straight"), ride, ring)
    along = slowed.along
    inside = (along > 1) & (along < ring.length - 1)
    speed, own = np.gradient(along)[inside].mean(), np.gradient(ride.along).mean()
    assert speed / own == pytest.approx(law(1 / radius), rel=0.05)
    balance = np.arctan((30 * speed) ** 2 / radius / 9.81)
    assert slowed.lean[inside].mean() == pytest.approx(balance, rel=0.1)


def test_legs_lean_by_the_whole_angle_and_the_trunk_by_a_quarter():
    """Measured on the motion: from behind, against the same frames of a walk that does not lean."""
    bent = bend(clip("walk_straight"), circle(1.0))
    leaning = slow_down(clip("walk_straight"), ride_of(clip("walk_straight")), bent.line.path).lean
    points, names = joint_positions(bent.motion), bent.motion.skeleton.names
    way = np.asarray(moving_frames(bent.line.path, bent.walked).angle)

    def leans(upper, lower):
        away = points[:, upper] - points[:, lower]
        left = away[:, 0] * np.cos(way) - away[:, 2] * np.sin(way)
        return np.degrees(np.arctan2(left, away[:, 1]))[20:-20].mean()

    legs = find_legs(bent.motion.skeleton)
    asked = np.degrees(leaning[: len(way)][20:-20].mean())
    assert np.mean([leans(leg.hip, leg.ankle) for leg in legs]) == pytest.approx(asked, rel=0.25)
    assert 0 < leans(names.index("upperneck"), 0) < 0.6 * asked
    assert slide(bent.motion) < 1e-6


@pytest.mark.parametrize("degrees", [-30, 0, 10, 45])
def test_a_straight_leg_leans_about_its_foot_and_stays_as_long(degrees):
    length, angle = 0.9, np.radians(degrees)
    half, ahead, up = [0, -length / 2, 0], [0, 0, 0.1], [0, 0.4, 0]
    legs = [side + part for side in "lr" for part in ("femur", "tibia", "foot", "toes")]
    names = ["root", "spine", "head", *legs]
    bones = [[0, 0, 0], half, half, ahead]  # both hips are where the root is
    skeleton = Skeleton(names, [-1, 0, 1, 0, 3, 4, 5, 0, 7, 8, 9], [[0, 0, 0], up, up, *bones, *bones])
    upright = np.tile([1.0, 0, 0, 0], (4, len(names), 1))
    stands = {name: np.ones(4, bool) for name in names if name.endswith(("foot", "toes"))}
    standing = Motion(skeleton, np.tile([0, length, 0], (4, 1)), upright, 30, contacts=stands)
    leaning, held = lean(standing, np.zeros(4), np.full(4, angle))
    for leg in find_legs(skeleton):  # towards +z: left, the inside, is +x
        hip, ankle = joint_positions(leaning)[:, [leg.hip, leg.ankle]].transpose(1, 0, 2)
        across = [length * np.sin(angle), length * np.cos(angle), 0]
        assert hip - held[leg.ankle] == pytest.approx(np.tile(across, (4, 1)), abs=1e-9)
        assert hip[:, 1] == pytest.approx(length * np.cos(angle), abs=1e-9)
        assert np.linalg.norm(hip - held[leg.ankle], axis=1) == pytest.approx(length, abs=1e-9)
        assert ankle == pytest.approx(held[leg.ankle], abs=1e-9)


def lowest_joints_of_feet(motion):
    """Give how high the lowest joint of both feet is in each frame, metres."""
    feet = [joint for leg in find_legs(motion.skeleton) for joint in (leg.ankle, leg.ball)]
    return joint_positions(motion)[:, feet, 1].min(axis=1)


@pytest.mark.parametrize("rate", [30, 45], ids=["jog", "run"])
def test_who_leans_far_keeps_his_plants_and_his_feet_on_the_floor(rate):
    """At 2 m/s, legs that leaned below a root as high as before lost 38 % of the plants, and floated."""
    jog = replace(clip("jog")[:120], fps=rate)
    bent = bend(jog, circle(1.5))
    assert plants_kept(bent.motion, bent.laid) == 1
    asked, found = lowest_joints_of_feet(jog), lowest_joints_of_feet(bent.motion)
    shares = [0, 10, 50, 90]  # percent of the frames; the highest flight may be lower
    assert np.percentile(found, shares) == pytest.approx(np.percentile(asked, shares), abs=0.01)
    assert found.max() <= asked.max() + 0.01


@pytest.mark.parametrize("name", ["16_17", "16_27", "16_33"])
def test_a_captured_turn_on_its_own_way_comes_back_as_it_was(real_data, name):
    motion = mark_plants(resample(load(real_data / "cmu" / "16" / f"{name}.amc")[12:], 30))
    bent = bend(motion, ride_of(motion).path)
    assert joint_positions(bent.laid) == pytest.approx(joint_positions(motion), abs=1e-9)
    assert not bent.line.roundings


def test_who_turns_faster_than_the_limit_by_himself_is_not_slowed_there():
    """The way of a body that stands turns by up to 580° per second; it was slowed there, and came late."""
    motion = clip("stop_and_go")
    laid = bend(motion, ride_of(motion).path).laid
    assert joint_positions(laid) == pytest.approx(joint_positions(motion), abs=1e-9)


LIMIT, FPS, SPEED = np.radians(100), 30.0, 1.2
RADIUS = 0.2  # metres: on about this arc a walk of this speed, at its slowest, turns by the limit


def straight(metres=60.0, fps=FPS):
    """A ride straight ahead at a steady speed."""
    along = np.arange(0, metres, SPEED / fps)
    return Ride(GroundPath([[0, 0], [0, along[-1]]]), along)


def corner(degrees, leg=6.0):
    turn = np.radians(degrees)
    return GroundPath([[0, 0], [0, leg], [leg * np.sin(turn), leg + leg * np.cos(turn)]])


def fastest(path, limit=LIMIT, fps=FPS):
    """How fast a walk turns on a path, radians per second."""
    along, ratio = places_on(path, straight(), fps, limit)
    rates = np.diff(moving_frames(path, along).angle) * fps * np.sqrt(ratio[1:])
    return np.abs(rates[along[1:] < path.length]).max()


def test_the_line_is_the_least_squares_one():
    random = np.random.default_rng(5)
    points, weight = random.normal(size=(30, 2)), random.uniform(0.1, 9, 30)
    second = np.diff(np.eye(30), 2, axis=0)
    matrix = np.eye(30) + second.T @ (weight[1:-1, None] * second)
    assert _smoothed(points, weight) == pytest.approx(np.linalg.solve(matrix, points), abs=1e-12)
    assert (_smoothed(points[:2], weight[:2]) == points[:2]).all()


@pytest.mark.parametrize("degrees", [70, 90])
def test_a_walk_slows_down_for_a_corner_and_does_not_cut_it(degrees):
    asked = corner(degrees)
    assert fastest(asked, np.inf) > 1.2 * LIMIT
    assert 0.85 * LIMIT < fastest(asked) <= 1.02 * LIMIT
    assert round_line(asked, straight(), FPS, LIMIT).moved.max() < 0.06


@pytest.mark.parametrize("degrees", [140, 150])
def test_a_corner_is_rounded_as_little_as_the_limit_allows(degrees):
    asked = corner(degrees)
    line = round_line(asked, straight(), FPS, LIMIT)
    assert fastest(asked) > 1.2 * LIMIT
    assert 0.85 * LIMIT < fastest(line.path) <= LIMIT
    # The arc that touches both legs passes the corner at this distance.
    arc = RADIUS * (1 / np.cos(np.radians(degrees) / 2) - 1)
    assert line.moved.max() < max(1.1 * arc, 0.1)
    ((start, end, worst),) = line.roundings
    assert start < 6 < end and end - start < 2.5
    assert worst == line.moved.max()
    assert line.moved[np.abs(line.requested - 6) > 4.5].max() < 0.01


@pytest.mark.parametrize("path", [circle(1.2), circle(3.0), arcs((0, 0), 0, [(3, 2.4), (4, -3), (2, 0)])])
def test_what_is_slow_enough_stays_as_it_is(path):
    line = round_line(path, straight(), FPS, LIMIT)
    assert not line.roundings
    assert line.moved.max() < 0.007
    assert np.median(line.moved) < 0.002
    assert line.path.length == pytest.approx(path.length, rel=0.001)


@pytest.mark.parametrize("degrees", [160, 170, 180])
def test_a_line_that_comes_back_on_itself_gets_a_loop(degrees):
    """A smoother line alone would come back on itself as well, or be much shorter."""
    back = corner(degrees)
    line = round_line(back, straight(), FPS, LIMIT)
    assert fastest(back, np.inf) > 2 * LIMIT
    assert fastest(line.path) <= 1.05 * LIMIT
    assert line.path.length > back.length
    assert line.moved.max() < 2.5 * RADIUS


def test_the_walk_may_turn_faster_where_it_turns_by_itself():
    """A walk that turns where the corner is needs less rounding than one that goes straight on."""
    asked = corner(140)
    own = round_line(asked, straight(), FPS, LIMIT).path  # a walk along the rounded line itself
    along = np.arange(0, own.length, SPEED / FPS)
    line = round_line(asked, Ride(own, along), FPS, LIMIT)
    assert line.moved.max() < 0.7 * round_line(asked, straight(), FPS, LIMIT).moved.max()


@settings(max_examples=12)
@given(st.integers(0, 10**6))
def test_any_line_can_be_walked_after_rounding(seed):
    random = np.random.default_rng(seed)
    steps = random.uniform(0.3, 4, size=random.integers(2, 9))
    ways = np.cumsum(random.uniform(-2.9, 2.9, size=len(steps)))
    points = np.cumsum(steps[:, None] * np.stack([np.sin(ways), np.cos(ways)], axis=1), axis=0)
    line = round_line(GroundPath(np.vstack([[0, 0], points])), straight(), FPS, LIMIT)
    assert np.isfinite(line.path.points).all()
    assert (np.diff(line.along) >= 0).all()
    assert fastest(line.path) <= 1.06 * LIMIT
    assert line.path.length < 3 * GroundPath(np.vstack([[0, 0], points])).length + 10


def test_a_scrawl_is_walked_and_not_shrunk_to_a_dot():
    turns = np.linspace(0, 20 * np.pi, 800)
    circles = GroundPath(0.2 * np.stack([np.cos(turns), np.sin(turns)], axis=1))
    noise = GroundPath(np.cumsum(np.random.default_rng(0).normal(0, 0.05, (500, 2)), axis=0))
    for path in (circles, noise):
        line = round_line(path, straight(), FPS, LIMIT)
        assert fastest(line.path) <= 1.05 * LIMIT
        assert line.path.length > 0.4 * path.length


def test_a_short_line_is_no_harm():
    for path in (GroundPath([[0, 0], [0, 0.02]]), GroundPath([[0, 0], [0.1, 0.1], [0, 0]])):
        line = round_line(path, straight(), FPS, LIMIT)
        assert np.isfinite(line.path.points).all()
