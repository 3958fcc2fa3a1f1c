"""The centre of mass, and the gravity that a flight shows."""

import numpy as np
import pytest

from mocap.body import Motion, Skeleton
from mocap.files import load_save
from mocap.quality.falling import SEGMENTS, centre_of_mass, gravity
from tests.refusals import refusals

# The flights of five captured jumps: their first and last frames in the air.
FLIGHTS = {
    "16_01": (136, 170),
    "16_02": (232, 273),
    "16_03": (186, 246),
    "16_04": (165, 226),
    "02_04": (112, 173),
}


def ball(fps=50.0, g=9.81):
    """Return a stick of two equal masses that is thrown up."""
    stick = Skeleton(["low", "top"], [-1, 0], [[0, 0, 0], [0, 0.2, 0]])
    t = np.arange(40) / fps
    roots = np.stack([t, 1 + 3 * t - g / 2 * t**2, 0 * t], axis=-1)
    return Motion(stick, roots, np.tile([1.0, 0, 0, 0], (40, 2, 1)), fps)


def test_the_masses_of_a_body_add_up_to_one():
    assert sum(mass for _, _, mass, _ in SEGMENTS) == pytest.approx(1.0)


def test_a_thrown_stick_falls_at_g_about_its_middle():
    parts = [("low", "top", 2.0, 0.25), ("low", "top", 2.0, 0.75)]
    assert centre_of_mass(ball(), parts)[0] == pytest.approx([0, 1.1, 0])
    assert gravity(ball(), 3, 30, parts) == pytest.approx(9.81)
    assert gravity(ball(g=16.7), 0, 39, parts) == pytest.approx(16.7)


def test_captured_jumps_fall_at_about_g(real_data):
    found = [
        gravity(load_save.load(real_data / "cmu" / name[:2] / f"{name}.amc"), first + 3, last - 3)
        for name, (first, last) in FLIGHTS.items()
    ]
    assert min(found) > 9.7
    assert max(found) < 10.6


test_a_flight_lies_on_the_clip_and_lasts_four_frames = refusals(
    *(
        (f"which has 40; got {first} to {last}", gravity, ball(), first, last)
        for first, last in ((-1, 20), (5, 7), (20, 10), (30, 40))
    ),
    ("No joint 'lfemur'; there are: low, top", centre_of_mass, ball()),  # needs its own segments
)
