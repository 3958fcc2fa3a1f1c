"""The command `mocap retarget`: clips of any bodies, worn by one."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

from mocap import editing, files
from mocap._shared.atomic import make_folder, require_folder
from mocap.cli.options import LENGTH, Reading, Widen, bar, number, require_other, tell_of_failures
from mocap.errors import MocapError

if TYPE_CHECKING:
    from mocap.body.skeleton import Skeleton
    from mocap.editing.upright_bodies import Stance


def retarget(
    clips: Sequence[Path],
    *,
    to: Path,
    out: Path,
    format: Literal["bvh", "amc", "glb"] = "bvh",
    steps: Annotated[float, number(0.1, 10)] = 1.0,
    to_scale: Annotated[float | None, LENGTH] = None,
    widen: Widen = False,
    reading: Reading,
) -> int:
    """Let one body wear the clips of others.

    Copy clips onto another body, with its feet planted on the floor where the old feet were planted. Clips of
    different people then fit into one motion graph. Joints are found by the names that files use.

    Parameters
    ----------
    clips (IN) : files with clips, or folders of them.
    to (FILE) : whose body: an .asf file whose rest pose stands upright; or better a clip of somebody who
        walks, which also says how high the feet stand.
    out (DIR) : folder for the new files.
    format : format of the new files.
    steps : length of steps, for these legs.
    to_scale : metres per unit of length in FILE, as --scale is for IN.

    Notes
    -----
    Example: mocap retarget clips/ --to hero.bvh -o worn/
    """
    require_folder(out)
    found, failed = files.find_files(clips), []
    targets: dict[Path, Path] = {}
    for source in found:
        target = out / f"{source.stem}.{format}"
        require_other(target, [*found, to])
        if (first := targets.setdefault(target, source)) != source:
            raise MocapError(f"{first} and {source} would both become {target}: retarget them one by one.")
    body = _body(to, to_scale)
    for target, source in bar("retargeting")(list(targets.items())):
        try:
            motion = reading.load(source)
            stands = editing.stance_of(motion)
            onto = body if isinstance(body, editing.Stance) else editing.standing_like(body, stands)
            worn = editing.retarget(motion, onto, stands, scale=steps * onto.leg / stands.leg)
            make_folder(out)
            files.save(worn, target, widen=widen)
        except MocapError as error:
            named = any(str(path) in str(error) for path in (source, target))
            failed.append(str(error) if named else f"{source}: {error}")
    return tell_of_failures("retargeted", len(targets), failed, f", in {out}")


def _body(path: Path, scale: float | None) -> "Skeleton | Stance":
    """Read whose body it is: how a clip's body stands, or a skeleton alone."""
    if path.suffix.lower() == ".asf":
        if scale:
            raise MocapError(f"--to-scale is for clips; {path} says its unit of length itself.")
        return files.load_skeleton(path)
    clip = Reading(scale=scale).load(path)
    try:
        return editing.stance_of(clip)
    except MocapError as error:
        try:  # nobody stands in it, but its rest pose alone may do
            return editing.stance_of_zero(clip.skeleton, 0.0).skeleton
        except MocapError:
            raise MocapError(f"{path}: {error}") from None
