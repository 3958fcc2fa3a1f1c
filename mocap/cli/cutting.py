"""The command that cuts clips and prepares them for other programs: `mocap cut`."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from mocap import body, editing, files
from mocap.cli.option_types import RATE, PlainNames, frame_at, moment, number
from mocap.cli.options import ReadingAtRate
from mocap.cli.outputs import check_out, print_rows, warn_of_lost_roles
from mocap.cli.stages import timed_stage
from mocap.cli.tuned import TUNED
from mocap.errors import MocapError, printable, shortened, warn
from mocap.files.conversion import find_files

if TYPE_CHECKING:
    from mocap.body.motion import Motion


@dataclass(frozen=True)
class Cutting:
    """The changes that `mocap cut` makes to each clip, in the order in which it makes them."""

    from_: Annotated[
        str | None, moment, "the first frame to keep, as in 90, or its time, as in 1.5s (default: the first)"
    ] = None
    to: Annotated[
        str | None, moment, "the first frame to leave out, or its time (default: keep all to the end)"
    ] = None
    rate: Annotated[
        float | None, RATE, "resample to this many frames per second. The motion keeps its speed"
    ] = None
    mirror: Annotated[bool, "swap left and right"] = False
    in_place: Annotated[
        bool,
        "remove the travel over the ground, the straight line from the first frame to the last. Sway about "
        "the line and the heading remain",
    ] = False
    times: Annotated[
        int,
        number(1, 1000, int),
        "number of copies of a cycle, each of which starts where the last one ended",
    ] = 1
    home: Annotated[bool, "start over the origin with heading 0, towards +z"] = False
    plain_names: PlainNames = False

    def apply(self, clip: "Motion") -> "Motion":
        """Make all changes to a clip."""
        from mocap.editing.mirroring import mirror_above_floor  # the help needs no NumPy

        motion = self._stretch(clip)
        if self.rate:
            motion = body.resample(motion, self.rate)
        if self.mirror:
            motion = mirror_above_floor(motion)
        if self.in_place:
            motion = editing.in_place(motion)
        if self.times > 1:
            _warn_of_leap(motion)
            motion = editing.repeated(motion, self.times)
        if self.home:
            motion = body.place(motion, 0.0, [0.0, 0.0])
        return files.with_plain_names(motion) if self.plain_names else motion

    def _stretch(self, clip: "Motion") -> "Motion":
        """Return the frames from `from_` up to `to`."""
        start = frame_at(self.from_, clip.fps) if self.from_ else 0
        stop = frame_at(self.to, clip.fps) if self.to else len(clip)
        if not 0 <= start < stop <= len(clip):
            last = f"frames 0 to {len(clip) - 1}, {clip.duration:.2f} s"
            raise MocapError(
                f"'{shortened(clip.name, 60)}' has {last}: --from is one of them, and --to a later one, got "
                f"{start} and {stop}."
            )
        return clip[start:stop]


def cut(
    clips: Sequence[Path], *, out: Path, cutting: Cutting, root: bool = False, reading: ReadingAtRate
) -> None:
    """Cut clips, resample, mirror or repeat them, and place them at the origin.

    Keep a part of a clip, and change it in the order of the options below. Several clips of one body are
    written to one .glb file, each as an animation with the name of its file, as engines read them.

    Parameters
    ----------
    clips (CLIP) : motion files, or folders of them.
    out (OUT) : file to write, .bvh, .glb, .npz or .csv. For several clips, and with --root, .glb.
    root : add a joint on the floor below the hips, with their heading, which engines use for root motion.

    Notes
    -----
    Frames are counted from 0, at the rate of the file.

    Example: mocap cut walk.bvh --from 1 -o walk-without-rest-pose.bvh

    Example: mocap cut walk.bvh --from 1.5s --to 4s --rate 30 --home -o short.bvh

    Example: mocap cut loops/ --in-place --home -o hero.glb
    """
    paths = find_files(clips)
    if len(paths) > 1:
        check_out("file of several clips", out, paths, [".glb"])
    elif root:
        check_out("clip with a joint on the floor", out, paths, [".glb"])
    else:
        check_out("clip", out, paths)
    from mocap.files.load_save import save_clips  # the help needs no NumPy

    motions = [cutting.apply(clip) for clip in reading.load_set(paths, clips)]
    with timed_stage("writing"):
        save_clips(motions, out, root=root)
    for motion in motions:
        rows = f"{len(motion)} frames at {motion.fps:g} Hz, {motion.duration:.2f} s"
        print_rows(cut=f"{printable(motion.name)}: {rows}")
    print_rows(wrote=out)
    warn_of_lost_roles(motions[0], out)


def _warn_of_leap(cycle: "Motion") -> None:
    """Warn if the last pose of a cycle differs from its first one: its copies are joined by a leap then."""
    from mocap.body.planar import align_frames  # the help needs no NumPy

    first = align_frames(cycle, cycle, len(cycle) - 1).apply_motion(cycle[:1])
    offsets = first.positions[0] - cycle.positions[-1]
    distance = float((offsets**2).sum(axis=-1).mean() ** 0.5)
    if distance > TUNED.poor_seam:
        poses = (
            f"'{shortened(cycle.name, 60)}': the first and the last pose are {100 * distance:.0f} cm apart"
        )
        warn(f"{poses}: the copies leap there. mocap loop finds a cycle and closes it.")
