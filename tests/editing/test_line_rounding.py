"""A line is rounded where a walk would turn too fast on it, and nowhere else."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mocap.body import GroundPath, arcs, circle, on_ground
from mocap.editing.line_rounding import _smoothed, round_line
from mocap.editing.path_editing import Ride, moving_frames
from mocap.editing.turning import places_on

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
    points, weight = on_ground(random.normal(size=(30, 2))), random.uniform(0.1, 9, 30)
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
    assert line.moved[np.abs(line.asked - 6) > 4.5].max() < 0.01


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
    assert not round_line(corner(150), straight(), FPS, np.inf).moved.max() > 0.06
