"""A walk on another path walks as before, stands as before, and is as near to its path as it was."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import cKDTree

from mocap.body import GroundPath, arcs, circle, joint_positions
from mocap.datasets.samples import sample
from mocap.editing import moving_frames, on_path, plants_kept, ride_of, spline_basis, start_at
from mocap.editing.tuned import TUNED
from mocap.feet import clean_up
from mocap.files.load_save import load
from tests.editing.wishes import smoothness
from tests.oracles import slides
from tests.refusals import refusals, told, unwarned

CLIPS = {"walk_straight": slice(0, 600), "jog": slice(600, 1100)}


@cache
def clip(name):
    return clean_up(sample(name)[CLIPS[name]])


@cache
def straight():
    return clip("walk_straight"), ride_of(clip("walk_straight"))


def slide(motion):
    """Metres that a planted joint strays from its mean place, at most."""
    return slides(motion).max()


def off(motion, path):
    return cKDTree(path.resampled(0.005).points).query(motion.root_positions[:, [0, 2]])[0]


def test_the_path_is_the_least_squares_spline():
    """As in [Gle01, 3]."""
    motion, ride = straight()
    basis = spline_basis(len(motion), TUNED.path_knots * motion.fps).toarray()
    expected = np.linalg.lstsq(basis, motion.root_positions[:, [0, 2]], rcond=None)[0]
    assert ride.handles == pytest.approx(expected, abs=1e-7)
    assert ride.path.points == pytest.approx(basis @ expected, abs=1e-8)
    assert ride.along[-1] == pytest.approx(ride.path.length, abs=1e-9)
    assert ride.with_handles(ride.handles).points == pytest.approx(ride.path.points, abs=1e-9)


def test_the_heading_is_calm_while_the_body_stands(real_data):
    motion = load(real_data / "cmu" / "16" / "16_33.amc")[4:]
    ride = ride_of(motion)
    speed = np.hypot(*np.gradient(motion.root_positions[:, [0, 2]], axis=0).T) * motion.fps
    stands = speed < 0.1

    def turn(stride, chord):
        ride = ride_of(motion, stride=stride)
        return np.degrees(np.ptp(moving_frames(ride.path, ride.along, chord=chord).angle[stands]))

    assert stands.sum() > 30
    assert turn(TUNED.path_knots, 0.25) <= 3
    assert turn(0.4, 0.005) > 90  # the tangent
    assert len(ride.along) == len(motion)


@pytest.mark.parametrize("name", CLIPS)
def test_on_its_own_path_nothing_changes(name):
    """As in [Gle01, 4; arc length]."""
    motion = clip(name)
    same = on_path(motion, ride_of(motion).path)
    assert np.abs(joint_positions(same) - joint_positions(motion)).max() <= 1e-12
    assert same.contacts is not None and list(same.contacts) == list(motion.contacts)


@settings(max_examples=10)
@given(st.floats(0.3, 5), st.floats(-3, 3))
def test_a_moving_frame_on_a_circle_heads_along_it(radius, turn):
    arc = arcs((0, 0), 0.0, [(3 * radius, 3.0)])
    frames = moving_frames(arc, [radius, 2 * radius], chord=0.1 * radius)
    assert frames.angle == pytest.approx([1.0, 2.0], abs=0.02 / radius)
    ride = straight()[1]
    own = moving_frames(ride.path, [0.0]).angle
    assert moving_frames(start_at(arc, ride), [0.0]).angle == pytest.approx(own, abs=1e-9)


def test_headings_do_not_spin_where_angles_wrap():
    arc = arcs((0, 0), 0.9 * np.pi, [(4.0, 1.0)])
    assert np.abs(np.diff(moving_frames(arc, np.linspace(0, 4, 99)).angle)).max() < 0.02


@pytest.mark.parametrize("name", CLIPS)
@pytest.mark.parametrize("radius", [4, 2, 1, 0.75])
def test_bent_walks_stand_as_before_and_keep_to_the_path(name, radius):
    """As in [Gle01, 4]."""
    motion = clip(name)
    ride = ride_of(motion)
    path = start_at(arcs((0, 0), 0, [(ride.path.length, ride.path.length / radius)]), ride)
    bent = on_path(motion, path, ride)
    cleaned = clean_up(bent)
    assert 0.015 / radius < slide(bent) < 0.15 / radius
    assert slide(cleaned) <= 1e-6
    assert plants_kept(cleaned, bent) >= 0.95
    assert smoothness(cleaned, motion) <= (1.2 if name == "jog" else 1.12)
    assert abs(off(cleaned, path).mean() - off(motion, ride.path).mean()) < 0.003
    assert abs(off(cleaned, path).max() - off(motion, ride.path).max()) < 0.003


def test_steps_twice_as_long_are_warned_of():
    """As in [Gle01, arc length]: unless asked for, they are as long as before."""
    motion, ride = straight()
    far = start_at(GroundPath([[0, 0], [0, 2.5 * ride.path.length]]), ride)
    longer = told(r"takes steps 2\.50 times as long on this path", on_path, motion, far, ride, keep="ends")
    end = np.hypot(*(longer.root_positions[-1, [0, 2]] - far.points[-1]))
    assert end == pytest.approx(off(motion[-1:], GroundPath(ride.path.points[-3:]))[0], abs=0.03)
    ends = unwarned(on_path, motion, far, ride).root_positions[[0, -1], 2]
    assert np.ptp(ends) == pytest.approx(ride.path.length, abs=0.05)


test_what_has_no_path_is_refused = refusals(
    (r"goes 0\.\d\d m only: it stands; there is no path to edit", lambda: ride_of(straight()[0][:9])),
    ("knots above 0 apart", lambda: ride_of(straight()[0], stride=0)),
    ("chord=-1", lambda: moving_frames(circle(2.0), [0.0], chord=-1)),
    ("keep='time'", lambda: on_path(straight()[0], circle(2.0), straight()[1], keep="time")),
    ("ride has 600 frames, .* has 300", lambda: on_path(straight()[0][:300], circle(2.0), straight()[1])),
    (r"handles \(x, z\), got an array \(2, 2\)", lambda: straight()[1].with_handles(np.zeros((2, 2)))),
)


def test_a_clip_of_few_frames_has_a_path():
    motion = replace(straight()[0][:3], root_positions=[[0, 1, 0], [0, 1, 0.5], [0.1, 1, 1]])
    ride = ride_of(motion)
    assert ride.path.points == pytest.approx(motion.root_positions[:, [0, 2]], abs=1e-4)
    tiny = GroundPath([[0, 0], [0.05, 0.1], [0, 0]])
    assert np.isfinite(np.stack(moving_frames(tiny, [-1.0, 0.1, 1.0]))).all()
    assert abs(moving_frames(ride.path, ride.along).angle[0]) < 0.2
