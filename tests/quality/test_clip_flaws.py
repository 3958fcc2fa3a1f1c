"""Flaws put into a clean clip are found, and those of real ones."""

from dataclasses import replace

import numpy as np
import pytest

from mocap.body import euler, rotations
from mocap.files import load_save
from mocap.quality.clip_flaws import inspect
from tests.strategies import wave


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
    assert report.turn == pytest.approx(4)
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
