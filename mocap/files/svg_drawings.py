"""The lines of an SVG picture, and which of them is meant as a path.

Elements are visited here, with their groups, transforms, styles and references, so that pictures of any depth
are read and hostile ones refused. `svg_shapes` draws each element.
"""

from collections.abc import Mapping
from enum import IntEnum
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import svgelements

from mocap._shared.arrays import Array
from mocap._shared.records import NamedTuple
from mocap.errors import FormatError
from mocap.files.svg_shapes import (
    DRAWN,
    JOINED,
    LENGTH,
    MOST_POINTS,
    NUMBER,
    SEPARATORS,
    lengths,
    strokes,
    too_many,
)
from mocap.files.text import quick_numbers, read_text, to_numbers

UNDRAWN = {"clipPath", "defs", "marker", "mask", "metadata", "pattern", "symbol"}  # only by reference
XLINK = "{http://www.w3.org/1999/xlink}href"
STEPS = {"matrix": (6,), "translate": (1, 2), "scale": (1, 2), "rotate": (1, 3), "skewX": (1,), "skewY": (1,)}
INITIAL = {"fill": "black", "stroke": "none", "visibility": "visible"}  # the inherited properties in use
PROPERTIES = {*INITIAL, "display"}
NO_PAINT = {"none", "transparent"}
BOX_NUMBERS = 4
MOST_ELEMENTS = 100_000  # with those that `use` repeats
PAGE = 0.95  # fraction of the page: a closed line of this width and height is a frame or a background
UNKNOWN_PAGE = (100.0, 100.0)  # units: a per cent is a unit

Style = Mapping[str, str]


class Rank(IntEnum):
    """The order in which lines are preferred."""

    OUTLINE = 0  # stroked and not filled
    FILLED = 1  # stroked and filled
    UNSTROKED = 2
    PAGE = 3  # closed, and as large as the page: a frame or a background


class Line(NamedTuple):
    """A line of a picture.

    name : the id of its element, or its kind and number, such as "path 2", with the number of the stroke.
    points : shape (N, 2), x to the right and y down.
    rank : the order in which it is preferred.
    """

    name: str
    points: Array
    rank: Rank

    @property
    def length(self) -> float:
        """The length of the line, in units of the picture."""
        return float(np.hypot(*np.diff(self.points, axis=0).T).sum())


class _Visit(NamedTuple):
    """An element to visit, with what it takes over from its groups.

    matrix : the transform (3, 3) of the groups.
    style : their inherited properties.
    is_chosen : whether one of them is the chosen element.
    is_used : whether the element is drawn by a reference.
    """

    element: ElementTree.Element
    matrix: Array
    style: Style
    is_chosen: bool
    is_used: bool = False


class Drawing:
    """The visible lines of a picture.

    Parameters
    ----------
    file : an `.svg` file.
    chosen : the id of an element or a group, or the name of a line, to which the lines are restricted.

    Attributes
    ----------
    lines : the lines, in the order in which they are drawn.
    names : the names of all visible elements that draw lines.

    Raises
    ------
    FormatError : for a picture that breaks its format, and for one of too many points or elements.
    """

    def __init__(self, file: Path, chosen: str | None = None) -> None:
        self.file = file
        self.chosen = chosen
        self.lines: list[Line] = []
        self.names: list[str] = []
        self._counts: dict[str, int] = {}
        self._points = 0
        try:
            root = ElementTree.fromstring(read_text(file))
        except ElementTree.ParseError as error:
            raise FormatError(file, error.position[0], "an SVG picture", str(error)) from None
        self._root = root
        self._page = _page(root)
        self._rules = _rules(root)
        self._by_id = {element.get("id"): element for element in root.iter() if element.get("id")}
        with np.errstate(over="ignore", invalid="ignore"):  # `GroundPath` rejects infinite and NaN values
            self._visit_all(root)

    def best(self) -> list[Line]:
        """Return the lines of the best rank, from the longest to the shortest; without lengths, the first.

        Raises
        ------
        FormatError : if there is no line.
        """
        if not self.lines and self.chosen is not None:
            listed = ", ".join(f"'{name}'" for name in self.names) or "none"
            raise FormatError(self.file, None, f"a visible line with the id '{self.chosen}'", listed)
        if not self.lines:
            raise FormatError(self.file, None, "a visible path, line or shape", "none")
        drawn = [line for line in self.lines if not line.length <= 0]  # NaN is reported by `GroundPath`
        if not drawn:
            return self.lines[:1]
        rank = min(line.rank for line in drawn)
        return sorted((line for line in drawn if line.rank == rank), key=lambda line: -line.length)

    def _visit_all(self, root: ElementTree.Element) -> None:
        """Visit the elements in their order, and draw those that are visible."""
        stack = [_Visit(root, np.eye(3), INITIAL, self.chosen is None)]  # the next one at the end
        visited = 0
        while stack:
            visited += 1
            if visited > MOST_ELEMENTS:
                got = "more, or an element that uses itself"
                raise FormatError(self.file, None, f"a picture of {MOST_ELEMENTS:,} elements at most", got)
            visit = stack.pop()
            kind = _kind(visit.element)
            style = {**visit.style, **_style(visit.element, kind, self._rules)}
            is_apart = kind in UNDRAWN and not visit.is_used
            if is_apart or style.pop("display", "") == "none":
                continue
            matrix = self._transformed(visit.matrix, visit.element.get("transform", ""))
            is_chosen = visit.is_chosen or visit.element.get("id") == self.chosen
            stack += self._entered(_Visit(visit.element, matrix, style, is_chosen), kind)

    def _entered(self, visit: _Visit, kind: str) -> list[_Visit]:
        """Draw an element, or return the visits of the elements in it, the last one first."""
        element = visit.element
        if kind in DRAWN:
            self._draw(visit, kind)
            return []
        if kind == "use":
            target = self._by_id.get(_reference(element))
            matrix = self._moved(visit.matrix, element, kind)
            return [] if target is None else [visit._replace(element=target, matrix=matrix, is_used=True)]
        if kind == "svg" and element is not self._root:
            visit = visit._replace(matrix=self._in_viewport(visit.matrix, element))
        return [visit._replace(element=child) for child in reversed(element)]

    def _draw(self, visit: _Visit, kind: str) -> None:
        """Add the lines of an element, if it is visible and chosen."""
        self._counts[kind] = self._counts.get(kind, 0) + 1
        if visit.style["visibility"] in ("hidden", "collapse"):
            return
        name = visit.element.get("id") or f"{kind} {self._counts[kind]}"
        self.names.append(name)
        if not (visit.is_chosen or f"{self.chosen} ".startswith(f"{name} ")):
            return
        limit = MOST_POINTS - self._points
        drawn = strokes(self.file, kind, visit.element.attrib, self._page or UNKNOWN_PAGE, limit)
        self._points += sum(map(len, drawn))
        if self._points > MOST_POINTS:
            raise too_many(self.file)
        for number, stroke in enumerate(drawn, 1):
            label = name if len(drawn) == 1 else f"{name} stroke {number}"
            if visit.is_chosen or self.chosen in (name, label):
                points = stroke @ visit.matrix[:2, :2].T + visit.matrix[:2, 2]
                self.lines.append(Line(label, points, self._rank(points, visit.style)))

    def _rank(self, points: Array, style: Style) -> Rank:
        """Return the rank of a line."""
        if self._page:
            is_large = bool((np.ptp(points, axis=0) >= PAGE * np.array(self._page)).all())
            if is_large and np.hypot(*(points[-1] - points[0])) <= JOINED:
                return Rank.PAGE
        if style["stroke"] in NO_PAINT:
            return Rank.UNSTROKED
        return Rank.OUTLINE if style["fill"] in NO_PAINT else Rank.FILLED

    def _moved(self, matrix: Array, element: ElementTree.Element, kind: str) -> Array:
        """Multiply a matrix by the translation to the x and y of an element."""
        place = lengths(self.file, kind, element.attrib, ("x", "y"))
        width, height = self._page or UNKNOWN_PAGE
        x = svgelements.Length(place.get("x", "0")).value(ppi=96.0, relative_length=width)
        y = svgelements.Length(place.get("y", "0")).value(ppi=96.0, relative_length=height)
        return np.asarray(matrix @ [[1, 0, x], [0, 1, y], [0, 0, 1]])

    def _in_viewport(self, matrix: Array, element: ElementTree.Element) -> Array:
        """Multiply a matrix by the transform into a picture within the picture."""
        matrix = self._moved(matrix, element, "svg")
        box = _box(element)
        size = _size(element)
        if box is None or size is None:
            return matrix
        aspect = element.get("preserveAspectRatio")
        return np.asarray(matrix @ _matrix(svgelements.Viewbox.viewbox_transform(0, 0, *size, *box, aspect)))

    def _transformed(self, matrix: Array, text: str) -> Array:
        """Multiply a matrix (3, 3) by the steps of a `transform`, such as "translate(5) scale(2)".

        The last step is applied to a point first.
        """
        *steps, remainder = text.split(")")
        if remainder.strip(SEPARATORS):
            raise FormatError(self.file, None, "a transform", f"'{remainder.strip(SEPARATORS)}'")
        for step in steps:
            name, _, arguments = step.strip(SEPARATORS).partition("(")
            words = NUMBER.findall(arguments)
            if NUMBER.sub("", arguments).strip(SEPARATORS):
                got = f"'{arguments.strip(SEPARATORS)}'"
                raise FormatError(self.file, None, "numbers of a transform", got)
            numbers = to_numbers(self.file, None, words, "numbers of a transform", len(words)).tolist()
            if len(numbers) not in STEPS.get(name.strip(), ()):
                raise FormatError(self.file, None, "a transform", f"'{step.strip(SEPARATORS)})'")
            arguments = " ".join(f"{number:.17g}" for number in numbers)
            matrix = matrix @ _matrix(f"{name.strip()}({arguments})")
        return matrix


def _matrix(text: str) -> Array:
    """Return the matrix (3, 3) of a checked `transform`."""
    step = svgelements.Matrix(text)
    return np.array([[step.a, step.c, step.e], [step.b, step.d, step.f], [0, 0, 1]], float)


def _kind(element: ElementTree.Element) -> str:
    """Return the name of an element without its namespace."""
    return element.tag.rpartition("}")[2]


def _reference(element: ElementTree.Element) -> str:
    """Return the id of the element that a `use` repeats; "" for one in another file."""
    href = element.get("href") or element.get(XLINK) or ""
    return href.removeprefix("#") if href.startswith("#") else ""


def _page(root: ElementTree.Element) -> tuple[float, float] | None:
    """Return the width and height of the page, in units of the picture, or None if they are not given."""
    box = _box(root)
    if box is None:
        return _size(root)
    _, _, width, height = box
    return width, height


def _box(element: ElementTree.Element) -> tuple[float, ...] | None:
    """Return the left, top, width and height of a viewBox, or None if there is none of a size above 0."""
    numbers = quick_numbers(NUMBER.findall(element.get("viewBox", "")))
    if numbers is None or len(numbers) != BOX_NUMBERS or numbers[2:].min() <= 0:
        return None
    return tuple(numbers.tolist())


def _size(element: ElementTree.Element) -> tuple[float, float] | None:
    """Return the width and height of an `svg` element in pixels, or None if they are not both given."""
    size = []
    for name in ("width", "height"):
        match = LENGTH.fullmatch(element.get(name, ""))
        if not match or match[2] == "%":
            return None
        size.append(float(svgelements.Length(match[0]).value(ppi=96.0)))
    return size[0], size[1]


def _rules(root: ElementTree.Element) -> dict[str, Style]:
    """Return the properties of each simple selector of the style sheets, such as ".st0" or "path"."""
    rules: dict[str, dict[str, str]] = {}
    for element in root.iter():
        if _kind(element) != "style":
            continue
        first, *comments = (element.text or "").split("/*")
        for block in "".join([first, *(text.partition("*/")[2] for text in comments)]).split("}"):
            selectors, _, declarations = block.partition("{")
            properties = _declared(declarations)
            for selector in selectors.split(",") if properties else ():
                rules.setdefault(selector.strip(), {}).update(properties)
    return dict(rules)


def _declared(text: str) -> dict[str, str]:
    """Return the properties in use of declarations such as "fill:none; stroke:red"."""
    pairs = (declaration.partition(":") for declaration in text.split(";"))
    return _in_use({name.strip(): value for name, _, value in pairs})


def _in_use(properties: Mapping[str, str]) -> dict[str, str]:
    """Select the properties in use, with their values in lower case."""
    values = {}
    for name in PROPERTIES & properties.keys():
        value = properties[name].partition("!")[0].strip().lower()
        if value not in ("", "inherit"):
            values[name] = value
    return values


def _style(element: ElementTree.Element, kind: str, rules: Mapping[str, Style]) -> dict[str, str]:
    """Return the properties that an element has itself: of attributes, style sheets, and its own style."""
    style = _in_use(element.attrib)
    classes = dict.fromkeys(element.get("class", "").split()) if rules else {}
    selectors = ["*", kind]
    for name in classes:
        selectors += [f".{name}", f"{kind}.{name}"]
    for selector in [*selectors, f"#{element.get('id')}"]:
        style.update(rules.get(selector, {}))
    style.update(_declared(element.get("style", "")))
    return style
