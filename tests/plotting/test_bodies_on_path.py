"""Bodies along a path: how many, where, in which colours."""

from dataclasses import replace

import numpy as np
import pytest
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import to_hex

from mocap.plotting.bodies_on_path import APART, HIGH, LOW, MOST, WIDTH, bodies_along
from mocap.plotting.style import ASKED, COLOURS, MARK, PATH, SOURCES
from tests.strategies import wave


def bodies(figure):
    """Return the colours of each body; the first collection is the ground."""
    _, *found = [part for part in figure.axes[0].collections if isinstance(part, LineCollection)]
    return [{to_hex(colour).upper() for colour in part.get_colors()} for part in found]


def lines(figure):
    return {line.get_label(): line for line in figure.axes[0].get_lines() if line.get_label()[0] != "_"}


def test_bodies_are_spread_over_the_ground_in_the_colours_of_their_sides():
    figure = bodies_along(wave(100))  # 2 cm per frame: 1.98 m
    assert len(bodies(figure)) == 1 + int(1.98 / APART)
    assert set().union(*bodies(figure)) <= set(COLOURS.values())
    assert to_hex(lines(figure)["walked path"].get_color()).upper() == PATH


def test_a_long_walk_has_a_bounded_number_of_bodies():
    assert APART * MOST < 0.02 * 2000
    assert MOST / 2 < len(bodies(bodies_along(wave(2000)))) <= MOST


def test_a_frame_beyond_the_horizon_gets_a_coarser_floor():
    """One frame out of range, as a lost marker gives it: squares of 1 m would take minutes and gigabytes."""
    walk = wave(50)
    roots = walk.root_positions.copy()
    roots[20] = [0, 1, 1e7]
    floor = bodies_along(replace(walk, root_positions=roots)).axes[0].collections[0]
    assert len(floor.get_segments()) < 2000


def test_clips_have_their_colours_and_seams_are_marked_where_they_are():
    motion = wave(200)
    figure = bodies_along(motion, sources=[(0, "a"), (100, "b"), (150, "a")], seams=[95, 145])
    drawn = lines(figure)
    assert list(drawn) == ["a", "b", "seam"]
    assert [to_hex(drawn[name].get_color()).upper() for name in ("a", "b", "seam")] == [*SOURCES[:2], MARK]
    assert [next(iter(body)) for body in bodies(figure)] == [*[SOURCES[0]] * 3, *[SOURCES[1]] * 2, SOURCES[0]]
    metres = np.diff(drawn["seam"].get_xdata())  # the walk is straight, so it runs across the picture
    assert metres == pytest.approx(0.02 * 50, abs=0.02)


def test_several_characters_have_a_colour_each_and_the_asked_path_is_black():
    figure = bodies_along(wave(100, name="a"), wave(100, phase=1, name="b"), path=[(0, 0), (1, 2)])
    assert list(lines(figure)) == ["asked path", "a", "b"]
    assert to_hex(lines(figure)["asked path"].get_color()) == ASKED
    assert set().union(*bodies(figure)) == set(SOURCES[:2])


def test_many_characters_are_seen_as_a_group_at_the_same_three_moments():
    figure = bodies_along(*(wave(400, phase=phase, name="walk") for phase in range(6)))
    assert len(bodies(figure)) == 6 * 3
    assert figure.legends == []  # one name for six colours would mislead


@pytest.mark.parametrize("frames", [1, 2, 60, 3000])
def test_the_picture_fits_what_it_shows(frames):
    figure = bodies_along(wave(frames))
    wide, high = figure.get_size_inches()
    assert wide == WIDTH
    assert LOW <= high <= HIGH
    figure.canvas.draw()
    inside = figure.axes[0].get_window_extent().bounds
    assert inside[3] > 0.6 * high * figure.dpi or inside[2] > 0.9 * wide * figure.dpi


def test_obstacles_lie_on_the_ground():
    (outline,) = [
        part.get_paths()
        for part in bodies_along(wave(30), discs=[[0, 1, 0.5]]).axes[0].collections
        if isinstance(part, PolyCollection)
    ]
    assert len(outline) == 1 and np.ptp(outline[0].vertices, axis=0).max() == pytest.approx(1.0, abs=0.01)
