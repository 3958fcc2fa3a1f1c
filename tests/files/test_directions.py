"""Directions come from tables and .toml files, with degrees and empty cells, and wrong ones are refused."""

import math

import pytest

from mocap.files.directions import DirectedPoint, Direction, is_direction, load_direction
from tests.refusals import refused


def test_a_table_and_a_toml_file_say_the_same(tmp_path):
    (tmp_path / "a.csv").write_text("x,z,t,heading,label,wait\n0,0,,,,\n0,4,5,90,walk,2\n")
    (tmp_path / "a.toml").write_text(
        "[[points]]\nx = 0\nz = 0\n[[points]]\nx = 0\nz = 4\nt = 5\nheading = 90\nlabel = 'walk'\nwait = 2\n"
    )
    of_table, of_toml = (load_direction(tmp_path / f"a.{suffix}") for suffix in ("csv", "toml"))
    assert of_table.points[1] == DirectedPoint(0.0, 4.0, 5.0, math.pi / 2, "walk", 2.0)
    assert [tuple(point) for point in of_table.points] == [tuple(point) for point in of_toml.points]


def test_a_toml_file_says_how_to_start_and_what_to_avoid(tmp_path):
    (tmp_path / "a.toml").write_text(
        "start = 'stand'\nfacing = -90\naround = [[1, 2, 0.5]]\n"
        "[[points]]\nx = 0\nz = 0\n[[points]]\nx = 0\nz = 4\n"
    )
    read = load_direction(tmp_path / "a.toml")
    assert (read.start, read.end, read.around) == ("stand", "", ((1, 2, 0.5),))
    assert read.facing == pytest.approx(-math.pi / 2)


def test_a_bare_line_is_no_direction(tmp_path):
    for text, wishes in (("x,z\n0,0\n", False), ("0,0\n1,1\n", False), ("z;x;wait\n0;0;1\n", True)):
        (tmp_path / "a.csv").write_text(text)
        assert is_direction(tmp_path / "a.csv") == wishes
    assert not is_direction(tmp_path / "gone.csv")


@pytest.mark.parametrize(
    ("name", "text", "words"),
    [
        ("a.csv", "x,z,t\n0,0,0\n0,,2\n", "line 3: expected x and z in each line, got an empty cell"),
        ("a.csv", "x,z,t\n0,0,soon\n0,1,2\n", "line 2: expected a number as t, got 'soon'"),
        ("a.csv", "x,z,t\n0,0,3\n0,1,2\n", "Times must grow along a direction, got"),
        ("a.csv", "x,z,t\n0,0,3\n", "two points or more, got 1"),
        ("a.csv", "x,z,wait\n0,0,-3\n0,1,2\n", "a wait of 0 s or more"),
        ("a.csv", "x,z,t,y\n0,0,3,1\n", "a first line with the columns x, z"),
        ("a.toml", "points = 3", r"expected a table \[\[points\]\] for each point"),
        ("a.toml", "[[points", "expected TOML"),
        (
            "a.toml",
            "colour = 3\n[[points]]\nx=0\nz=0\n",
            "the keys start, end, facing, around, points, got 'colour'",
        ),
        ("a.toml", "[[points]]\nx=0\ny=0\n", "x and z, and any of t, heading, label, wait, for point 1"),
        ("a.toml", "[[points]]\nx=0\nz='far'\n", "a value of its kind as z of point 1, got 'far'"),
        (
            "a.toml",
            "[[points]]\nx=0\nz=nan\n[[points]]\nx=0\nz=1\n",
            "Point 1 of a direction needs finite numbers",
        ),
        (
            "a.toml",
            "end='sit'\n[[points]]\nx=0\nz=0\n[[points]]\nx=0\nz=1\n",
            "end is 'stand' or '', got 'sit'",
        ),
        (
            "a.toml",
            "around=[[1,2]]\n[[points]]\nx=0\nz=0\n[[points]]\nx=0\nz=1\n",
            r"around = \[\[x, z, radius\]",
        ),
        ("a.txt", "x,z\n0,0\n", "A direction is read from a .csv or .toml file"),
    ],
)
def test_a_wrong_direction_is_refused(tmp_path, name, text, words):
    (tmp_path / name).write_text(text)
    refused(words, load_direction, tmp_path / name)


def test_discs_need_a_radius():
    refused("a radius above 0 m", Direction, [(0, 0), (0, 1)], around=[(0, 0, 0)])
