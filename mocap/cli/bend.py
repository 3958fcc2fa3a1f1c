"""The command `mocap bend`: a walk laid on a line drawn on the ground."""

import argparse
import math
from pathlib import Path
from typing import TYPE_CHECKING

from mocap import editing, files, quality
from mocap._shared.atomic import require_writable
from mocap.cli.options import LENGTH, TURN, add_reading, require_amc
from mocap.cli.warp import FORMATS
from mocap.errors import MocapError

if TYPE_CHECKING:
    from mocap.cli.options import Commands


def add_bend(commands: "Commands") -> None:
    """Add `mocap bend`."""
    bend = commands.add_parser(
        "bend",
        help="lay a walk on a line",
        description="Lay the walk of a clip on a line drawn on the ground, as far as it goes, and clean up "
        "its feet. Where the line turns too fast, it is rounded; the report says where and by how much. For "
        "a line longer than the clip, see `mocap walk --bend`.",
        epilog="Example: mocap bend walk.bvh --along line.csv -o bent.bvh",
    )
    add = bend.add_argument
    add("source", type=Path, metavar="IN", help="an .amc or .bvh file of a walk")
    line = "the line: .csv with points x, z in metres, or an .svg picture"
    add("--along", type=Path, required=True, metavar="LINE", help=line)
    add("-o", "--out", type=Path, required=True, metavar="OUT", help="the new .bvh, .glb or .amc file")
    fastest = (
        "the fastest that the walk is turned, degrees per second; faster only where it turns by itself "
        "(default: %(default)g)"
    )
    add("--limit", type=TURN, default=60.0, metavar="DEGREES", help=fastest)
    add("--unit", type=LENGTH, help="metres per unit of length in the line (default: 1; for .svg 0.01)")
    add("--widen", action="store_true", help="for .amc, write an .asf whose bones turn about three axes")
    add_reading(bend)
    bend.set_defaults(run=_bend)


def _bend(options: argparse.Namespace) -> int:
    require_amc(options.source, options.skeleton)
    if options.out.suffix.lower() not in FORMATS:
        raise MocapError(f"A bent walk is written as {', '.join(FORMATS)}, got '{options.out}'.")
    if options.out.resolve() == options.source.resolve():
        raise MocapError(f"{options.out} is the walk to bend itself: choose another name.")
    require_writable(options.out)
    line = files.load_path(options.along, scale=options.unit)
    motion = files.load(options.source, skeleton=options.skeleton, fps=options.fps, scale=options.scale)
    quality.warn_of_size([motion])
    bent = editing.bend(motion, line, limit=math.radians(options.limit))
    files.save(bent.motion, options.out, widen=options.widen)
    print(f"{'bent':<10} {bent.report()}")
    print(f"{'wrote':<10} {options.out}")
    return 0
