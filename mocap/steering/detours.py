"""Lines around discs on the ground, by the convex hulls of discs that are too close to pass between."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from scipy.spatial import ConvexHull

from mocap._shared.arrays import Array, Points
from mocap.errors import NoWalk
from mocap.files.directions import DirectedPoint

Disc = tuple[complex, float]
CORNERS = 24  # corners of the polygon around a disc, which are 0.9 % of the radius outside
BAND = 0.1  # metres between the points of an elastic band
RELAXATIONS = 300  # which smooth the line over about 2 m
FINE = 0.05  # metres between the points of a line that are tested against polygons


def around_discs(line: Points, discs: Sequence[Disc], clearance: float) -> Points:
    """Lead a line around discs, on the shorter side of each.

    Discs are enlarged by the room of a body, but by less next to an end of the line, which may be beside a
    disc. Enlarged discs that touch are passed together: their convex hull is a polygon, and
    the part of the line inside it is replaced by the shorter part of its border.

    Parameters
    ----------
    line : shape (N,), complex z + ix, metres.
    discs : centres and radii.
    clearance : the room of a body, metres.

    Returns
    -------
    The points of the new line; those of the old one that are outside all polygons are among them.

    Raises
    ------
    NoWalk : for a line that starts or ends inside a disc, or between discs that are passed together.

    Examples
    --------
    >>> line = around_discs(np.array([0j, 6 + 0j]), [(3 + 0.1j, 0.5)], 0.4)
    >>> bool(np.abs(line - (3 + 0.1j)).min() > 0.85), bool(line.imag.min() < -0.5), bool(line[-1] == 6)
    (True, True, True)
    """
    for end in line[[0, -1]]:
        inside = [centre for centre, radius in discs if abs(end - centre) <= radius]
        if inside:
            place = f"x = {end.imag:.2f}, z = {end.real:.2f}"
            raise NoWalk(f"The line starts, waits or ends at {place}, which is inside a disc.")
    ends = line[[0, -1]]
    enlarged = [(centre, _room(centre, radius + clearance, radius, ends)) for centre, radius in discs]
    fine = _refined(line)
    for polygon in _hulls(enlarged):
        fine = _led_around(fine, polygon)
    return _relaxed(_refined(fine), enlarged, line)


def _room(centre: complex, enlarged: float, radius: float, ends: Points) -> float:
    """Return the radius of an enlarged disc, which leaves out the ends of the line."""
    nearest = float(np.abs(ends - centre).min())
    return min(enlarged, max(radius, nearest - FINE))


def _refined(line: Points) -> Points:
    """Insert points into a line, at most `FINE` metres apart."""
    pieces = []
    for start, end in pairwise(line.tolist()):
        count = max(1, int(np.ceil(abs(end - start) / FINE)))
        pieces.append(start + (end - start) * np.arange(count) / count)
    return np.concatenate([*pieces, line[-1:]])


def _hulls(discs: Sequence[Disc]) -> list[Points]:
    """Return the convex polygons around groups of discs, merged until no two of them overlap."""
    angles = 2 * np.pi * np.arange(CORNERS) / CORNERS
    circle = np.exp(1j * angles) / np.cos(np.pi / CORNERS)  # the polygon is around the circle
    polygons = [centre + radius * circle for centre, radius in discs]
    while True:
        pair = _first_overlap(polygons)
        if pair is None:
            return polygons
        a, b = pair
        merged = np.concatenate([polygons[a], polygons[b]])
        corners = merged[ConvexHull(np.stack([merged.real, merged.imag], axis=1)).vertices]
        polygons = [part for number, part in enumerate(polygons) if number not in pair]
        polygons.append(corners)


def _relaxed(line: Points, discs: Sequence[Disc], fixed: Points) -> Points:
    """Shorten and smooth a line like an elastic band around discs; the points `fixed` stay."""
    length = along_line(line)
    count = int(length[-1] / BAND) + 2
    nearest = [int(np.abs(line - point).argmin()) for point in fixed]
    knots = set(length[nearest].tolist())
    along = np.array(sorted({*np.linspace(0, length[-1], count).tolist(), *knots}))
    band = np.interp(along, length, line.real) + 1j * np.interp(along, length, line.imag)
    stays = np.isin(along, sorted(knots))
    stays[[0, -1]] = True
    for _ in range(RELAXATIONS):
        moved = band.copy()
        moved[1:-1] = (band[:-2] + band[2:]) / 2
        for centre, radius in discs:
            offset = moved - centre
            distance = np.maximum(np.abs(offset), 1e-9)
            moved = np.where(distance < radius, centre + offset * (radius / distance), moved)
        band = np.where(stays, band, moved)
    return np.asarray(band)


def _first_overlap(polygons: Sequence[Points]) -> tuple[int, int] | None:
    """Return the first two convex polygons that overlap, by their separating axes."""
    for b in range(len(polygons)):
        for a in range(b):
            first = polygons[a]
            second = polygons[b]
            if not (_separated(first, second) or _separated(second, first)):
                return a, b
    return None


def _separated(polygon: Points, second: Points) -> bool:
    """Return whether an edge of a convex polygon (counter-clockwise) has a second one on its outer side."""
    edges = np.roll(polygon, -1) - polygon
    sides = ((second[None] - polygon[:, None]) * edges.conj()[:, None]).imag
    return bool((sides < 0).all(axis=1).any())


def _led_around(line: Points, polygon: Points) -> Points:
    """Replace the part of a line inside a convex polygon by the shorter part of its border."""
    edges = np.roll(polygon, -1) - polygon
    offsets = (line[None] - polygon[:, None]) * edges.conj()[:, None]
    inside = np.asarray((offsets.imag > 0).all(axis=0))
    if not inside.any():
        return line
    if inside[0] or inside[-1]:
        end = line[0] if inside[0] else line[-1]
        place = f"x = {end.imag:.2f}, z = {end.real:.2f}"
        raise NoWalk(f"No way leads to {place}, between discs that leave no room: leave 0.9 m between them.")
    first = int(inside.argmax())
    last = len(line) - int(inside[::-1].argmax())
    enter = int(np.abs(polygon - line[first - 1]).argmin())
    leave = int(np.abs(polygon - line[last]).argmin())
    count = len(polygon)
    forwards = polygon[(enter + np.arange((leave - enter) % count + 1)) % count]
    backwards = polygon[(enter - np.arange((enter - leave) % count + 1)) % count]
    border = min(forwards, backwards, key=lambda part: np.abs(np.diff(part)).sum())
    return np.concatenate([line[:first], border, line[last:]])


def line_around(points: Sequence[DirectedPoint], discs: Sequence[Disc], clearance: float) -> Points:
    """Return the line through two or more points, led around discs, as complex numbers z + ix."""
    line = np.array([complex(point.z, point.x) for point in points])
    return around_discs(line, discs, clearance) if discs else _refined(line)


def along_line(line: Points) -> Array:
    """Return the arc length from the start of a line to each of its points, metres."""
    return np.concatenate([[0.0], np.cumsum(np.abs(np.diff(line)))])


def metres_of(line: Points, positions: Sequence[complex]) -> list[float]:
    """Return the arc lengths at which a line passes positions in their order, from its start to its end."""
    along = along_line(line)
    passed = 0
    metres = [0.0]
    for position in positions[1:-1]:
        passed += int(np.abs(line[passed:] - position).argmin())
        metres.append(float(along[passed]))
    return [*metres, float(along[-1])]
