"""The command `mocap loop`: the best cycle in a clip, closed."""

import argparse
import math
import warnings
from pathlib import Path
from typing import TYPE_CHECKING

from mocap import editing, files, quality
from mocap._shared.atomic import require_writable
from mocap.cli.options import add_reading, number, require_amc, require_other, whole
from mocap.errors import MocapWarning

if TYPE_CHECKING:
    from mocap.cli.options import Commands

LASTS = number(0.2, 600)  # no shorter than the seam
POOR = 0.06  # metres RMS; the cycles of eight walks had seams of 0.5 to 3 cm
LITTLE = 0.15  # metres; cycles of walks miss 1 to 9 cm, a pose held before a run misses 30


def add_loop(commands: "Commands") -> None:
    """Add `mocap loop`."""
    loop = commands.add_parser(
        "loop",
        help="cut the best cycle out of a clip and close it",
        description="Find the stretch of a clip that makes the best cycle: its ends are alike, and it holds "
        "most of what the clip does. Close it, and write it as .bvh, .glb, .amc or .npz. Its last frame is "
        "its first one, farther on over the ground.",
        epilog="Example: mocap loop walk.bvh --straight --clean -o loop.bvh",
    )
    add = loop.add_argument
    add("clip", type=Path, help="an .amc, .bvh or AMASS .npz file")
    add("-o", "--out", type=Path, default=Path("loop.bvh"), help="file to write (default: %(default)s)")
    add_reading(loop)
    add("--shortest", type=LASTS, default=0.4, help="seconds of a cycle at least (default: %(default)g)")
    add("--longest", type=LASTS, default=3.0, help="seconds of a cycle at most (default: %(default)g)")
    add("--straight", action="store_true", help="take out the turn of a round: it goes on straight ahead")
    add("--clean", action="store_true", help="clean up footskate: planted feet stand still")
    add("--inertialize", action="store_true", help="close it by an offset that fades, not by a blend")
    add("--times", type=whole(1, 1000), default=1, help="rounds to write (default: %(default)s)")
    loop.set_defaults(run=_loop)


def _loop(options: argparse.Namespace) -> int:
    require_amc(options.clip, options.skeleton)
    require_other(options.out, [options.clip])
    require_writable(options.out)
    motion = files.load(options.clip, skeleton=options.skeleton, fps=options.fps, scale=options.scale)
    quality.warn_of_size([motion])
    found = editing.find_loop(motion, seconds=(options.shortest, options.longest))
    way = "inertialize" if options.inertialize else "blend"
    if found.seam > POOR:
        seam = f"the ends of the best cycle are {100 * found.seam:.0f} cm apart: it may leap there"
        warnings.warn(f"{options.clip}: {seam}.", MocapWarning, stacklevel=1)
    if found.missed > LITTLE:
        other = f"the clip's other poses are {100 * found.missed:.0f} cm away: it may hold no whole cycle"
        warnings.warn(f"{options.clip}: {other}.", MocapWarning, stacklevel=1)
    cycle = editing.loop(motion, found, way=way, straight=options.straight, clean=options.clean)
    files.save(editing.repeated(cycle, options.times), options.out, widen=True)
    report = quality.inspect(cycle)
    step = math.hypot(*(cycle.root_positions[-1] - cycle.root_positions[0])[[0, 2]])
    print(f"{'cycle':<12} frames {found.first} to {found.last}, {cycle.duration:.2f} s")
    print(f"{'seam':<12} {100 * found.seam:.1f} cm RMS")
    print(f"{'misses':<12} {100 * found.missed:.1f} cm of the clip's other poses, on average")
    side = "left" if report.turn > 0 else "right"
    print(f"{'a round':<12} {step:.2f} m, turns {side} by {abs(math.degrees(report.turn)):.0f}°")
    print(f"{'wrote':<12} {options.out}")
    return 0
