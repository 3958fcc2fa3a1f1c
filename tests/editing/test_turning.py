"""A walk in a bend is as slow, and leans as much, as the law says; a turn on its own way stays as it is."""

from functools import cache

import numpy as np
import pytest

from mocap.body import GroundPath, circle, find_legs, joint_positions, resample
from mocap.datasets.samples import sample
from mocap.editing.bending import bend
from mocap.editing.path_editing import Ride, moving_frames, ride_of
from mocap.editing.turning import places_on, slow_down
from mocap.feet.footplants import mark_plants
from mocap.files.load_save import load
from tests.editing.test_path_editing import slide


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
