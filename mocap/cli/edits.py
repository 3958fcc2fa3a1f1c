"""The commands that change one clip: `mocap warp`, by a small text file, and `mocap bend`, along a line."""

import math
from pathlib import Path
from typing import Annotated

from mocap import body, editing, feet, files
from mocap.cli.options import TURN, Reading, Unit, Widen, check_out, number, tell, write_out
from mocap.errors import MocapError

FORMATS = (".bvh", ".glb", ".amc")


def warp(
    source: Path,
    *,
    keys: Path,
    out: Path,
    window: Annotated[float, number(0.01, 60)] = 0.5,
    loose_feet: bool = False,
    widen: Widen = False,
    reading: Reading,
) -> None:
    """Change a few poses and moments of a clip; all its frames follow.

    Move joints at a few moments of a clip, or let its moments happen at other times. Smooth curves carry the
    change to the frames between, and planted feet are put back to where they stood.

    Parameters
    ----------
    source (IN) : an .amc or .bvh file.
    keys (FILE) : a text file of keys, described below.
    out (OUT) : the new .bvh, .glb or .amc file.
    window : seconds, see below.
    loose_feet : let feet slide; needed for bodies without legs.

    Notes
    -----
    keys, one in each line of FILE; what follows a # is left out:
      at 1.5s lhand 0.10 0.25 0   second 1.5: the joint is moved, metres to the body's left, up and ahead
      at 180 lhand 0.10 0.25 0    the same at frame 180; more joints may be moved at one moment
      at 1s same                  from there on, or up to there, the pose is as it was
      at 1s level                 the same, and the change stands still there: at take-off and landing
      at 2s lhand 0 0.5 0 level   a pose may be level, too
      time 2.5 2                  the clip's second 2 is shown at second 2.5; two such lines or more

    `mocap info IN --joints` lists the names of the joints. Where FILE does not say it, the motion is as it
    was --window seconds before the first pose and after the last one.

    Example: mocap warp walk.bvh --keys keys.txt -o warped.bvh
    """
    check_out("warped clip", out, FORMATS, [source])
    plan, motion = editing.load_plan(keys), reading.load(source)
    if not loose_feet:
        try:
            body.find_legs(motion.skeleton)
        except MocapError as error:
            raise MocapError(f"{str(error).partition(':')[0]}: give --loose-feet.") from None
        motion = feet.mark_plants(motion)
    warped = editing.warp(motion, plan, window=window, feet=not loose_feet)
    tell(keys=f"{len(plan.wishes)} of poses, {len(plan.times)} of time")
    write_out(warped, out, widen=widen, about=f": {len(warped)} frames, {warped.duration:.2f} s")


def bend(
    source: Path,
    *,
    along: Path,
    out: Path,
    limit: Annotated[float, TURN] = 60.0,
    unit: Unit = None,
    widen: Widen = False,
    reading: Reading,
) -> None:
    """Lay a walk on a line.

    Lay the walk of a clip on a line drawn on the ground, as far as it goes, and clean up its feet. Where the
    line turns too fast, it is rounded; the report says where and by how much. For a line longer than the
    clip, see `mocap walk --bend`.

    Parameters
    ----------
    source (IN) : an .amc or .bvh file of a walk.
    along (LINE) : the line: .csv with points x, z in metres, or an .svg picture.
    out (OUT) : the new .bvh, .glb or .amc file.
    limit (DEGREES) : the fastest that the walk is turned, degrees per second; faster only where it turns by
        itself.

    Notes
    -----
    Example: mocap bend walk.bvh --along line.csv -o bent.bvh
    """
    check_out("bent walk", out, FORMATS, [source])
    line = files.load_path(along, scale=unit)
    bent = editing.bend(reading.load(source), line, limit=math.radians(limit))
    tell(bent=bent.report())
    write_out(bent.motion, out, widen=widen)
