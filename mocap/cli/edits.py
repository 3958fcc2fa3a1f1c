"""The commands that make clips of clips: `mocap warp`, `bend`, `loop`, `blend` and `retarget`."""

import math
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

from mocap import blending, body, editing, feet, quality
from mocap._shared.atomic import require_folder
from mocap.cli import options
from mocap.cli.options import TURN, Clean, Reading, Unit, bar, check_out, number, tell, write_out
from mocap.errors import MocapError, Remedy, warn
from mocap.files.conversion import convert, find_files, require_apart

if TYPE_CHECKING:
    from mocap.editing.stances import Stance

LASTS = number(0.2, 600)  # seconds; no shorter than the seam
POOR = 0.06  # metres RMS; the cycles of eight walks had seams of 0.5 to 3 cm
LITTLE = 0.15  # metres; cycles of walks miss 1 to 9 cm, a pose held before a run misses 30


def warp(
    source: Path,
    *,
    keys: Path,
    out: Path,
    window: Annotated[float, number(0.01, 60)] = 0.5,
    loose_feet: bool = False,
    reading: Reading,
) -> None:
    """Change a few poses and moments of a clip; all its frames follow.

    Move joints at a few moments of a clip, or let its moments happen at other times. Smooth curves carry the
    change to the frames between, and planted feet are put back to where they stood.

    Parameters
    ----------
    source (IN) : an .amc or .bvh file.
    keys (FILE) : a text file of keys, described below.
    out (OUT) : the new .bvh or .glb file.
    window : seconds, see below.
    loose_feet : let feet slide; needed for bodies without legs.

    Notes
    -----
    keys, one in each line of FILE; what follows a # is left out:
      at 1.5s lhand 0.10 0.25 0   second 1.5: the joint is moved, in metres to
                                  the body's left, up and ahead
      at 180 lhand 0.10 0.25 0    the same at frame 180; more joints may be
                                  moved at one moment
      at 1s same                  from there on, or up to there, the pose is as
                                  it was
      at 1s level                 the same, and the change stands still there:
                                  at take-off and landing
      at 2s lhand 0 0.5 0 level   a pose may be level, too
      time 2.5 2                  the clip's second 2 is shown at second 2.5;
                                  two such lines or more

    `mocap info IN --joints` lists the names of the joints. Where FILE does not say it, the motion is as it
    was --window seconds before the first pose and after the last one.

    Example: mocap warp walk.bvh --keys keys.txt -o warped.bvh
    """
    check_out("warped clip", out, [source])
    from mocap.editing import warp_plans  # the help needs no NumPy

    motion = reading.load(source)
    plan = warp_plans.load_plan(keys, motion)
    if not loose_feet:
        try:
            body.find_legs(motion.skeleton)
        except MocapError as error:
            raise MocapError(
                error.problem(), remedy=Remedy("give {}, or name them by --joints", "loose_feet")
            ) from None
        motion = feet.mark_plants(motion)
    warped = warp_plans.warp(motion, plan, window=window, feet=not loose_feet)
    poses = sum(map(len, plan.wishes.values()))
    tell(keys=f"{poses} of poses, {len(plan.times)} of time")
    write_out(warped, out, details=f": {len(warped)} frames, {warped.duration:.2f} s")


def bend(
    source: Path,
    *,
    along: Path,
    out: Path,
    limit: Annotated[float, TURN] = 100.0,
    unit: Unit = None,
    reading: Reading,
) -> None:
    """Lay a walk on a line.

    Lay the walk of a clip on a line drawn on the ground, as far as it goes: it slows down and leans in where
    the line bends, and its feet are cleaned up. Where the line turns too fast, it is rounded; the report says
    where and by how much. For a line longer than the clip, see `mocap walk --bend`.

    Parameters
    ----------
    source (IN) : an .amc or .bvh file of a walk.
    along (LINE) : the line: .csv with points x, z in metres, or an .svg picture.
    out (OUT) : the new .bvh or .glb file.
    limit (DEGREES) : the fastest that the walk is turned, degrees per second; faster only where it turns by
        itself.

    Notes
    -----
    Example: mocap bend walk.bvh --along line.csv -o bent.bvh
    """
    check_out("bent walk", out, [source])
    from mocap.files.path_files import load_path  # the help needs no NumPy

    line = load_path(along, scale=unit)
    bent = editing.bend(reading.load(source), line, limit=math.radians(limit))
    tell(bent=bent.report())
    write_out(bent.motion, out)


def loop(
    clip: Path,
    *,
    out: Path = Path("loop.bvh"),
    reading: Reading,
    shortest: Annotated[float, LASTS] = 0.4,
    longest: Annotated[float, LASTS] = 3.0,
    straight: bool = False,
    clean: Clean = False,
    times: Annotated[int, number(1, 1000, int)] = 1,
) -> None:
    """Cut the best cycle out of a clip and close it.

    Find the stretch of a clip that makes the best cycle: its ends are alike, and it holds most of what the
    clip does. Close it, and write it as .bvh or .glb. Its last frame is its first one, farther on
    over the ground.

    Parameters
    ----------
    clip : a motion file.
    out : file to write.
    shortest : seconds of a cycle at least.
    longest : seconds of a cycle at most.
    straight : take out the turn of a round: it goes on straight ahead.
    times : rounds to write.

    Notes
    -----
    Example: mocap loop walk.bvh --straight --clean -o loop.bvh
    """
    check_out("cycle", out, [clip])
    if shortest > longest:
        raise MocapError(f"--shortest {shortest:g} is longer than --longest {longest:g}.")
    from mocap.editing.cycles import find_loop, repeated  # the help needs no NumPy

    motion = reading.load(clip)
    best = find_loop(motion, seconds=(shortest, longest))
    seam, missed = (f"{100 * metres:.0f} cm" for metres in (best.seam, best.missed))
    if best.seam > POOR:
        warn(f"{clip}: the ends of the best cycle are {seam} apart: it may leap there.")
    if best.missed > LITTLE:
        warn(f"{clip}: the clip's other poses are {missed} away: it may hold no whole cycle.")
    cycle = editing.loop(motion, best, straight=straight, clean=clean)
    turn = quality.inspect(cycle).turn
    step = math.hypot(*(cycle.root_positions[-1] - cycle.root_positions[0])[[0, 2]])
    side = "left" if turn > 0 else "right"
    tell(cycle=f"frames {best.first} to {best.last}, {cycle.duration:.2f} s")
    tell(seam=f"{100 * best.seam:.1f} cm RMS")
    tell(misses=f"{100 * best.missed:.1f} cm of the clip's other poses, on average")
    tell(**{"a round": f"{step:.2f} m, turns {side} by {abs(math.degrees(turn)):.0f}°"})
    write_out(repeated(cycle, times), out)


def _share(text: str) -> float:
    """Read the share of a clip in a blend.

    Examples
    --------
    >>> _share("0.5")
    0.5
    """
    try:
        return number(-1, 2)(text)
    except MocapError as error:
        raise MocapError(f"{error}: give shares such as 0.5 0.5") from None


def blend(
    clips: Sequence[Path],
    *,
    weights: Annotated[Sequence[float], _share] = (),
    fade: Annotated[float | None, number(0.01, 1000)] = None,
    slack: Annotated[float, number(0, 1e4)] = 1.2,
    clean: bool = False,
    out: Path = Path("blend.bvh"),
    reading: Reading,
) -> None:
    """Blend clips of one kind as wholes, by weights, or pass from one into another.

    Blend two clips of one kind or more: which of their frames belong together is found first, so walks of
    different speed or direction stay in step. With --fade, pass from the first clip into the second.

    Parameters
    ----------
    clips (CLIP) : a motion file.
    weights : one for each clip, with the sum 1 (default: all alike).
    fade (SECONDS) : pass from the first into the second clip, in the middle of what they have in common.
    slack : seconds that one clip may start or end before the others, at most half of the shortest.
    clean : find footplants and clean up footskate.
    out : file to write.

    Notes
    -----
    Example: mocap blend slow.bvh brisk.bvh --weights 0.3 0.7 -o walk.bvh
    """
    check_out("blend", out, clips)
    if len(clips) < 2:
        raise MocapError("Give two clips or more: a blend is made of several.")
    if weights and len(weights) != len(clips):
        raise MocapError(f"{len(clips)} clips need {len(clips)} weights, got {len(weights)}.")
    if fade and (weights or len(clips) != 2):
        raise MocapError(f"--fade passes from one clip into another, got {len(clips)} clips.")
    motions = [reading.load(path) for path in bar("reading")(clips)]
    if clean:
        motions = [feet.mark_plants(motion) for motion in motions]
    registration = blending.register(motions, slack=slack)
    first, last = registration.span
    worst = 100 * max(registration.costs)
    tell(registered=f"{len(motions)} clips, {last - first:.2f} s in common, {worst:.1f} cm")
    weights = weights or [1 / len(clips)] * len(clips)
    mixed = blending.crossfade(registration, seconds=fade) if fade else blending.mix(registration, weights)
    tell(blended=f"{mixed.duration:.2f} s")
    write_out(feet.clean_up(mixed) if clean else mixed, out)


def retarget(
    clips: Sequence[Path],
    *,
    to: Path,
    out: Path,
    format: Literal["bvh", "glb"] = "bvh",
    to_scale: Annotated[float | None, options.LENGTH] = None,
    reading: Reading,
) -> int:
    """Let one body wear the clips of others.

    Copy clips onto another body, with its feet planted on the floor where the old feet were planted. Clips of
    different people then fit into one motion graph. Joints are found by their names, or by how
    they move.

    Parameters
    ----------
    clips (IN) : files with clips, or folders of them.
    to (FILE) : whose body: an .asf file whose rest pose stands upright; or better a clip of somebody who
        walks, which also says how high the feet stand.
    out (DIR) : folder for the new files.
    format : format of the new files.
    to_scale : metres per unit of length in FILE, as --scale is for IN.

    Notes
    -----
    Example: mocap retarget clips/ --to hero.bvh -o worn/
    """
    if out.suffix.lower() in (".bvh", ".glb", ".amc", ".npz") and not out.is_dir():
        raise MocapError(f"-o takes the folder for the new files, got '{out}', which names a file.")
    require_folder(out)
    pairs = [(source, out / f"{source.stem}.{format}") for source in find_files(clips)]
    require_apart(pairs, [to])
    wear = partial(_worn, reading, _body(to, to_scale, reading.joints))
    failed = convert(pairs, wear, progress=bar("retargeting"))
    return options.tell_of_failures("retargeted", len(pairs), failed, f", in {out}")


def _worn(reading: Reading, wearer: "Stance | body.Skeleton", source: Path) -> "body.Motion":
    from mocap.editing.retargeting import wear  # the help needs no NumPy

    return wear(reading.load(source), wearer)


def _body(path: Path, scale: float | None, joints: Sequence[Path]) -> "Stance | body.Skeleton":
    """Read whose body it is, and, of a clip in which somebody stands, how it stands."""
    from mocap.editing.stances import stance_of_zero
    from mocap.files.asf import read_skeleton

    if path.suffix.lower() == ".asf":
        if scale:
            raise MocapError(f"--to-scale is for clips; {path} says its unit of length itself.")
        return read_skeleton(path).skeleton
    clip = Reading(scale=scale, joints=joints).load(path)
    try:
        return editing.stance_of(clip)
    except MocapError as error:
        try:  # nobody stands in it, but its rest pose alone may do
            return stance_of_zero(clip.skeleton, 0.0).skeleton
        except MocapError:
            raise MocapError(f"{path}: {error}") from None
