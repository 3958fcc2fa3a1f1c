"""The commands for clip files: `mocap info`, `mocap convert` and `mocap data`."""

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from mocap import datasets, files, quality
from mocap.cli.options import add_reading, bar, require_amc, whole

if TYPE_CHECKING:
    from mocap.cli.options import Commands


def add_info(commands: "Commands") -> None:
    """Add `mocap info`."""
    info = commands.add_parser(
        "info",
        help="report a clip's length, path and flaws",
        description="Report how long a clip is, how far the body goes and turns, and what is wrong with it.",
    )
    info.add_argument("file", type=Path, help="an .amc, .bvh or .npz file")
    add_reading(info)
    info.set_defaults(run=_info)


def _info(options: argparse.Namespace) -> int:
    require_amc(options.file, options.skeleton)
    motion = files.load(options.file, skeleton=options.skeleton, fps=options.fps, scale=options.scale)
    angles = files.read_angles(options.file, skeleton=options.skeleton)
    print(quality.inspect(motion, angles).table())
    return 0


def add_convert(commands: "Commands") -> None:
    """Add `mocap convert`."""
    convert = commands.add_parser(
        "convert",
        help="convert clips between .amc, .bvh and AMASS .npz, or to .glb; whole folders of them",
        description="Convert a clip, or all clips in a folder and the folders inside it. For one clip, the "
        "suffix of OUT is the format. An .amc gets an .asf of its name. Lengths in a .bvh are centimetres. A "
        ".glb is for engines and viewers, and shows a body of capsules.",
    )
    convert.add_argument("source", type=Path, metavar="IN", help="an .amc, .bvh or .npz file, or a folder")
    convert.add_argument("target", type=Path, metavar="OUT", help="the new file, or folder")
    add_reading(convert)
    convert.add_argument(
        "--to",
        choices=["amc", "bvh", "glb"],
        default="bvh",
        help="format for the clips of a folder (default: %(default)s)",
    )
    convert.add_argument(
        "--widen", action="store_true", help="write an .asf in which all bones turn about three axes"
    )
    convert.set_defaults(run=_convert)


def _convert(options: argparse.Namespace) -> int:
    """Convert, and return 2 if any file failed."""
    pairs = files.plan(options.source, options.target, f".{options.to}")
    reading = files.Options(options.skeleton, options.fps, options.scale, options.widen)
    outcomes = files.convert(pairs, reading, bar("converting"))
    failed = [outcome for outcome in outcomes if outcome.problem]
    print(f"{'converted':<10} {len(outcomes) - len(failed)} of {len(outcomes)}")
    for outcome in failed:
        print(f"{'failed':<10} {outcome.problem}")
    return 2 if failed else 0


def add_data(commands: "Commands") -> None:
    """Add `mocap data list`."""
    data = commands.add_parser("data", help="list clips to download", description="List clips to download.")
    actions = data.add_subparsers(title="actions", required=True, metavar="ACTION")
    listing = actions.add_parser(
        "list",
        help="list the trials of the CMU database that datasets.cmu fetches",
        description="List the trials of the CMU database that datasets.cmu fetches by name.",
    )
    listing.add_argument("--subject", type=whole(1, 999), help="only this person's trials")
    listing.add_argument("--kind", help="only trials with this word in their description")
    listing.set_defaults(run=_list)


def _list(options: argparse.Namespace) -> int:
    trials = datasets.trials(options.subject, options.kind)
    print(f"{'trial':<8} {'frames':>6}  description")
    for trial in trials:
        print(f"{trial.name:<8} {trial.frames:>6}  {trial.description}")
    print(f"\n{datasets.TERMS}")
    return 0
