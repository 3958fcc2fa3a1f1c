"""Paths from files: tables and pictures, and what is wrong with some of them."""

import numpy as np
import pytest

from mocap.errors import MocapError
from mocap.path_files import load_path


def svg(tmp_path, body):
    file = tmp_path / "path.svg"
    file.write_text(f'<svg xmlns="http://www.w3.org/2000/svg">{body}</svg>')
    return file


@pytest.mark.parametrize("text", ["x,z\n0,0\n1,2\n", "0;0\n1;2", "# drawn by hand\n0 0\n\n1\t2\n"])
def test_tables_are_read(tmp_path, text):
    file = tmp_path / "path.csv"
    file.write_text(text)
    assert load_path(file).points.tolist() == [[0, 0], [1, 2]]
    assert load_path(file, scale=0.5).points.tolist() == [[0, 0], [0.5, 1]]


@pytest.mark.parametrize(
    "body",
    [
        '<path d="M 0 0 L 100 0 L 100 -200"/>',
        '<path d="m0,0 100,0 0-200"/>',
        '<g><path d="M0 0H100V-200"/></g>',
        '<path d="M0 0h1e2v-2e2M 5 5 L 9 9"/>',
        '<polyline points="0,0 100,0 100,-200"/>',
    ],
)
def test_the_same_corner_drawn_in_many_ways(tmp_path, body):
    assert load_path(svg(tmp_path, body)).points == pytest.approx(np.array([[0, 0], [-1, 0], [-1, 2]]))


def test_curves_are_the_curves_they_are(tmp_path):
    """A quadratic curve and the cubic that equals it; a mirrored control point."""
    quadratic = load_path(svg(tmp_path, '<path d="M0 0 Q 300 0 300 300 T 600 600"/>')).points
    cubic = load_path(svg(tmp_path, '<path d="M0 0 C 200 0 300 100 300 300 S 400 600 600 600"/>')).points
    assert quadratic == pytest.approx(cubic)
    assert quadratic[-1] == pytest.approx([-6, -6])
    closed = load_path(svg(tmp_path, '<polygon points="0 0 100 0 100 100"/>'))
    assert closed.points[-1] == pytest.approx(closed.points[0])
    assert load_path(svg(tmp_path, '<path d="M0 0 L 100 0 L 100 100 z"/>')).length == pytest.approx(
        closed.length
    )


@pytest.mark.parametrize(
    ("body", "message"),
    [
        ("", "a path, polyline, polygon or line, got none"),
        ('<path d=""/>', "starts with 'M'"),
        ('<path d="M 0 0 L 5"/>', "2 numbers for 'L'"),
        ('<path d="M 0 0 A 5 5 0 0 1 9 9"/>', "'A': simplify"),
        ('<path transform="scale(2)" d="M 0 0 L 5 5"/>', "transform"),
        ('<path d="M 0 0 L 0 0"/>', "zero length"),
        ('<polyline points="0 0"/>', "two points"),
        ("<path", "SVG picture"),
    ],
)
def test_pictures_without_a_path_are_told(tmp_path, body, message):
    with pytest.raises(MocapError, match=message):
        load_path(svg(tmp_path, body))


@pytest.mark.parametrize(
    ("name", "text", "message"),
    [
        ("path.csv", "0,0\n1,nan", "line 2: expected x and z"),
        ("path.csv", "x,z\n0,0\n1", "line 3: expected x and z, got 1"),
        ("path.csv", "1,1", "two points"),
        ("path.csv", "", "an empty file"),
        ("path.png", "x", "give a .csv or .svg"),
    ],
)
def test_tables_without_a_path_are_told(tmp_path, name, text, message):
    file = tmp_path / name
    file.write_text(text)
    with pytest.raises(MocapError, match=message):
        load_path(file)
