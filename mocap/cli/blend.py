"""The command `mocap blend`: clips of one kind blended as wholes, or one that passes into another."""

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

from mocap import blending, feet
from mocap.cli.options import Reading, bar, check_out, number, tell, write_out
from mocap.errors import MocapError

SLACK = 1.2  # seconds, at most half of the shortest clip


def blend(
    clips: Sequence[Path],
    *,
    weights: Annotated[Sequence[float], number(-1, 2)] = (),
    fade: Annotated[float | None, number(0.01, 1000)] = None,
    at: Annotated[float | None, number(0, 1e6)] = None,
    slack: Annotated[float | None, number(0, 1e4)] = None,
    clean: bool = False,
    out: Path = Path("blend.bvh"),
    reading: Reading,
) -> None:
    """Blend clips of one kind as wholes, by weights, or pass from one into another.

    Blend two clips of one kind or more: which of their frames belong together is found first, so walks of
    different speed or direction stay in step. With --fade, pass from the first clip into the second.

    Parameters
    ----------
    clips (CLIP) : an .amc, .bvh or AMASS .npz file.
    weights : one for each clip, with the sum 1 (default: all alike).
    fade (SECONDS) : pass from the first into the second clip.
    at (SECONDS) : middle of the fade, in the first clip's time.
    slack : seconds that one clip may start or end before the others (default: 1.2, or half of the shortest).
    clean : find footplants and clean up footskate.
    out : file to write.

    Notes
    -----
    Example: mocap blend slow.bvh brisk.bvh --weights 0.3 0.7 -o walk.bvh
    """
    check_out("blend", out, (".bvh", ".amc", ".glb", ".npz"), clips)
    if len(clips) < 2:
        raise MocapError("A blend needs two clips or more.")
    if weights and len(weights) != len(clips):
        raise MocapError(f"{len(clips)} clips need {len(clips)} weights, got {len(weights)}.")
    if fade and (weights or len(clips) != 2):
        raise MocapError(f"--fade passes from one clip into another, got {len(clips)} clips.")
    if at is not None and not fade:
        raise MocapError("--at belongs to --fade.")
    motions = [reading.load(path) for path in bar("reading")(clips)]
    if clean:
        motions = [feet.mark_plants(motion) for motion in motions]
    if slack is None:
        slack = min(SLACK, min(motion.duration for motion in motions) / 2)
    registration = blending.register(motions, slack=slack)
    first, last = registration.span
    worst = 100 * max(registration.costs)
    tell(registered=f"{len(motions)} clips, {last - first:.2f} s in common, {worst:.1f} cm")
    if fade:
        blended = blending.crossfade(registration, seconds=fade, at=at)
    else:
        blended = blending.mix(registration, weights or [1 / len(clips)] * len(clips))
    tell(blended=f"{blended.duration:.2f} s")
    write_out(feet.clean_up(blended) if clean else blended, out)
