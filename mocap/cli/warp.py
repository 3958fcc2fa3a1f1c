"""The command `mocap warp`: a few poses and moments of a clip changed, and all its frames follow."""

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from mocap import body, editing, feet, files
from mocap._shared.atomic import require_writable
from mocap.cli.options import add_reading, number, require_amc
from mocap.errors import MocapError

if TYPE_CHECKING:
    from mocap.body.motion import Motion
    from mocap.cli.options import Commands

FORMATS = (".bvh", ".glb", ".amc")
WHAT = """\
Move joints at a few moments of a clip, or let its moments happen at other times. Smooth curves carry
the change to the frames between, and planted feet are put back to where they stood.
"""
KEYS = """\
keys, one in each line of FILE; what follows a # is left out:
  at 1.5s lhand 0.10 0.25 0   second 1.5: the joint is moved, metres to the body's left, up and ahead
  at 180 lhand 0.10 0.25 0    the same at frame 180; more joints may be moved at one moment
  at 1s same                  from there on, or up to there, the pose is as it was
  at 1s level                 the same, and the change stands still there: at take-off and landing
  at 2s lhand 0 0.5 0 level   a pose may be level, too
  time 2.5 2                  the clip's second 2 is shown at second 2.5; two such lines or more
`mocap info IN --joints` lists the names of the joints.
Where FILE does not say it, the motion is as it was --window seconds before the first pose and after
the last one.

Example: mocap warp walk.bvh --keys keys.txt -o warped.bvh
"""


def add_warp(commands: "Commands") -> None:
    """Add `mocap warp`."""
    warp = commands.add_parser(
        "warp",
        help="change a few poses and moments of a clip; all its frames follow",
        description=WHAT,
        epilog=KEYS,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    add = warp.add_argument
    add("source", type=Path, metavar="IN", help="an .amc or .bvh file")
    add("--keys", type=Path, required=True, metavar="FILE", help="a text file of keys, described below")
    add("-o", "--out", type=Path, required=True, metavar="OUT", help="the new .bvh, .glb or .amc file")
    add("--window", type=number(0.01, 60), default=0.5, help="seconds, see below (default: %(default)s)")
    add("--loose-feet", action="store_true", help="let feet slide; needed for bodies without legs")
    add("--widen", action="store_true", help="for .amc, write an .asf whose bones turn about three axes")
    add_reading(warp)
    warp.set_defaults(run=_warp)


def _warp(options: argparse.Namespace) -> int:
    require_amc(options.source, options.skeleton)
    if options.out.suffix.lower() not in FORMATS:
        raise MocapError(f"A warped clip is written as {', '.join(FORMATS)}, got '{options.out}'.")
    if options.out.resolve() == options.source.resolve():
        raise MocapError(f"{options.out} is the clip to warp itself: choose another name.")
    require_writable(options.out)
    plan = editing.load_plan(options.keys)
    motion = files.load(options.source, skeleton=options.skeleton, fps=options.fps, scale=options.scale)
    if not options.loose_feet:
        motion = _with_plants(motion)
    warped = editing.warp(motion, plan, window=options.window, feet=not options.loose_feet)
    files.save(warped, options.out, widen=options.widen)
    print(f"{'keys':<10} {len(plan.wishes)} of poses, {len(plan.times)} of time")
    print(f"{'wrote':<10} {options.out}: {len(warped)} frames, {warped.duration:.2f} s")
    return 0


def _with_plants(motion: "Motion") -> "Motion":
    """Mark when the feet stand, or say what to do with a body that has none."""
    try:
        body.find_legs(motion.skeleton)
    except MocapError as error:
        raise MocapError(f"{str(error).partition(':')[0]}: give --loose-feet.") from None
    planted: Motion = feet.mark_plants(motion)
    return planted
