"""The command `mocap blend`: clips of one kind blended as wholes, or one that passes into another."""

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from mocap import blending, feet, files, quality
from mocap._shared.atomic import require_writable
from mocap.cli.options import add_reading, bar, number, require_amc
from mocap.errors import MocapError

if TYPE_CHECKING:
    from mocap.blending.registering import Registration
    from mocap.body.motion import Motion
    from mocap.cli.options import Commands

SLACK = 1.2  # seconds, at most half of the shortest clip


def add_blend(commands: "Commands") -> None:
    """Add `mocap blend`."""
    blend = commands.add_parser(
        "blend",
        help="blend clips of one kind as wholes, by weights, or pass from one into another",
        description="Blend two clips of one kind or more: which of their frames belong together is found "
        "first, so walks of different speed or direction stay in step. With --fade, pass from the first clip "
        "into the second.",
        epilog="Example: mocap blend slow.bvh brisk.bvh --weights 0.3 0.7 -o walk.bvh",
    )
    add = blend.add_argument
    add("clips", nargs="+", type=Path, metavar="CLIP", help="an .amc, .bvh or AMASS .npz file")
    how = blend.add_mutually_exclusive_group()
    share = number(-1, 2)
    how.add_argument(
        "--weights", nargs="+", type=share, help="one for each clip, with the sum 1 (default: all alike)"
    )
    how.add_argument(
        "--fade", type=number(0.01, 1000), metavar="SECONDS", help="pass from the first into the second clip"
    )
    add("--at", type=number(0, 1e6), metavar="SECONDS", help="middle of the fade, in the first clip's time")
    slack = "seconds that one clip may start or end before the others (default: 1.2, or half of the shortest)"
    add("--slack", type=number(0, 1e4), help=slack)
    add("--clean", action="store_true", help="find footplants and clean up footskate")
    add("-o", "--out", type=Path, default=Path("blend.bvh"), help="file to write (default: %(default)s)")
    add_reading(blend)
    blend.set_defaults(run=_blend)


def _blend(options: argparse.Namespace) -> int:
    _check(options)
    registration = _registered(options)
    worst = 100 * max(registration.costs)
    first, last = registration.span
    print(
        f"{'registered':<12} {len(registration.clips)} clips, {last - first:.2f} s in common, {worst:.1f} cm"
    )
    blended = _blended(registration, options)
    if options.clean:
        blended = feet.clean_up(blended)
    files.save(blended, options.out)
    print(f"{'blended':<12} {blended.duration:.2f} s")
    print(f"{'wrote':<12} {options.out}")
    return 0


def _check(options: argparse.Namespace) -> None:
    """Raise, before any work is done, for options that would have no effect or fail late."""
    count = len(options.clips)
    if options.out.suffix.lower() not in (".bvh", ".amc", ".glb", ".npz"):
        raise MocapError(f"A blend is written as .bvh, .amc, .glb or .npz, got '{options.out}'.")
    require_writable(options.out)
    if options.out.resolve() in [clip.resolve() for clip in options.clips]:
        raise MocapError(f"{options.out} is one of the clips to blend.")
    if count < 2:
        raise MocapError("A blend needs two clips or more.")
    if options.weights and len(options.weights) != count:
        raise MocapError(f"{count} clips need {count} weights, got {len(options.weights)}.")
    if options.fade and count != 2:
        raise MocapError(f"--fade passes from one clip into another, got {count} clips.")
    if options.at is not None and not options.fade:
        raise MocapError("--at belongs to --fade.")
    for clip in options.clips:
        require_amc(clip, options.skeleton)


def _registered(options: argparse.Namespace) -> "Registration":
    clips = []
    for path in bar("reading")(options.clips):
        clip = files.load(path, skeleton=options.skeleton, fps=options.fps, scale=options.scale)
        clips.append(feet.mark_plants(clip) if options.clean else clip)
    quality.warn_of_size(clips)
    slack = min(SLACK, min(clip.duration for clip in clips) / 2) if options.slack is None else options.slack
    registration: Registration = blending.register(clips, slack=slack)
    return registration


def _blended(registration: "Registration", options: argparse.Namespace) -> "Motion":
    count = len(registration.clips)
    made: Motion
    if options.fade:
        made = blending.crossfade(registration, seconds=options.fade, at=options.at)
    else:
        made = blending.mix(registration, options.weights or [1 / count] * count)
    return made
