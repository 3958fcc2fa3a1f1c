"""The commands that edit clips: `mocap warp`, `bend`, `loop`, `blend` and `retarget`."""

import math
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, ClassVar, Literal

from mocap import blending, body, editing, feet, quality
from mocap._shared.atomic import require_folder
from mocap.cli.clip_sets import Spaces
from mocap.cli.option_types import LENGTH, TURN, Clean, Up, number
from mocap.cli.options import PathReading, Reading
from mocap.cli.outputs import check_out, print_rows, report_failures, write_out
from mocap.cli.stages import bar
from mocap.cli.tuned import TUNED
from mocap.errors import MocapError, Remedy, warn
from mocap.files.conversion import convert, plan, require_apart

if TYPE_CHECKING:
    from mocap.editing.stances import Stance

LASTS = number(0.2, 600)  # seconds, not shorter than the seam


def warp(
    source: Path,
    *,
    keys: Path,
    out: Path,
    window: Annotated[float, number(0.01, 60)] = 0.5,
    loose_feet: bool = False,
    reading: Reading,
) -> None:
    """Edit the poses and the timing of a clip by a few keys.

    Move joints at a few times of a clip, or change the times of its frames. Smooth curves interpolate the
    changes between the keys, and foot sliding is removed between them. Without keys of time, all other frames
    stay exactly as they are.

    Parameters
    ----------
    source (IN) : a motion file.
    keys (FILE) : a text file of keys, described below.
    out (OUT) : file to write, .bvh, .glb, .npz or .csv.
    window : duration of the edit before the first and after the last pose, seconds, see below.
    loose_feet : do not remove foot sliding. Needed for bodies without legs.

    Notes
    -----
    FILE has one key in each line. Text after a # is a comment:
      at 1.5s lhand 0.10 0.25 0   at 1.5 s the joint is moved to the body's left,
                                  up and ahead, in metres
      at 180 lhand 0.10 0.25 0    the same at frame 180. Several joints may be
                                  moved at one time
      at 1s same                  the pose at 1 s is unchanged: an edit begins or
                                  ends here
      at 1s level                 the same, and the rate of the change is zero,
                                  as needed at take-off and landing
      at 2s lhand 0 0.5 0 level   a moved joint may also have a zero rate
      time 2.5 2                  the frame at 2 s of the clip is shown at 2.5 s.
                                  A file has none or at least two of these keys

    `mocap info IN --joints` lists the names of the joints. Without keys of unchanged poses, the edit begins
    --window seconds before the first moved pose, and ends as many seconds after the last one.

    Example: mocap warp walk.bvh --keys keys.txt -o warped.bvh
    """
    check_out("warped clip", out, [source, keys])
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
    poses = sum(map(len, plan.targets.values()))
    print_rows(keys=f"{poses} of poses, {len(plan.times)} of time")
    write_out(warped, out, details=f": {len(warped)} frames, {warped.duration:.2f} s")


def bend(
    source: Path,
    *,
    along: Path,
    out: Path,
    limit: Annotated[float, TURN] = 100.0,
    drawn: PathReading,
    reading: Reading,
) -> None:
    """Bend a walk onto a path.

    Bend the walk of a clip onto a path on the ground, up to the length of the walk. It slows down and leans
    in at bends of the path, and foot sliding is removed. If the path turns too fast, it is rounded, and the
    report has the position and the amount. For a path longer than the clip, see `mocap walk --bend`.

    Parameters
    ----------
    source (IN) : a motion file of a walk.
    along (PATH) : the path, .csv with points x, z in metres, or .svg.
    out (OUT) : file to write, .bvh, .glb, .npz or .csv.
    limit (DEGREES) : the highest angular speed that bending adds to that of the walk, degrees per second.

    Notes
    -----
    Example: mocap bend walk.bvh --along line.csv -o bent.bvh
    """
    check_out("bent walk", out, [source, along])
    line = drawn.load(along)
    bent = editing.bend(reading.load(source), line, limit=math.radians(limit))
    print_rows(bent=bent.report())
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

    Find the part of a clip that is the best cycle: its ends are similar, and it contains most poses of the
    clip. Close the cycle, so that it can be repeated. Its last frame has the pose of the first one, at a new
    position on the ground.

    Parameters
    ----------
    clip : a motion file.
    out : file to write, .bvh, .glb, .npz or .csv.
    shortest : shortest duration of a cycle, seconds.
    longest : longest duration of a cycle, seconds.
    straight : remove the change of heading of a cycle, so that it continues straight ahead.
    times : number of cycles to write.

    Notes
    -----
    Example: mocap loop walk.bvh --straight --clean -o loop.bvh
    """
    check_out("cycle", out, [clip])
    if shortest > longest:
        raise MocapError(f"--shortest {shortest:g} is longer than --longest {longest:g}.")
    from mocap.editing.cycles import find_loop, repeated, seam_jolt  # the help needs no NumPy

    motion = reading.load(clip)
    best = find_loop(motion, seconds=(shortest, longest))
    seam, missed = (f"{100 * metres:.0f} cm" for metres in (best.seam, best.missed))
    if best.seam > TUNED.poor_seam:
        warn(f"{clip}: the ends of the best cycle are {seam} apart: it may leap there.")
    if best.missed > TUNED.missed_cycle:
        warn(f"{clip}: the clip's other poses are {missed} away: it may hold no whole cycle.")
    cycle = editing.loop(motion, best, straight=straight, clean=clean)
    turn = quality.inspect(cycle).heading_change
    step = math.hypot(*(cycle.root_positions[-1] - cycle.root_positions[0])[[0, 2]])
    side = "left" if turn > 0 else "right"
    print_rows(cycle=f"frames {best.first} to {best.last}, {cycle.duration:.2f} s")
    jolt = f"accelerates up to {seam_jolt(motion, cycle):.1f} times the clip's 99th percentile"
    print_rows(seam=f"{100 * best.seam:.1f} cm RMS, {jolt}")
    print_rows(misses=f"{100 * best.missed:.1f} cm of the clip's other poses, on average")
    print_rows(**{"a round": f"{step:.2f} m, turns {side} by {abs(math.degrees(turn)):.0f}°"})
    write_out(repeated(cycle, times), out)


def _weight(text: str) -> float:
    """Parse the weight of a clip in a blend."""
    try:
        return number(-1, 2)(text)
    except MocapError as error:
        raise MocapError(f"{error}: give weights such as 0.5 0.5") from None


def blend(
    clips: Sequence[Path],
    *,
    weights: Annotated[Sequence[float], _weight] = (),
    fade: Annotated[float | None, number(0.01, 1000)] = None,
    slack: Annotated[float, number(0, 1e4)] = 1.2,
    clean: bool = False,
    out: Path = Path("blend.bvh"),
    reading: Reading,
) -> None:
    """Blend whole clips of one kind by weights, or crossfade from one to another.

    Blend two or more clips of one kind. Corresponding frames are registered first, so that walks of different
    speed or direction stay in step. With --fade, crossfade from the first clip to the second.

    Parameters
    ----------
    clips (CLIP) : a motion file.
    weights : a weight for each clip, with the sum 1 (default: equal weights).
    fade (SECONDS) : duration of a crossfade from the first clip to the second, in the middle of their common
        part, seconds.
    slack (SECONDS) : largest difference between the starts, or the ends, of the clips, seconds, at most half
        of the shortest clip.
    clean : detect footplants, and remove foot sliding.
    out : file to write, .bvh, .glb, .npz or .csv.

    Notes
    -----
    Example: mocap blend slow.bvh brisk.bvh --weights 0.3 0.7 -o walk.bvh
    """
    check_out("blend", out, clips)
    from mocap.quality.clip_flaws import warn_of_size  # the help needs no NumPy

    if len(clips) < 2:
        raise MocapError("Give two clips or more: a blend is made of several.")
    if weights and len(weights) != len(clips):
        raise MocapError(f"{len(clips)} clips need {len(clips)} weights, got {len(weights)}.")
    if fade and (weights or len(clips) != 2):
        raise MocapError(f"--fade passes from one clip into another, got {len(clips)} clips.")
    for path in clips:
        reading.require_skeleton_of_use(path)
    motions = reading.load_set(bar("reading")(clips), clips)
    warn_of_size(motions)
    motions = [body.resample(motion, motions[0].fps) for motion in motions]
    if clean:
        motions = [feet.mark_plants(motion) for motion in motions]
    registration = blending.register(motions, slack=slack)
    first, last = registration.span
    worst = 100 * max(registration.costs)
    from mocap.editing.foot_cleaning import clean_feet  # the help needs no NumPy
    from mocap.editing.toes import lowest_heights

    print_rows(registered=f"{len(motions)} clips, {last - first:.2f} s in common, {worst:.1f} cm")
    weights = weights or [1 / len(clips)] * len(clips)
    mixed = blending.crossfade(registration, seconds=fade) if fade else blending.mix(registration, weights)
    print_rows(blended=f"{mixed.duration:.2f} s")
    write_out(clean_feet(mixed, lowest_heights(motions)) if clean else mixed, out)


def retarget(
    clips: Sequence[Path],
    *,
    to: Path,
    out: Path,
    format: Literal["bvh", "glb"] = "bvh",
    to_scale: Annotated[float | None, LENGTH] = None,
    to_up: Up = None,
    reading: Reading,
) -> int:
    """Retarget clips to another body.

    Transfer clips to another body, with its feet planted at the positions of the original footplants. Then
    clips of different people can be used in one motion graph. Joints are identified by common names, or by
    their motion.

    Parameters
    ----------
    clips (IN) : motion files, or folders of them.
    to (FILE) : the body, from a motion file of a person who walks, or of one or two frames in which it
        stands, such as a T-pose. These also define the height of the feet. Or from an .asf file with an
        upright rest pose.
    out (DIR) : folder to write to.
    format : format of the files to write.
    to_scale : metres per unit of length in FILE, as --scale for IN (default: as the frames show).
    to_up : axis of FILE that points up, as --up for IN (default: as the frames show; y, for AMASS z).

    Notes
    -----
    Example: mocap retarget clips/ --to hero.bvh -o worn/
    """
    if out.suffix.lower() in (".bvh", ".glb", ".amc", ".npz") and not out.is_dir():
        raise MocapError(f"-o takes the folder for the new files, got '{out}', which names a file.")
    require_folder(out)
    pairs = []
    for source in clips:
        target = out if source.is_dir() else out / f"{source.stem}.{format}"
        pairs += plan(source, target, f".{format}")
    require_apart(pairs, [to])
    paths = [path for path, _ in pairs]
    said = [reading.scale, reading.up, to_scale, to_up]  # for IN, or for FILE
    is_apart = any(said) or _is_skeleton(to)
    spaces = reading.survey(paths if is_apart else [*paths, to])
    wearer = _body(to, BodyReading(scale=to_scale, up=to_up, joints=reading.joints), spaces)
    failed = convert(pairs, partial(_worn, reading, spaces, wearer, paths), progress=bar("retargeting"))
    return report_failures("retargeted", len(pairs), failed, f", in {out}")


class BodyReading(Reading):
    """The reading of the file to whose body clips are retargeted."""

    named: ClassVar[Mapping[str, str]] = {"scale": "--to-scale", "up": "--to-up"}


def _is_skeleton(path: Path) -> bool:
    """Return whether a file is a skeleton without a motion, which says its unit itself."""
    return path.suffix.lower() == ".asf"


def _worn(
    reading: Reading,
    spaces: Spaces,
    wearer: "Stance | body.Skeleton",
    sources: Sequence[Path],
    source: Path,
) -> "body.Motion":
    """Read a clip and retarget it. Feet that never stand in it are as high as in others of the sources."""
    from mocap.editing.retargeting import wear  # the help needs no NumPy

    clips = _readable(reading, spaces, sources, source)
    return wear(reading.load_body(source, spaces), wearer, clips=clips)


def _readable(
    reading: Reading, spaces: Spaces, sources: Sequence[Path], chosen: Path
) -> "Iterator[body.Motion]":
    """Read the sources other than the chosen one, leaving out those that cannot be read."""
    for source in sources:
        if source != chosen:
            with suppress(MocapError):
                yield reading.load_body(source, spaces)


def _body(path: Path, reading: BodyReading, spaces: Spaces) -> "Stance | body.Skeleton":
    """Read the body to which clips are retargeted, and its stance from a clip or pose in which it stands."""
    from mocap.editing.stances import stance_of_zero
    from mocap.files.asf import read_skeleton

    if _is_skeleton(path):
        for option, value in (("--to-scale", reading.scale), ("--to-up", reading.up)):
            if value:
                raise MocapError(f"{option} is for clips; {path} says its unit and its axes itself.")
        return read_skeleton(path).skeleton
    clip = reading.load_body(path, spaces)
    try:
        return editing.stance_of(clip)
    except MocapError as error:
        try:  # the clip has no stance, but its rest pose may be sufficient
            at_rest = stance_of_zero(clip.skeleton, 0.0).skeleton
        except MocapError:
            raise MocapError(f"{path}: {error}") from None
        warn(f"{path}: {error} The rest pose of its skeleton is taken as the stance.")
        return at_rest
