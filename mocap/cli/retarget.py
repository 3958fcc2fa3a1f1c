"""The command `mocap retarget`: clips of any bodies, worn by one."""

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from mocap import editing, files, quality
from mocap._shared.atomic import make_folder, require_folder
from mocap.cli.options import LENGTH, add_reading, as_options, bar, number, require_amc
from mocap.errors import MocapError

if TYPE_CHECKING:
    from mocap.body.skeleton import Skeleton
    from mocap.cli.options import Commands
    from mocap.editing.upright_bodies import Stance

FORMATS = ("bvh", "amc", "glb")


def add_retarget(commands: "Commands") -> None:
    """Add `mocap retarget`."""
    retarget = commands.add_parser(
        "retarget",
        help="let one body wear the clips of others",
        description="Copy clips onto another body, with its feet planted on the floor where the old feet "
        "were planted. Clips of different people then fit into one motion graph. Joints are found by the "
        "names that files use.",
        epilog="Example: mocap retarget clips/ --to hero.bvh -o worn/",
    )
    add = retarget.add_argument
    add("clips", nargs="+", type=Path, metavar="IN", help="files with clips, or folders of them")
    add(
        "--to",
        type=Path,
        required=True,
        metavar="FILE",
        help="whose body: an .asf file whose rest pose stands upright; or better a clip of somebody who "
        "walks, which also says how high the feet stand",
    )
    add("-o", "--out", type=Path, required=True, metavar="DIR", help="folder for the new files")
    add("--format", choices=FORMATS, default="bvh", help="format of the new files (default: %(default)s)")
    add("--steps", type=number(0.1, 10), default=1.0, help="length of steps, for these legs (default: 1)")
    add("--to-scale", type=LENGTH, help="metres per unit of length in FILE, as --scale is for IN")
    add("--widen", action="store_true", help="for .amc, write an .asf whose bones turn about three axes")
    add_reading(retarget)
    retarget.set_defaults(run=_retarget)


def _retarget(options: argparse.Namespace) -> int:
    """Retarget, and return 2 if any file failed."""
    require_folder(options.out)
    pairs = _pairs(options)
    body = _body(options)
    failed = []
    for source, target in bar("retargeting")(pairs):
        try:
            _wear(source, target, body, options)
        except MocapError as error:
            named = any(str(path) in str(error) for path in (source, target))
            failed.append(str(error) if named else f"{source}: {error}")
    print(f"{'retargeted':<10} {len(pairs) - len(failed)} of {len(pairs)}, in {options.out}")
    for problem in failed:
        print(f"{'failed':<10} {as_options(problem)}")
    return 2 if failed else 0


def _pairs(options: argparse.Namespace) -> list[tuple[Path, Path]]:
    """Pair each clip with the file to write; no two may become one, and none may replace what is read."""
    found = files.find_files(options.clips)
    read = {path.resolve() for path in (*found, options.to)}
    taken: dict[Path, Path] = {}
    for source in found:
        target = options.out / f"{source.stem}.{options.format}"
        if target.resolve() in read:
            raise MocapError(f"{target} is one of the files to read: choose another folder.")
        if (first := taken.setdefault(target, source)) != source:
            raise MocapError(f"{first} and {source} would both become {target}: retarget them one by one.")
    return [(source, target) for target, source in taken.items()]


def _body(options: argparse.Namespace) -> "Skeleton | Stance":
    """Read whose body it is: how a clip's body stands, or a skeleton alone."""
    if options.to.suffix.lower() == ".asf":
        if options.to_scale:
            raise MocapError(f"--to-scale is for clips; {options.to} says its unit of length itself.")
        body: Skeleton | Stance = files.load_skeleton(options.to)
        return body
    clip = files.load(options.to, scale=options.to_scale)
    quality.warn_of_size([clip])
    try:
        body = editing.stance_of(clip)
    except MocapError as error:
        try:  # nobody stands in it, but its rest pose alone may do
            body = editing.stance_of_zero(clip.skeleton, 0.0).skeleton
        except MocapError:
            raise MocapError(f"{options.to}: {error}") from None
    return body


def _wear(source: Path, target: Path, body: "Skeleton | Stance", options: argparse.Namespace) -> None:
    """Retarget one clip, and write it."""
    require_amc(source, options.skeleton)
    motion = files.load(source, skeleton=options.skeleton, fps=options.fps, scale=options.scale)
    stands = editing.stance_of(motion)
    onto = body if isinstance(body, editing.Stance) else editing.standing_like(body, stands)
    worn = editing.retarget(motion, onto, stands, scale=options.steps * onto.leg / stands.leg)
    make_folder(options.out)
    files.save(worn, target, widen=options.widen)
