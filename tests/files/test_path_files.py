"""Paths from files: tables and pictures, and what is wrong with some of them."""

import numpy as np
import pytest

from mocap.errors import FormatError, MocapWarning
from mocap.files.path_files import load_path
from tests.refusals import refusals, refused, refused_texts

SVG = '<svg xmlns="http://www.w3.org/2000/svg">{}</svg>'


def svg(tmp_path, body):
    (tmp_path / "path.svg").write_text(SVG.format(body))
    return tmp_path / "path.svg"


@pytest.mark.parametrize("text", ["x,z\n0,0\n1,2\n", "0;0\n1;2", "# drawn by hand\n0 0\n\n1\t2\n"])
def test_tables_are_read(tmp_path, text):
    file = tmp_path / "path.csv"
    file.write_text(text)
    assert load_path(file).points.tolist() == [[0, 0], [1, 2]]
    assert load_path(file, scale=0.5).points.tolist() == [[0, 0], [0.5, 1]]


CORNERS = [
    '<path d="M 0 0 L 100 0 L 100 -200"/>',
    '<path d="m0,0 100,0 0-200"/>',
    '<g><path d="M0 0H100V-200"/></g>',
    '<path d="M0 0h1e2v-2e2M 5 5 L 9 9"/>',
    '<polyline points="0,0 100,0 100,-200"/>',
]


@pytest.mark.parametrize("body", CORNERS)
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
    path = svg(tmp_path, '<path d="M0 0 L 100 0 L 100 100 z"/>')
    assert load_path(path).length == pytest.approx(closed.length)


@pytest.mark.parametrize("sweep", [0, 1])
@pytest.mark.parametrize("large", [0, 1])
def test_arcs_are_parts_of_their_circles(tmp_path, large, sweep):
    """Of the two circles of radius 2 through (0, 0) and (-2, 0), each has a short and a long arc."""
    path = load_path(svg(tmp_path, f'<path d="M0 0a-200 200 30 {large} {sweep} 200 0"/>'))
    furthest = (2 + np.sqrt(3) * (1 if large else -1)) * (1 if sweep else -1)  # clockwise is first up
    centre = [-1, furthest - (2 if sweep else -2)]
    assert np.hypot(*(path.points - centre).T) == pytest.approx(2)
    assert path.points[len(path.points) // 2] == pytest.approx([-1, furthest])
    assert path.points[-1].tolist() == [-2, 0]
    assert path.length == pytest.approx(2 * np.pi / 3 * (5 if large else 1), rel=1e-3)


@pytest.mark.parametrize("flags", ["0 0", "0 1", "1 0", "1 1"])
def test_an_elliptic_arc_is_a_circular_one_tilted_and_squeezed(tmp_path, flags):
    circular = (
        f'<g transform="rotate(40)"><path transform="scale(2, .5)" d="M0 0A90 90 0 {flags} 60 80"/></g>'
    )
    c, s = np.cos(np.radians(40)), np.sin(np.radians(40))
    end = [c * 120 - s * 40, s * 120 + c * 40]
    elliptic = f'<path d="M0 0A180 45 40 {flags} {end[0]} {end[1]}"/>'
    points = load_path(svg(tmp_path, circular)).points
    assert load_path(svg(tmp_path, elliptic)).points == pytest.approx(points)


def test_arcs_that_cannot_be_are_fixed(tmp_path):
    """Radii too short to reach grow; of radius 0 it is a line; to the same point it is nothing."""
    half = load_path(svg(tmp_path, '<path d="M0 0A1 1 0 0 1 200 0"/>'))
    assert half.length == pytest.approx(np.pi, rel=1e-3)
    straight = load_path(svg(tmp_path, '<path d="M0 0A0 9 0 0 1 200 0A9 9 0 1 1 200 0"/>'))
    assert straight.points.tolist() == [[0, 0], [-2, 0]]


@pytest.mark.parametrize(("smooth", "plain"), [("T 9 0", "Q 5 5 9 0"), ("S 7 7 9 0", "C 5 5 7 7 9 0")])
@pytest.mark.parametrize("before", ["L 5 5", "C 1 2 3 4 5 5", "Q 1 2 5 5"])
def test_only_a_curve_of_the_same_kind_is_mirrored(tmp_path, before, smooth, plain):
    """Else the control point not given is where the pen is [SVG 1.1, 8.3.6 and 8.3.7]."""
    same = before[0] in {"T": "Q", "S": "C"}[smooth[0]]
    one, other = (load_path(svg(tmp_path, f'<path d="M0 0 {before} {end}"/>')) for end in (smooth, plain))
    assert np.allclose(one.points, other.points) != same


TRANSFORMS = [
    ("matrix(1 2 3 4 5 6)", (5 + 1 * 10 + 3 * 20, 6 + 2 * 10 + 4 * 20)),
    ("translate(5)", (15, 20)),
    ("translate(5, 6)", (15, 26)),
    ("scale(2)", (20, 40)),
    ("scale(2 3)", (20, 60)),
    ("rotate(90)", (-20, 10)),
    ("rotate(90, 10, 0)", (-10, 0)),
    ("skewX(45)", (30, 20)),
    ("skewY(-45)", (10, 10)),
    ("translate(5) scale(2), rotate(90)", (-35, 20)),  # the last comes first
]


@pytest.mark.parametrize(("transform", "end"), TRANSFORMS)
def test_transforms_move_what_is_drawn(tmp_path, transform, end):
    body = f'<defs><line x2="1"/></defs><line transform="{transform}" x2="10" y2="20"/>'
    assert load_path(svg(tmp_path, body), scale=1).points[-1] == pytest.approx(np.negative(end))


def test_groups_carry_what_is_in_them(tmp_path):
    body = (
        '<g transform="translate(100)"><g transform="scale(2)">'
        '<polyline points="0 0 1 1" stroke="red"/></g></g>'
        '<path d="M0 0L9 9"/>'
    )
    assert load_path(svg(tmp_path, body), scale=1).points.tolist() == [[-100, 0], [-102, -2]]


PATHLESS = [
    ("", "a visible path, line or shape, got none"),
    ('<path d=""/>', "shape, got none"),
    ('<path d="L 5 5"/>', "starts with 'M'"),
    ('<path d="M 0 0 L 5"/>', "2 numbers for 'L'"),
    ('<path d="M 0 0 L 55"/>', "2 numbers for 'L', got 1"),
    ('<path d="M 0 0 C 1 2 3 4 5 6 7"/>', "6 numbers for 'C', got 1"),
    ('<path d="M 0 0 L"/>', "2 numbers for 'L', got 0"),
    ('<path d="M 0 0 L 5 *"/>', "numbers for 'L', got '[*]' as number 2"),
    ('<path d="M 0 0 B 5 5"/>', "the commands M L H V C S Q T A Z, got 'B'"),
    ('<path d="M 0 0 L 5 5 z 9 9"/>', "0 numbers for 'z', got 2"),
    ('<path d="M 0 0 A 5 5 0 2 1 9 9"/>', "flags 0 or 1 for 'A', got '5 5 0 2 1 9 9'"),
    ('<path transform="scale(1, 2, 3)" d="M 0 0 L 5 5"/>', r"a transform, got 'scale\(1, 2, 3\)'"),
    ('<path transform="perspective(9)" d="M 0 0 L 5 5"/>', "a transform, got 'perspective"),
    ('<g transform="scale 2"><path d="M 0 0 L 5 5"/></g>', "a transform, got 'scale 2'"),
    ('<defs><path d="M 0 0 L 5 5"/></defs>', "a visible path, line or shape, got none"),
    ('<path d="M 0 0 L 0 0"/>', "zero length"),
    ('<polyline points="0 0"/>', "two points"),
    ('<polyline points="0 0 9 9 5"/>', "2 numbers for each point of a polyline, got 1"),
    ('<polyline points="0 0 9 x"/>', "2 numbers for each point of a polyline, got 'x' as number 4"),
    ('<line x2="10em"/>', "a length for 'x2' of a line, got '10em'"),
    ('<line x2=""/>', "a length for 'x2' of a line, got ''"),
    ('<g display="none"><path d="M 0 0 L 5 5"/></g>', "got none"),
    ("<path", "SVG picture"),
]
test_tables_without_a_path_are_told = refused_texts(
    load_path,
    "path.csv",
    ("1,1", "two points"),
    (f"0 0\n1{' ' * 500_000}x 2", "line 2: expected x and z .*, got 3"),
    ("", "an empty file"),
)
test_another_ending_is_told = refusals(("give a .csv or .svg", load_path, "path.png"))
NESTED = 5000
BOMB = "".join(f'<!ENTITY e{n + 1} "{f"&e{n};" * 10}">' for n in range(9))


HOSTILE = [
    (f'<!DOCTYPE svg [<!ENTITY e0 "L 9 9">{BOMB}]><svg><path d="M 0 0 &e9;"/></svg>', "SVG picture"),
    ('<!DOCTYPE svg [<!ENTITY e SYSTEM "file:///etc/passwd">]><svg>&e;</svg>', "SVG picture, got undef"),
    ('<!DOCTYPE svg SYSTEM "http://127.0.0.1:9/x.dtd"><svg/>', "a visible path, line or shape"),
    ("<g>" * NESTED + "</g>" * NESTED, "a visible path, line or shape"),
    ('<g transform="scale(1e8)">' * 99 + '<line x2="1"/>' + "</g>" * 99, "not finite"),
    ('<path d="M 0 0 L 1e999 0"/>', "numbers for 'L', all below 1e[+]09"),
    (f'<path d="M 0 0 L 1 {"1" * 200_000}"/>', "numbers for 'L', all below"),
    (f'<path d="M 0 0 L {"1 " * 100_001}"/>', "2 numbers for 'L', got 1"),
    (f'<path d="{"M 0 0 " * 30_000} x"/>', "the commands M L .* got 'x'"),
    (f'<path d="M 0 0 A {"1 " * 100_001}"/>', "flags 0 or 1 for 'A'|7 numbers for 'A', got 6"),
    (f'<path transform="{"translate(1)  " * 9999}!" d="M 0 0 L 1 1"/>', "a transform, got '!'"),
    (f'<polyline points="{" " * 100_000}x"/>', "2 numbers for each point of a polyline, got 1"),
]
test_pictures_without_a_path_and_hostile_ones_are_told = refused_texts(
    load_path, "path.svg", *((SVG.format(body), said) for body, said in PATHLESS), *HOSTILE
)


@pytest.mark.parametrize("hidden", ['display="none"', 'style="fill:red; display : none"'])
def test_what_is_not_shown_is_not_walked(tmp_path, hidden):
    body = f'<g {hidden}><line x2="1"/></g><line {hidden} x2="2"/><line x2="3"/>'
    assert load_path(svg(tmp_path, body), scale=1).points[-1].tolist() == [-3, 0]


def test_groups_may_be_nested_to_any_depth(tmp_path):
    body = '<g transform="translate(1)">' * 5000 + '<line x2="3"/>' + "</g>" * 5000
    assert load_path(svg(tmp_path, body), scale=1).points[-1].tolist() == [-5003, 0]


def test_moves_without_a_line_draw_nothing(tmp_path):
    path = load_path(svg(tmp_path, '<path d="M 900 900 M 0 0 L 100 0 M 5 5 L 6 6"/>'))
    assert path.points.tolist() == [[0, 0], [-1, 0]]


@pytest.mark.parametrize("step", ["12.3 45.6 22.1 17.9 ", "c 1 2 3 4 5 6 l 7 8"])
def test_a_long_path_is_read(tmp_path, step):
    """Of up to 80 000 points, in time that grows as they do."""
    count = 800_000 // len(step) if "." in step else 3000
    end = [-0.221, -0.179] if "." in step else [-360, -420]
    path = load_path(svg(tmp_path, f'<path d="M 0 0 {step * count}"/>'))
    assert path.points[-1] == pytest.approx(end)


@pytest.mark.parametrize("step", ["a 9 9 0 0 1 5 5 ", "c 1 2 3 4 5 6 "])
def test_a_line_of_too_many_points_is_refused(tmp_path, step):
    file = svg(tmp_path, f'<path d="M 0 0 {step * 16_000}"/>')
    refused("lines of 500,000 points at most", load_path, file, kind=FormatError)


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("line", ['<line x1="1" x2="1e8"/>', '<path d="M 1 1 A 1e8 1e-8 9 1 1 1e8 -1e8"/>'])
def test_numpy_does_not_warn_beside_an_error(tmp_path, line):
    groups = '<g transform="scale(1e8 -1e8)">'
    refused("not finite", load_path, svg(tmp_path, f"{groups * 60}{line}{'</g>' * 60}"))


# Shapes, references and styles ------------------------------------------------------------------------------

ROUND = np.pi * 100
ELLIPSE = 484.422411  # the perimeter of an ellipse of half axes 100 and 50
LENGTHS = [
    ('<circle cx="9" cy="5" r="50"/>', ROUND),
    ('<ellipse rx="100" ry="50"/>', ELLIPSE),
    ('<rect x="5" width="30" height="40"/>', 140),
    ('<rect width="300" height="200" rx="50"/>', 600 + ROUND),
    ('<rect width="300" height="200" rx="auto" ry="50"/>', 600 + ROUND),
    ('<line x2="1in"/>', 96),
    ('<path d="M10 300A50 50 0 01110 300"/>', ROUND / 2),
    ('<path d="M10 300a50 50 0 0 1 100 0 50 50 0 01-1e2 0"/>', ROUND),
    ('<path d="M0 0H30M30 0V40M30 40 L 0 40"/>', 100),
    ('<path d="M0. 0. H 3. z h 5"/>', 11),
    ('<g transform="skewX(45)"><path d="M7 0V30"/></g>', 30 * np.sqrt(2)),
    ('<defs><path id="p" d="M0 0H9"/></defs><use href="#p" transform="scale(3)"/>', 27),
    ('<symbol id="p"><line x2="9"/></symbol><use href="#p" x="5"/><use href="#q"/>', 9),
    ('<svg x="9" width="100" height="100" viewBox="0 0 10 10"><line x2="9"/></svg>', 90),
    ('<rect width="100%" height="50%"/>', 300),
]


@pytest.mark.parametrize(("body", "length"), LENGTHS)
def test_each_shape_has_the_length_of_its_formula(tmp_path, body, length):
    assert load_path(svg(tmp_path, body), scale=1).length == pytest.approx(length, rel=1e-3)


def test_references_move_what_they_repeat(tmp_path):
    body = '<defs><line id="a" x2="3"/></defs><g transform="scale(2)"><use href="#a" x="5" y="7"/></g>'
    assert load_path(svg(tmp_path, body), scale=1).points.tolist() == [[-10, -14], [-16, -14]]


CSS = "<style>/* .a{} */ .a, line.b {display:none} #c{fill:none; stroke:red !important} .d{visibility:hidden}"
PICTURES = [  # the line of 3 units is meant
    '<path d="M0 0H99V99H0z" fill="#fff"/><path d="M0 0H3" stroke="red" fill="none"/>',
    '<path d="M0 0H99" stroke="red"/><path d="M0 0H3" style="stroke:red; fill:none"/>',
    '<path d="M0 0H99" visibility="hidden"/><line x2="3"/>',
    '<g visibility="hidden"><path d="M0 0H99"/><line x2="3" style="visibility:visible"/></g>',
    f'{CSS}</style><line class="x a" x2="9"/><line class="b" x2="9"/><line x2="3"/>',
    f'{CSS}</style><line x2="9"/><line id="c" x2="3"/>',
    f'{CSS}</style><g class="d"><line x2="9"/></g><line x2="3"/>',
    '<g stroke="red" fill="none"><svg width="9" height="9"/><path d=""/><path d="M0 0h3"/></g>',
]


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("body", PICTURES)
def test_the_line_that_is_meant_is_read(tmp_path, body):
    assert load_path(svg(tmp_path, body), scale=1).length == 3


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("size", ['viewBox="5 5 60 40"', 'width="60" height="40px"'])
def test_a_frame_of_the_page_comes_last(tmp_path, size):
    style = 'fill="none" stroke="red"'
    frame = f'<rect width="60" height="40" {style}/>'
    file = tmp_path / "path.svg"
    file.write_text(f'<svg {size}>{frame}<line x2="3" {style}/></svg>')
    assert load_path(file, scale=1).length == 3
    file.write_text(f"<svg {size}>{frame}</svg>")
    assert load_path(file, scale=1).length == 200


SEVERAL = '<g id="walks"><line id="short" x2="3"/><line x2="5"/></g><path d="M0 0H9M9 9H2"/>'


def test_of_several_lines_the_longest_is_read_and_named(tmp_path):
    file = svg(tmp_path, SEVERAL)
    said = r"4 lines: 'path 1 stroke 1' \(9.00 m\), the longest, is read, and not 'path 1 stroke 2' .*by id="
    with pytest.warns(MocapWarning, match=said):
        assert load_path(file, scale=1).length == 9
    with pytest.warns(MocapWarning, match=r"'path 1 stroke 1' \(18.00 m\).*\(14.00 m\)"):
        assert load_path(file, length=18).length == pytest.approx(18)


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize(("name", "length"), [("short", 3), ("line 2", 5), ("path 1 stroke 2", 7)])
def test_a_line_is_chosen_by_its_id_or_name(tmp_path, name, length):
    assert load_path(svg(tmp_path, SEVERAL), scale=1, id=name).length == length


def test_a_group_is_chosen_by_its_id(tmp_path):
    with pytest.warns(MocapWarning, match="2 lines: 'line 2'"):
        assert load_path(svg(tmp_path, SEVERAL), scale=1, id="walks").length == 5


def test_the_length_sets_the_size(tmp_path):
    (tmp_path / "path.csv").write_text("0 0\n0 3\n4 3\n")
    assert load_path(tmp_path / "path.csv", length=14).points.tolist() == [[0, 0], [0, 6], [8, 6]]


def test_wrong_choices_are_told(tmp_path):
    table = tmp_path / "path.csv"
    table.write_text("0 0\n0 3\n")
    picture = svg(tmp_path, SEVERAL)
    refused("one of scale and length", load_path, picture, scale=1, length=2)
    refused("length must be a number above 0", load_path, picture, length=0)
    refused("no elements with an id", load_path, table, id="walk")
    refused("'walk', got 'short', 'line 2', 'path 1'", load_path, picture, id="walk", kind=FormatError)


ENDLESS = [
    '<g id="a"><use href="#a"/><line x2="9"/></g>',
    "<defs>"
    + "".join(f'<g id="g{n}">{f"""<use href="#g{n + 1}"/>""" * 10}</g>' for n in range(9))
    + '</defs><use href="#g0"/>',
]


@pytest.mark.parametrize("body", ENDLESS)
def test_references_without_end_are_refused(tmp_path, body):
    refused("100,000 elements at most", load_path, svg(tmp_path, body), kind=FormatError)


@pytest.mark.parametrize("suffix", [".csv", ".svg"])
def test_a_file_of_too_many_points_is_refused_before_it_is_read(tmp_path, suffix):
    points = "1 2\n2 1\n" * 250_001
    file = tmp_path / f"path{suffix}"
    file.write_text(points if suffix == ".csv" else SVG.format(f'<path d="M{points}"/>'))
    refused("500,000 (lines|points) at most", load_path, file, kind=FormatError)
