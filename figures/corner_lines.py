"""Follow lines with corners and cusps: `python figures/corner_lines.py [FOLDER]`.

Writes the table `corners.md` beside this script. The folder holds the clips of CMU 16; without it the bundled
clips alone follow the lines.
"""

import sys
import warnings
from pathlib import Path

import numpy as np
from asked_lines import follow_unbent
from benchmark import clips
from tasks import CMU_16, WALKS, graph

from mocap.body import GroundPath, on_ground
from mocap.editing import LIMIT
from mocap.errors import MocapError, MocapWarning
from mocap.graphs.compiled_graph import CompiledGraph
from mocap.steering import follow_path
from mocap.steering.followed import Followed

PAGE = Path(__file__).with_name("corners.md")
CORNERS = (30, 60, 90, 120, 150)  # degrees by which a line turns at once
ZIGZAGS = (45, 90, 135)  # degrees, to either side in turn
SIDE = 4.0  # metres from a corner to the ends of the line
ZIG = 2.5  # metres between the corners of a zigzag
ZIGS = 5  # sides of a zigzag
RADIUS = 2.0  # metres, of the half circles that meet in a cusp
FINE = 0.02  # metres between the points of a line that are looked for in the walk


def corner(degrees: float) -> GroundPath:
    """Draw one corner."""
    return polyline([0.0, np.radians(degrees)], SIDE)


def zigzag(degrees: float) -> GroundPath:
    """Draw corners to either side in turn."""
    return polyline([np.radians(degrees) * (number % 2) for number in range(ZIGS)], ZIG)


def polyline(headings: list[float], side: float) -> GroundPath:
    """Draw sides of one length with some headings, radians."""
    moves = side * np.stack([np.sin(headings), np.cos(headings)], axis=1)
    return GroundPath(np.vstack([[0.0, 0.0], np.cumsum(moves, axis=0)]))


def cusp() -> GroundPath:
    """Draw two half circles side by side, which meet in a cusp: the line turns back by 180° there."""
    angles = np.linspace(np.pi, 0, 100)
    arch = RADIUS * np.stack([1 + np.cos(angles), np.sin(angles)], axis=1)
    return GroundPath(np.vstack([arch, arch[1:] + np.array([2 * RADIUS, 0])]))


# reads: statement: a table
LINES = {
    **{f"corner of {degrees}°": corner(degrees) for degrees in CORNERS},
    **{f"corners of {degrees}°": zigzag(degrees) for degrees in ZIGZAGS},
    "two half circles, a cusp": cusp(),
}


def row(name: str, title: str, line: GroundPath, followed: Followed) -> str:
    """Write how far a walk is from its line, how far the line is from the walk, and what is told of it."""
    track = on_ground(followed.motion().root_positions)
    points = on_ground(line.at(np.arange(0, line.length, FINE)))
    distances = 100 * np.abs(track[:, None] - points)
    nearest = distances.min(axis=1)
    left_out = distances.min(axis=0).max()
    rounding = max((moved for _, _, moved in roundings(followed)), default=0.0)
    if followed.bent:
        description = f"rounded by {100 * rounding:.0f} cm" if rounding else ""
    else:
        worst = max((distance for _, _, distance in followed.departures), default=0.0)
        description = f"leaves the path by {100 * worst:.0f} cm" if worst else ""
    return (
        f"| {name} | {title} | {nearest.mean():.1f} | {nearest.max():.1f} | {left_out:.1f} | {description} |"
    )


def roundings(followed: Followed) -> list[tuple[float, float, float]]:
    """Return the rounded intervals of a bent walk's line."""
    return followed.bent.line.roundings if followed.bent else []


def rows(name: str, source: CompiledGraph) -> list[str]:
    """Write two rows for each line: clips as they are, and bent."""
    lines = []
    for title, line in LINES.items():
        for kind, follow in (("as it is", follow_unbent), ("bent", bent)):
            try:
                lines.append(row(f"{name}, {kind}", title, line, follow(source, line)))
            except MocapError as error:
                lines.append(f"| {name}, {kind} | {title} | | | | refused: {error} |")
            print(lines[-1], flush=True)
    return lines


def bent(source: CompiledGraph, line: GroundPath) -> Followed:
    """Bend a walk onto a line."""
    return follow_path(source, line, bend=LIMIT)


HEAD = """# Lines with corners and cusps

`python figures/corner_lines.py` writes this page. Off: the mean distance of the root from the line; worst:
the largest. Left out: the largest distance of a point of the line from the walk, such as the tip of a corner
that is cut. Told: what `report()` and `mocap walk` say about it. A bent walk turns by at most 100° per second
more than its clips do, so that a sharper corner is rounded.

| walk | line | off, cm | worst, cm | left out, cm | told |
|---|---|---|---|---|---|"""


def main() -> None:
    """Write the table."""
    warnings.simplefilter("ignore", MocapWarning)
    folders = tuple(Path(folder) for folder in sys.argv[1:])
    lines = [HEAD]
    for name, names in (("bundled", WALKS), ("CMU 16", CMU_16)):
        loaded = clips(names, folders)
        if loaded is not None:
            lines += rows(name, graph(tuple(loaded)))
    PAGE.write_text("\n".join([*lines, ""]), "utf-8")


if __name__ == "__main__":
    main()
