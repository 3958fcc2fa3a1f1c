"""A walk laid on a line keeps to it on feet that stand; in a bend it slows and leans as the law says."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from mocap.body import SHAPES, GroundPath, arcs, circle, find_legs, joint_positions, resample, s_curve
from mocap.datasets.samples import sample
from mocap.editing.bending import bend
from mocap.editing.path_editing import Ride, moving_frames, plants_kept, ride_of
from mocap.editing.turning import places_on, slow_down
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


@cache
def walk():
    return resample(sample("walk_straight")[:1200], 30)


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
    _, _, along, leaning = slow_down(walk(), ride_of(walk()), ring)
    inside = (along > 1) & (along < ring.length - 1)
    speeds = np.gradient(along)[inside] / np.gradient(ride_of(walk()).along).mean()
    assert speeds.mean() == pytest.approx(law(1 / radius), rel=0.05)
    balance = np.arctan((speeds.mean() * 30 * np.gradient(ride_of(walk()).along).mean()) ** 2 / radius / 9.81)
    assert leaning[inside].mean() == pytest.approx(balance, rel=0.1)


def test_legs_lean_by_the_whole_angle_and_the_trunk_by_a_quarter():
    """Measured on the motion: from behind, against the same frames of a walk that does not lean."""
    bent = bend(walk(), circle(1.0))
    leaning = slow_down(walk(), ride_of(walk()), bent.line.path)[3]
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


@pytest.mark.parametrize("name", ["16_17", "16_27", "16_33"])
def test_a_captured_turn_on_its_own_way_comes_back_as_it_was(real_data, name):
    motion = mark_plants(resample(load(real_data / "cmu" / "16" / f"{name}.amc")[12:], 30))
    bent = bend(motion, ride_of(motion).path)
    assert joint_positions(bent.laid) == pytest.approx(joint_positions(motion), abs=1e-9)
    assert not bent.line.roundings
